// Camera, limits and lights of one picture, and the pixels that come out of it. The layouts are
// those of `ViewBlock`, `LightBlock` and `PixelBlock`.

const MAX_LIGHTS: u32 = 8;
const MAX_REFLECTIONS: u32 = 8;

const SHADOW_OFF: u32 = 0;

const MISS: u32 = 0;
const HIT: u32 = 1;
const CAPPED: u32 = 2;

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
    fixed_step: f32,
    ambient: vec3f,
    reflections: u32,
    background: vec3f,
    reflection_strength: f32,
    lights: array<Light, MAX_LIGHTS>,
}

struct Pixel {
    color: vec4f,
    depth: f32,
    status: u32,
    evaluations: u32,
    primary_evaluations: u32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(2) var<storage, read_write> pixels: array<Pixel>;
