// The program's part of the shader: a camera, two rays into the scenes, Lambert's law. It follows
// the functions of the scenes.

struct Camera {
    eye: vec3f,
    ambient: f32,
    right: vec3f,
    far: f32,
    up: vec3f,
    forward: vec3f,
    // Unit vector towards the sun.
    sun: vec3f,
    size: vec2f,
}

@group(0) @binding(0) var<uniform> camera: Camera;

const GREY = vec3f(0.8);
// Linear, like all light here.
const BACKGROUND = vec3f(0.01, 0.0331, 0.0732);

// A triangle over the whole target.
@vertex
fn vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(vec2u(corner & 1u, corner >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let offset = 2.0 * position.xy / camera.size - 1.0;
    let direction = normalize(camera.forward + offset.x * camera.right - offset.y * camera.up);
    let bowl = bowl_intersect(camera.eye, direction, 0.0, camera.far);
    // The second ray ends where the bowl was hit.
    let end = select(camera.far, bowl.t, bowl.status == bowl_HIT);
    let ring = ring_intersect(camera.eye, direction, 0.0, end);
    var gradient: vec4f;
    if ring.status == ring_HIT {
        gradient = ring_gradient(camera.eye + ring.t * direction);
    } else if bowl.status == bowl_HIT {
        gradient = bowl_gradient(camera.eye + bowl.t * direction);
    } else {
        return vec4f(BACKGROUND, 1.0);
    }
    let light = camera.ambient + max(dot(normalize(gradient.xyz), camera.sun), 0.0);
    return vec4f(light * GREY, 1.0);
}
