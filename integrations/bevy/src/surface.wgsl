// Draws a scene inside its box: the part of the fragment shader that does not depend on the scene.
// The scene's functions, with the prefix `sdfc_`, follow it.
//
// Modules are imported under names with a prefix, because the preprocessor replaces an imported
// name wherever it appears, and scenes have names of their own.

#import bevy_pbr::mesh_functions as sdfc_mesh_functions
#import bevy_pbr::mesh_bindings as sdfc_mesh_bindings
#import bevy_pbr::mesh_view_bindings as sdfc_view_bindings

#ifdef PREPASS_PIPELINE
#import bevy_pbr::prepass_io as sdfc_io
#ifdef MOTION_VECTOR_PREPASS
#import bevy_pbr::prepass_bindings as sdfc_prepass_bindings
#endif
#else
#import bevy_pbr::forward_io as sdfc_io
#import bevy_pbr::pbr_functions as sdfc_pbr_functions
#import bevy_pbr::pbr_types as sdfc_pbr_types
#endif

// What the entity states. `SurfaceBlock` in `material.rs` writes it.
struct SurfaceBlock {
    // The corners of the box that holds the surface, in the scene's coordinates.
    low: vec4<f32>,
    high: vec4<f32>,
    // Linear colour of parts without a material.
    color: vec4<f32>,
    // Of scenes without materials. Reflectance is of all.
    roughness: f32,
    metallic: f32,
    reflectance: f32,
    unused: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> surface_block: SurfaceBlock;

struct SurfaceHit {
    // In the scene's coordinates.
    point: vec3<f32>,
    world: vec4<f32>,
    depth: f32,
}

// The step budget of a ray.
const SURFACE_STEPS: u32 = 256u;
// Rays stop when they are nearer to the surface than this part of a pixel.
const SURFACE_TOLERANCE: f32 = 0.25;
// Accuracy of the methods `sphere` and `fixed`, as a fraction of the size of the box.
const SURFACE_EPSILON: f32 = 0.0001;
// Roughness below this makes highlights smaller than a pixel.
const SURFACE_MIN_ROUGHNESS: f32 = 0.089;

// Marches the ray through a point on the box, from the eye or from the light. Discards the fragment
// if it misses the surface.
fn surface_march(on_box: vec3<f32>, instance: u32) -> SurfaceHit {
    let clip_from_world = sdfc_view_bindings::view.clip_from_world;
    let is_parallel = sdfc_view_bindings::view.clip_from_view[3].w == 1.0;
    var eye = sdfc_view_bindings::view.world_position;
    var toward = on_box - eye;
    if is_parallel {
        eye = on_box;
        toward = -sdfc_view_bindings::view.world_from_view[2].xyz;
    }
    toward = normalize(toward);

    // Lengths along the ray are `stretch` times as long in the scene's coordinates.
    let local_from_world = sdfc_mesh_functions::get_local_from_world(instance);
    let origin = (local_from_world * vec4<f32>(eye, 1.0)).xyz;
    let scaled = (local_from_world * vec4<f32>(toward, 0.0)).xyz;
    let stretch = length(scaled);
    let direction = scaled / stretch;

    // The interval of the ray inside the box. A component of 0 is replaced by one that is almost 0,
    // so that no quotient is 0 / 0.
    let step_sign = select(vec3<f32>(-1.0), vec3<f32>(1.0), direction >= vec3<f32>(0.0));
    let divisor = step_sign * max(abs(direction), vec3<f32>(1e-12));
    let to_low = (surface_block.low.xyz - origin) / divisor;
    let to_high = (surface_block.high.xyz - origin) / divisor;
    let enters = min(to_low, to_high);
    let leaves = max(to_low, to_high);
    var start = max(max(enters.x, enters.y), enters.z);
    let end = min(min(leaves.x, leaves.y), leaves.z);

    // Views of directional lights have no near plane: what is in front of it casts a shadow too.
#ifndef SDFC_UNCLIPPED
    let clip_origin = clip_from_world * vec4<f32>(eye, 1.0);
    let clip_toward = clip_from_world * vec4<f32>(toward, 0.0);
    let near = (clip_origin.w - clip_origin.z) / (clip_toward.z - clip_toward.w);
    start = max(start, near * stretch);
#endif
    if !(start < end) {
        discard;
    }

    // Half the width of a pixel, at distance 1 if rays spread.
    let half_pixel = 1.0 / (abs(sdfc_view_bindings::view.clip_from_view[1].y)
        * sdfc_view_bindings::view.viewport.w);
    let spread = select(half_pixel, 0.0, is_parallel);
    let radius = select(half_pixel * start, half_pixel * stretch, is_parallel);
    let size = length(surface_block.high.xyz - surface_block.low.xyz);
    let found = sdfc_trace(sdfc_Ray(
        origin + start * direction,
        radius,
        direction,
        spread,
        end - start,
        SURFACE_EPSILON * size,
        SURFACE_TOLERANCE,
        SURFACE_STEPS,
    ));
    if found.status != sdfc_HIT {
        discard;
    }

    var hit: SurfaceHit;
    hit.point = origin + (start + found.t) * direction;
    let world_from_local = sdfc_mesh_functions::get_world_from_local(instance);
    hit.world = world_from_local * vec4<f32>(hit.point, 1.0);
    let clip = clip_from_world * hit.world;
    hit.depth = clip.z / clip.w;
#ifndef SDFC_UNCLIPPED
    // Behind the far plane.
    if hit.depth < 0.0 {
        discard;
    }
#endif
    hit.depth = clamp(hit.depth, 0.0, 1.0);
    return hit;
}

// The unit normal in world coordinates.
fn surface_normal(point: vec3<f32>, instance: u32) -> vec3<f32> {
    return sdfc_mesh_functions::mesh_normal_local_to_world(sdfc_gradient(point).xyz, instance);
}

#ifdef PREPASS_PIPELINE

struct SurfaceOutput {
#ifdef NORMAL_PREPASS
    @location(0) normal: vec4<f32>,
#endif
#ifdef MOTION_VECTOR_PREPASS
    @location(1) motion_vector: vec2<f32>,
#endif
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: sdfc_io::VertexOutput) -> SurfaceOutput {
    let hit = surface_march(in.world_position.xyz, in.instance_index);
    var out: SurfaceOutput;
    out.depth = hit.depth;
#ifdef NORMAL_PREPASS
    out.normal = vec4<f32>(surface_normal(hit.point, in.instance_index) * 0.5 + 0.5, 1.0);
#endif
#ifdef MOTION_VECTOR_PREPASS
    // The motion of the entity and the camera. That of a scene that moves in itself is unknown.
    let previous_world_from_local =
        sdfc_mesh_functions::get_previous_world_from_local(in.instance_index);
    let now = sdfc_view_bindings::view.unjittered_clip_from_world * hit.world;
    let before = sdfc_prepass_bindings::previous_view_uniforms.clip_from_world
        * (previous_world_from_local * vec4<f32>(hit.point, 1.0));
    out.motion_vector = (now.xy / now.w - before.xy / before.w) * vec2<f32>(0.5, -0.5);
#endif
    return out;
}

#else

struct SurfaceOutput {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: sdfc_io::VertexOutput) -> SurfaceOutput {
    let hit = surface_march(in.world_position.xyz, in.instance_index);
    let normal = surface_normal(hit.point, in.instance_index);

    var pbr = sdfc_pbr_types::pbr_input_new();
    pbr.flags = sdfc_mesh_bindings::mesh[in.instance_index].flags;
    pbr.is_orthographic = sdfc_view_bindings::view.clip_from_view[3].w == 1.0;
    pbr.V = sdfc_pbr_functions::calculate_view(hit.world, pbr.is_orthographic);
    pbr.frag_coord = vec4<f32>(in.position.xy, hit.depth, in.position.w);
    pbr.world_position = hit.world;
    pbr.world_normal = normal;
    pbr.N = normal;
    pbr.material.flags |= sdfc_pbr_types::STANDARD_MATERIAL_FLAGS_FOG_ENABLED_BIT;
    pbr.material.base_color = surface_block.color;
    pbr.material.perceptual_roughness = surface_block.roughness;
    pbr.material.metallic = surface_block.metallic;
    pbr.material.reflectance = vec3<f32>(surface_block.reflectance);
    // An emission of 1 is white, whatever the exposure of the camera.
    var emission = vec3<f32>(0.0);
    var lit = 1.0;
#ifdef SDFC_MATERIAL
    let material = sdfc_material(hit.point);
    let color = mix(surface_block.color.rgb, material.color, material.coverage);
    pbr.material.base_color = vec4<f32>(color, 1.0);
    pbr.material.perceptual_roughness = clamp(material.roughness, SURFACE_MIN_ROUGHNESS, 1.0);
    pbr.material.metallic = material.metallic;
    pbr.diffuse_occlusion = vec3<f32>(max(material.occlusion, 0.0));
    pbr.specular_occlusion = max(material.occlusion, 0.0);
    emission = material.emission;
    // An occlusion of -1 keeps direct light away too.
    lit = clamp(1.0 + material.occlusion, 0.0, 1.0);
#endif
    var color_out = sdfc_pbr_functions::apply_pbr_lighting(pbr);
    color_out = vec4<f32>(lit * color_out.rgb + emission, 1.0);

    var out: SurfaceOutput;
    out.color = sdfc_pbr_functions::main_pass_post_lighting_processing(pbr, color_out);
    out.depth = hit.depth;
    return out;
}

#endif
