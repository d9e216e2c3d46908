// The colour behind the scene.

fn background_color(direction: vec3f) -> vec3f {
    var color = view.background;
    if SKY {
        // The colour changes fastest near the horizon.
        let low = 1.0 - saturate(direction.y);
        color = mix(view.zenith, view.horizon, low * low * low);
        if GROUND {
            if direction.y < 0.0 {
                // Under a sky, the background is the ground.
                let high = 1.0 - saturate(-direction.y);
                color = mix(view.background, view.horizon, high * high * high);
            }
        }
    }
    return color;
}

// The colour of the fog in a direction.
fn fog_color_at(direction: vec3f) -> vec3f {
    var color: vec3f;
    if FOG_COLOR {
        color = view.fog_color;
    } else {
        color = background_color(direction);
    }
    return color;
}
