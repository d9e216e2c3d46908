
// After a field's own functions: pixel i tells the distance at the i-th value, as its depth.

struct Pixel {
    color: vec4f,
    depth: f32,
    status: u32,
    evaluations: u32,
    primary_evaluations: u32,
}

struct Tile {
    unused: array<vec4u, 4>,
    unused_end: vec2u,
    tile_origin: vec2u,
    tile_size: vec2u,
}

@group(0) @binding(0) var<uniform> view: Tile;
@group(0) @binding(1) var<uniform> points: array<vec4f, 256>;
@group(0) @binding(2) var<storage, read_write> pixels: array<Pixel>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) place: vec3u) {
    if any(place.xy >= view.tile_size) {
        return;
    }
    let here = place.y * view.tile_size.x + place.x;
    let value = sdf_distance(points[view.tile_origin.x + place.x].xyz);
    pixels[here] = Pixel(vec4f(), value, 1u, 1u, 1u);
}
