// The functions that the scene supplies for the analytic intersection of rays. Their bodies are
// replaced when the shader is linked. Directions are unit vectors.

// Where a ray first enters the analytic part of the scene: 0 if it starts inside, FAR if it never
// does.
fn analytic_hit(origin: vec3f, direction: vec3f) -> f32 {
    return 0.0;
}

// Signed distance to the analytic part of the scene.
fn analytic_distance(p: vec3f) -> f32 {
    return 0.0;
}

// Signed distance to the marched part of the scene.
fn marched_distance(p: vec3f) -> f32 {
    return 0.0;
}

// Where a ray enters and leaves a box around the marched part; x > y if it misses the box.
fn clip_interval(origin: vec3f, direction: vec3f) -> vec2f {
    return vec2f();
}

// x: where a ray first enters a copy that is sampled at its origin, FAR if it never does. y: the
// distance from the origin within which nothing else needs marching.
fn intersect_copies(origin: vec3f, direction: vec3f) -> vec2f {
    return vec2f();
}
