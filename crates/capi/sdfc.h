/* The sdfc compiler and the fields of its scenes. Made from crates/capi/src/lib.rs by HEADER_UPDATE=1 cargo test -p sdfc-capi. */

#ifndef SDFC_H
#define SDFC_H

#include <stddef.h>
#include <stdint.h>

/*
 How a call ended.
 */
typedef enum {
  /*
   As asked.
   */
  SDFC_STATUS_OK = 0,
  /*
   A pointer is null that may not be.
   */
  SDFC_STATUS_NULL = 1,
  /*
   A text is not UTF-8.
   */
  SDFC_STATUS_NOT_UTF8 = 2,
  /*
   There is no such target, part, param or value, or no room.
   */
  SDFC_STATUS_ARGUMENT = 3,
  /*
   The scene has errors, draws nothing, or cannot be written so.
   */
  SDFC_STATUS_SCENE = 4,
  /*
   A fault of sdfc.
   */
  SDFC_STATUS_INTERNAL = 5,
} sdfc_status;

/*
 The contents of a file that a scene imports, given by `sdfc_file_give`.
 */
typedef struct sdfc_file sdfc_file;

/*
 A compiled scene, and values of its params.

 Any number of threads may call functions that take it as `const`, while none calls another.
 */
typedef struct sdfc_scene sdfc_scene;

/*
 A scene written as a shader.
 */
typedef struct sdfc_shader sdfc_shader;

/*
 Gives a file that a scene imports to `file`, and returns 0; anything else where there is none or the scene may not have it,
 which is then an error at its `import`. `path` is below the scene's folder, with `/` between its parts and neither `.` nor `..`
 among them: `parts/gear.sdf`. `context` is what `sdfc_compile_with_files` was given.
 */
typedef int (*sdfc_read)(void *context, const char *path, sdfc_file *file);

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 The version of sdfc, such as `0.1.0`. Not to be freed.
 */
const char *sdfc_version(void);

/*
 Why the last call of this thread failed, as text for people; empty if it did not. Valid until the thread's next call.
 */
const char *sdfc_error(void);

/*
 Compiles a scene: `length` bytes of source, UTF-8; `name` is what messages call it. Where `diagnostics` is not null, a
 JSON array of all findings is stored there, as `sdfc check --json` writes it, to be freed with `sdfc_string_free`.

 Null where the source has errors, or imports a file; else to be freed with `sdfc_scene_free`.

 # Safety

 `name` ends in a null byte; `source` has that many bytes; `diagnostics` may be written.
 */
sdfc_scene *sdfc_compile(const char *name,
                         const char *source,
                         size_t length,
                         char **diagnostics);

/*
 As `sdfc_compile`, for a scene that imports files: `read` gives them. It is called while this runs, by this thread, with
 `context`. Null for it is none.

 # Safety

 As `sdfc_compile`; `read` may be called with `context`, and neither throws nor jumps out of it.
 */
sdfc_scene *sdfc_compile_with_files(const char *name,
                                    const char *source,
                                    size_t length,
                                    sdfc_read read,
                                    void *context,
                                    char **diagnostics);

/*
 Frees what `sdfc_compile` gave; null is nothing.

 # Safety

 It came from there and is not used again.
 */
void sdfc_scene_free(sdfc_scene *scene);

/*
 Frees a text that was given to be freed; null is nothing.

 # Safety

 It came from a function that says so and is not used again.
 */
void sdfc_string_free(char *string);

/*
 Sets a param by its name. The value is written as in a scene: `0.5`, `90deg`, `true`, `#d94f30`; a choice by its name.

 # Safety

 The scene is one of `sdfc_compile`; both texts end in a null byte.
 */
sdfc_status sdfc_set(sdfc_scene *scene,
                     const char *param,
                     const char *value);

/*
 Sets a param that is a number, a whole number or an angle in radians.

 # Safety

 The scene is one of `sdfc_compile`; the name ends in a null byte.
 */
sdfc_status sdfc_set_number(sdfc_scene *scene, const char *param, double value);

/*
 Sets what `time`, in seconds, and `frame`, a whole number, are in the scene.

 # Safety

 The scene is one of `sdfc_compile`.
 */
sdfc_status sdfc_set_time(sdfc_scene *scene, double time, double frame);

/*
 Signed distances at `count` points, each x, y, z one after the other. Never more than the true distance where the
 scene is certified.

 # Safety

 The scene is one of `sdfc_compile`; `points` has 3 numbers for each point, `distances` room for one.
 */
sdfc_status sdfc_distance(const sdfc_scene *scene,
                          const double *points,
                          size_t count,
                          double *distances);

/*
 The derivative of the distance at `count` points, and the distance: x, y, z, distance for each.

 # Safety

 The scene is one of `sdfc_compile`; `points` has 3 numbers for each point, `gradients` room for 4.
 */
sdfc_status sdfc_gradient(const sdfc_scene *scene,
                          const double *points,
                          size_t count,
                          double *gradients);

/*
 Lowest and highest corner of a box that holds the surface, three numbers each; infinite where there is no end.

 # Safety

 The scene is one of `sdfc_compile`; both have room for 3 numbers.
 */
sdfc_status sdfc_bounds(const sdfc_scene *scene,
                        double *lowest,
                        double *highest);

/*
 Writes the scene as a shader. `target` is one of `wgsl`, `glsl`, `glsl-es`, `hlsl`, `msl`, `spirv`, `shadertoy`; `part` one of
 `field`, `march`, `render`; names begin with `prefix`, and the first buffer is at `group` and `binding`. Null for a text
 is `wgsl`, `field` and `sdf_`.

 Null where that cannot be; else to be freed with `sdfc_shader_free`.

 # Safety

 The scene is one of `sdfc_compile`; texts end in a null byte.
 */
sdfc_shader *sdfc_shader_write(const sdfc_scene *scene,
                               const char *target,
                               const char *part,
                               const char *prefix,
                               uint32_t group,
                               uint32_t binding);

/*
 The shader's text or words, `length` bytes if that is not null; behind them there is a null byte. Null for null.

 # Safety

 The shader is one of `sdfc_shader_write`, and is not freed while the code is used; `length` may be written.
 */
const char *sdfc_shader_code(const sdfc_shader *shader,
                             size_t *length);

/*
 What the shader offers and reads, and what is certified of its field, as JSON: that of `sdfc compile --reflect`. Null
 for null.

 # Safety

 The shader is one of `sdfc_shader_write`, and is not freed while the text is used.
 */
const char *sdfc_shader_reflection(const sdfc_shader *shader);

/*
 The bytes of the shader's uniform buffer for the values that the scene has. Stores how many they are, 0 where the shader has
 no such buffer, in `length`, and the bytes themselves where `bytes` is not null and `capacity` is as much.

 # Safety

 The shader was written of this scene; `bytes` has room for `capacity`; `length` may be written.
 */
sdfc_status sdfc_shader_uniform(const sdfc_shader *shader,
                                const sdfc_scene *scene,
                                uint8_t *bytes,
                                size_t capacity,
                                size_t *length);

/*
 Frees what `sdfc_shader_write` gave; null is nothing.

 # Safety

 It came from there and is not used again.
 */
void sdfc_shader_free(sdfc_shader *shader);

/*
 Adds bytes to a file that a scene imports, which are copied. A scene's text is UTF-8.

 # Safety

 The file is that of a call of `sdfc_read` that has not returned; there are that many bytes.
 */
sdfc_status sdfc_file_give(sdfc_file *file, const void *bytes, size_t length);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SDFC_H */
