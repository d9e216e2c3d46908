// Steps to where the ball of free space there would touch the ball here, were the surface as flat as the last two
// distances tell. Where the balls do not meet, the step is taken back to the end of the first one.
// Cs. Balint, G. Valasek, Accelerating sphere tracing (Eurographics 2018 short papers).

// Part of the ball ahead that a step covers.
const TRUST: f32 = 0.95;
// Straight away from a surface there is no end to the ball ahead; this bounds it.
const MIN_APPROACH: f32 = 0.1;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    // Distance at t, and the step to take from there.
    var radius = 0.0;
    var stride = 0.0;
    for (var step = 0u; step < ray.steps; step++) {
        let next = t + stride;
        let distance = field(ray_point(ray, next));
        // A step as long as the distance is never taken back.
        if stride > radius + abs(distance) {
            stride = radius;
            continue;
        }
        record_sample(next, distance);
        // Beside a plane the distance r falls by the same slope s all along; the ball that touches this one
        // has the radius r (1 - s) / (1 + s).
        var ahead = 0.0;
        if stride > 0.0 {
            let slope = (radius - distance) / stride;
            ahead = TRUST * distance * max(1.0 - slope, 0.0) / max(1.0 + slope, MIN_APPROACH);
        }
        t = next;
        radius = distance;
        if distance < tolerance(ray, t) {
            return Trace(t, HIT, step + 1u);
        }
        if !(t + distance <= ray.t_max) {
            return Trace(t + distance, MISS, step + 1u);
        }
        stride = min(limited_step(distance + ahead, distance), ray.t_max - t);
    }
    return Trace(t, CAPPED, ray.steps);
}
