// Interval tracing. A ray segment on which the field is proven to be nonzero is skipped; any other
// is cut, and its nearer part is examined first, down to a fraction of the tolerance, where the
// sign of the field behind the segment decides. So the first hit is found whatever the field
// promises, even if it jumps. No stack of segments is kept: after a segment that is skipped the
// next one is as long as the distance there, or twice as long as the last one. After A. Knoll et
// al., Fast Ray Tracing of Arbitrary Implicit Surfaces with Interval and Affine Arithmetic (2009).
//
// The rest of a ray that runs out of steps is sampled, without a proof (`sampling.wgsl`). A scene
// whose bounds prove next to nothing has no `field_range`: its rays are sampled from the start.
//
// Analytic parts of the scene are intersected without marching, and rays are clipped to the box
// around the rest (`pre_intersection.wgsl`).

// The shortest segment, as a fraction of the tolerance. It grows up to COARSEST tolerances as a ray
// spends its steps: near a jump the bounds stay wide however short the segment is.
const FINEST: f32 = 0.0625;
const COARSEST: f32 = 4.0;
// Bounds on the fraction of a segment that is examined next.
const MAX_FRACTION: f32 = 0.9;
const MIN_FRACTION: f32 = 0.0625;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var found: Trace;
    if PRE_INTERSECTS {
        let known = pre_intersect(ray);
        found = Trace(0.0, MISS, 0u);
        if ANY_MARCHED {
            if known.start <= known.end {
                // The march ends where the ray does, so its steps suffice for the shorter way.
                var rest = advanced(ray, known.start);
                rest.t_max = known.end - known.start;
                found = march(rest);
            }
        }
        found = combined(ray, known, found);
    } else {
        found = march(ray);
    }
    return found;
}

// Each iteration examines a segment or takes a step, and samples the field first where the ray has
// moved. A loop over segments within one over samples would be natural, but a software driver
// (Mesa 22) mixes up the rays of a workgroup there if the field has loops too.
fn march(ray: Ray) -> Trace {
    // The ray is free of the surface up to the last sample outside.
    var bracket: Bracket;
    var t = 0.0;
    var distance = 0.0;
    var segment = ray.t_max;
    // True if the field at t is known, because a segment from there was found too long.
    var shortened = false;
    // At first as if straight towards a surface.
    var slope = 1.0;
    // Evaluations of the field's range; the sample at the end of a segment counts as part of it.
    var evaluations = 0u;
    // Steps for a proof, and for the samples after it.
    var proving = 0u;
    if PROVED {
        proving = ray.steps;
    }
    let budget = proving + SAMPLE_BUDGET_FACTOR * ray.steps;
    while evaluations < budget {
        if !shortened {
            distance = marched_field(ray_point(ray, t));
            record_sample(ray, t, distance);
            // A ray that starts inside or on a surface hits at its origin. A small value does not
            // tell that it does: the field may be flat there.
            if evaluations == 0u && distance <= 0.0 {
                return Trace(t, HIT, 1u);
            }
            slope = recent_slope(slope, bracket.outside, t, distance);
            bracket = with_sample(bracket, t, distance);
        }
        let free = bracket.outside.x;
        let near = tolerance(ray, free);
        if bracket.crossed {
            evaluations++;
            let is_narrow = width(bracket) < hit_within(ray, t, near);
            t = false_position(bracket);
            if is_narrow {
                return Trace(t, HIT, evaluations);
            }
        } else if !(t < ray.t_max) {
            // Beyond the end of any ray; NaN where the field is NaN.
            return Trace(t + FAR, MISS, evaluations);
        } else if evaluations >= proving {
            record_gap();
            t = min(t + sampling_step(ray, t, distance, slope, budget - evaluations), ray.t_max);
            evaluations++;
            shortened = false;
        } else {
            if PROVED {
                if !shortened {
                    segment = limited_step(max(segment, max(distance, rounding(ray, t))), max(distance, near));
                }
                let end = min(free + segment, ray.t_max);
                let least = field_range(ray_point(ray, free), ray_point(ray, end)).x;
                evaluations++;
                let spent = f32(evaluations) / f32(ray.steps);
                let finest = max(max(FINEST, COARSEST * spent) * near, rounding(ray, t));
                if least > 0.0 || segment <= finest {
                    if !(least > 0.0) && end - free > max(near, rounding(ray, t)) {
                        record_gap();
                    }
                    t = end;
                    segment = select(2.0 * segment, 0.0, shortened);
                    shortened = false;
                } else {
                    // As far as the field would stay positive if it fell linearly to its lower
                    // bound.
                    let fraction = clamp(MAX_FRACTION * distance / max(distance - least, 1e-30), MIN_FRACTION, MAX_FRACTION);
                    segment = max(fraction * (end - free), finest);
                    shortened = true;
                }
            }
        }
    }
    return Trace(bracket.outside.x, CAPPED, budget);
}
