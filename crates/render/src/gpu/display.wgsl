// Writes a tile's pixels into a texture that a window shows. Its bytes are sRGB, as those of
// `linear_to_srgb8` are.

struct Pixel {
    color: vec4f,
    depth: f32,
    status: u32,
    evaluations: u32,
    primary_evaluations: u32,
}

struct Tile {
    origin: vec2u,
    size: vec2u,
}

@group(0) @binding(0) var<uniform> tile: Tile;
@group(0) @binding(1) var<storage, read> pixels: array<Pixel>;
@group(0) @binding(2) var picture: texture_storage_2d<rgba8unorm, write>;

fn encoded(linear: vec3f) -> vec3f {
    let light = clamp(linear, vec3f(0.0), vec3f(1.0));
    let curved = 1.055 * pow(light, vec3f(1.0 / 2.4)) - 0.055;
    return select(curved, 12.92 * light, light <= vec3f(0.0031308));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= tile.size) {
        return;
    }
    let color = encoded(pixels[id.y * tile.size.x + id.x].color.rgb);
    textureStore(picture, tile.origin + id.xy, vec4f(color, 1.0));
}
