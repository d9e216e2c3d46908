// What the scene supplies of rays. The bodies are replaced when the scene is linked. Directions are of unit length.

// Where a ray is first inside what needs no march: 0 for one that starts there, FAR for one that never is.
fn analytic_hit(origin: vec3f, direction: vec3f) -> f32 {
    return 0.0;
}

// Signed distance to what needs no march.
fn analytic_distance(p: vec3f) -> f32 {
    return 0.0;
}

// Signed distance to all else.
fn marched_distance(p: vec3f) -> f32 {
    return 0.0;
}

// Where a ray enters and leaves a box around what is marched; the first above the second where it misses it.
fn clip_interval(origin: vec3f, direction: vec3f) -> vec2f {
    return vec2f();
}

// Where a ray is first inside of what is sampled at its origin, FAR where it never is; and how far from the origin nothing else
// is marched.
fn intersect_copies(origin: vec3f, direction: vec3f) -> vec2f {
    return vec2f();
}
