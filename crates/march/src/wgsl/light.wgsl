// Lights as a point sees them.

struct IncomingLight {
    // Towards it, of unit length.
    direction: vec3f,
    // How far away it is, or where rays end.
    distance: f32,
    // Linear colour of what arrives.
    color: vec3f,
}

// A lamp is never taken to be nearer than the root of this.
const MIN_SQUARE: f32 = 1e-12;

fn light_at(light: Light, point: vec3f) -> IncomingLight {
    var incoming = IncomingLight(light.position, view.t_max, light.color);
    if POSITIONAL_LIGHTS {
        if light.kind != SUN {
            let offset = light.position - point;
            let square = max(dot(offset, offset), MIN_SQUARE);
            let inverse_distance = inverseSqrt(square);
            incoming.direction = inverse_distance * offset;
            incoming.distance = inverse_distance * square;
            incoming.color *= 1.0 / square;
            if SPOT_LIGHTS {
                if light.kind == SPOT {
                    incoming.color *= smoothstep(light.rim.y, light.rim.x, -dot(light.axis, incoming.direction));
                }
            }
        }
    }
    return incoming;
}
