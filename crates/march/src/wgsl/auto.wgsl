// Steps as long as those of `auto-relaxed`, to a part of a pixel, wherever on the ray that is. That near to a surface the ray
// closes in by secants, so that a ray that only passes by an edge is not taken for a hit on it; where the field led
// through the surface it closes in on the bracket. What the scene meets without steps is not marched (`ahead.wgsl`).

// A ray may take so many times the steps that it has by other methods: the few that do graze a floor on their way to the horizon.
const STEP_BUDGET_FACTOR: u32 = 4;
// Weight of the last step's slope in the mean.
const SLOPE_WEIGHT: f32 = 0.5;
// Steps are at most so many distances: straight away from a surface there is no end to them.
const MAX_RELAXATION: f32 = 4.0;
// A secant is at most the inverse of this times the distance, or that part of the tolerance.
const MIN_SLOPE: f32 = 0.25;
const MIN_STEP_FRACTION: f32 = 0.25;
// What is left of the way at a hit is at most the inverse of this times the distance.
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

// Copies are met in closed form, a few at a time: those that are sampled at a place, as far from there as there are no others.
fn march_copies(ray: Ray, end: f32) -> Trace {
    if SOFT_SHADOWS {
        // How narrowly a ray passes is known from the distance alone.
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

fn march(ray: Ray, end: f32) -> Trace {
    var bracket: Bracket;
    // From the last place outside to the next one.
    var stride = 0.0;
    // What the distance gains per unit of length, in the mean: straight towards a surface at first.
    var slope = -1.0;
    // Whether the last place is nearer to a surface than the tolerance.
    var close = false;
    for (var step = 0u; step < STEP_BUDGET_FACTOR * ray.steps; step++) {
        let last = bracket.outside;
        let t = last.x + stride;
        let distance = marched_field(ray_point(ray, t));
        // A ray that starts inside is at its hit.
        if step == 0u && distance < 0.0 {
            return Trace(t, HIT, 1u);
        }
        let near = tolerance(ray, t);
        let hit = hit_within(ray, t, near);
        // The balls of free space do not meet: something may lie between them. A secant is short enough without that.
        if !bracket.crossed && !close && stride > last.y + max(distance, 0.0) + hit {
            stride = last.y;
            slope = -1.0;
            continue;
        }
        record_sample(t, distance);
        let gain = select(-1.0, (distance - last.y) / stride, stride > 0.0);
        if abs(distance) < hit {
            return Trace(t + distance / max(-gain, MIN_FINAL_SLOPE), HIT, step + 1u);
        }
        bracket = with_sample(bracket, t, distance);
        if bracket.crossed {
            if width(bracket) < hit {
                return Trace(bracket.inside.x, HIT, step + 1u);
            }
            stride = false_position(bracket) - bracket.outside.x;
            continue;
        }
        // Only the distance is known to be free.
        let free = t + distance;
        if !(free <= end) {
            return Trace(free, MISS, step + 1u);
        }
        slope = mix(slope, gain, SLOPE_WEIGHT);
        close = distance < near;
        if close {
            stride = distance / max(-gain, MIN_SLOPE);
            // Along a surface, and hardly towards it: what is that short does not matter.
            if gain > -MIN_SLOPE {
                stride = max(stride, MIN_STEP_FRACTION * near);
            }
        } else {
            // Two balls touch at a step z = r + (r + slope z).
            stride = 2.0 / clamp(1.0 - slope, 2.0 / MAX_RELAXATION, 2.0) * distance;
        }
        stride = min(limited_step(stride, distance), end - t);
    }
    return Trace(bracket.outside.x + stride, CAPPED, STEP_BUDGET_FACTOR * ray.steps);
}
