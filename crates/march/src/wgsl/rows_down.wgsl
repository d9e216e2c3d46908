// The target's first row is the topmost, as in WebGPU, Vulkan, Metal and DirectX.

fn pixel_at(position: vec2f) -> vec2u {
    return view.tile_origin + vec2u(position);
}
