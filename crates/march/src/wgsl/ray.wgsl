// What every ray method takes and gives: `fn trace(ray: Ray) -> Trace`.
// Each method states beside it how near to the surface its hits are: `fn tolerance(ray: Ray, t: f32) -> f32`.

struct Ray {
    origin: vec3f,
    // A unit vector.
    direction: vec3f,
    // The ray ends here.
    t_max: f32,
    // Radius of the ray's footprint at its origin, and what it gains per unit of length.
    radius: f32,
    spread: f32,
}

struct Trace {
    // Distance of the hit, or where the ray was left. NaN where the field is.
    t: f32,
    // MISS, HIT or CAPPED.
    status: u32,
    // Evaluations of the field.
    evaluations: u32,
}

// Eight units in the last place of numbers that large: sums of a few of them are no better.
const ROUNDING: f32 = 1e-6;

fn ray_point(ray: Ray, t: f32) -> vec3f {
    return ray.origin + t * ray.direction;
}

// Radius of the ray's footprint at a distance: half a pixel for rays from the eye.
fn footprint(ray: Ray, t: f32) -> f32 {
    return ray.radius + ray.spread * t;
}

// What rounding alone may do to a point on the ray.
fn rounding(ray: Ray, t: f32) -> f32 {
    return ROUNDING * (length(ray.origin) + t);
}

// The ray through the centre of a pixel.
fn camera_ray(pixel: vec2u) -> Ray {
    let place = 2.0 * (vec2f(pixel) + 0.5) / vec2f(view.size) - 1.0;
    let direction = view.forward + place.x * view.right - place.y * view.up;
    return Ray(view.eye, normalize(direction), view.t_max, 0.0, view.pixel_radius);
}
