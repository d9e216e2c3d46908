// Shading of scenes with materials: metals and dielectrics of some roughness. The interface
// reflects a part of the light at microfacets; the light that passes it, in and out again, is
// scattered evenly below, except in metals. Units are such that white paper under a light shows the
// light's colour: reflectances are pi times the usual.
//
// Microfacet slopes: T. S. Trowbridge, K. P. Reitz, Average irregularity representation of a rough
// surface for ray reflection (J. Opt. Soc. Am. 65, 1975), which B. Walter et al. call GGX (EGSR
// 2007). Masking and shadowing: E. Heitz, Understanding the masking-shadowing function in
// microfacet-based BRDFs (JCGT 3, 2014), the height-correlated form of Smith's. Fresnel: C.
// Schlick, An inexpensive BRDF model for physically-based rendering (Eurographics 1994). Colour,
// metallic and alpha = roughness^2: B. Burley, Physically-based shading at Disney (SIGGRAPH 2012).

// The fields are in the order of `MaterialField::ALL`.
struct Material {
    color: vec3f,
    coverage: f32,
    roughness: f32,
    metallic: f32,
    emission: vec3f,
    occlusion: f32,
}

// Reflectance of a dielectric at normal incidence, for an index of refraction of 1.5.
const DIELECTRIC: f32 = 0.04;
// The highlight of a smoother surface would be narrower than a pixel.
const MIN_ROUGHNESS: f32 = 0.1;
// Lower bound of cosines, for directions along the surface or, with an inexact normal, below it.
const MIN_COSINE: f32 = 1e-4;

struct Surface {
    point: vec3f,
    normal: vec3f,
    toward_eye: vec3f,
    // Cosine between the two.
    facing: f32,
    material: Material,
}

// Supplied by the scene: the material at a point of the surface.
fn material(p: vec3f) -> Material {
    return Material();
}

// Supplied by the scene: the material of a surface that is seen from a direction.
fn seen_material(p: vec3f, normal: vec3f, toward_eye: vec3f) -> Material {
    return Material();
}

fn surface_at(ray: Ray, t: f32) -> Surface {
    let point = ray_point(ray, t);
    let toward_eye = -ray.direction;
    let normal = normal_at(point, toward_eye);
    if SEEN_MATERIALS {
        return seen_surface(point, normal, toward_eye);
    } else {
        var paint = material(point);
        paint.color = mix(DEFAULT_COLOR, paint.color, paint.coverage);
        paint.roughness = clamp(paint.roughness, MIN_ROUGHNESS, 1.0);
        return Surface(point, normal, toward_eye, max(dot(normal, toward_eye), MIN_COSINE), paint);
    }
}

fn seen_surface(point: vec3f, normal: vec3f, toward_eye: vec3f) -> Surface {
    var paint = seen_material(point, normal, toward_eye);
    paint.color = mix(DEFAULT_COLOR, paint.color, paint.coverage);
    paint.roughness = clamp(paint.roughness, MIN_ROUGHNESS, 1.0);
    return Surface(point, normal, toward_eye, max(dot(normal, toward_eye), MIN_COSINE), paint);
}

// Specular reflectance at normal incidence.
fn specular_color(paint: Material) -> vec3f {
    return mix(vec3f(DIELECTRIC), paint.color, paint.metallic);
}

// Reflectance of the scattering layer below the interface.
fn diffuse_color(paint: Material) -> vec3f {
    return (1.0 - paint.metallic) * paint.color;
}

// Schlick: F = F0 + (1 - F0) (1 - cosine)^5.
fn fresnel(straight_on: vec3f, cosine: f32) -> vec3f {
    let rest = 1.0 - cosine;
    let square = rest * rest;
    return mix(straight_on, vec3f(1.0), square * square * rest);
}

// pi D V, with D the density of microfacets along the halfway vector h and V their visibility over
// 4 (n.l) (n.v). 1 - (n.h)^2 is |n x h|^2, which does not cancel at a highlight.
fn highlight(surface: Surface, halfway: vec3f, incidence: f32) -> f32 {
    let alpha = surface.material.roughness * surface.material.roughness;
    let across = cross(surface.normal, halfway);
    let along = alpha * dot(surface.normal, halfway);
    let peak = alpha / (dot(across, across) + along * along);
    let square = alpha * alpha;
    let rest = 1.0 - square;
    let light_side = surface.facing * sqrt(incidence * incidence * rest + square);
    let eye_side = incidence * sqrt(surface.facing * surface.facing * rest + square);
    return 0.5 * peak * peak / (light_side + eye_side);
}

// The fraction of ambient light that microfacets reflect towards the eye: a fit to the integral. B.
// Karis, Physically based shading on mobile (Unreal Engine, 2014).
fn ambient_specular(straight_on: vec3f, roughness: f32, facing: f32) -> vec3f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * facing)) * r.x + r.y;
    return max(straight_on * (r.z - 1.04 * a) + (r.w + 1.04 * a), vec3f());
}

// The fraction of the light from the mirrored direction that the surface reflects towards the eye
// as a mirror: rough surfaces spread the rest.
fn mirrored_fraction(surface: Surface, toward_eye: vec3f) -> vec3f {
    let paint = surface.material;
    let mirrored = ambient_specular(specular_color(paint), paint.roughness, surface.facing);
    return (1.0 - paint.roughness) * mirrored;
}

fn roughness_of(surface: Surface) -> f32 {
    return surface.material.roughness;
}

// The surface as a mirror of some roughness shows it.
fn roughened(surface: Surface, roughness: f32) -> Surface {
    var seen = surface;
    seen.material.roughness = max(surface.material.roughness, roughness);
    return seen;
}

// The fraction of ambient light that reaches the surface. The occlusion of an unlit surface is
// below 0.
fn ambient_fraction(paint: Material) -> f32 {
    return max(paint.occlusion, 0.0);
}

// What mirroring the sky adds to mirroring the ambient light.
fn mirrored_sky(surface: Surface) -> vec3f {
    let sky = background_color(reflect(-surface.toward_eye, surface.normal));
    if UNLIT {
        let fraction = ambient_fraction(surface.material);
        return fraction * mirrored_fraction(surface, surface.toward_eye) * (sky - view.ambient);
    }
    return surface.material.occlusion * mirrored_fraction(surface, surface.toward_eye) * (sky - view.ambient);
}

// The light that the surface emits, and the ambient light that it reflects.
fn ambient_light(surface: Surface, ambient: vec3f) -> vec3f {
    let paint = surface.material;
    let mirrored = ambient_specular(specular_color(paint), paint.roughness, surface.facing);
    let lost = ambient_specular(vec3f(DIELECTRIC), paint.roughness, surface.facing);
    if UNLIT {
        let reflected = mirrored + (1.0 - lost) * diffuse_color(paint);
        return ambient * ambient_fraction(paint) * reflected + paint.emission;
    }
    return ambient * paint.occlusion * (mirrored + (1.0 - lost) * diffuse_color(paint)) + paint.emission;
}

// The light that the surface emits, and the light of the surroundings that it reflects. A reflected
// ray brings `mirrored_fraction`, so only the rest of the mirrored light is added before it.
fn environment_light(surface: Surface, open: f32) -> vec3f {
    let paint = surface.material;
    var mirrored = ambient_specular(specular_color(paint), paint.roughness, surface.facing);
    let lost = ambient_specular(vec3f(DIELECTRIC), paint.roughness, surface.facing);
    if REFLECTIONS {
        mirrored *= select(paint.roughness, 1.0, is_last);
    }
    let direction = reflect(-surface.toward_eye, surface.normal);
    let specular = mirrored * radiance(direction, vec3f(paint.roughness));
    let diffuse = (1.0 - lost) * diffuse_color(paint) * irradiance(surface.normal);
    return open * ambient_fraction(paint) * (specular + diffuse) + paint.emission;
}

// The light that the surface reflects from a light source: a highlight and, through the interface
// twice, Lambert's law.
fn reflected_light(surface: Surface, light: IncomingLight) -> vec3f {
    let incidence = dot(surface.normal, light.direction);
    if incidence <= 0.0 {
        return vec3f();
    }
    let halfway = normalize(light.direction + surface.toward_eye);
    let tilt = saturate(dot(light.direction, halfway));
    let paint = surface.material;
    let mirrored = fresnel(specular_color(paint), tilt) * highlight(surface, halfway, incidence);
    let dielectric = vec3f(DIELECTRIC);
    let transmitted_in = 1.0 - fresnel(dielectric, incidence);
    let transmitted_out = 1.0 - fresnel(dielectric, surface.facing);
    if UNLIT {
        let reflected = mirrored + transmitted_in * transmitted_out * diffuse_color(paint);
        return saturate(1.0 + paint.occlusion) * light.color * incidence * reflected;
    }
    return light.color * incidence * (mirrored + transmitted_in * transmitted_out * diffuse_color(paint));
}
