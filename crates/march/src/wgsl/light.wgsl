// Lights as seen from a point.

struct IncomingLight {
    // Unit vector towards the light.
    direction: vec3f,
    // Distance to the light; for a sun, the length of rays.
    distance: f32,
    // The inverse of the distance to the light; 0 for a sun.
    inverse_distance: f32,
    // Linear colour of the light that arrives.
    color: vec3f,
}

// Lower bound of the squared distance to a light.
const MIN_SQUARE: f32 = 1e-12;

fn light_at(light: Light, point: vec3f) -> IncomingLight {
    var incoming = IncomingLight(light.position, view.t_max, 0.0, light.color);
    if POSITIONAL_LIGHTS {
        if light.kind != SUN {
            let offset = light.position - point;
            let square = max(dot(offset, offset), MIN_SQUARE);
            let inverse_distance = inverseSqrt(square);
            incoming.direction = inverse_distance * offset;
            incoming.distance = inverse_distance * square;
            incoming.inverse_distance = inverse_distance;
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
