// What the scene supplies. The bodies here are replaced when the scene is linked.

// Signed distance.
fn field(p: vec3f) -> f32 {
    return 0.0;
}

// Spatial derivative of `field`.
fn field_gradient(p: vec3f) -> vec3f {
    return vec3f();
}

// Copies what is known per frame from its uniform buffer to private variables, once for each
// invocation: reading the buffer in the loop of a ray is slower.
fn load_frame() {
}
