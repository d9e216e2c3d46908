// Rays that start on a surface.

// Tolerance of a shadow ray in widths of its footprint, which is as wide as the ray starts above
// the surface.
const SHADOW_TOLERANCE: f32 = 0.25;

// The maximum distance of the hit from the surface.
fn nearness(ray: Ray, t: f32) -> f32 {
    return max(tolerance(ray, t), rounding(ray, t));
}

// The origin of a secondary ray: above the surface, and a little back along the incoming ray. At
// the foot of a wall the wall's normal does not lead out of the floor.
fn start_at(surface: Surface, ray: Ray, t: f32, lift: f32) -> vec3f {
    return surface.point + lift * surface.normal - 0.25 * nearness(ray, t) * ray.direction;
}

// A ray from a surface towards a light. Its origin is farther from the surface than the tolerance
// of a hit, half a pixel and rounding, so that it does not hit the surface that it leaves.
fn shadow_ray(surface: Surface, ray: Ray, t: f32, light: IncomingLight) -> Ray {
    let lift = max(3.0 * nearness(ray, t), footprint(ray, t));
    let origin = start_at(surface, ray, t, lift);
    if SOFT_SHADOWS {
        start_penumbra(light.inverse_distance);
    }
    let radius = 0.5 * lift;
    return Ray(origin, radius, light.direction, 0.0, light.distance, ray.epsilon, SHADOW_TOLERANCE, ray.steps);
}

// The reflection of a ray. It starts nearer to the surface, since the offset moves the image; its
// footprint goes on growing as it would without the mirror.
fn reflected_ray(surface: Surface, ray: Ray, t: f32) -> Ray {
    let origin = start_at(surface, ray, t, 1.5 * nearness(ray, t));
    let direction = reflect(ray.direction, surface.normal);
    let radius = footprint(ray, t);
    return Ray(origin, radius, direction, ray.spread, ray.t_max, ray.epsilon, ray.tolerance, ray.steps);
}
