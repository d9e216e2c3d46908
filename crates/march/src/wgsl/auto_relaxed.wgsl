// Steps to where the ball of free space there would touch the ball here, were the surface as flat as the distances
// so far tell: their slope is averaged over the steps. Where the balls do not meet, the step is taken back to the end
// of the first one. R. Ban, G. Valasek, Automatic step size relaxation in sphere tracing (Eurographics 2023 short
// papers); without a latch, as in their program.

// Weight of the last step's slope.
const SLOPE_WEIGHT: f32 = 0.3;
// Steps are at most so many distances: straight away from a surface there is no end to them.
const MAX_RELAXATION: f32 = 10.0;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    // Distance at t, and the step to take from there.
    var radius = 0.0;
    var stride = 0.0;
    // What the distance gains per unit of length, in the mean: straight towards a surface at first.
    var slope = -1.0;
    for (var step = 0u; step < ray.steps; step++) {
        let next = t + stride;
        let distance = field(ray_point(ray, next));
        // A step as long as the distance is never taken back.
        if stride > radius + abs(distance) {
            stride = radius;
            slope = -1.0;
            continue;
        }
        record_sample(next, distance);
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
        // Two balls touch at a step z = r + (r + slope z).
        let relaxation = 2.0 / clamp(1.0 - slope, 2.0 / MAX_RELAXATION, 2.0);
        stride = min(limited_step(relaxation * distance, distance), ray.t_max - t);
    }
    return Trace(t, CAPPED, ray.steps);
}
