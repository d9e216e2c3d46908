// An entry point that keeps the ray method and `intersect` alive while unreachable functions are
// removed; then it is removed itself.

@compute @workgroup_size(1)
fn anchor() {
    let found = trace(Ray());
    let met = intersect(vec3f(), vec3f(), 0.0, 0.0);
}
