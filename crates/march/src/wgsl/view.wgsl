// Camera, limits and lights of one picture, in `view`. The layouts are those of `ViewBlock` and `LightBlock`.

const MAX_LIGHTS: u32 = 8;
const MAX_REFLECTIONS: u32 = 8;

const SHADOW_OFF: u32 = 0;

struct Light {
    direction: vec3f,
    shadow: u32,
    color: vec3f,
    pad: f32,
}

struct View {
    eye: vec3f,
    pixel_radius: f32,
    right: vec3f,
    t_max: f32,
    up: vec3f,
    epsilon: f32,
    forward: vec3f,
    steps: u32,
    size: vec2u,
    tile_origin: vec2u,
    tile_size: vec2u,
    light_count: u32,
    pad: f32,
    ambient: vec3f,
    reflections: u32,
    background: vec3f,
    reflection_strength: f32,
    lights: array<Light, MAX_LIGHTS>,
}

// The ray through the centre of a pixel.
fn camera_ray(pixel: vec2u) -> Ray {
    let place = 2.0 * (vec2f(pixel) + 0.5) / vec2f(view.size) - 1.0;
    let direction = normalize(view.forward + place.x * view.right - place.y * view.up);
    return Ray(view.eye, 0.0, direction, view.pixel_radius, view.t_max, view.epsilon, view.steps);
}
