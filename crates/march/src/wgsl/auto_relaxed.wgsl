// Sphere tracing with automatic step size relaxation. A step leads to where the next empty sphere
// would touch this one if the surface were as flat as the distances so far suggest: their slope is
// averaged over the steps. If the spheres do not touch, the step is taken back to the end of the
// first one. R. Ban, G. Valasek, Automatic step size relaxation in sphere tracing (Eurographics
// 2023 short papers); without a latch, as in their program.

// Weight of the last step's slope in the running mean.
const SLOPE_WEIGHT: f32 = 0.3;
// Upper bound of a step in distances: a ray that leads straight away from a surface would have no
// limit.
const MAX_RELAXATION: f32 = 10.0;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    // The distance at t, and the step to take from there.
    var radius = 0.0;
    var stride = 0.0;
    // The running mean of the field's slope along the ray; at first as if straight towards a
    // surface.
    var slope = -1.0;
    for (var step = 0u; step < ray.steps; step++) {
        let next = t + stride;
        let distance = field(ray_point(ray, next));
        // A step no longer than the distance is never taken back.
        if stride > radius + abs(distance) {
            stride = radius;
            slope = -1.0;
            continue;
        }
        record_sample(ray, next, distance);
        if stride > 0.0 {
            slope = mix(slope, (distance - radius) / stride, SLOPE_WEIGHT);
        }
        t = next;
        radius = distance;
        if distance < tolerance(ray, t) {
            return Trace(t, HIT, step + 1u);
        }
        if !(t + distance <= ray.t_max) {
            return Trace(t + distance, MISS, step + 1u);
        }
        // Two spheres touch at a step z = r + (r + slope z).
        let relaxation = 2.0 / clamp(1.0 - slope, 2.0 / MAX_RELAXATION, 2.0);
        stride = min(limited_step(relaxation * distance, distance), ray.t_max - t);
    }
    return Trace(t, CAPPED, ray.steps);
}
