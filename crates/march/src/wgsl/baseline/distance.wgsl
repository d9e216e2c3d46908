// What the scene supplies where its gradient is taken by differences. The body is replaced when it is linked.

// Signed distance.
fn field(p: vec3f) -> f32 {
    return 0.0;
}
