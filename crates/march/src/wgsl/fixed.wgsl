// Steps of constant length until the sign of the field changes, then bisection. Parts thinner than
// a step may be missed.

fn tolerance(ray: Ray, t: f32) -> f32 {
    return ray.epsilon;
}

fn trace(ray: Ray) -> Trace {
    let near = tolerance(ray, 0.0);
    var t = 0.0;
    var stride = ray.t_max / f32(ray.steps);
    var crossed = false;
    for (var step = 0u; step < ray.steps; step++) {
        let distance = field(ray_point(ray, t));
        record_sample(ray, t, distance);
        let inside = distance < 0.0;
        // A ray that starts inside hits at its origin; so does a ray whose bracket has closed on a
        // jump.
        if abs(distance) < near || stride < near || (inside && step == 0u) {
            return Trace(t, HIT, step + 1u);
        }
        crossed = crossed || inside;
        if crossed {
            stride *= 0.5;
        }
        t += select(stride, -stride, inside);
        if !(t <= ray.t_max) {
            return Trace(t, MISS, step + 1u);
        }
    }
    return Trace(t, CAPPED, ray.steps);
}
