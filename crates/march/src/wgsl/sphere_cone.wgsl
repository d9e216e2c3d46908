// Cone tracing: sphere tracing that stops where the surface enters the cone that the pixel sees, so
// that no work is spent on detail that the pixel cannot show. B. Keinert et al., Enhanced sphere
// tracing (STAG 2014).

fn tolerance(ray: Ray, t: f32) -> f32 {
    return footprint_tolerance(ray, t);
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    for (var step = 0u; step < ray.steps; step++) {
        let distance = field(ray_point(ray, t));
        record_sample(ray, t, distance);
        if distance < tolerance(ray, t) {
            return Trace(t, HIT, step + 1u);
        }
        t += distance;
        if !(t <= ray.t_max) {
            return Trace(t, MISS, step + 1u);
        }
    }
    return Trace(t, CAPPED, ray.steps);
}
