/* The C interface of the sdfc compiler, and of the fields, meshes and pictures of its scenes.
   Generated from crates/capi/src by HEADER_UPDATE=1 cargo test -p sdfc-capi --test header. */

#ifndef SDFC_H
#define SDFC_H

#include <stddef.h>
#include <stdint.h>

/*
 The result of a call.
 */
typedef enum {
  /*
   The call succeeded.
   */
  SDFC_STATUS_OK = 0,
  /*
   A required pointer is null.
   */
  SDFC_STATUS_NULL = 1,
  /*
   A string is not UTF-8.
   */
  SDFC_STATUS_NOT_UTF8 = 2,
  /*
   An unknown name, a value that an argument, param or option does not take, or a buffer that
   is too small.
   */
  SDFC_STATUS_ARGUMENT = 3,
  /*
   The scene has errors, draws nothing, or cannot be written with these options.
   */
  SDFC_STATUS_SCENE = 4,
  /*
   A bug in sdfc.
   */
  SDFC_STATUS_INTERNAL = 5,
  /*
   The machine cannot do it: there is no GPU, or not enough memory.
   */
  SDFC_STATUS_MACHINE = 6,
  /*
   The progress callback stopped the work.
   */
  SDFC_STATUS_STOPPED = 7,
} sdfc_status;

/*
 The content of a file.
 */
typedef struct sdfc_bytes sdfc_bytes;

/*
 The closed paths around a section of a scene.
 */
typedef struct sdfc_contour sdfc_contour;

/*
 The contents of a file that a scene imports, given by `sdfc_file_give`.
 */
typedef struct sdfc_file sdfc_file;

/*
 A closed mesh of triangles.
 */
typedef struct sdfc_mesh sdfc_mesh;

/*
 A finished picture.
 */
typedef struct sdfc_picture sdfc_picture;

/*
 A compiled scene, and values of its params.

 Functions that take the scene as `const` may run in any number of threads at once, but not while
 another function changes the scene.
 */
typedef struct sdfc_scene sdfc_scene;

/*
 A scene written as a shader.
 */
typedef struct sdfc_shader sdfc_shader;

/*
 Callback that receives how far a call is: `done` of `total` units of its current step. It runs
 in the thread of the call, and returns 0 to go on. Any other value stops the work, and the call
 fails with `SDFC_STATUS_STOPPED`. `context` is the pointer that was passed to the call.
 */
typedef int (*sdfc_progress)(void *context, uint64_t done, uint64_t total);

/*
 Callback that reads a file that a scene imports. It passes the contents to `sdfc_file_give` and
 returns 0. Any other value means that there is no such file or that the scene may not read it;
 that is an error at its `import`.

 `path` is relative to the scene's folder, uses `/`, and has no parts `.` or `..`:
 `parts/gear.sdf`. `context` is the pointer that was passed to `sdfc_compile_with_files`.
 */
typedef int (*sdfc_read)(void *context, const char *path, sdfc_file *file);

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Returns the version of sdfc, such as `0.1.0`. Do not free it.
 */
const char *sdfc_version(void);

/*
 Returns the message of the last error of this thread, or an empty string if the last call
 succeeded. It is valid until the thread's next call. Functions that free an object, and
 `sdfc_version`, do not change it.
 */
const char *sdfc_error(void);

/*
 Returns the status of the last call of this thread, also of one that returned a pointer.
 */
sdfc_status sdfc_error_status(void);

/*
 Frees a string that the caller must free. Does nothing for null.

 # Safety

 The string came from a function whose documentation says so, and is not used again.
 */
void sdfc_string_free(char *string);

/*
 Returns the bytes, and stores their number in `length`. Returns null for null.

 # Safety

 `bytes` is null or valid, and is not freed while its content is used. `length` is null or valid
 for a write.
 */
const uint8_t *sdfc_bytes_data(const sdfc_bytes *bytes, size_t *length);

/*
 Frees the content of a file. Does nothing for null.

 # Safety

 The bytes were returned by a function whose documentation says so, and are not used again.
 */
void sdfc_bytes_free(sdfc_bytes *bytes);

/*
 Makes the closed paths around the section of a scene by a plane, on all cores of the machine.

 `options` is a JSON object with the keys of `sdfc_mesh_make` and these, all of them optional;
 null is the same as `{}`. `normal`: the normal of the plane, of any length, by default
 `[0, 0, 1]`. `offset`: the coordinate of the plane along its normal, in scene units, by default
 0. `arcs`: true if paths may have circular arcs, which are described by their bulges.

 Returns null if the plane meets no inside, and in the cases of `sdfc_mesh_make`. Free the
 contour with `sdfc_contour_free`.

 # Safety

 As for `sdfc_mesh_make`.
 */
sdfc_contour *sdfc_contour_make(const sdfc_scene *scene,
                                const char *options,
                                sdfc_progress progress,
                                void *context);

/*
 Returns the contour as JSON, as `sdfc contour --json` writes it: its paths in the coordinates of
 the plane, the position and the directions of these coordinates in space, its area, length and
 bounds, and the certificate. `left_out` lists the solids or regions that the contour leaves out,
 as in `sdfc_mesh_describe`. Returns null for null.

 # Safety

 `contour` is null or a valid contour, and is not freed while the string is used.
 */
const char *sdfc_contour_describe(const sdfc_contour *contour);

/*
 Writes the contour as a file: `svg` or `dxf`.

 Returns null if the format is unknown. Free the result with `sdfc_bytes_free`.

 # Safety

 `contour` is null or a valid contour. `format` ends in a null byte.
 */
sdfc_bytes *sdfc_contour_write(const sdfc_contour *contour, const char *format);

/*
 Frees a contour. Does nothing for null.

 # Safety

 The contour was returned by `sdfc_contour_make` and is not used again.
 */
void sdfc_contour_free(sdfc_contour *contour);

/*
 Computes the signed distances at `count` points, each given as x, y, z. If the scene is
 certified, they never exceed the true distances. `distances` may be `points`.

 # Safety

 `scene` is null or a valid scene. `points` has 3 numbers for each point, `distances` has room
 for 1.
 */
sdfc_status sdfc_distance(const sdfc_scene *scene,
                          const double *points,
                          size_t count,
                          double *distances);

/*
 Computes the gradient of the distance and the distance at `count` points: x, y, z, distance for
 each. `gradients` may be `points`.

 # Safety

 `scene` is null or a valid scene. `points` has 3 numbers for each point, `gradients` has room
 for 4.
 */
sdfc_status sdfc_gradient(const sdfc_scene *scene,
                          const double *points,
                          size_t count,
                          double *gradients);

/*
 Computes the lowest and the highest corner of a box that contains the surface, three numbers
 each. A number is infinite if the surface has no bound on that side.

 # Safety

 `scene` is null or a valid scene. `lowest` and `highest` have room for 3 numbers each.
 */
sdfc_status sdfc_bounds(const sdfc_scene *scene, double *lowest, double *highest);

/*
 Appends a copy of `length` bytes to a file that a scene imports. The text of a scene must be
 UTF-8.

 # Safety

 `file` is the pointer that a running call of `sdfc_read` received. `bytes` is valid for `length`
 bytes.
 */
sdfc_status sdfc_file_give(sdfc_file *file, const void *bytes, size_t length);

/*
 Makes a closed mesh of the scene's surface, on all cores of the machine.

 `options` is a JSON object with these keys, all of them optional; null is the same as `{}`.
 `error`: the greatest distance between mesh and surface, in scene units. `error_relative`: the
 same as a fraction of the longest side of the scene's bounds, by default 0.001. `max_cells`: the
 most cells that are examined, by default 50000000, which take some gigabytes of memory.

 `progress` is called with `context`; it may be null.

 Returns null if the scene has no limit or no inside, the error is too small or greater than the
 scene, or `progress` stops the work. Free the mesh with `sdfc_mesh_free`.

 # Safety

 `scene` is null or a valid scene. `options` is null or ends in a null byte. `progress` may be
 called with `context`, and returns normally.
 */
sdfc_mesh *sdfc_mesh_make(const sdfc_scene *scene,
                          const char *options,
                          sdfc_progress progress,
                          void *context);

/*
 Returns the positions of the vertices in scene units, x, y, z for each, and stores the number of
 vertices in `count`.

 # Safety

 `mesh` is null or a valid mesh, and is not freed while the numbers are used. `count` is null or
 valid for a write.
 */
const double *sdfc_mesh_vertices(const sdfc_mesh *mesh, size_t *count);

/*
 Returns the normals at the vertices, x, y, z for each, of length 1, and stores the number of
 vertices in `count`. On a sharp edge the normal is that of one side.

 # Safety

 As for `sdfc_mesh_vertices`.
 */
const double *sdfc_mesh_normals(const sdfc_mesh *mesh, size_t *count);

/*
 Returns the colours at the vertices, linear red, green and blue for each, and stores their
 number in `count`: 0 if the scene has no materials.

 # Safety

 As for `sdfc_mesh_vertices`.
 */
const float *sdfc_mesh_colors(const sdfc_mesh *mesh, size_t *count);

/*
 Returns the triangles as indices of vertices, three for each, counter-clockwise as seen from
 outside, and stores the number of triangles in `count`.

 # Safety

 As for `sdfc_mesh_vertices`.
 */
const uint32_t *sdfc_mesh_triangles(const sdfc_mesh *mesh, size_t *count);

/*
 Returns what is known about the mesh as JSON, as `sdfc mesh --json` writes it: the numbers of
 its vertices and triangles, its volume, area and bounds, its connected parts, and the
 certificate. `left_out` lists the solids that have no limit, such as a floor, which the mesh
 leaves out because others of the scene have limits; it is empty if there are none. Returns null
 for null.

 # Safety

 `mesh` is null or a valid mesh, and is not freed while the string is used.
 */
const char *sdfc_mesh_describe(const sdfc_mesh *mesh);

/*
 Writes the mesh as a file: `stl`, `obj`, `ply`, `glb` or `3mf`.

 Returns null if the format is unknown or cannot hold the mesh. Free the result with
 `sdfc_bytes_free`.

 # Safety

 `mesh` is null or a valid mesh. `format` ends in a null byte.
 */
sdfc_bytes *sdfc_mesh_write(const sdfc_mesh *mesh, const char *format);

/*
 Frees a mesh. Does nothing for null.

 # Safety

 The mesh was returned by `sdfc_mesh_make` and is not used again.
 */
void sdfc_mesh_free(sdfc_mesh *mesh);

/*
 Measures the scene, on all cores of the machine: volume, center of mass, inertia and extent as
 intervals that are proven to hold the truth, as `sdfc measure --json` writes them. `left_out`
 lists the solids that are not measured, as in `sdfc_mesh_describe`.

 `options` is a JSON object with these keys, all of them optional; null is the same as `{}`.
 `error_relative`: how exact the volume is, as a fraction of itself, by default 0.001.
 `max_cells`: the most boxes that are examined, by default 4000000.

 Returns null if the scene has no limit, or `progress` stops the work. Free the string with
 `sdfc_string_free`.

 # Safety

 As for `sdfc_mesh_make`.
 */
char *sdfc_measure(const sdfc_scene *scene,
                   const char *options,
                   sdfc_progress progress,
                   void *context);

/*
 Draws the scene, on the GPU or on all cores of the CPU.

 `options` is a JSON object with these keys, all of them optional; null is the same as `{}`.
 `size`: width and height in pixels, by default `[640, 360]`. `region`: the part of the picture
 that is drawn: left, top, width, height in pixels. `backend`: `auto`, `gpu` or `cpu`; `auto`
 draws on the CPU without a GPU. `method`: the ray method, by default the scene's or `auto`.
 `samples`: rays per pixel. `isolines`: the distance between the isolines of a picture of
 regions. `camera`: `eye`, `target`, `up`, three numbers each, and either `fov`, in radians, or
 `height`, in scene units, for parallel rays; by default the scene's camera, or one that sees the
 whole scene.

 `progress` is called with `context`; it may be null.

 Returns null if the machine cannot draw the scene, or `progress` stops the work. Free the
 picture with `sdfc_picture_free`.

 # Safety

 `scene` is null or a valid scene. `options` is null or ends in a null byte. `progress` may be
 called with `context`, and returns normally.
 */
sdfc_picture *sdfc_render(const sdfc_scene *scene,
                          const char *options,
                          sdfc_progress progress,
                          void *context);

/*
 Stores width and height of the picture in pixels.

 # Safety

 `picture` is null or a valid picture. `width` and `height` are null or valid for a write.
 */
sdfc_status sdfc_picture_size(const sdfc_picture *picture, uint32_t *width, uint32_t *height);

/*
 Returns the colours of the pixels, row by row from the top: red, green, blue in sRGB and an
 alpha of 255 for each. Returns null for null.

 # Safety

 `picture` is null or a valid picture, and is not freed while the bytes are used.
 */
const uint8_t *sdfc_picture_rgba(const sdfc_picture *picture);

/*
 Returns the distance from the eye to the surface along the ray of each pixel, row by row from
 the top, in scene units: infinite for a ray that hit nothing. Returns null for null.

 # Safety

 `picture` is null or a valid picture, and is not freed while the numbers are used.
 */
const float *sdfc_picture_depths(const sdfc_picture *picture);

/*
 Returns what is known about the picture as JSON. `note` says why device or method differ from
 the options, and `unproven` says which part of the picture is unproven; both may be null.
 `stats` has what `sdfc render --stats` writes. Returns null for null.

 # Safety

 `picture` is null or a valid picture, and is not freed while the string is used.
 */
const char *sdfc_picture_describe(const sdfc_picture *picture);

/*
 Writes the picture as a PNG file. Returns null for null. Free the result with `sdfc_bytes_free`.

 # Safety

 `picture` is null or a valid picture.
 */
sdfc_bytes *sdfc_picture_png(const sdfc_picture *picture);

/*
 Frees a picture. Does nothing for null.

 # Safety

 The picture was returned by `sdfc_render` and is not used again.
 */
void sdfc_picture_free(sdfc_picture *picture);

/*
 Compiles a scene from `length` bytes of UTF-8 source. Messages use `name` as its file name.

 If `diagnostics` is not null, a JSON array of all diagnostics is stored there, as `sdfc check
 --json` writes it, or null if the call fails before it compiles. Free it with `sdfc_string_free`.

 Returns null if the source has errors or imports a file. Free the scene with `sdfc_scene_free`.

 # Safety

 `name` ends in a null byte. `source` is valid for `length` bytes. `diagnostics` is null or valid
 for a write.
 */
sdfc_scene *sdfc_compile(const char *name, const char *source, size_t length, char **diagnostics);

/*
 Compiles a scene like `sdfc_compile`, but `read` provides the files that it imports. `read` is
 called with `context`, in this thread, before this function returns. If `read` is null, imports
 are errors.

 # Safety

 The conditions of `sdfc_compile` hold. `read` may be called with `context`, and returns
 normally: no exceptions and no jumps out of it.
 */
sdfc_scene *sdfc_compile_with_files(const char *name,
                                    const char *source,
                                    size_t length,
                                    sdfc_read read,
                                    void *context,
                                    char **diagnostics);

/*
 Compiles a scene like `sdfc_compile_with_files`, with values for some of its params. These are
 the only way to set params that decide what the scene consists of, such as a number of copies.

 `values` is a JSON object with strings, by the names of params: `{ "n": "8" }`. Values are
 written as for `sdfc_set`. They are also the values of params in the compiled scene. Null is the
 same as `{}`.

 # Safety

 The conditions of `sdfc_compile_with_files` hold. `values` is null or ends in a null byte.
 */
sdfc_scene *sdfc_compile_with_values(const char *name,
                                     const char *source,
                                     size_t length,
                                     const char *values,
                                     sdfc_read read,
                                     void *context,
                                     char **diagnostics);

/*
 Returns a copy of a scene, with values of its own for params, time and frame. Both share what is
 compiled, so the copy is cheap. Returns null for null. Free it with `sdfc_scene_free`.

 # Safety

 `scene` is null or a valid scene.
 */
sdfc_scene *sdfc_scene_copy(const sdfc_scene *scene);

/*
 Returns what is known about a scene as JSON:

 - `params`: for each param its `name`, `type` (`number`, `int`, `angle`, `bool`, `color` or
   `choice`), `value` and `default` as lists of numbers (angles in radians, colours linear,
   choices as an index), `min` and `max` (null without a range), `choices`, `summary`, and
   `fixed`, which is true if only `sdfc_compile_with_values` sets it;
 - `certified`: true if distances never exceed the true distances;
 - `planar`: true if the scene draws regions.

 Returns null for null. Free the string with `sdfc_string_free`.

 # Safety

 `scene` is null or a valid scene.
 */
char *sdfc_scene_describe(const sdfc_scene *scene);

/*
 Frees a scene. Does nothing for null.

 # Safety

 The scene was returned by a function whose documentation says so, and is not used again.
 */
void sdfc_scene_free(sdfc_scene *scene);

/*
 Sets the param with a name. The value is written as in a scene: `0.5`, `90deg`, `true`,
 `#d94f30`; a choice by its name.

 A param that decides what the scene consists of, such as a number of copies, cannot change in a
 compiled scene: that is an error.

 # Safety

 `scene` is null or a valid scene. Both strings end in a null byte.
 */
sdfc_status sdfc_set(sdfc_scene *scene, const char *param, const char *value);

/*
 Sets a param that is a number, an integer or an angle in radians.

 # Safety

 `scene` is null or a valid scene. The name ends in a null byte.
 */
sdfc_status sdfc_set_number(sdfc_scene *scene, const char *param, double value);

/*
 Sets the values of `time`, in seconds, and `frame`, an integer, in the scene. A time that is not
 finite, or a frame that is no integer, is an error.

 # Safety

 `scene` is null or a valid scene.
 */
sdfc_status sdfc_set_time(sdfc_scene *scene, double time, double frame);

/*
 Writes the scene as a shader.

 `target` is one of `wgsl`, `glsl`, `glsl-es`, `hlsl`, `msl`, `spirv`, `shadertoy`. `part` is one
 of `field`, `march`, `render`. Names in the shader begin with `prefix`, and the first buffer has
 the index `binding` in `group`; both are at most 65535. The defaults for null are `wgsl`,
 `field` and `sdf_`.

 Returns null if the shader cannot be written. Free the shader with `sdfc_shader_free`.

 # Safety

 `scene` is null or a valid scene. The strings are null or end in a null byte.
 */
sdfc_shader *sdfc_shader_write(const sdfc_scene *scene,
                               const char *target,
                               const char *part,
                               const char *prefix,
                               uint32_t group,
                               uint32_t binding);

/*
 Returns the source of the shader, or its words in SPIR-V, with a null byte behind. If `length`
 is not null, the number of bytes without that null byte is stored there. Returns null for null.

 # Safety

 `shader` is null or a valid shader, and is not freed while the code is used. `length` is null or
 valid for a write.
 */
const char *sdfc_shader_code(const sdfc_shader *shader, size_t *length);

/*
 Returns the reflection of the shader as JSON, as `sdfc compile --reflect` writes it: its
 functions, its inputs, and the certificate of its field. Returns null for null.

 # Safety

 `shader` is null or a valid shader, and is not freed while the string is used.
 */
const char *sdfc_shader_reflection(const sdfc_shader *shader);

/*
 Computes the bytes of the shader's uniform buffer for the current values of the scene's params.

 Stores the number of bytes in `length`: 0 if the shader has no uniform buffer. If `bytes` is not
 null, writes the bytes there; `capacity` must be large enough.

 # Safety

 `shader` was written from `scene`; both are null or valid. `bytes` is null or has room for
 `capacity` bytes. `length` is null or valid for a write.
 */
sdfc_status sdfc_shader_uniform(const sdfc_shader *shader,
                                const sdfc_scene *scene,
                                uint8_t *bytes,
                                size_t capacity,
                                size_t *length);

/*
 Frees a shader. Does nothing for null.

 # Safety

 The shader was returned by `sdfc_shader_write` and is not used again.
 */
void sdfc_shader_free(sdfc_shader *shader);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SDFC_H */
