// Colour of a pixel with mirror reflections and hard shadows. The ray from the eye, what becomes of it at each
// mirror, and the rays from there to the lamps pass through one call of `trace`.

fn picture(pixel: vec2u) -> Pixel {
    // The ray along which the eye sees, and the one that is traced.
    var sight = camera_ray(pixel);
    var ray = sight;
    var seen: Trace;
    var met: Trace;
    var surface: Surface;
    var color = vec3f();
    var lamp_part = vec3f();
    var weight = 1.0;
    var evaluations = 0u;
    for (var mirror = 0u; mirror <= min(view.reflections, MAX_REFLECTIONS); mirror++) {
        // The first leg follows the sight, each further one leads to a lamp.
        for (var leg = 0u; leg <= min(view.light_count, MAX_LIGHTS); leg++) {
            if leg > 0u {
                let light = view.lights[leg - 1u];
                lamp_part = weight * light_part(surface, light);
                if light.shadow == SHADOW_OFF || all(lamp_part <= vec3f()) {
                    color += lamp_part;
                    continue;
                }
                ray = shadow_ray(surface, sight, met.t, light.direction);
            }
            let found = trace(ray);
            evaluations += found.evaluations;
            if leg > 0u {
                if found.status != HIT {
                    color += lamp_part;
                }
                continue;
            }
            met = found;
            if met.status != HIT {
                color += weight * view.background;
                break;
            }
            surface = surface_at(sight, met.t);
            color += weight * ambient_part(surface);
        }
        if mirror == 0u {
            seen = met;
        }
        if met.status != HIT {
            break;
        }
        weight *= view.reflection_strength;
        sight = mirrored_ray(surface, sight, met.t);
        ray = sight;
    }
    return pixel_of(seen, color, evaluations);
}
