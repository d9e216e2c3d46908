// A scene with materials: Lambert's law for the matt part, a normalised Blinn-Phong lobe for the
// mirroring part. Units are such that a white matt surface facing a lamp shows the lamp's colour.

// In the order of `MaterialField::ALL`.
struct Material {
    color: vec3f,
    coverage: f32,
    roughness: f32,
    metallic: f32,
    emission: vec3f,
    occlusion: f32,
}

// Reflectance of a dielectric seen straight on.
const DIELECTRIC: f32 = 0.04;
// The lobe of a smoother surface would be thinner than pixels.
const LEAST_ROUGHNESS: f32 = 0.1;

struct Surface {
    point: vec3f,
    normal: vec3f,
    toward_eye: vec3f,
    material: Material,
}

// Supplied by the scene.
fn material(p: vec3f) -> Material {
    return Material();
}

fn surface_at(ray: Ray, t: f32) -> Surface {
    let point = ray_point(ray, t);
    var paint = material(point);
    paint.color = mix(UNPAINTED, paint.color, paint.coverage);
    return Surface(point, normal_at(point, -ray.direction), -ray.direction, paint);
}

// Light that does not come from a lamp.
fn ambient_part(surface: Surface) -> vec3f {
    let paint = surface.material;
    return view.ambient * paint.color * paint.occlusion + paint.emission;
}

// What the surface returns of a lamp's light, with n, l, h the normal, the direction to the lamp and
// halfway between lamp and eye:
// (n.l) (color (1 - metallic) + F (s + 8) / 8 (n.h)^s), F = mix(0.04, color, metallic), s = 2 / roughness^4 - 2.
fn light_part(surface: Surface, light: Light) -> vec3f {
    let paint = surface.material;
    let incidence = max(dot(surface.normal, light.direction), 0.0);
    let halfway = normalize(light.direction + surface.toward_eye);
    let aligned = max(dot(surface.normal, halfway), 1e-4);
    let roughness = clamp(paint.roughness, LEAST_ROUGHNESS, 1.0);
    let alpha = roughness * roughness;
    let shininess = 2.0 / (alpha * alpha) - 2.0;
    let lobe = (shininess + 8.0) / 8.0 * pow(aligned, shininess);
    let mirrored = mix(vec3f(DIELECTRIC), paint.color, paint.metallic);
    let matt = paint.color * (1.0 - paint.metallic);
    return light.color * incidence * (matt + mirrored * lobe);
}
