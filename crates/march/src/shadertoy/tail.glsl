void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fragColor = image(fragCoord, iResolution.xy, iMouse.xy, iTime, float(iFrame));
}
