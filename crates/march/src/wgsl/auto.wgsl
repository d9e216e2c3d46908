// The method `auto`: relaxed steps as in `auto-relaxed`, up to a fraction of a pixel from the
// surface. From there the ray approaches by secant steps, so that a ray that only passes an edge is
// not taken for a hit on it; after a change of sign it closes in on the bracket. Analytic parts of
// the scene are intersected without marching (`pre_intersection.wgsl`).

// Factor of the step budget compared to other methods: a few rays graze a floor on their way to the
// horizon.
const STEP_BUDGET_FACTOR: u32 = 4;
// Weight of the last step's slope in the running mean.
const SLOPE_WEIGHT: f32 = 0.5;
// Upper bound of a step in distances: a ray that leads straight away from a surface would have no
// limit.
const MAX_RELAXATION: f32 = 4.0;
// Bounds of a secant step: the distance divided by this slope, or this fraction of the tolerance.
const MIN_SLOPE: f32 = 0.25;
const MIN_STEP_FRACTION: f32 = 0.25;
// Bound of the last secant, which places the hit: the distance divided by this slope.
const MIN_FINAL_SLOPE: f32 = 0.0078125;

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
                if COPIES {
                    found = march_copies(advanced(ray, known.start), known.end - known.start);
                } else {
                    found = march(advanced(ray, known.start), known.end - known.start);
                }
            }
        }
        found = combined(ray, known, found);
    } else {
        if COPIES {
            found = march_copies(ray, ray.t_max);
        } else {
            found = march(ray, ray.t_max);
        }
    }
    return found;
}

// Intersects copies analytically, a few at a time: at each position those that are sampled there.
// No other copy lies within the distance that `intersect_copies` returns.
fn march_copies(ray: Ray, end: f32) -> Trace {
    if SOFT_SHADOWS {
        // The clearance of a ray follows from distances alone.
        if records_clearance {
            return march(ray, end);
        }
    }
    var t = 0.0;
    for (var step = 0u; step < STEP_BUDGET_FACTOR * ray.steps; step++) {
        let sampled = t + intersect_copies(ray_point(ray, t), ray.direction);
        if sampled.x <= min(sampled.y, end) {
            return Trace(sampled.x, HIT, step + 1u);
        }
        if !(sampled.y <= end) {
            return Trace(sampled.y, MISS, step + 1u);
        }
        t = max(sampled.y, t + rounding(ray, t));
    }
    return Trace(t, CAPPED, STEP_BUDGET_FACTOR * ray.steps);
}

// True if a small distance means that the surface is near. Otherwise only a change of sign tells
// where it is.
fn small_is_near() -> bool {
    if LOOSE {
        if SOFT_SHADOWS {
            // These rays step no farther than the distance: they would hardly move.
            return records_clearance;
        }
        return false;
    }
    return true;
}

fn march(ray: Ray, end: f32) -> Trace {
    var bracket: Bracket;
    // The step from the last sample outside.
    var stride = 0.0;
    // The running mean of the field's slope along the ray; at first as if straight towards a
    // surface.
    var slope = -1.0;
    // True if the last sample is nearer to a surface than the tolerance.
    var close = false;
    for (var step = 0u; step < STEP_BUDGET_FACTOR * ray.steps; step++) {
        let last = bracket.outside;
        let t = last.x + stride;
        let distance = marched_field(ray_point(ray, t));
        // A ray that starts inside hits at its origin.
        if step == 0u && distance < 0.0 {
            return Trace(t, HIT, 1u);
        }
        let near = tolerance(ray, t);
        let hit = hit_within(ray, t, near);
        // The empty spheres around both ends of the step do not meet: something may lie between
        // them. A secant step is short enough without this check.
        if !bracket.crossed && !close && stride > last.y + max(distance, 0.0) + hit {
            stride = last.y;
            slope = -1.0;
            continue;
        }
        record_sample(ray, t, distance);
        let gain = select(-1.0, (distance - last.y) / stride, stride > 0.0);
        if abs(distance) < hit && small_is_near() {
            return Trace(t + distance / max(-gain, MIN_FINAL_SLOPE), HIT, step + 1u);
        }
        bracket = with_sample(bracket, t, distance);
        if bracket.crossed {
            let next = false_position(bracket);
            if width(bracket) < hit {
                return Trace(next, HIT, step + 1u);
            }
            stride = next - bracket.outside.x;
            continue;
        }
        // Only the sphere of the distance is known to be empty.
        let free = t + distance;
        if !(free <= end) {
            return Trace(free, MISS, step + 1u);
        }
        slope = mix(slope, gain, SLOPE_WEIGHT);
        close = distance < near;
        if close {
            stride = distance / max(-gain, MIN_SLOPE);
            // A ray along the surface, or one that looks for a change of sign, need not take
            // shorter steps.
            if LOOSE {
                stride = max(stride, MIN_STEP_FRACTION * near);
            } else if gain > -MIN_SLOPE {
                stride = max(stride, MIN_STEP_FRACTION * near);
            }
        } else {
            // Two spheres touch at a step z = r + (r + slope z).
            stride = 2.0 / clamp(1.0 - slope, 2.0 / MAX_RELAXATION, 2.0) * distance;
        }
        stride = min(limited_step(stride, distance), end - t);
    }
    return Trace(bracket.outside.x + stride, CAPPED, STEP_BUDGET_FACTOR * ray.steps);
}
