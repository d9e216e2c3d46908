// Supplied by the scene for methods that need bounds along a ray segment: the bodies are replaced
// when the shader is linked.

// Lower and upper bound of `field` on the segment from a to b.
fn field_range(a: vec3f, b: vec3f) -> vec2f {
    return vec2f();
}

// Lower and upper bound of the slope of `field` on the segment from a to b, along `direction`, the
// unit vector from a to b. Where the field may jump they are -1e15 and 1e15.
fn field_slope_range(a: vec3f, b: vec3f, direction: vec3f) -> vec2f {
    return vec2f();
}
