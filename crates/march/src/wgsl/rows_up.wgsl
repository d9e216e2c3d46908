// The target's first row is the lowest, as in OpenGL and WebGL.

fn pixel_at(position: vec2f) -> vec2u {
    let pixel = view.tile_origin + vec2u(position);
    return vec2u(pixel.x, view.size.y - 1u - pixel.y);
}
