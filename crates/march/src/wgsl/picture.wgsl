// Colour of a pixel. The ray from the eye, what becomes of it at mirrors, and the rays to lamps pass through one call
// of `trace`: drivers inline the field wherever it is called, and their compile time grows with it.

// Where a ray along which the eye sees has ended.
struct Meeting {
    trace: Trace,
    // Where it met something.
    surface: Surface,
    // The part of the surface's light that comes through the fog.
    clear: f32,
    // Light that does not come from a lamp.
    color: vec3f,
    // Evaluations of the field.
    evaluations: u32,
}

fn meet(sight: Ray, found: Trace) -> Meeting {
    var met: Meeting;
    met.trace = found;
    met.evaluations = found.evaluations;
    if found.status == HIT {
        met.surface = surface_at(sight, found.t);
        var ambient = view.ambient;
        if OCCLUSION {
            ambient *= open_part(met.surface.point, met.surface.normal);
            met.evaluations += OCCLUSION_SAMPLES;
        }
        met.color = ambient_part(met.surface, ambient);
        if FOG {
            met.clear = exp(-view.fog_density * found.t);
            met.color = mix(haze(sight.direction), met.color, met.clear);
        }
    } else {
        met.color = behind(sight.direction);
    }
    return met;
}

// The part of a lamp's light that a ray to it lets through.
fn unshaded(light: Light, found: Trace) -> f32 {
    var part = 1.0;
    if SOFT_SHADOWS {
        if light.shadow == SHADOW_SOFT {
            part = smoothstep(0.0, 1.0, light.sharpness * clearance);
        }
    }
    return select(part, 0.0, found.status == HIT);
}

fn picture(pixel: vec2u) -> Pixel {
    // The ray along which the eye sees, and the one that is traced.
    var sight = camera_ray(pixel);
    var ray = sight;
    var first: Trace;
    var met: Meeting;
    var color = vec3f();
    var evaluations = 0u;
    // What is seen along the sight counts by this factor.
    var weight = 1.0;
    var mirrors = 0u;
    // How many lights were asked what they shed on the surface. The ray leads to the last of them, or along the sight.
    var asked = 0u;
    var lamp_part = vec3f();
    let light_count = min(view.light_count, MAX_LIGHTS);
    loop {
        if SOFT_SHADOWS {
            watched = asked > 0u && view.lights[max(asked, 1u) - 1u].shadow == SHADOW_SOFT;
        }
        var found: Trace;
        if CULLED {
            found = trace_listed(ray, asked == 0u && mirrors == 0u);
        } else {
            found = trace(ray);
        }
        if REFLECTIONS {
            if evaluations == 0u {
                first = found;
            }
        }
        if SHADOWS {
            if asked > 0u {
                color += lamp_part * unshaded(view.lights[asked - 1u], found);
                evaluations += found.evaluations;
            } else {
                met = meet(sight, found);
                color += weight * met.color;
                evaluations += met.evaluations;
            }
        } else {
            met = meet(sight, found);
            color += weight * met.color;
            evaluations += met.evaluations;
        }
        if met.trace.status == HIT {
            var through = weight;
            if FOG {
                through *= met.clear;
            }
            if SHADOWS {
                var leads = false;
                while asked < light_count && !leads {
                    let light = view.lights[asked];
                    asked++;
                    let lamp = lamp_at(light, met.surface.point);
                    lamp_part = through * light_part(met.surface, lamp);
                    leads = light.shadow != SHADOW_OFF && any(lamp_part > vec3f());
                    if leads {
                        ray = shadow_ray(met.surface, sight, met.trace.t, lamp);
                    } else {
                        color += lamp_part;
                    }
                }
                if leads {
                    continue;
                }
            } else {
                for (var i = 0u; i < light_count; i++) {
                    let lamp = lamp_at(view.lights[i], met.surface.point);
                    color += through * light_part(met.surface, lamp);
                }
            }
            if REFLECTIONS {
                if mirrors < min(view.reflections, MAX_REFLECTIONS) {
                    mirrors++;
                    asked = 0u;
                    weight = through * view.reflection_strength;
                    sight = mirrored_ray(met.surface, sight, met.trace.t);
                    ray = sight;
                    continue;
                }
            }
        }
        break;
    }
    var seen = met.trace;
    if REFLECTIONS {
        seen = first;
    }
    return pixel_of(seen, color, evaluations);
}
