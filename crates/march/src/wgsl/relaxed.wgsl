// Over-relaxed sphere tracing: steps longer than the distance. Where the empty spheres around both
// ends of a step do not meet, something may lie between them: the step is taken back to the end of
// the first sphere, and the ray goes on by plain steps. B. Keinert et al., Enhanced sphere tracing
// (STAG 2014).

// Length of a step in distances.
const RELAXATION: f32 = 1.2;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    // The distance at t, and the step to take from there.
    var radius = 0.0;
    var stride = 0.0;
    var relaxation = RELAXATION;
    for (var step = 0u; step < ray.steps; step++) {
        let next = t + stride;
        let distance = field(ray_point(ray, next));
        // A step no longer than the distance is never taken back.
        if stride > radius + abs(distance) {
            stride = radius;
            relaxation = 1.0;
            continue;
        }
        record_sample(ray, next, distance);
        t = next;
        radius = distance;
        if distance < tolerance(ray, t) {
            return Trace(t, HIT, step + 1u);
        }
        if !(t + distance <= ray.t_max) {
            return Trace(t + distance, MISS, step + 1u);
        }
        stride = min(limited_step(relaxation * distance, distance), ray.t_max - t);
    }
    return Trace(t, CAPPED, ray.steps);
}
