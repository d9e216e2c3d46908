// Supplied by the scene: the body is replaced when the shader is linked.

// Copies the per-frame values from their uniform buffer to private variables, once per invocation:
// reading the buffer inside the loop of a ray is slower.
fn load_frame() {
}
