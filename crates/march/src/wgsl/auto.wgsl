// Sphere tracing to a part of a pixel, wherever on the ray that is. That near to a surface the ray closes in by
// secants, so that a ray that only passes by an edge is not taken for a hit on it; where the field led through the
// surface it closes in on the bracket. What the scene meets without steps is not marched (`ahead.wgsl`).

// A hit is nearer than this part of the tolerance.
const HIT_PART: f32 = 0.00390625;
// The ray is never taken to approach a surface at less than this slope: steps are at most its inverse
// times the distance.
const LEAST_SLOPE: f32 = 0.125;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return part_of_footprint(ray, t);
}

// How far along the ray the line through two samples reaches zero.
fn secant(before: vec2f, t: f32, distance: f32) -> f32 {
    let slope = (before.y - distance) / (t - before.x);
    return distance / max(slope, LEAST_SLOPE);
}

fn trace(ray: Ray) -> Trace {
    var found: Trace;
    if LOOKS_AHEAD {
        let ahead = look_ahead(ray);
        found = Trace(ahead.start, MISS, 0u);
        if ANY_MARCHED {
            if ahead.start <= ahead.end {
                found = march(ray, ahead.start, ahead.end);
            }
        }
        found = met_in_all(ray, ahead, found);
    } else {
        found = march(ray, 0.0, ray.t_max);
    }
    return found;
}

fn march(ray: Ray, start: f32, end: f32) -> Trace {
    // Last sample outside and first sample inside, as (t, distance).
    var outside = vec2f(0.0);
    var inside = vec2f(0.0);
    var crossed = false;
    var t = start;
    for (var step = 0u; step < ray.steps; step++) {
        let distance = along(ray_point(ray, t));
        passed(t, distance);
        // A ray that starts inside is at its hit.
        if step == 0u && distance < 0.0 {
            return Trace(t, HIT, 1u);
        }
        let near = tolerance(ray, t);
        let hit = max(HIT_PART * near, rounding(ray, t));
        var stride = distance;
        if abs(distance) < near && step > 0u {
            stride = secant(outside, t, distance);
        }
        if abs(distance) < hit {
            return Trace(t + stride, HIT, step + 1u);
        }
        if distance < 0.0 {
            inside = vec2f(t, distance);
            crossed = true;
        } else {
            outside = vec2f(t, distance);
        }
        if crossed {
            if inside.x - outside.x < hit {
                return Trace(inside.x, HIT, step + 1u);
            }
            // False position, kept off the ends so that the bracket always shrinks.
            let part = clamp(outside.y / (outside.y - inside.y), 0.1, 0.9);
            t = mix(outside.x, inside.x, part);
        } else {
            // Only the distance is known to be free.
            let free = t + distance;
            if !(free <= end) {
                return Trace(free, MISS, step + 1u);
            }
            t = min(t + stride, end);
        }
    }
    return Trace(t, CAPPED, ray.steps);
}
