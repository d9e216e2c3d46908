// The gradient of any field by central differences at the corners of a tetrahedron. Benchmarks use
// it for scenes and interpreters alike, so that a normal costs four evaluations in both. I. Quilez,
// "Normals for an SDF".

// With a shorter offset rounding shows, with a longer one creases do.
const TAP: f32 = 5e-4;

fn field_gradient(p: vec3f) -> vec3f {
    var sum = vec3f();
    // One call in a loop: drivers inline the field wherever it is called.
    for (var i = 0u; i < 4u; i++) {
        let corner = vec3f(vec3u((i + 3u) >> 1u, i, i >> 1u) & vec3u(1u)) * 2.0 - 1.0;
        sum += corner * field(p + TAP * corner);
    }
    return sum / (4.0 * TAP);
}
