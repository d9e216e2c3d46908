// Proof by rejection and cutting. A stretch on which the field is nowhere 0 is free; any other is cut and its nearer part is
// looked at first, down to a part of the tolerance, where the sign behind it tells whether the ray went in. So the first hit is
// found whatever the field promises, jumps included. Nothing is kept of the parts that wait: the stretch after a free one
// is as long as the field is high there, or twice as long as the last. After A. Knoll et al., Fast Ray Tracing of Arbitrary Implicit Surfaces
// with Interval and Affine Arithmetic (2009).

// No stretch is cut shorter than this part of it; nor, of a ray that has spent its steps, than so many tolerances: bounds of what
// jumps stay wide however short the stretch is.
const FINEST: f32 = 0.0625;
const COARSEST: f32 = 4.0;
// Of what is not free this part at most is looked at next, and this part at least.
const MAX_FRACTION: f32 = 0.9;
const MIN_FRACTION: f32 = 0.0625;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    // The ray is free up to the last place outside.
    var bracket: Bracket;
    var t = 0.0;
    var segment = ray.t_max;
    // Of the field's range; a sample at the end of a stretch belongs to it.
    var evaluations = 0u;
    while evaluations < ray.steps {
        let distance = field(ray_point(ray, t));
        record_sample(t, distance);
        // A ray that starts inside, or at a surface, is at its hit.
        if evaluations == 0u && distance < hit_within(ray, t, tolerance(ray, t)) {
            return Trace(t, HIT, 1u);
        }
        bracket = with_sample(bracket, t, distance);
        let free = bracket.outside.x;
        let near = tolerance(ray, free);
        if bracket.crossed {
            evaluations++;
            if width(bracket) < hit_within(ray, t, near) {
                return Trace(bracket.inside.x, HIT, evaluations);
            }
            t = false_position(bracket);
            continue;
        }
        if !(t < ray.t_max) {
            return Trace(t, MISS, evaluations);
        }
        segment = limited_step(max(segment, max(distance, rounding(ray, t))), max(distance, near));
        var shortened = false;
        while evaluations < ray.steps {
            let end = min(free + segment, ray.t_max);
            let least = field_range(ray_point(ray, free), ray_point(ray, end)).x;
            evaluations++;
            let spent = f32(evaluations) / f32(ray.steps);
            let finest = max(max(FINEST, COARSEST * spent) * near, rounding(ray, t));
            if least > 0.0 || segment <= finest {
                t = end;
                break;
            }
            // As far as the field would stay above 0 if it fell evenly to its least value.
            let fraction = clamp(MAX_FRACTION * distance / max(distance - least, 1e-30), MIN_FRACTION, MAX_FRACTION);
            segment = max(fraction * (end - free), finest);
            shortened = true;
        }
        segment = select(2.0 * segment, 0.0, shortened);
    }
    return Trace(bracket.outside.x, CAPPED, ray.steps);
}
