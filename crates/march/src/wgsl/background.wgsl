// The colour behind the scene.

// Supplied by the scene: the light of the surroundings that a mirror receives. All components of
// `roughness` are the mirror's roughness, 0 for the surroundings themselves.
fn radiance(direction: vec3f, roughness: vec3f) -> vec3f {
    return vec3f();
}

// Supplied by the scene: the light of the surroundings that a matt white surface reflects.
fn irradiance(normal: vec3f) -> vec3f {
    return vec3f();
}

fn background_color(direction: vec3f) -> vec3f {
    var color = view.background;
    if SKY {
        var far = view.zenith;
        var height = direction.y;
        if GROUND {
            // Under a sky, the background is the ground. No branch: with parallel rays, its
            // condition is the same for all pixels, and Mesa's software driver (lavapipe 22.3)
            // then compiles the shader again at each dispatch.
            far = select(view.zenith, view.background, direction.y < 0.0);
            height = abs(direction.y);
        }
        // The colour changes fastest near the horizon.
        let low = 1.0 - saturate(height);
        color = mix(far, view.horizon, low * low * low);
    }
    if ENVIRONMENT {
        color = radiance(direction, vec3f());
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
