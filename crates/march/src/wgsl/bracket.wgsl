// Root finding once a sample outside and one inside the surface are known.

// A sample within this fraction of the tolerance is a hit.
const HIT_FRACTION: f32 = 0.00390625;

struct Bracket {
    // The last sample outside and the first one inside, as (t, distance).
    outside: vec2f,
    inside: vec2f,
    // True if there is a sample inside.
    crossed: bool,
}

// The bracket with one more sample.
fn with_sample(bracket: Bracket, t: f32, distance: f32) -> Bracket {
    var next = bracket;
    if distance < 0.0 {
        next.inside = vec2f(t, distance);
        next.crossed = true;
    } else {
        next.outside = vec2f(t, distance);
    }
    return next;
}

// The distance from the surface below which a sample is a hit.
fn hit_within(ray: Ray, t: f32, near: f32) -> f32 {
    return max(HIT_FRACTION * near, rounding(ray, t));
}

// The next position to sample, and the position of the hit in a bracket that is narrow, by false
// position. It keeps away from both ends, so that the bracket always shrinks.
fn false_position(bracket: Bracket) -> f32 {
    let fraction = clamp(bracket.outside.y / (bracket.outside.y - bracket.inside.y), 0.1, 0.9);
    return mix(bracket.outside.x, bracket.inside.x, fraction);
}

fn width(bracket: Bracket) -> f32 {
    return bracket.inside.x - bracket.outside.x;
}
