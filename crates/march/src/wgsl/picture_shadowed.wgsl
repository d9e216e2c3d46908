// Colour of a pixel with hard shadows. The ray from the eye and the rays to the lamps pass through one
// call of `trace`: drivers inline the field wherever it is called, and their compile time grows with it.

fn picture(pixel: vec2u) -> Pixel {
    let eye_ray = camera_ray(pixel);
    var ray = eye_ray;
    var seen: Trace;
    var surface: Surface;
    var color = view.background;
    var lamp_part = vec3f();
    var evaluations = 0u;
    // The first leg is from the eye, each further one to a lamp.
    for (var leg = 0u; leg <= min(view.light_count, MAX_LIGHTS); leg++) {
        if leg > 0u {
            let light = view.lights[leg - 1u];
            lamp_part = light_part(surface, light);
            if light.shadow == SHADOW_OFF || all(lamp_part <= vec3f()) {
                color += lamp_part;
                continue;
            }
            ray = shadow_ray(surface, eye_ray, seen.t, light.direction);
        }
        let found = trace(ray);
        evaluations += found.evaluations;
        if leg > 0u {
            if found.status != HIT {
                color += lamp_part;
            }
        } else {
            seen = found;
            if found.status != HIT {
                break;
            }
            surface = surface_at(ray, found.t);
            color = ambient_part(surface);
        }
    }
    return pixel_of(seen, color, evaluations);
}
