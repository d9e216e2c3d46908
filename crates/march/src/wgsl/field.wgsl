// What the scene supplies. The body is replaced when the scene is linked.

// Signed distance.
fn field(p: vec3f) -> f32 {
    return 0.0;
}
