// The interface of a ray method: `fn trace(ray: Ray) -> Trace` finds the first hit of a ray, and
// `fn tolerance(ray: Ray, t: f32) -> f32` tells how near to the surface its hits are. A method
// calls `record_sample` for each sample that it keeps, and may call `record_gap` for what it passes
// without a proof.

const MISS: u32 = 0;
const HIT: u32 = 1;
const CAPPED: u32 = 2;

struct Ray {
    origin: vec3f,
    // Radius of the ray's footprint at its origin.
    radius: f32,
    // A unit vector.
    direction: vec3f,
    // Growth of the radius per unit of length.
    spread: f32,
    // Length of the ray.
    t_max: f32,
    // Absolute distance below which a point is a hit (`fixed`, `sphere`).
    epsilon: f32,
    // Distance below which a point is a hit, in widths of the footprint there (all other methods).
    tolerance: f32,
    // The step budget.
    steps: u32,
}

struct Trace {
    // Distance to the hit, or to where the ray ended. NaN where the field is NaN.
    t: f32,
    // MISS, HIT or CAPPED (out of steps).
    status: u32,
    // Evaluations of the field.
    evaluations: u32,
}

// Relative rounding error of a position: eight units in the last place, for sums of a few terms.
const ROUNDING: f32 = 1e-6;

// True for NaN. A compiler may assume that no number is NaN: NVIDIA's turned
// `select(t, limit, t > limit)` into a minimum, which is `limit` where t is NaN. A test of the bits
// stays as it is.
fn is_nan(number: f32) -> bool {
    return (bitcast<u32>(number) & 0x7fffffffu) > 0x7f800000u;
}

fn ray_point(ray: Ray, t: f32) -> vec3f {
    return ray.origin + t * ray.direction;
}

// Radius of the ray's footprint at t: half a pixel's width for camera rays.
fn footprint(ray: Ray, t: f32) -> f32 {
    return ray.radius + ray.spread * t;
}

// The tolerance as a fraction of the footprint's width, but no finer than rounding allows.
fn footprint_tolerance(ray: Ray, t: f32) -> f32 {
    return max(2.0 * ray.tolerance * footprint(ray, t), rounding(ray, t));
}

// The largest error of a point of the ray by rounding alone.
fn rounding(ray: Ray, t: f32) -> f32 {
    return ROUNDING * (length(ray.origin) + t);
}
