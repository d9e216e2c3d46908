// Sphere tracing down to a quarter of a pixel, wherever on the ray that is, with a bracket where
// the field led through the surface, and a last secant through the two nearest samples.

// A quarter of a pixel's width, but no finer than what rounding allows.
fn tolerance(ray: Ray, t: f32) -> f32 {
    return max(0.5 * footprint(ray, t), rounding(ray, t));
}

// A hit within tolerance of the surface is moved along the ray by the secant through the last two
// samples, which costs no evaluation. Where the ray approaches slower than at a slope of 1/4 the
// secant is not to be trusted further than four times the distance left.
fn polished(t: f32, distance: f32, before: vec2f) -> f32 {
    let slope = (before.y - distance) / (t - before.x);
    if slope > 0.0 {
        return t + distance / max(slope, 0.25);
    }
    return t;
}

fn trace(ray: Ray) -> Trace {
    // Last sample outside and first sample inside, as (t, distance).
    var outside = vec2f();
    var inside = vec2f();
    var crossed = false;
    var t = 0.0;
    for (var step = 0u; step < view.steps; step++) {
        let distance = field(ray_point(ray, t));
        let near = tolerance(ray, t);
        if step == 0u {
            // A ray that starts inside is at its hit.
            if distance < near {
                return Trace(t, HIT, 1u);
            }
        } else if abs(distance) < near {
            return Trace(polished(t, distance, outside), HIT, step + 1u);
        }
        if distance < 0.0 {
            inside = vec2f(t, distance);
            crossed = true;
        } else {
            outside = vec2f(t, distance);
        }
        if crossed {
            if inside.x - outside.x < near {
                return Trace(inside.x, HIT, step + 1u);
            }
            // False position, kept off the ends so that the bracket always shrinks.
            let part = clamp(outside.y / (outside.y - inside.y), 0.1, 0.9);
            t = mix(outside.x, inside.x, part);
        } else {
            t += distance;
            if !(t <= ray.t_max) {
                return Trace(t, MISS, step + 1u);
            }
        }
    }
    return Trace(t, CAPPED, view.steps);
}
