//! Ray methods and shading of sdfc, as WGSL files with stubs that `sdfc-codegen` replaces.
//!
//! A picture's shader is made of whole files, joined: the files that all pictures share, one ray
//! method, and one way of shading ([`source`]). No file knows a scene. The functions that a scene
//! supplies are stubs, listed in [`stubs`], whose bodies the linker replaces. The optional parts
//! that a scene needs are [`Features`], one WGSL override each, on which the files branch; so a
//! feature is written once, whatever it is combined with. The linker takes one side of each branch
//! and drops the other.
//!
//! ```
//! use sdfc_march::{Features, Method, source};
//!
//! let text = source(Method::Sphere.definition(), Features::default());
//! assert!(text.contains("fn trace(ray: Ray) -> Trace"));
//! for (name, _) in Features::default().overrides() {
//!     assert!(text.contains(&format!("override {name}: bool;")));
//! }
//! ```
//!
//! A ray method is a file with `fn trace(ray: Ray) -> Trace` and `fn tolerance(ray: Ray, t: f32) ->
//! f32` (see `ray.wgsl`), a variant of [`Method`] and a row of [`METHODS`]. The file calls `field`
//! in one place, in a loop of at most `ray.steps` iterations, and passes each sample that it keeps
//! to `record_sample`. A change of sign counts as a hit, so that a ray that has passed through a
//! surface does not walk away from it.
//!
//! The blocks ([`ViewBlock`], [`PixelBlock`]) match what `view.wgsl` and `pixel_layout.wgsl` state;
//! their layout is that of WGSL.

mod blocks;
mod features;
mod methods;
mod source;
pub mod stubs;

pub use blocks::{
    DEFAULT_COLOR, LOOPS_ENDED, LightBlock, MAX_LIGHTS, MAX_REFLECTIONS, POINT, PixelBlock,
    SHADOW_HARD, SHADOW_OFF, SHADOW_SOFT, SPOT, SUN, UNPROVEN, ViewBlock,
};
pub use features::Features;
pub use methods::{Audience, METHODS, Method, MethodDefinition, MethodParameter, UnknownMethod};
pub use source::{
    FieldSource, Form, SHADERTOY_HEAD, SHADERTOY_TAIL, culling_source, display_source, ray_source,
    source, source_with,
};
