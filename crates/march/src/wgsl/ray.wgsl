// What every ray method takes and gives: `fn trace(ray: Ray) -> Trace`.
// Each method states beside it how near to the surface its hits are: `fn tolerance(ray: Ray, t: f32) -> f32`, and tells
// `passed` of each sample that it keeps.

const MISS: u32 = 0;
const HIT: u32 = 1;
const CAPPED: u32 = 2;

struct Ray {
    origin: vec3f,
    // Radius of the ray's footprint at its origin.
    radius: f32,
    // A unit vector.
    direction: vec3f,
    // What the radius gains per unit of length.
    spread: f32,
    // The ray ends here.
    t_max: f32,
    // A hit is nearer than this, absolute (`fixed`, `sphere`).
    epsilon: f32,
    // A hit is nearer than this, in widths of the footprint there (all others).
    tolerance: f32,
    // At most so many steps.
    steps: u32,
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

// A part of the footprint's width, but no finer than what rounding allows.
fn footprint_tolerance(ray: Ray, t: f32) -> f32 {
    return max(2.0 * ray.tolerance * footprint(ray, t), rounding(ray, t));
}

// What rounding alone may do to a point on the ray.
fn rounding(ray: Ray, t: f32) -> f32 {
    return ROUNDING * (length(ray.origin) + t);
}
