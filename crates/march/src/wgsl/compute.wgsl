// The entry point: one invocation for each pixel of a tile.

@group(0) @binding(2) var<storage, read_write> pixels: array<Pixel>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) place: vec3u) {
    if any(place.xy >= view.tile_size) {
        return;
    }
    load_frame();
    if CULLED {
        open_visits(place.xy);
    }
    pixels[place.y * view.tile_size.x + place.x] = picture(view.tile_origin + place.xy);
    if COUNTED {
        pixels[place.y * view.tile_size.x + place.x].evaluations = visited;
    }
}
