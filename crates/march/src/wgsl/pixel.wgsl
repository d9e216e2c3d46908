// The output for a pixel of rays.

// True for NaN. A compiler may assume that no number is NaN: NVIDIA's turned
// `select(t, limit, t > limit)` into a minimum, which is `limit` where t is NaN. A test of the bits
// stays as it is.
fn is_nan(number: f32) -> bool {
    return (bitcast<u32>(number) & 0x7fffffffu) > 0x7f800000u;
}

// A ray that ran out of steps shows the background, as one that missed.
fn pixel_of(primary: Trace, color: vec3f, evaluations: u32) -> Pixel {
    var depth = primary.t;
    if !is_nan(depth) {
        depth = min(depth, view.t_max);
    }
    return Pixel(vec4f(color, 1.0), depth, primary.status, evaluations, primary.evaluations);
}
