// The gradient of the naive marcher: central differences along the three axes with a fixed offset,
// which rounding swallows where coordinates are large.

const OFFSET: f32 = 0.001;

fn field_gradient(p: vec3f) -> vec3f {
    var sum = vec3f();
    // One call in a loop: drivers inline the field wherever it is called.
    for (var tap = 0u; tap < 6u; tap++) {
        let axis = select(vec3f(), vec3f(1.0), vec3u(0, 1, 2) == vec3u(tap >> 1u));
        let side = select(1.0, -1.0, (tap & 1u) == 1u);
        sum += side * axis * field(p + side * OFFSET * axis);
    }
    return sum / (2.0 * OFFSET);
}
