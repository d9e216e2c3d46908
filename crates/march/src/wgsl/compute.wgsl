// The entry point: one invocation for each pixel of a tile.

@group(0) @binding(2) var<storage, read_write> pixels: array<Pixel>;

// Beside the status of a pixel: a ray passed a stretch without a proof that it is free.
const UNPROVEN: u32 = 0x10000;
// Beside the status of a pixel: the driver ended its loops early.
const LOOPS_ENDED: u32 = 0x20000;

// True if the driver has ended the loops of this invocation early, as llvmpipe of Mesa 22.3 does
// without an error after 65,535 iterations in total. From then on, loops end after one iteration.
// This one runs two. A constant number would be unrolled, and a number from the uniforms alone
// would make that driver compile the shader anew for each dispatch.
fn has_ended_loops(column: u32) -> bool {
    let expected = select(1u, 2u, column < view.tile_size.x);
    var iterations = 0u;
    loop {
        if iterations >= expected {
            break;
        }
        iterations++;
    }
    return iterations < expected;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if any(id.xy >= view.tile_size) {
        return;
    }
    limit_loops(group.x < view.tile_size.x);
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
    if HAS_LOOPS {
        if has_ended_loops(id.x) {
            pixels[id.y * view.tile_size.x + id.x].status |= LOOPS_ENDED;
        }
    }
    if INSTRUMENTED {
        pixels[id.y * view.tile_size.x + id.x].evaluations = iterations_run;
    }
}
