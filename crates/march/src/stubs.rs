//! Names of the functions that a scene supplies, and of those that a host calls.
//!
//! A *stub* is a function of the WGSL files whose body the linker replaces by the scene's.

/// `fn field(p: vec3f) -> f32`, the signed distance.
pub const FIELD: &str = "field";
/// `fn field_estimate(p: vec3f) -> f32`, what the distance is likely to be. Called if
/// [`Features::estimated`](crate::Features::estimated) is set.
pub const ESTIMATE: &str = "field_estimate";
/// `fn field_gradient(p: vec3f) -> vec3f`, the spatial derivative of the distance. A method with a
/// gradient of its own does not have this stub.
pub const GRADIENT: &str = "field_gradient";
/// `fn analytic_hit(origin: vec3f, direction: vec3f) -> f32`: where a ray first enters the analytic
/// part of the scene. Called if [`Features::analytic`](crate::Features::analytic) is set.
pub const ANALYTIC_HIT: &str = "analytic_hit";
/// `fn analytic_distance(p: vec3f) -> f32`, the distance to the analytic part of the scene.
pub const ANALYTIC_DISTANCE: &str = "analytic_distance";
/// `fn marched_distance(p: vec3f) -> f32`, the distance to the marched part of the scene.
pub const MARCHED_DISTANCE: &str = "marched_distance";
/// `fn clip_interval(origin: vec3f, direction: vec3f) -> vec2f`: where a ray enters and leaves a
/// box around the marched part. Called if [`Features::clipped`](crate::Features::clipped) is set.
pub const CLIP_INTERVAL: &str = "clip_interval";
/// `fn intersect_copies(origin: vec3f, direction: vec3f) -> vec2f`: where a ray first enters a copy
/// that is sampled at its origin, and the distance from there within which nothing else is marched.
/// Called if [`Features::copies`](crate::Features::copies) is set.
pub const COPIES: &str = "intersect_copies";
/// `fn field_range(a: vec3f, b: vec3f) -> vec2f`, bounds of the distance to the marched part of the
/// scene on the segment from a to b. Called if [`Features::proved`](crate::Features::proved) is
/// set and [`Features::marches`](crate::Features::marches) returns true.
pub const RANGE: &str = "field_range";
/// `fn field_slope_range(a: vec3f, b: vec3f, direction: vec3f) -> vec2f`, bounds of the slope of
/// `field` on the segment from a to b, where `direction` is the unit vector from a to b.
pub const SLOPE_RANGE: &str = "field_slope_range";
/// `fn material(p: vec3f) -> Material`. Called if
/// [`Features::materials`](crate::Features::materials) is set.
pub const MATERIAL: &str = "material";
/// `fn seen_material(p: vec3f, normal: vec3f, toward_eye: vec3f) -> Material`. Called in place of
/// [`MATERIAL`] if [`Features::seen_materials`](crate::Features::seen_materials) is set.
pub const SEEN_MATERIAL: &str = "seen_material";
/// `fn radiance(direction: vec3f, roughness: vec3f) -> vec3f`: the light of the surroundings that a
/// mirror of some roughness receives. Called if
/// [`Features::environment`](crate::Features::environment) is set.
pub const RADIANCE: &str = "radiance";
/// `fn irradiance(normal: vec3f) -> vec3f`: the light of the surroundings that a matt white surface
/// reflects. Called as [`RADIANCE`].
pub const IRRADIANCE: &str = "irradiance";
/// `fn planar_pixel(p: vec2f, size: vec2f) -> vec4f`: the linear colour of a pixel with the middle
/// p, and the field there. Called in place of all others if
/// [`Features::planar`](crate::Features::planar) is set.
pub const PLANAR_PIXEL: &str = "planar_pixel";
/// `fn exposure() -> f32`, the factor of all light. Called if
/// [`Features::exposure`](crate::Features::exposure) is set.
pub const EXPOSURE: &str = "exposure";
/// `fn load_frame()`, which loads or computes the per-frame values. Its calls are dropped if there
/// are none.
pub const LOAD_FRAME: &str = "load_frame";
/// `fn trace(ray: Ray) -> Trace`, which a method supplies and a host may call.
pub const TRACE: &str = "trace";
/// `fn intersect(origin: vec3f, direction: vec3f, t_min: f32, t_max: f32) -> Trace`, which a host
/// may call.
pub const INTERSECT: &str = "intersect";
/// `var<private> view: View` of [`Form::Shadertoy`](crate::Form::Shadertoy).
pub const VIEW: &str = "view";
/// `fn load_view()`, which sets the parts of the view that do not follow from the camera.
pub const LOAD_VIEW: &str = "load_view";
/// `fn camera() -> Camera`.
pub const CAMERA: &str = "camera";
/// `fn load_time(now: f32)`. Its calls are dropped if nothing depends on the time.
pub const LOAD_TIME: &str = "load_time";
/// `fn load_count(count: f32)`. Its calls are dropped if nothing depends on the frame number.
pub const LOAD_COUNT: &str = "load_count";
/// `fn load_headlight()`. Its calls are dropped if the scene has lights of its own.
pub const LOAD_HEADLIGHT: &str = "load_headlight";
/// `fn image(...) -> vec4f` of [`Form::Shadertoy`](crate::Form::Shadertoy), which the GLSL entry
/// point calls.
pub const IMAGE: &str = "image";
/// `fn record_sample(ray: Ray, t: f32, distance: f32)`, which methods call for each sample of a
/// ray. No scene supplies it; its calls are dropped if no shadow is soft.
pub const RECORD_SAMPLE: &str = "record_sample";
/// `fn record_slope(square: f32)`, which takes the squared length of each gradient. No scene
/// supplies it; its calls are dropped if there is neither ambient occlusion nor a soft shadow.
pub const RECORD_SLOPE: &str = "record_slope";
/// `fn record_gap()`, which methods call for each stretch of a ray that they pass without a proof
/// that it is free. No scene supplies it; its calls are dropped if pixels do not tell
/// ([`Features::records_gaps`](crate::Features::records_gaps)).
pub const RECORD_GAP: &str = "record_gap";
/// `fn limit_loops(is_drawn: bool)`, which entry points call. No scene supplies it; its calls are
/// dropped if the scene has no loops.
pub const LIMIT_LOOPS: &str = "limit_loops";
/// `var<private> loop_limit: f32`, a limit on iterations that no loop reaches.
pub const LOOP_LIMIT: &str = "loop_limit";
/// `fn culling_bounds_0(iteration: f32, p: vec3f) -> vec3f` and so on, one for each loop that can
/// be culled, of [`culling_source`](crate::culling_source). `x`: lower bound on the distance to
/// where the iteration can affect a ray. `y`: the iteration's operand minus the blend radius. `z`:
/// the operand.
pub const CULLING_BOUNDS: [&str; 8] = [
    "culling_bounds_0",
    "culling_bounds_1",
    "culling_bounds_2",
    "culling_bounds_3",
    "culling_bounds_4",
    "culling_bounds_5",
    "culling_bounds_6",
    "culling_bounds_7",
];
/// `var<storage, read> active_lists`, the lists of iterations to run.
pub const ACTIVE_LISTS: &str = "active_lists";
/// `var<private> iterations_run: u32`, which counts the iterations that were run, if
/// [`Features::instrumented`](crate::Features::instrumented) is set.
pub const ITERATIONS_RUN: &str = "iterations_run";
/// `var<private> active_spans: array<vec2u, 8>`: for each loop, how many iterations to run and the
/// index of the first one's number in `active_lists`.
pub const ACTIVE_SPANS: &str = "active_spans";
/// `fn select_lists(p: vec3f)`, which sets `active_spans` for a point.
pub const SELECT_LISTS: &str = "select_lists";
/// `var<private> inactive_distance: f32`, a lower bound on the distance to what the lists leave
/// out.
pub const INACTIVE_DISTANCE: &str = "inactive_distance";
