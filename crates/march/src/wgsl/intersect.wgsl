// Intersection for hosts: the first hit of a ray between two positions, for rays without a pixel.

// A hit is nearer than this fraction of its distance from the ray's origin.
const ACCURACY: f32 = 1e-4;
// Absolute tolerance, for methods that do not use the footprint.
const EPSILON: f32 = 1e-4;
// The step budget of a ray.
const MAX_STEPS: u32 = 256u;

// Returns the first hit of a ray between `t_min` and `t_max`. `direction` is a unit vector and both
// ends are finite; `t` of the result is counted from `origin`. A ray that starts inside hits at its
// start.
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
