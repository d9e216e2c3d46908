// A limit on the iterations of the scene's loops that none of them reaches, and that no compiler
// knows. A compiler that knows how often a loop runs at most tries to unroll it. That takes it
// longer than all else where a loop has many operations, and gains nothing: docs/gpu.md.
var<private> loop_limit: f32;

const UNREACHED: f32 = 1e9;

// `is_drawn` is true, but follows neither from constants nor from uniforms alone: a software driver
// (Mesa 22) compiles a shader anew for each value of a uniform that limits a loop.
fn limit_loops(is_drawn: bool) {
    loop_limit = select(0.0, UNREACHED, is_drawn);
}
