// What the scene supplies for methods that look at a stretch of the ray at once. The bodies are replaced when the scene is
// linked.

// The least and the greatest of `field` from one point to another.
fn field_range(a: vec3f, b: vec3f) -> vec2f {
    return vec2f();
}

// The least and the greatest slope of `field` from one point to another, along a unit vector that leads there.
// Where the field may jump they are -1e15 and 1e15.
fn field_slope_range(a: vec3f, b: vec3f, direction: vec3f) -> vec2f {
    return vec2f();
}
