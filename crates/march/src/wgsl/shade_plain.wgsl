// A scene that paints nothing: one colour, Lambert's law.

struct Surface {
    point: vec3f,
    normal: vec3f,
}

fn surface_at(ray: Ray, t: f32) -> Surface {
    let point = ray_point(ray, t);
    return Surface(point, normal_at(point, -ray.direction));
}

// Light that does not come from a lamp.
fn ambient_part(surface: Surface) -> vec3f {
    return view.ambient * UNPAINTED;
}

// What the surface returns of a lamp's light: its colour times the cosine of the angle of incidence.
fn light_part(surface: Surface, light: Light) -> vec3f {
    return light.color * UNPAINTED * max(dot(surface.normal, light.direction), 0.0);
}
