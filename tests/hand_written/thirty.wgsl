// The field of examples/bench/thirty.sdf as a careful person writes it: all constants inlined and worked
// out beforehand, vector code, no work done twice. Written by thirty.rs from the scene's constants.

fn ball(p: vec3f, centre: vec3f, radius: f32) -> f32 {
    return length(p - centre) - radius;
}

fn block(p: vec3f, centre: vec3f, half_size: vec3f) -> f32 {
    let q = abs(p - centre) - half_size;
    return length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// `scaled` is `axis` over its squared length.
fn capsule(p: vec3f, start: vec3f, axis: vec3f, scaled: vec3f, radius: f32) -> f32 {
    let q = p - start;
    return length(q - axis * saturate(dot(q, scaled))) - radius;
}

// Quadratic smooth minimum of width k; `slope` is 0.25 / k.
fn join(a: f32, b: f32, k: f32, slope: f32) -> f32 {
    let h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * slope;
}

fn field(p: vec3f) -> f32 {
    var d = ball(p, vec3f(-1.59, -0.14, -0.67), 0.55);
    d = join(d, block(p, vec3f(-0.55, 1.05, 1.31), vec3f(0.23, 0.29, 0.39)), 0.36, 0.694444444);
    d = join(d, capsule(p, vec3f(-0.12, -0.86, 0.48), vec3f(-0.12, -0.42, 0.06), vec3f(-0.617283951, -2.160493827, 0.308641975), 0.14), 0.39, 0.641025641);
    d = join(d, ball(p, vec3f(0.72, -1.59, -1.77), 0.52), 0.13, 1.923076923);
    d = join(d, block(p, vec3f(-1.38, -0.52, -0.58), vec3f(0.49, 0.32, 0.24)), 0.22, 1.136363636);
    d = join(d, capsule(p, vec3f(0.34, 1.17, 1.06), vec3f(-0.19, 0.62, 0.17), vec3f(-0.422785937, 1.379617267, 0.378282154), 0.13), 0.26, 0.961538462);
    d = join(d, ball(p, vec3f(1.49, 1.13, 0.46), 0.46), 0.3, 0.833333333);
    d = join(d, block(p, vec3f(0.41, -0.51, -0.71), vec3f(0.21, 0.35, 0.42)), 0.25, 1.000000000);
    d = join(d, capsule(p, vec3f(-0.47, -1.13, -1.29), vec3f(-0.42, -0.48, 0.07), vec3f(-1.020160311, -1.165897498, 0.170026718), 0.16), 0.16, 1.562500000);
    d = join(d, ball(p, vec3f(0.1, -1.75, 0.62), 0.41), 0.13, 1.923076923);
    d = join(d, block(p, vec3f(-0.71, -1.67, 1.72), vec3f(0.44, 0.24, 0.36)), 0.28, 0.892857143);
    d = join(d, capsule(p, vec3f(-1.02, 0.09, -0.23), vec3f(-0.59, -0.53, -0.08), vec3f(-0.928548946, -0.834120239, -0.125904942), 0.12), 0.39, 0.641025641);
    d = join(d, ball(p, vec3f(0.12, -0.44, -0.78), 0.5), 0.17, 1.470588235);
    d = join(d, block(p, vec3f(-1.55, 0.13, 1.21), vec3f(0.23, 0.23, 0.46)), 0.17, 1.470588235);
    d = join(d, capsule(p, vec3f(-1.56, 0.42, -0.78), vec3f(0.14, 0.7, 0.43), vec3f(0.201583873, 1.007919366, 0.619150468), 0.15), 0.27, 0.925925926);
    d = join(d, ball(p, vec3f(1.44, 1.37, 1.54), 0.32), 0.34, 0.735294118);
    d = join(d, block(p, vec3f(-1.61, -1.6, 1.02), vec3f(0.44, 0.41, 0.19)), 0.11, 2.272727273);
    d = join(d, capsule(p, vec3f(1.16, -0.02, 0.72), vec3f(-0.23, 0.24, 0.01), vec3f(-2.079566004, 2.169981917, 0.090415913), 0.15), 0.11, 2.272727273);
    d = join(d, ball(p, vec3f(1.35, 0.04, 1.37), 0.41), 0.15, 1.666666667);
    d = join(d, block(p, vec3f(1.29, 1.18, -0.04), vec3f(0.29, 0.42, 0.37)), 0.28, 0.892857143);
    d = join(d, capsule(p, vec3f(1.35, 1.14, 1.13), vec3f(0.53, -0.04, 0.65), vec3f(0.751773050, -0.056737589, 0.921985816), 0.14), 0.4, 0.625000000);
    d = join(d, ball(p, vec3f(-1.26, -0.57, -0.18), 0.28), 0.28, 0.892857143);
    d = join(d, block(p, vec3f(-1.28, -1.76, -1.46), vec3f(0.47, 0.18, 0.26)), 0.34, 0.735294118);
    d = join(d, capsule(p, vec3f(-0.19, -0.46, -0.89), vec3f(-0.68, -0.11, 0.22), vec3f(-1.300439855, -0.210365271, 0.420730541), 0.23), 0.23, 1.086956522);
    d = join(d, ball(p, vec3f(-1.22, 0.64, -0.54), 0.34), 0.18, 1.388888889);
    d = join(d, block(p, vec3f(0.42, 1.23, 1.14), vec3f(0.39, 0.2, 0.46)), 0.35, 0.714285714);
    d = join(d, capsule(p, vec3f(0.35, -0.65, 0.9), vec3f(-0.64, 0.46, 0.06), vec3f(-1.024327785, 0.736235595, 0.096030730), 0.15), 0.16, 1.562500000);
    d = join(d, ball(p, vec3f(-1.26, 0.7, 0.98), 0.5), 0.2, 1.250000000);
    d = join(d, block(p, vec3f(1.65, -0.83, -0.73), vec3f(0.36, 0.18, 0.32)), 0.34, 0.735294118);
    d = join(d, capsule(p, vec3f(-1.33, -0.02, 1.7), vec3f(-0.61, 0.04, 0.1), vec3f(-1.589783685, 0.104248111, 0.260620276), 0.19), 0.24, 1.041666667);
    return d;
}

// Keeps `field` alive through the optimiser and adds no arithmetic of its own.
@group(0) @binding(0) var<storage, read_write> sample: vec4f;

@compute @workgroup_size(1)
fn main() {
    sample.w = field(sample.xyz);
}
