// Writes a tile's pixels into a texture that a window shows. Its bytes are sRGB, as those of
// `linear_to_srgb8` are.

struct Tile {
    origin: vec2u,
    size: vec2u,
}

@group(0) @binding(0) var<uniform> tile: Tile;
@group(0) @binding(1) var<storage, read> pixels: array<Pixel>;
@group(0) @binding(2) var picture: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= tile.size) {
        return;
    }
    let color = srgb(pixels[id.y * tile.size.x + id.x].color.rgb);
    textureStore(picture, tile.origin + id.xy, vec4f(color, 1.0));
}
