// The sRGB transfer function (IEC 61966-2-1).
fn srgb(linear: vec3f) -> vec3f {
    let light = saturate(linear);
    return select(1.055 * pow(light, vec3f(1.0 / 2.4)) - 0.055, 12.92 * light, light <= vec3f(0.0031308));
}
