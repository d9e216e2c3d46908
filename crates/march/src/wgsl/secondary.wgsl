// Rays that start on a surface.

// Of a ray to a lamp, whose footprint is as wide as it starts above the surface.
const SHADOW_TOLERANCE: f32 = 0.25;

// How far a hit may be from it.
fn nearness(ray: Ray, t: f32) -> f32 {
    return max(tolerance(ray, t), rounding(ray, t));
}

// Off the surface, and a little back towards where the ray came from: at the foot of a wall the normal of the
// wall does not lead out of the floor.
fn start_at(surface: Surface, ray: Ray, t: f32, lift: f32) -> vec3f {
    return surface.point + lift * surface.normal - 0.25 * nearness(ray, t) * ray.direction;
}

// From a surface to a lamp. It starts further off than what counts as a hit there, than half a pixel and than
// rounding, so that it does not meet the surface that it leaves.
fn shadow_ray(surface: Surface, ray: Ray, t: f32, light: IncomingLight) -> Ray {
    let lift = max(3.0 * nearness(ray, t), footprint(ray, t));
    let origin = start_at(surface, ray, t, lift);
    if SOFT_SHADOWS {
        start_penumbra();
    }
    let radius = 0.5 * lift;
    return Ray(origin, radius, light.direction, 0.0, light.distance, ray.epsilon, SHADOW_TOLERANCE, ray.steps);
}

// From a surface to what it mirrors, less far off, since that moves the image. The footprint goes on growing
// as it would without the mirror.
fn reflected_ray(surface: Surface, ray: Ray, t: f32) -> Ray {
    let origin = start_at(surface, ray, t, 1.5 * nearness(ray, t));
    let direction = reflect(ray.direction, surface.normal);
    let radius = footprint(ray, t);
    return Ray(origin, radius, direction, ray.spread, ray.t_max, ray.epsilon, ray.tolerance, ray.steps);
}
