// The penumbra of a soft shadow, from how narrowly a ray towards a light passes what it does not
// hit. The distances at two positions of the ray are the radii of two spheres; where these
// intersect is taken for the surface that both are as far away from. S. Aaltonen, GPU-based clay
// simulation and ray-tracing tech in Claybook (GDC 2018), there for steps as long as the distance;
// here for steps of any length, and only for positions within the step.
//
// A field that is divided by a Lipschitz constant is flatter than a distance, and shadows would be
// darker and wider. The position of the least ratio remains, so the ratio is taken from an estimate
// of the distance there.

// True if the current ray leads to a light with a soft shadow.
var<private> records_clearance: bool;
// The least ratio of the distance from the ray to the distance along it, and where it is.
var<private> clearance: f32;
var<private> closest: f32;
// The last sample, as (t, distance).
var<private> last_sample: vec2f;

// The step of a ray; for a ray that records its clearance, no longer than the distance, whatever
// the method allows: the spheres of longer steps would hardly intersect, or not at all.
fn limited_step(stride: f32, distance: f32) -> f32 {
    var allowed = stride;
    if SOFT_SHADOWS {
        if records_clearance {
            allowed = min(stride, distance);
        }
    }
    return allowed;
}

// Call before tracing a ray towards a light.
fn start_penumbra() {
    clearance = 1e30;
    last_sample = vec2f();
}

// Methods call this after each sample of a ray.
fn record_sample(t: f32, distance: f32) {
    let step = t - last_sample.x;
    if step > 0.0 {
        let square = distance * distance;
        // How far before this position the spheres intersect, and how far beside the ray.
        let back = 0.5 * (step + (square - last_sample.y * last_sample.y) / step);
        var nearest = vec2f(t - back, sqrt(max(square - back * back, 0.0)));
        if back <= 0.0 || step > distance + last_sample.y {
            nearest = vec2f(t, distance);
        } else if back >= step {
            nearest = last_sample;
        }
        if nearest.x > 0.0 {
            if ESTIMATED {
                if nearest.y / nearest.x < clearance {
                    closest = nearest.x;
                }
            }
            clearance = min(clearance, nearest.y / nearest.x);
        }
    }
    last_sample = vec2f(t, distance);
}

// Supplied by the scene: the body is replaced when the shader is linked.

// What the distance to the surface is likely to be.
fn field_estimate(p: vec3f) -> f32 {
    return 0.0;
}

// Call after tracing a ray towards a light.
fn estimate_clearance(ray: Ray) {
    if records_clearance && clearance < 1e30 {
        clearance = max(clearance, field_estimate(ray_point(ray, closest)) / closest);
    }
}
