// The entry points: a triangle that covers the target, and the colour of a pixel.

@vertex
fn vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(vec2u(corner & 1u, corner >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    limit_loops(position.x >= 0.0);
    load_frame();
    return picture(pixel_at(position.xy)).color;
}
