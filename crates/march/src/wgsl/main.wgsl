// The entry point: one invocation for each pixel of a tile.

// Where a ray ran out of steps the background is drawn, as where it missed.
fn pixel_of(seen: Trace, color: vec3f, evaluations: u32) -> Pixel {
    let depth = select(seen.t, view.t_max, seen.t > view.t_max);
    return Pixel(vec4f(color, 1.0), depth, seen.status, evaluations, seen.evaluations);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) place: vec3u) {
    if any(place.xy >= view.tile_size) {
        return;
    }
    load_frame();
    pixels[place.y * view.tile_size.x + place.x] = picture(view.tile_origin + place.xy);
}
