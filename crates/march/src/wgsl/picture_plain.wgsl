// Colour of a pixel without shadows.

fn picture(pixel: vec2u) -> Pixel {
    let ray = camera_ray(pixel);
    let seen = trace(ray);
    if seen.status != HIT {
        return pixel_of(seen, view.background, seen.evaluations);
    }
    let surface = surface_at(ray, seen.t);
    var color = ambient_part(surface);
    for (var i = 0u; i < min(view.light_count, MAX_LIGHTS); i++) {
        color += light_part(surface, view.lights[i]);
    }
    return pixel_of(seen, color, seen.evaluations);
}
