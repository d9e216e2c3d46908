// The entry point: one invocation for each pixel of a tile.

@group(0) @binding(2) var<storage, read_write> pixels: array<Pixel>;

// Beside the status of a pixel: a ray passed a stretch without a proof that it is free.
const UNPROVEN: u32 = 0x10000;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= view.tile_size) {
        return;
    }
    load_frame();
    if CULLED {
        start_pixel(id.xy);
    }
    pixels[id.y * view.tile_size.x + id.x] = picture(view.tile_origin + id.xy);
    if RECORDS_GAPS {
        if is_unproven {
            pixels[id.y * view.tile_size.x + id.x].status |= UNPROVEN;
        }
    }
    if INSTRUMENTED {
        pixels[id.y * view.tile_size.x + id.x].evaluations = iterations_run;
    }
}
