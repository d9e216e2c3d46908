//! Ray methods and shading, one `.wgsl` file each, around stubs that codegen fills.
//!
//! A picture's shader is whole files joined: what all pictures share, one ray method, one way of
//! shading ([`source`]). Each file is valid WGSL beside those it names; none knows a scene. What a
//! scene supplies are functions with a body to be replaced, listed in [`stubs`]. What it needs of the
//! rest are [`Features`]: one override each, on which the files branch, so that a feature is written once,
//! whatever it is combined with. Whoever links the files takes one side of each branch and drops the other.
//!
//! ```
//! use sdfc_march::{Features, method, source};
//!
//! let sphere = method("sphere").expect("a method of the table");
//! let text = source(sphere, Features::default());
//! assert!(text.contains("fn trace(ray: Ray) -> Trace"));
//! for (name, _) in Features::default().overrides() {
//!     assert!(text.contains(&format!("override {name}: bool;")));
//! }
//! ```
//!
//! A ray method is `fn trace(ray: Ray) -> Trace` and `fn tolerance(ray: Ray, t: f32) -> f32`
//! (`ray.wgsl`), in a file of its own and a row of [`METHODS`]. It calls `field` at one place, in a
//! loop of at most `ray.steps` turns, and tells `passed` of each sample that it keeps; it takes a sign change for a hit, so that a field that leads
//! through a surface does not walk away from it.
//!
//! The blocks below are what `view.wgsl` and `pixel.wgsl` declare; their layout is WGSL's.

mod files;

pub use files::{
    Features, FieldSource, Form, Knob, METHODS, Method, SHADERTOY_HEAD, SHADERTOY_TAIL,
    UNCERTIFIED, method, prune_source, ray_source, source, source_over, stubs,
};

/// Linear colour of surfaces that nothing paints, `UNPAINTED` of `shade.wgsl`.
pub const UNPAINTED: [f32; 3] = [0.8; 3];

/// At most so many lights in one scene.
pub const MAX_LIGHTS: usize = 8;

/// A ray from the eye is mirrored at most so often.
pub const MAX_REFLECTIONS: u32 = 8;

/// Kind of a [`LightBlock`]: from infinitely far away.
pub const SUN: u32 = 0;
/// Kind of a [`LightBlock`]: from a point, in all directions.
pub const POINT: u32 = 1;
/// Kind of a [`LightBlock`]: from a point, in a cone.
pub const SPOT: u32 = 2;

/// Shadow of a [`LightBlock`]: none.
pub const SHADOW_OFF: u32 = 0;
/// Shadow of a [`LightBlock`]: hard.
pub const SHADOW_HARD: u32 = 1;
/// Shadow of a [`LightBlock`]: soft.
pub const SHADOW_SOFT: u32 = 2;

/// A light as the shader sees it: 64 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct LightBlock {
    /// Unit vector towards a sun; where any other light stands.
    pub place: [f32; 3],
    /// [`SUN`], [`POINT`] or [`SPOT`].
    pub kind: u32,
    /// Linear colour times strength; of a light at a point, at distance 1.
    pub color: [f32; 3],
    /// [`SHADOW_OFF`], [`SHADOW_HARD`] or [`SHADOW_SOFT`].
    pub shadow: u32,
    /// Unit vector along the middle of a spot light's cone.
    pub axis: [f32; 3],
    /// Of a soft shadow: its edge fades over the inverse of this.
    pub sharpness: f32,
    /// Cosines of angles from the axis: all light within the first, none outside the second.
    pub rim: [f32; 2],
    /// Unused.
    pub pad: [f32; 2],
}

/// Binding 0 of group 0: camera, tile, limits, lights. Lengths are in scene units.
///
/// The ray through the centre of pixel (x, y), y downwards, has direction `normalize(forward + aside)`, where `aside` is
/// `(2 (x + 0.5) / width - 1) * right - (2 (y + 0.5) / height - 1) * up`. Of parallel rays it starts at
/// `eye + aside`, and the picture is as large at any distance as it otherwise is at distance 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ViewBlock {
    /// Where rays start.
    pub eye: [f32; 3],
    /// Half the width of a pixel at distance 1; of parallel rays, everywhere.
    pub pixel_radius: f32,
    /// Half the width of the picture at distance 1, as a vector.
    pub right: [f32; 3],
    /// Rays end here.
    pub t_max: f32,
    /// Half the height of the picture at distance 1, as a vector.
    pub up: [f32; 3],
    /// A hit is nearer than this, absolute (`fixed`, `sphere`).
    pub epsilon: f32,
    /// Unit vector into the picture.
    pub forward: [f32; 3],
    /// At most so many steps a ray.
    pub steps: u32,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// First pixel of this tile.
    pub tile_origin: [u32; 2],
    /// Size of this tile in pixels; the output buffer holds `tile_size.x * tile_size.y` pixels, row by row.
    pub tile_size: [u32; 2],
    /// How many of `lights` are used.
    pub light_count: u32,
    /// A hit is nearer than this, in widths of a pixel there (all methods but `fixed` and `sphere`).
    pub tolerance: f32,
    /// Linear colour of light from everywhere.
    pub ambient: [f32; 3],
    /// How often a ray from the eye is mirrored.
    pub reflections: u32,
    /// Linear colour behind everything.
    pub background: [f32; 3],
    /// What is seen in a mirror counts by this factor, once more for each mirror.
    pub reflection_strength: f32,
    /// Linear colour of the sky straight up.
    pub zenith: [f32; 3],
    /// What is left of a surface's light after a length t is `exp(-fog_density * t)`.
    pub fog_density: f32,
    /// Linear colour of the sky at the horizon.
    pub horizon: [f32; 3],
    /// What is farther from a surface takes no light from it.
    pub occlusion_radius: f32,
    /// Linear colour that surfaces fade to.
    pub fog_color: [f32; 3],
    /// By what part light is taken, 0..1.
    pub occlusion_strength: f32,
    /// The lights.
    pub lights: [LightBlock; MAX_LIGHTS],
}

/// One pixel of binding 2 of group 0: 32 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PixelBlock {
    /// Linear red, green, blue; alpha 1.
    pub color: [f32; 4],
    /// Distance along the (unit) ray of the hit, or where the ray ended.
    pub depth: f32,
    /// 0 miss, 1 hit, 2 capped (ran out of steps).
    pub status: u32,
    /// Evaluations of the field for this pixel, shadows and reflections included.
    pub evaluations: u32,
    /// Evaluations of the field for the primary ray.
    pub primary_evaluations: u32,
}
