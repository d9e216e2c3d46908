// The shader returns linear light. A WebGL canvas shows numbers as they are, so a second `main`
// calls the first one and encodes its result.
export function encoded(text) {
  const output = text.match(/ out vec4 (\w+);/)[1];
  return `${text.replace("void main()", "void draw_linear()")}
void main() {
    draw_linear();
    vec3 light = clamp(${output}.rgb, 0.0, 1.0);
    vec3 curve = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    ${output} = vec4(mix(curve, 12.92 * light, lessThanEqual(light, vec3(0.0031308))), 1.0);
}`;
}
