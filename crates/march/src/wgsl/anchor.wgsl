// Keeps the ray method and what asks it while what nothing reaches is dropped, and is dropped then itself.

@compute @workgroup_size(1)
fn anchor() {
    let found = trace(Ray());
    let met = intersect(vec3f(), vec3f(), 0.0, 0.0);
}
