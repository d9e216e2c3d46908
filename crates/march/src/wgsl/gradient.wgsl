// Supplied by the scene: the body is replaced when the shader is linked.

// Spatial derivative of `field`.
fn field_gradient(p: vec3f) -> vec3f {
    return vec3f();
}
