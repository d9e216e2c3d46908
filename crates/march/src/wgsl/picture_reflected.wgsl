// Colour of a pixel with mirror reflections, without shadows. The ray from the eye and what becomes of it at
// each mirror pass through one call of `trace`.

fn picture(pixel: vec2u) -> Pixel {
    var ray = camera_ray(pixel);
    var seen: Trace;
    var color = vec3f();
    var weight = 1.0;
    var evaluations = 0u;
    for (var mirror = 0u; mirror <= min(view.reflections, MAX_REFLECTIONS); mirror++) {
        let found = trace(ray);
        evaluations += found.evaluations;
        if mirror == 0u {
            seen = found;
        }
        if found.status != HIT {
            color += weight * view.background;
            break;
        }
        let surface = surface_at(ray, found.t);
        color += weight * ambient_part(surface);
        for (var i = 0u; i < min(view.light_count, MAX_LIGHTS); i++) {
            color += weight * light_part(surface, view.lights[i]);
        }
        weight *= view.reflection_strength;
        ray = mirrored_ray(surface, ray, found.t);
    }
    return pixel_of(seen, color, evaluations);
}
