// What the scene supplies. The body is replaced when the scene is linked.

// Copies what is known per frame from its uniform buffer to private variables, once for each
// invocation: reading the buffer in the loop of a ray is slower.
fn load_frame() {
}
