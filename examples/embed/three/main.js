// Marches the field in scene.glsl, which `sdfc compile --emit march --target glsl-es` wrote, in a
// three.js scene: with the same camera, light and depth buffer as the meshes there.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { clock, compiled, sliders } from "../reflection.js";

// The ray through each corner of a triangle that covers the picture.
const VERTEX = `
out vec3 ray;
void main() {
  gl_Position = vec4(position.xy, 0.0, 1.0);
  vec4 far = inverse(projectionMatrix * viewMatrix) * vec4(position.xy, 1.0, 1.0);
  ray = far.xyz / far.w - cameraPosition;
}`;

// The shader has `sdf_material` if something in the scene has a material.
const fragment = (hasMaterial) => `
uniform mat4 projectionMatrix;
uniform vec3 sun;
in vec3 ray;
out vec4 color;
void main() {
  vec3 direction = normalize(ray);
  sdf_Trace found = sdf_intersect(cameraPosition, direction, 0.0, 100.0);
  if (found.status != sdf_HIT) discard;
  vec3 p = cameraPosition + found.t * direction;
  vec3 normal = normalize(sdf_gradient(p).xyz);
  float light = 0.2 + 0.8 * max(dot(normal, sun), 0.0);
  color = linearToOutputTexel(vec4(light * ${hasMaterial ? "sdf_material(p).color" : "vec3(0.5)"}, 1.0));

  // Depth as three.js has it, so that meshes and field hide each other.
  vec4 place = projectionMatrix * viewMatrix * vec4(p, 1.0);
  gl_FragDepth = 0.5 + 0.5 * place.z / place.w;
}`;

/// Removes from the shader what three.js writes itself: the version, and the entry point.
function functions(text) {
  return text.replace(/^#version.*/, "").replace("void main()", "void sdf_unused()");
}

/// The uniform block of params, if there are any. three.js lays it out by the same rules.
function paramGroups(reflection) {
  const uniforms = {};
  if (!reflection.uniform) return { groups: [], uniforms };
  const group = new THREE.UniformsGroup();
  group.setName(reflection.uniform.block);
  for (const { param, default: lanes } of reflection.params) {
    const value = lanes.length === 4 ? new THREE.Vector4(...lanes) : lanes[0];
    uniforms[param] = new THREE.Uniform(value);
    group.add(uniforms[param]);
  }
  return { groups: [group], uniforms };
}

async function main() {
  const [text, reflection] = await compiled("scene.glsl");
  const canvas = document.querySelector("canvas");
  const { width, height } = canvas;
  const renderer = new THREE.WebGLRenderer({ canvas, preserveDrawingBuffer: true });
  renderer.setSize(width, height);
  const camera = new THREE.PerspectiveCamera(42, width / height, 0.1, 100);
  camera.position.set(4.4, 2.4, 2.6);
  const sun = new THREE.Vector3(1.5, 2, 0.2).normalize();

  const { groups, uniforms } = paramGroups(reflection);
  const hasMaterial = reflection.functions.some(({ role }) => role === "material");
  const material = new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: VERTEX,
    fragmentShader: functions(text) + fragment(hasMaterial),
    uniforms: { sun: { value: sun } },
    uniformsGroups: groups,
  });
  const triangle = new THREE.BufferGeometry();
  const corners = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
  triangle.setAttribute("position", new THREE.BufferAttribute(corners, 3));
  const field = new THREE.Mesh(triangle, material);
  field.frustumCulled = false;

  // A mesh, half in the bowl.
  const knot = new THREE.Mesh(
    new THREE.TorusKnotGeometry(0.45, 0.12, 128, 24),
    new THREE.MeshStandardMaterial({ color: "#c04a6a", roughness: 0.4 }),
  );
  knot.position.set(0.3, 0.35, 0.4);
  const lamp = new THREE.DirectionalLight("white", 3);
  lamp.position.copy(sun);
  const scene = new THREE.Scene().add(field, knot, lamp, new THREE.AmbientLight("white", 0.6));

  const draw = () => renderer.render(scene, camera);
  function setParams(values) {
    for (const [param, value] of Object.entries(values)) {
      // The clock sets `frame` even if the scene does not use it.
      if (param in uniforms) {
        uniforms[param].value = Array.isArray(value) ? new THREE.Vector4(...value) : value;
      }
    }
    requestAnimationFrame(draw);
  }
  sliders(reflection, document.querySelector("form"), setParams);
  clock(reflection, setParams);
  const controls = new OrbitControls(camera, canvas);
  controls.target.set(0, 0, 0.2);
  controls.update();
  controls.addEventListener("change", () => requestAnimationFrame(draw));
  draw();
  // To play with in the browser's console.
  window.page = { scene, camera, knot, draw };
}

main().then(
  () => (document.body.dataset.state = "drawn"),
  (error) => {
    document.body.dataset.state = "failed";
    document.querySelector("p").textContent = error.message;
  },
);
