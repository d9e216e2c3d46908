// The camera, limits and lights of one picture. The layouts are those of `ViewBlock` and
// `LightBlock`, where the members are described.

const MAX_LIGHTS: u32 = 8;
const MAX_REFLECTIONS: u32 = 8;

const SUN: u32 = 0;
const SPOT: u32 = 2;

const SHADOW_OFF: u32 = 0;
const SHADOW_SOFT: u32 = 2;

struct Light {
    // The light's position; for a sun, the unit vector towards it.
    position: vec3f,
    kind: u32,
    // Linear colour; for a light with a position, as received at distance 1.
    color: vec3f,
    shadow: u32,
    // Unit vector along the axis of a spot light's cone.
    axis: vec3f,
    sharpness: f32,
    // Cosines of two angles from the axis: full light within the first, none outside the second.
    rim: vec2f,
    pad: vec2f,
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
    tolerance: f32,
    ambient: vec3f,
    reflections: u32,
    background: vec3f,
    reflection_strength: f32,
    zenith: vec3f,
    fog_density: f32,
    horizon: vec3f,
    occlusion_radius: f32,
    fog_color: vec3f,
    occlusion_strength: f32,
    lights: array<Light, MAX_LIGHTS>,
}

// The ray through the centre of a pixel.
fn camera_ray(pixel: vec2u) -> Ray {
    return ray_through(vec2f(pixel) + 0.5);
}

// The ray through a position in the picture, in pixels.
fn ray_through(pixels: vec2f) -> Ray {
    let position = 2.0 * pixels / vec2f(view.size) - 1.0;
    let aside = position.x * view.right - position.y * view.up;
    var ray = Ray(view.eye, 0.0, view.forward, 0.0, view.t_max, view.epsilon, view.tolerance, view.steps);
    if PARALLEL {
        ray.origin += aside;
        ray.radius = view.pixel_radius;
    } else {
        ray.direction = normalize(view.forward + aside);
        ray.spread = view.pixel_radius;
    }
    return ray;
}
