// A scene that paints nothing: one colour, Lambert's law.

struct Surface {
    point: vec3f,
    normal: vec3f,
}

fn surface_at(ray: Ray, t: f32) -> Surface {
    let point = ray_point(ray, t);
    return Surface(point, normal_at(point, -ray.direction));
}

// What the surface gives off, and returns of light from everywhere.
fn ambient_light(surface: Surface, ambient: vec3f) -> vec3f {
    return ambient * DEFAULT_COLOR;
}

// What the surface returns of a lamp's light: its colour times the cosine of the angle of incidence.
fn reflected_light(surface: Surface, light: IncomingLight) -> vec3f {
    return light.color * DEFAULT_COLOR * max(dot(surface.normal, light.direction), 0.0);
}
