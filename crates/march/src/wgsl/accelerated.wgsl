// Accelerated sphere tracing. A step leads to where the next empty sphere would touch this one if
// the surface were as flat as the last two distances suggest. If the spheres do not touch, the step
// is taken back to the end of the first one. Cs. Balint, G. Valasek, Accelerating sphere tracing
// (Eurographics 2018 short papers).

// Fraction of the next sphere's radius that a step covers.
const TRUST: f32 = 0.95;
// Lower bound of the divisor: on a ray that leads straight away from a surface the next sphere
// would be infinite.
const MIN_APPROACH: f32 = 0.1;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    // The distance at t, and the step to take from there.
    var radius = 0.0;
    var stride = 0.0;
    for (var step = 0u; step < ray.steps; step++) {
        let next = t + stride;
        let distance = field(ray_point(ray, next));
        // A step no longer than the distance is never taken back.
        if stride > radius + abs(distance) {
            stride = radius;
            continue;
        }
        record_sample(ray, next, distance);
        // Beside a plane the distance r falls by a constant slope s along the ray; the sphere that
        // touches this one has the radius r (1 - s) / (1 + s).
        var next_radius = 0.0;
        if stride > 0.0 {
            let slope = (radius - distance) / stride;
            next_radius = TRUST * distance * max(1.0 - slope, 0.0) / max(1.0 + slope, MIN_APPROACH);
        }
        t = next;
        radius = distance;
        if distance < tolerance(ray, t) {
            return Trace(t, HIT, step + 1u);
        }
        if !(t + distance <= ray.t_max) {
            return Trace(t + distance, MISS, step + 1u);
        }
        stride = min(limited_step(distance + next_radius, distance), ray.t_max - t);
    }
    return Trace(t, CAPPED, ray.steps);
}
