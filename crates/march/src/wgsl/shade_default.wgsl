// Shading of scenes without materials: one colour, Lambert's law.

// Reflectance of a polished dielectric, if surfaces mirror each other.
const POLISHED: f32 = 0.04;

struct Surface {
    point: vec3f,
    normal: vec3f,
}

fn surface_at(ray: Ray, t: f32) -> Surface {
    let point = ray_point(ray, t);
    return Surface(point, normal_at(point, -ray.direction));
}

// The fraction of the light from the mirrored direction that the surface reflects: without a
// material, that of a polished dielectric (Schlick).
fn mirrored_fraction(surface: Surface, toward_eye: vec3f) -> vec3f {
    let rest = 1.0 - saturate(dot(surface.normal, toward_eye));
    let square = rest * rest;
    return vec3f(mix(POLISHED, 1.0, square * square * rest));
}

fn roughness_of(surface: Surface) -> f32 {
    return 0.0;
}

// Surfaces without materials have no highlights.
fn roughened(surface: Surface, roughness: f32) -> Surface {
    return surface;
}

// Surfaces without materials do not mirror the sky.
fn mirrored_sky(surface: Surface) -> vec3f {
    return vec3f();
}

// The ambient light that the surface reflects.
fn ambient_light(surface: Surface, ambient: vec3f) -> vec3f {
    return ambient * DEFAULT_COLOR;
}

// The light of the surroundings that the surface reflects. If surfaces mirror each other, reflected
// rays add what a polished surface mirrors.
fn environment_light(surface: Surface, open: f32) -> vec3f {
    return open * irradiance(surface.normal) * DEFAULT_COLOR;
}

// The light that the surface reflects from a light source: its colour times the cosine of the angle
// of incidence.
fn reflected_light(surface: Surface, light: IncomingLight) -> vec3f {
    return light.color * DEFAULT_COLOR * max(dot(surface.normal, light.direction), 0.0);
}
