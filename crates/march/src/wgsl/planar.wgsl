// The colour of a pixel of a planar picture: a formula of its middle and its size. The camera looks
// along -z with parallel rays, so `view.right` and `view.up` are half the picture's size. Its eye
// is at distance 1 from the plane.

// Supplied by the scene: linear red, green and blue of a pixel, and the distance at its middle.
fn planar_pixel(p: vec2f, size: vec2f) -> vec4f {
    return vec4f();
}

fn picture(pixel: vec2u) -> Pixel {
    let position = 2.0 * (vec2f(pixel) + 0.5) / vec2f(view.size) - 1.0;
    let p = view.eye.xy + position.x * view.right.xy - position.y * view.up.xy;
    let shown = planar_pixel(p, vec2f(2.0 * view.pixel_radius));
    return Pixel(vec4f(shown.rgb, 1.0), 1.0, select(MISS, HIT, shown.a <= 0.0), 1u, 1u);
}
