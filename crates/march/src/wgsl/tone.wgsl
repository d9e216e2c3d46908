// From light to the colours of the picture.

// Supplied by the scene: the factor of all light.
fn exposure() -> f32 {
    return 1.0;
}

// Keeps colours up to 0.8. Brighter ones approach 1, and white the more the brighter they are.
// Khronos, PBR Neutral Tone Mapper (2024).
fn neutral_tone(light: vec3f) -> vec3f {
    let lowest = min(light.r, min(light.g, light.b));
    // The part of white light that dielectrics reflect.
    let offset = select(0.04, lowest - 6.25 * lowest * lowest, lowest < 0.08);
    let color = light - offset;
    let peak = max(color.r, max(color.g, color.b));
    let start = 0.76;
    if peak < start {
        return color;
    }
    let rest = 1.0 - start;
    let compressed = 1.0 - rest * rest / (peak + rest - start);
    let white = 1.0 - 1.0 / (0.15 * (peak - compressed) + 1.0);
    return mix(color * (compressed / peak), vec3f(compressed), white);
}

// A fit to the curve of the Academy Color Encoding System. K. Narkowicz, ACES filmic tone mapping
// curve (2016).
fn film_tone(light: vec3f) -> vec3f {
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
}

fn developed(light: vec3f) -> vec3f {
    var color = light;
    if EXPOSURE {
        color *= exposure();
    }
    if NEUTRAL_TONE {
        color = neutral_tone(color);
    }
    if FILM_TONE {
        color = film_tone(color);
    }
    return color;
}
