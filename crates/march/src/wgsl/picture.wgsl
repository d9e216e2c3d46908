// The colour of a pixel. The camera ray, its reflections and the shadow rays share one call of
// `trace`: drivers inline the field wherever it is called, and their compile time grows with that.

// The end of a camera ray or a reflection.
struct SurfaceHit {
    trace: Trace,
    // The surface, if something was hit.
    surface: Surface,
    // The fraction of the surface's light that is left after the fog.
    clear: f32,
    // Ambient and emitted light, or the background.
    color: vec3f,
    // Evaluations of the field.
    evaluations: u32,
}

// Roughness of the mirror before the current hit, which spreads the highlights that it shows.
var<private> blur: f32;
// True if no reflected ray follows the current one: the surface mirrors the surroundings alone.
var<private> is_last: bool;

fn shade_hit(view_ray: Ray, found: Trace) -> SurfaceHit {
    var hit: SurfaceHit;
    hit.trace = found;
    hit.evaluations = found.evaluations;
    if found.status == HIT {
        hit.surface = surface_at(view_ray, found.t);
        if REFLECTIONS {
            hit.surface = roughened(hit.surface, blur);
        }
        var open = 1.0;
        if OCCLUSION {
            open = unoccluded_fraction(hit.surface.point, hit.surface.normal);
            hit.evaluations += OCCLUSION_SAMPLES;
        }
        if ENVIRONMENT {
            hit.color = environment_light(hit.surface, open);
        } else {
            hit.color = ambient_light(hit.surface, open * view.ambient);
        }
        if MIRRORS_SKY {
            hit.color += open * mirrored_sky(hit.surface);
        }
        if FOG {
            hit.clear = exp(-view.fog_density * found.t);
            hit.color = mix(fog_color_at(view_ray.direction), hit.color, hit.clear);
        }
    } else {
        hit.color = background_color(view_ray.direction);
        if ENVIRONMENT {
            if REFLECTIONS {
                hit.color = radiance(view_ray.direction, vec3f(blur));
            }
        }
    }
    return hit;
}

// The fraction of a light that a ray towards it lets through.
fn light_visibility(light: Light, found: Trace) -> f32 {
    var fraction = 1.0;
    if SOFT_SHADOWS {
        if light.shadow == SHADOW_SOFT {
            fraction = smoothstep(0.0, 1.0, light.sharpness * clearance / flatness());
        }
    }
    return select(fraction, 0.0, found.status == HIT);
}

fn picture(pixel: vec2u) -> Pixel {
    // The ray along which the camera looks, and the one that is traced.
    var view_ray = camera_ray(pixel);
    var ray = view_ray;
    var first: Trace;
    var hit: SurfaceHit;
    var color = vec3f();
    var evaluations = 0u;
    // Factor of the light along the current view ray.
    var weight = vec3f(1.0);
    var reflections = 0u;
    if REFLECTIONS {
        blur = 0.0;
        if ENVIRONMENT {
            is_last = min(view.reflections, MAX_REFLECTIONS) == 0u;
        }
    }
    // The number of lights handled for the current surface. The ray leads to the last of them, or
    // is the view ray.
    var lights_done = 0u;
    var pending_light = vec3f();
    let light_count = min(view.light_count, MAX_LIGHTS);
    loop {
        if SOFT_SHADOWS {
            records_clearance = lights_done > 0u && view.lights[max(lights_done, 1u) - 1u].shadow == SHADOW_SOFT;
            full_light = 1.0 / view.lights[max(lights_done, 1u) - 1u].sharpness;
        }
        var found: Trace;
        if CULLED {
            found = trace_culled(ray, lights_done == 0u && reflections == 0u);
        } else {
            found = trace(ray);
        }
        if REFLECTIONS {
            if lights_done == 0u && reflections == 0u {
                first = found;
            }
        }
        if SHADOWS {
            if lights_done > 0u {
                if SOFT_SHADOWS {
                    if ESTIMATED {
                        estimate_clearance(ray);
                    }
                }
                color += pending_light * light_visibility(view.lights[lights_done - 1u], found);
                evaluations += found.evaluations;
            } else {
                hit = shade_hit(view_ray, found);
                color += weight * hit.color;
                evaluations += hit.evaluations;
            }
        } else {
            hit = shade_hit(view_ray, found);
            color += weight * hit.color;
            evaluations += hit.evaluations;
        }
        if hit.trace.status == HIT {
            var through = weight;
            if FOG {
                through *= hit.clear;
            }
            if SHADOWS {
                var needs_ray = false;
                while lights_done < light_count && !needs_ray {
                    let light = view.lights[lights_done];
                    lights_done++;
                    let incoming = light_at(light, hit.surface.point);
                    pending_light = through * reflected_light(hit.surface, incoming);
                    needs_ray = light.shadow != SHADOW_OFF && any(pending_light > vec3f());
                    if needs_ray {
                        ray = shadow_ray(hit.surface, view_ray, hit.trace.t, incoming);
                    } else {
                        color += pending_light;
                    }
                }
                if needs_ray {
                    continue;
                }
            } else {
                // All lights. The bound depends on the pixel: Mesa's software driver compiles a
                // shader anew for each dispatch where the uniforms alone bound a loop.
                let lights = select(0u, light_count, hit.trace.t < 2.0 * view.t_max);
                for (var i = 0u; i < lights; i++) {
                    let incoming = light_at(view.lights[i], hit.surface.point);
                    color += through * reflected_light(hit.surface, incoming);
                }
            }
            if REFLECTIONS {
                weight = through * view.reflection_strength * mirrored_fraction(hit.surface, -view_ray.direction);
                // A surface that mirrors nothing needs no reflected ray.
                if reflections < min(view.reflections, MAX_REFLECTIONS) && any(weight > vec3f()) {
                    reflections++;
                    lights_done = 0u;
                    blur = roughness_of(hit.surface);
                    if ENVIRONMENT {
                        is_last = reflections >= min(view.reflections, MAX_REFLECTIONS);
                    }
                    view_ray = reflected_ray(hit.surface, view_ray, hit.trace.t);
                    ray = view_ray;
                    continue;
                }
            }
        }
        break;
    }
    var primary = hit.trace;
    if REFLECTIONS {
        primary = first;
    }
    if DEVELOPS {
        color = developed(color);
    }
    return pixel_of(primary, color, evaluations);
}
