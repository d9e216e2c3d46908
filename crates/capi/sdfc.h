/* The C interface of the sdfc compiler and of the fields of its scenes.
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
   Unknown target, part, param or value, or a buffer that is too small.
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
} sdfc_status;

/*
 The contents of a file that a scene imports, given by `sdfc_file_give`.
 */
typedef struct sdfc_file sdfc_file;

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
 succeeded. It is valid until the thread's next call.
 */
const char *sdfc_error(void);

/*
 Compiles a scene from `length` bytes of UTF-8 source. Messages use `name` as its file name.

 If `diagnostics` is not null, a JSON array of all diagnostics is stored there, as `sdfc check
 --json` writes it. Free it with `sdfc_string_free`.

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
 Frees a scene. Does nothing for null.

 # Safety

 The scene was returned by `sdfc_compile` or `sdfc_compile_with_files` and is not used again.
 */
void sdfc_scene_free(sdfc_scene *scene);

/*
 Frees a string that the caller must free. Does nothing for null.

 # Safety

 The string came from a function whose documentation says so, and is not used again.
 */
void sdfc_string_free(char *string);

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
 Sets the values of `time`, in seconds, and `frame`, an integer, in the scene.

 # Safety

 `scene` is null or a valid scene.
 */
sdfc_status sdfc_set_time(sdfc_scene *scene, double time, double frame);

/*
 Computes the signed distances at `count` points, each given as x, y, z. If the scene is
 certified, they never exceed the true distances.

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
 each.

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
 Writes the scene as a shader.

 `target` is one of `wgsl`, `glsl`, `glsl-es`, `hlsl`, `msl`, `spirv`, `shadertoy`. `part` is one
 of `field`, `march`, `render`. Names in the shader begin with `prefix`, and the first buffer has
 the index `binding` in `group`. The defaults for null are `wgsl`, `field` and `sdf_`.

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

/*
 Appends a copy of `length` bytes to a file that a scene imports. The text of a scene must be
 UTF-8.

 # Safety

 `file` is the pointer that a running call of `sdfc_read` received. `bytes` is valid for `length`
 bytes.
 */
sdfc_status sdfc_file_give(sdfc_file *file, const void *bytes, size_t length);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SDFC_H */
