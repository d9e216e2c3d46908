// A planar picture without buffers, for hosts that give a shader only the picture's size, the mouse
// and the clock. The entry point is there only to keep `image`.

struct Camera {
    eye: vec3f,
    // The point in the middle of the picture.
    center: vec3f,
    up: vec3f,
    // The height of the picture in scene units.
    lens: f32,
}

var<private> view: View;
var<private> time: f32;
var<private> frame: f32;

fn load_time(now: f32) {
    time = now;
}

fn load_count(count: f32) {
    frame = count;
}

// Supplied by the scene: the scene's camera.
fn camera() -> Camera {
    return Camera();
}

// The picture's middle and size. The drag of the mouse is the fraction of the picture by which its
// content moves.
fn set_view(shown: Camera, size: vec2f, drag: vec2f) {
    let up = normalize(select(vec2f(0.0, 1.0), shown.up.xy, any(shown.up.xy != vec2f(0.0))));
    let half_size = 0.5 * shown.lens * vec2f(size.x / size.y, 1.0);
    view.right = vec3f(half_size.x * vec2f(up.y, -up.x), 0.0);
    view.up = vec3f(half_size.y * up, 0.0);
    view.eye = shown.center - 2.0 * (drag.x * view.right + drag.y * view.up);
    view.pixel_radius = half_size.y / size.y;
    view.size = vec2u(size);
}

// The colour at a position in pixels from the picture's lower left. The mouse moves the picture
// once it was dragged.
fn image(position: vec2f, size: vec2f, mouse: vec2f, now: f32, count: f32) -> vec4f {
    load_time(now);
    load_count(count);
    limit_loops(position.x >= 0.0);
    load_frame();
    var drag = vec2f(0.0);
    if any(mouse > vec2f(0.0)) {
        drag = mouse / size - 0.5;
    }
    set_view(camera(), size, drag);
    let pixel = vec2u(position);
    let result = picture(vec2u(pixel.x, view.size.y - 1u - pixel.y));
    return vec4f(srgb(result.color.rgb), 1.0);
}

@fragment
fn anchor(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return image(position.xy, vec2f(1.0), vec2f(0.0), 0.0, 0.0);
}
