// The output for a pixel of rays.

// A ray that ran out of steps shows the background, as one that missed.
fn pixel_of(primary: Trace, color: vec3f, evaluations: u32) -> Pixel {
    var depth = primary.t;
    if !is_nan(depth) {
        depth = min(depth, view.t_max);
    }
    return Pixel(vec4f(color, 1.0), depth, primary.status, evaluations, primary.evaluations);
}
