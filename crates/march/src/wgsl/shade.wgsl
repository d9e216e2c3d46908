// Shared by both ways of shading.

// Linear colour of surfaces without a material.
const DEFAULT_COLOR = vec3f(0.8);

// The outward unit normal; the direction towards the eye if the field has no slope.
fn normal_at(p: vec3f, toward_eye: vec3f) -> vec3f {
    let gradient = field_gradient(p);
    let square = dot(gradient, gradient);
    record_slope(square);
    if square > 0.0 {
        return gradient * inverseSqrt(square);
    }
    return toward_eye;
}
