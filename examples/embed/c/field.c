/* Reads a scene, drops a ball of the given radius onto it from above, and prints where it comes to
 * rest. Then prints the distance and its derivative at each point of standard input, one "x y z" on
 * each line.
 *
 *   cc -I crates/capi examples/embed/c/field.c -L target/release -lsdfc_capi \
 *     -Wl,-rpath,target/release -o field
 *   ./field examples/embed/bowl.sdf 0.1 < points.txt
 */
#include "sdfc.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *read_file(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    size_t room = 1 << 16;
    char *text = malloc(room);
    *length = 0;
    while (text) {
        *length += fread(text + *length, 1, room - *length, file);
        if (*length < room) break;
        char *more = realloc(text, room *= 2);
        if (!more) free(text);
        text = more;
    }
    fclose(file);
    return text;
}

/* Hands over a file that a scene imports. The path is always below the scene's folder. */
static int read_beside(void *scene_path, const char *path, sdfc_file *file) {
    const char *scene = scene_path;
    const char *slash = strrchr(scene, '/');
    size_t folder = slash ? (size_t)(slash - scene) + 1 : 0;
    char *whole = malloc(folder + strlen(path) + 1);
    if (!whole) return 1;
    memcpy(whole, scene, folder);
    strcpy(whole + folder, path);
    size_t length;
    char *text = read_file(whole, &length);
    free(whole);
    int refused = !text || sdfc_file_give(file, text, length) != SDFC_STATUS_OK;
    free(text);
    return refused;
}

static sdfc_scene *read_scene(char *path) {
    size_t length;
    char *text = read_file(path, &length);
    if (!text) {
        fprintf(stderr, "%s cannot be read\n", path);
        return NULL;
    }
    char *diagnostics = NULL;
    sdfc_scene *scene = sdfc_compile_with_files(path, text, length, read_beside, path, &diagnostics);
    /* A scene can have warnings too. Without diagnostics the array is "[]". */
    if (diagnostics && diagnostics[1] != ']') fprintf(stderr, "%s\n", diagnostics);
    sdfc_string_free(diagnostics);
    free(text);
    return scene;
}

/* Moves a ball down until it touches the surface. No step is longer than the distance. */
static int drop(const sdfc_scene *scene, double radius, double ball[3]) {
    for (int step = 0; step < 1000; step++) {
        double distance;
        if (sdfc_distance(scene, ball, 1, &distance) != SDFC_STATUS_OK) return 0;
        double gap = distance - radius;
        if (gap < 1e-9) return 1;
        ball[1] -= gap;
        if (ball[1] < -100) return 0;
    }
    return 0;
}

int main(int count, char **arguments) {
    if (count != 3) {
        fprintf(stderr, "usage: field SCENE RADIUS\n");
        return 2;
    }
    sdfc_scene *scene = read_scene(arguments[1]);
    if (!scene) return 1;
    if (sdfc_set_number(scene, "wall", 0.1) != SDFC_STATUS_OK) fprintf(stderr, "%s\n", sdfc_error());

    double ball[3] = {0.3, 3, 0.1};
    if (drop(scene, atof(arguments[2]), ball)) printf("rests %.17g %.17g %.17g\n", ball[0], ball[1], ball[2]);

    double point[3], gradient[4];
    while (scanf("%lf %lf %lf", &point[0], &point[1], &point[2]) == 3) {
        if (sdfc_gradient(scene, point, 1, gradient) != SDFC_STATUS_OK) {
            fprintf(stderr, "%s\n", sdfc_error());
            return 1;
        }
        printf("%.17g %.17g %.17g %.17g\n", gradient[3], gradient[0], gradient[1], gradient[2]);
    }
    sdfc_scene_free(scene);
    return 0;
}
