// What the scene supplies. The body is replaced when the scene is linked.

// Spatial derivative of `field`.
fn field_gradient(p: vec3f) -> vec3f {
    return vec3f();
}
