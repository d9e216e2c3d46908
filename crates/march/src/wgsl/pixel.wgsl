// The output for a pixel. The layout is that of `PixelBlock`.

struct Pixel {
    color: vec4f,
    depth: f32,
    // MISS, HIT or CAPPED, and perhaps UNPROVEN and LOOPS_ENDED.
    status: u32,
    evaluations: u32,
    primary_evaluations: u32,
}

// A ray that ran out of steps shows the background, as one that missed.
fn pixel_of(primary: Trace, color: vec3f, evaluations: u32) -> Pixel {
    let depth = select(primary.t, view.t_max, primary.t > view.t_max);
    return Pixel(vec4f(color, 1.0), depth, primary.status, evaluations, primary.evaluations);
}
