// The field of blend.wgsl in the fewest arithmetic instructions that were found. It is harder to
// read and rounds once more far from the blend. README.md one level up derives the form.

fn field(p: vec3f) -> f32 {
    // 0.4 = k more than the distance to the ball, so that the smooth minimum needs no `abs`.
    let ball = length(p - vec3f(0.4, 0.7, 0.4)) - 0.4;
    let q = abs(p) - vec3f(0.8, 0.5, 0.8);
    let block = length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0);
    let nearer = min(ball, block);
    let h = max(nearer - ball + 0.8, 0.0);
    return min(nearer + h * h * -0.625, p.y + 0.5);
}

// Keeps the optimiser from deleting `field` and adds no arithmetic of its own.
@group(0) @binding(0) var<storage, read_write> sample: vec4f;

@compute @workgroup_size(1)
fn main() {
    sample.w = field(sample.xyz);
}
