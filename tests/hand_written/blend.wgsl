// The field of examples/course/blend.sdf as a careful person writes it: all constants are inlined,
// vector code, no repeated work. README.md explains how the compiler is compared with it.

fn smooth_min(a: f32, b: f32) -> f32 {
    // Quadratic smooth minimum with k = 0.4; 0.625 is 0.25 / k.
    let h = max(0.4 - abs(a - b), 0.0);
    return min(a, b) - h * h * 0.625;
}

fn field(p: vec3f) -> f32 {
    let ball = length(p - vec3f(0.4, 0.7, 0.4)) - 0.8;
    let q = abs(p) - vec3f(0.8, 0.5, 0.8);
    let block = length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0);
    let ground = p.y + 0.5;
    return min(smooth_min(ball, block), ground);
}

// Keeps the optimiser from deleting `field` and adds no arithmetic of its own.
@group(0) @binding(0) var<storage, read_write> sample: vec4f;

@compute @workgroup_size(1)
fn main() {
    sample.w = field(sample.xyz);
}
