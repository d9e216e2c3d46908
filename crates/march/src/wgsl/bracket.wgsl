// Closing in on where a ray goes in, once a place outside and one inside are known.

// A hit is nearer than this part of the tolerance.
const HIT_FRACTION: f32 = 0.00390625;

struct Bracket {
    // Last place outside and first place inside, as (t, distance).
    outside: vec2f,
    inside: vec2f,
    // Whether there is a place inside.
    crossed: bool,
}

// With one more place.
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

// How near to the surface a hit is.
fn hit_within(ray: Ray, t: f32, near: f32) -> f32 {
    return max(HIT_FRACTION * near, rounding(ray, t));
}

// Where to look next: false position, kept off the ends so that the bracket always shrinks.
fn false_position(bracket: Bracket) -> f32 {
    let fraction = clamp(bracket.outside.y / (bracket.outside.y - bracket.inside.y), 0.1, 0.9);
    return mix(bracket.outside.x, bracket.inside.x, fraction);
}

fn width(bracket: Bracket) -> f32 {
    return bracket.inside.x - bracket.outside.x;
}
