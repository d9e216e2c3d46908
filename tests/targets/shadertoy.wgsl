// Calls what the text for shadertoy.com calls, at the defaults: no mouse, time 0.

@vertex
fn triangle(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(vec2u(corner & 1u, corner >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn toy(@builtin(position) place: vec4f) -> @location(0) vec4f {
    return image(vec2f(place.x, HEIGHT - place.y), vec2f(WIDTH, HEIGHT), vec2f(), 0.0, 0.0);
}

const WIDTH: f32 = 48.0;
const HEIGHT: f32 = 40.0;
