// Supplied by the scene: the body is replaced when the shader is linked.

// Signed distance to the surface, negative inside.
fn field(p: vec3f) -> f32 {
    return 0.0;
}
