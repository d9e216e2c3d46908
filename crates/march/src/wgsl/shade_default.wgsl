// Shading of scenes without materials: one colour, Lambert's law.

struct Surface {
    point: vec3f,
    normal: vec3f,
}

fn surface_at(ray: Ray, t: f32) -> Surface {
    let point = ray_point(ray, t);
    return Surface(point, normal_at(point, -ray.direction));
}

// The ambient light that the surface reflects.
fn ambient_light(surface: Surface, ambient: vec3f) -> vec3f {
    return ambient * DEFAULT_COLOR;
}

// The light that the surface reflects from a light source: its colour times the cosine of the angle
// of incidence.
fn reflected_light(surface: Surface, light: IncomingLight) -> vec3f {
    return light.color * DEFAULT_COLOR * max(dot(surface.normal, light.direction), 0.0);
}
