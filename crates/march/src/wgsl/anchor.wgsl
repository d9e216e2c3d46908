// Keeps the ray method while what nothing reaches is dropped, and is dropped then itself.

@compute @workgroup_size(1)
fn anchor() {
    let found = trace(Ray());
}
