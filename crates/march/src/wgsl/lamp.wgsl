// Lights as a point sees them.

struct Lamp {
    // Towards it, of unit length.
    direction: vec3f,
    // How far away it is, or where rays end.
    reach: f32,
    // Linear colour of what arrives.
    color: vec3f,
}

// A lamp is never taken to be nearer than the root of this.
const LEAST_SQUARE: f32 = 1e-12;

fn lamp_at(light: Light, point: vec3f) -> Lamp {
    var lamp = Lamp(light.place, view.t_max, light.color);
    if LAMPS {
        if light.kind != SUN {
            let way = light.place - point;
            let square = max(dot(way, way), LEAST_SQUARE);
            let nearness = inverseSqrt(square);
            lamp.direction = nearness * way;
            lamp.reach = nearness * square;
            lamp.color *= 1.0 / square;
            if SPOTS {
                if light.kind == SPOT {
                    lamp.color *= smoothstep(light.rim.y, light.rim.x, -dot(light.axis, lamp.direction));
                }
            }
        }
    }
    return lamp;
}
