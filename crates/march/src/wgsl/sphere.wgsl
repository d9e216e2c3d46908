// Sphere tracing: the sphere of the distance is empty, so a step along the ray may be as long. J.
// C. Hart, Sphere tracing (The Visual Computer 12, 1996).

fn tolerance(ray: Ray, t: f32) -> f32 {
    return ray.epsilon;
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    for (var step = 0u; step < ray.steps; step++) {
        let distance = field(ray_point(ray, t));
        record_sample(ray, t, distance);
        // Negative distances count too: a field that overestimates leads through the surface, not
        // to it.
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
