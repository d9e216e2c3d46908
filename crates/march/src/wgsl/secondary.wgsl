// Rays that start on a surface.

// Of a ray to a lamp, whose footprint is as wide as it starts above the surface.
const SHADOW_TOLERANCE: f32 = 0.25;

// How far a hit may be from it.
fn nearness(seen: Ray, t: f32) -> f32 {
    return max(tolerance(seen, t), rounding(seen, t));
}

// Off the surface, and a little back towards where the ray came from: at the foot of a wall the normal of the
// wall does not lead out of the floor.
fn start_at(surface: Surface, seen: Ray, t: f32, lift: f32) -> vec3f {
    return surface.point + lift * surface.normal - 0.25 * nearness(seen, t) * seen.direction;
}

// From a surface to a lamp. It starts further off than what counts as a hit there, than half a pixel and than
// rounding, so that it does not meet the surface that it leaves.
fn shadow_ray(surface: Surface, seen: Ray, t: f32, lamp: Lamp) -> Ray {
    let lift = max(3.0 * nearness(seen, t), footprint(seen, t));
    let origin = start_at(surface, seen, t, lift);
    if SOFT_SHADOWS {
        open_penumbra();
    }
    let radius = 0.5 * lift;
    return Ray(origin, radius, lamp.direction, 0.0, lamp.reach, seen.epsilon, SHADOW_TOLERANCE, seen.steps);
}

// From a surface to what it mirrors, less far off, since that moves the image. The footprint goes on growing
// as it would without the mirror.
fn mirrored_ray(surface: Surface, seen: Ray, t: f32) -> Ray {
    let origin = start_at(surface, seen, t, 1.5 * nearness(seen, t));
    let direction = reflect(seen.direction, surface.normal);
    let radius = footprint(seen, t);
    return Ray(origin, radius, direction, seen.spread, seen.t_max, seen.epsilon, seen.tolerance, seen.steps);
}
