// Segment tracing: a step is as long as the field can stay positive at the steepest slope by which
// it falls anywhere on the segment of the ray ahead. The segment grows with the steps. After a
// change of sign the ray closes in on the bracket. After E. Galin et al., Segment Tracing Using
// Local Lipschitz Bounds (2020); there the slope's magnitude is bounded, here its downward part.

// Length of the next segment as a multiple of the last step.
const GROWTH: f32 = 2.0;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var bracket: Bracket;
    var t = 0.0;
    var segment = ray.t_max;
    for (var step = 0u; step < ray.steps; step++) {
        let distance = field(ray_point(ray, t));
        record_sample(ray, t, distance);
        let near = tolerance(ray, t);
        // A ray that starts inside or on a surface hits at its origin. A small value does not tell
        // that it does: the field may be flat there.
        if step == 0u && distance <= 0.0 {
            return Trace(t, HIT, 1u);
        }
        bracket = with_sample(bracket, t, distance);
        if bracket.crossed {
            let is_narrow = width(bracket) < hit_within(ray, t, near);
            t = false_position(bracket);
            if is_narrow {
                return Trace(t, HIT, step + 1u);
            }
        } else {
            let end = min(t + segment, ray.t_max);
            let slopes = field_slope_range(ray_point(ray, t), ray_point(ray, end), ray.direction);
            // At least the tolerance: what is thinner along the ray is less than a quarter of a
            // pixel.
            let free = limited_step(distance / max(-slopes.x, 1e-6), distance);
            let stride = clamp(free, near, max(end - t, near));
            segment = GROWTH * stride;
            t += stride;
            if !(t <= ray.t_max) {
                return Trace(t, MISS, step + 1u);
            }
        }
    }
    return Trace(t, CAPPED, ray.steps);
}
