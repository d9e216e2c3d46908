// The edge of a soft shadow, from how narrowly a ray to a lamp passes what it does not meet. The distances at two
// places of the ray are the radii of two spheres; where these meet is taken for the surface that both are as far
// away from. S. Aaltonen, GPU-based clay simulation and ray-tracing tech in Claybook (GDC 2018), there for
// steps as long as the distance; here for steps of any length, and for no place outside the step.

// Whether the ray at hand leads to a lamp with a soft shadow.
var<private> records_clearance: bool;
// Distance from the ray over distance along it, the least of all places.
var<private> clearance: f32;
// Last place, and the distance there.
var<private> last_sample: vec2f;

// A step, but of a ray that is watched no longer than the distance, whatever the method could do: its spheres would hardly
// meet, or not, and what they touch at would be taken for a surface.
fn limited_step(stride: f32, distance: f32) -> f32 {
    var allowed = stride;
    if SOFT_SHADOWS {
        if records_clearance {
            allowed = min(stride, distance);
        }
    }
    return allowed;
}

// Before a ray to a lamp.
fn start_penumbra() {
    clearance = 1e30;
    last_sample = vec2f();
}

// After each sample of a ray.
fn record_sample(t: f32, distance: f32) {
    let step = t - last_sample.x;
    if step > 0.0 {
        let square = distance * distance;
        // How far before this place the spheres meet, and how far beside the ray.
        let back = 0.5 * (step + (square - last_sample.y * last_sample.y) / step);
        var nearest = vec2f(t - back, sqrt(max(square - back * back, 0.0)));
        if back <= 0.0 || step > distance + last_sample.y {
            nearest = vec2f(t, distance);
        } else if back >= step {
            nearest = last_sample;
        }
        if nearest.x > 0.0 {
            clearance = min(clearance, nearest.y / nearest.x);
        }
    }
    last_sample = vec2f(t, distance);
}
