// What a host asks that has no footprint of its own: where a ray first meets the surface between two places.

// A hit is nearer than this part of the way from the ray's origin to it.
const ACCURACY: f32 = 1e-4;
// A hit is nearer than this, absolute, by methods that know no footprint.
const EPSILON: f32 = 1e-4;
// At most so many steps.
const MAX_STEPS: u32 = 256u;

// `t` of the result is counted from `origin`; `direction` is a unit vector, both places are finite. A place inside is a hit.
fn intersect(origin: vec3f, direction: vec3f, t_min: f32, t_max: f32) -> Trace {
    if !(t_min <= t_max) {
        return Trace(t_min, MISS, 0u);
    }
    let start = origin + t_min * direction;
    let radius = ACCURACY * t_min;
    var found = trace(Ray(start, radius, direction, ACCURACY, t_max - t_min, EPSILON, 0.5, MAX_STEPS));
    found.t += t_min;
    return found;
}
