// The penumbra of a soft shadow, from how narrowly a ray towards a light passes what it does not
// hit. The distances at two positions of the ray are the radii of two spheres; where these
// intersect is taken for the surface that both are as far away from. S. Aaltonen, GPU-based clay
// simulation and ray-tracing tech in Claybook (GDC 2018), there for steps as long as the distance;
// here for steps of any length, and only for positions within the step.
//
// A field that is divided by a Lipschitz constant is flatter than a distance, and shadows would be
// darker and wider. The position of the least ratio remains, so the ratio is taken from an estimate
// of the distance there.
//
// Other fields fall behind the distance because they are the distance to something that is not
// there: beside an opening, a difference is the distance to the side of the tool that goes on
// outside of the solid. Following the gradient tells, as the field is not 0 at its end. So the way
// along the gradients takes the place of the field, wherever the field lies within the cone.
//
// A light with a place is a point, so the cone of its penumbra closes there again. Otherwise a
// light would be in the shadow of the ceiling above it, and of its own shade.

// The most steps along gradients. With 5, shadows behind copies of different heights have streaks.
const MAX_PROJECTIONS: u32 = 10u;
// A surface is reached where the field is less than this fraction of the way. The limit of copies
// in a grid is more at the border of a cell, unless the way is 50 times as long.
const ARRIVED: f32 = 0.02;
// Samples whose gradients are followed are at least this far from each other, as a fraction of the
// distance there: the least distance of a straight ray is missed by less than a hundredth.
const MIN_WAY: f32 = 0.25;

// True if the current ray leads to a light with a soft shadow.
var<private> records_clearance: bool;
// The inverse of the distance to the light; 0 for a sun.
var<private> inverse_light_distance: f32;
// The least ratio of the distance from the ray to the cone's width, and where it is.
var<private> clearance: f32;
var<private> closest: f32;
// The clearance from which on all light passes.
var<private> full_light: f32;
// The last sample, and the last one whose gradients were followed, as (t, distance).
var<private> last_sample: vec2f;
var<private> last_projection: vec2f;

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

// Call before tracing a ray towards a light, with the inverse of the distance to it.
fn start_penumbra(inverse_distance: f32) {
    clearance = 1e30;
    last_sample = vec2f();
    last_projection = vec2f();
    inverse_light_distance = inverse_distance;
}

// The width of the cone at a position of the ray, for a sharpness of 1.
fn cone_width(t: f32) -> f32 {
    var width = t;
    if POSITIONAL_LIGHTS {
        width *= 1.0 - t * inverse_light_distance;
    }
    return width;
}

// The way along the gradients to a surface, from a position of the ray with this value of the
// field, as (t, distance). The least of it matters, and only below `limit`; infinite if it does not
// matter.
fn projected(ray: Ray, nearest: vec2f, limit: f32) -> f32 {
    // A distance falls by no more than the way.
    let way = abs(nearest.x - last_projection.x);
    if nearest.y >= limit || way < MIN_WAY * last_projection.y || last_projection.y - way >= limit {
        return FAR;
    }
    var p = ray_point(ray, nearest.x);
    var distance = nearest.y;
    var length = 0.0;
    for (var step = 0u; step < MAX_PROJECTIONS; step++) {
        let gradient = field_gradient(p);
        let inverse = inverseSqrt(max(dot(gradient, gradient), 1e-12));
        let stride = distance * inverse;
        length += stride;
        if length >= limit {
            break;
        }
        p -= stride * inverse * gradient;
        distance = marched_field(p);
        if distance < ARRIVED * length {
            break;
        }
    }
    last_projection = vec2f(nearest.x, length);
    return max(nearest.y, length);
}

// Methods call this after each sample of a ray.
fn record_sample(ray: Ray, t: f32, distance: f32) {
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
        let width = cone_width(nearest.x);
        if width > 0.0 {
            if PROJECTED {
                if records_clearance {
                    nearest.y = projected(ray, nearest, min(clearance, full_light) * width);
                }
            }
            if ESTIMATED {
                if nearest.y / width < clearance {
                    closest = nearest.x;
                }
            }
            clearance = min(clearance, nearest.y / width);
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
        clearance = max(clearance, field_estimate(ray_point(ray, closest)) / cone_width(closest));
    }
}
