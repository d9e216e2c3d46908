// The output for a pixel. The layout is that of `PixelBlock`.

struct Pixel {
    color: vec4f,
    depth: f32,
    // MISS, HIT or CAPPED, and perhaps UNPROVEN and LOOPS_ENDED.
    status: u32,
    evaluations: u32,
    primary_evaluations: u32,
}
