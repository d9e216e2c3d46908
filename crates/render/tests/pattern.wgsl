// Every pixel tells where it is, what it was given, and which tile it came in: with the bindings of
// a scene's shader, without a scene.

struct Light {
    place: vec3f,
    kind: u32,
    color: vec3f,
    shadow: u32,
    axis: vec3f,
    sharpness: f32,
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
    pad: f32,
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
    lights: array<Light, 8>,
}

struct Pixel {
    color: vec4f,
    depth: f32,
    status: u32,
    evaluations: u32,
    primary_evaluations: u32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> values: array<vec4f, 2>;
@group(0) @binding(2) var<storage, read_write> pixels: array<Pixel>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) place: vec3u) {
    if any(place.xy >= view.tile_size) {
        return;
    }
    let pixel = view.tile_origin + place.xy;
    let color = vec4f(values[1].w, view.eye.z, view.lights[0].color.y, 1.0);
    pixels[place.y * view.tile_size.x + place.x] =
        Pixel(color, view.t_max, 1u, pixel.x + pixel.y * view.size.x, view.steps);
}
