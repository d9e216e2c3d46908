// A picture without buffers, for hosts that give a shader only the picture's size, the mouse and
// the clock: functions set the camera, the limits and the lights. The entry point is there only to
// keep `image`.

const PI: f32 = 3.14159265;
// Largest pitch of a dragged camera, in radians: just short of straight above.
const MAX_PITCH: f32 = 1.5;

struct Camera {
    eye: vec3f,
    // The point in the middle of the picture.
    center: vec3f,
    up: vec3f,
    // Vertical field of view in radians; for parallel rays, the height of the picture.
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

// Supplied by the scene: limits, lights, and the eye for which the limits were chosen.
fn load_view() {
}

// Supplied by the scene: the scene's camera.
fn camera() -> Camera {
    return Camera();
}

// The camera orbited around the centre: a full turn over the picture's width, half a turn over its
// height.
fn orbited(camera_at_rest: Camera, mouse: vec2f) -> Camera {
    let offset = camera_at_rest.eye - camera_at_rest.center;
    let radius = length(offset);
    let angles = vec2f(2.0 * PI, PI) * (vec2f(0.5) - mouse);
    let yaw = atan2(offset.x, offset.z) + angles.x;
    let pitch = clamp(asin(offset.y / radius) + angles.y, -MAX_PITCH, MAX_PITCH);
    let direction = vec3f(cos(pitch) * sin(yaw), sin(pitch), cos(pitch) * cos(yaw));
    return Camera(camera_at_rest.center + radius * direction, camera_at_rest.center, camera_at_rest.up, camera_at_rest.lens);
}

// The unit vector to the right. If the camera looks along `up`, what lies behind is at the bottom
// of the picture, as on a map.
fn camera_right(forward: vec3f, up: vec3f) -> vec3f {
    let right = cross(forward, normalize(up));
    if length(right) > 1e-6 {
        return normalize(right);
    }
    let level = abs(forward.z) > 0.9;
    return normalize(cross(forward, select(vec3f(0.0, 0.0, forward.y), vec3f(0.0, 1.0, 0.0), level)));
}

fn set_view(shown: Camera, size: vec2f) {
    var half_height = 0.5 * shown.lens;
    if PARALLEL {
    } else {
        half_height = tan(half_height);
    }
    let forward = normalize(shown.center - shown.eye);
    let right = camera_right(forward, shown.up);
    // Rays reach as far as they did from the original eye.
    view.t_max += distance(shown.eye, view.eye);
    view.eye = shown.eye;
    view.forward = forward;
    view.right = half_height * (size.x / size.y) * right;
    view.up = half_height * cross(right, forward);
    view.pixel_radius = half_height / size.y;
    view.size = vec2u(size);
}

// A scene without lights is lit from the eye.
fn load_headlight() {
    view.lights[0].position = -view.forward;
}

// The colour at a position in pixels from the picture's lower left. The mouse orbits the camera
// once it was dragged.
fn image(position: vec2f, size: vec2f, mouse: vec2f, now: f32, count: f32) -> vec4f {
    load_time(now);
    load_count(count);
    limit_loops(position.x >= 0.0);
    load_frame();
    load_view();
    var shown = camera();
    if any(mouse > vec2f(0.0)) {
        shown = orbited(shown, mouse / size);
    }
    set_view(shown, size);
    load_headlight();
    let pixel = vec2u(position);
    let result = picture(vec2u(pixel.x, view.size.y - 1u - pixel.y));
    return vec4f(srgb(result.color.rgb), 1.0);
}

@fragment
fn anchor(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return image(position.xy, vec2f(1.0), vec2f(0.0), 0.0, 0.0);
}
