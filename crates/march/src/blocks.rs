//! The uniform and storage blocks that the shaders read and write.

/// Linear colour of surfaces without a material, `DEFAULT_COLOR` of `shade.wgsl`.
pub const DEFAULT_COLOR: [f32; 3] = [0.8; 3];

/// The largest number of lights in a scene.
pub const MAX_LIGHTS: usize = 8;

/// The largest number of times that a camera ray is reflected.
pub const MAX_REFLECTIONS: u32 = 8;

/// Kind of a [`LightBlock`]: a directional light, infinitely far away.
pub const SUN: u32 = 0;
/// Kind of a [`LightBlock`]: a point light.
pub const POINT: u32 = 1;
/// Kind of a [`LightBlock`]: a spot light.
pub const SPOT: u32 = 2;

/// Shadow of a [`LightBlock`]: none.
pub const SHADOW_OFF: u32 = 0;
/// Shadow of a [`LightBlock`]: hard.
pub const SHADOW_HARD: u32 = 1;
/// Shadow of a [`LightBlock`]: soft.
pub const SHADOW_SOFT: u32 = 2;

/// A light as the shader reads it: 64 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct LightBlock {
    /// The light's position; for a [`SUN`], the unit vector towards it.
    pub position: [f32; 3],
    /// [`SUN`], [`POINT`] or [`SPOT`].
    pub kind: u32,
    /// Linear colour times strength; for a light with a position, as received at distance 1.
    pub color: [f32; 3],
    /// [`SHADOW_OFF`], [`SHADOW_HARD`] or [`SHADOW_SOFT`].
    pub shadow: u32,
    /// Unit vector along the axis of a spot light's cone.
    pub axis: [f32; 3],
    /// Sharpness of a soft shadow: the angle over which its edge fades is the inverse of this.
    pub sharpness: f32,
    /// Cosines of two angles from a spot light's axis: full light within the first, none outside
    /// the second.
    pub rim: [f32; 2],
    /// Padding.
    pub pad: [f32; 2],
}

/// The uniform at binding 0 of group 0: camera, tile, limits and lights. Lengths are in scene
/// units.
///
/// The ray through the centre of pixel (x, y), y downwards, has the direction `normalize(forward +
/// aside)`, where `aside` is `(2 (x + 0.5) / width - 1) * right - (2 (y + 0.5) / height - 1) * up`.
/// Parallel rays start at `eye + aside` instead and have the direction `forward`; then `right` and
/// `up` are half the size of the picture at any distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ViewBlock {
    /// Origin of the camera rays.
    pub eye: [f32; 3],
    /// Half the width of a pixel at distance 1; for parallel rays, at any distance.
    pub pixel_radius: f32,
    /// Half the width of the picture at distance 1, as a vector.
    pub right: [f32; 3],
    /// Length of a ray: what lies farther away is not found.
    pub t_max: f32,
    /// Half the height of the picture at distance 1, as a vector.
    pub up: [f32; 3],
    /// Absolute distance from the surface below which a point is a hit (`fixed`, `sphere`).
    pub epsilon: f32,
    /// Unit vector into the picture.
    pub forward: [f32; 3],
    /// The largest number of steps of a ray.
    pub steps: u32,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// First pixel of this tile.
    pub tile_origin: [u32; 2],
    /// Size of this tile in pixels; the output buffer holds `tile_size.x * tile_size.y` pixels, row
    /// by row.
    pub tile_size: [u32; 2],
    /// The number of `lights` that are used.
    pub light_count: u32,
    /// Distance from the surface below which a point is a hit, as a multiple of the pixel's width
    /// there (all methods but `fixed` and `sphere`).
    pub tolerance: f32,
    /// Linear colour of the ambient light.
    pub ambient: [f32; 3],
    /// The number of times that a camera ray is reflected.
    pub reflections: u32,
    /// Linear colour of the background; under a sky, that of the ground.
    pub background: [f32; 3],
    /// Factor of the light from each reflection.
    pub reflection_strength: f32,
    /// Linear colour of the sky straight up.
    pub zenith: [f32; 3],
    /// Density of the fog: a fraction `exp(-fog_density * t)` of a surface's light is left after a
    /// length t.
    pub fog_density: f32,
    /// Linear colour of the sky at the horizon.
    pub horizon: [f32; 3],
    /// Distance up to which surfaces occlude ambient light.
    pub occlusion_radius: f32,
    /// Linear colour of the fog.
    pub fog_color: [f32; 3],
    /// Strength of the ambient occlusion, 0..1.
    pub occlusion_strength: f32,
    /// The lights.
    pub lights: [LightBlock; MAX_LIGHTS],
}

/// In [`PixelBlock::unproven`]: a ray of the pixel passed a stretch longer than the tolerance
/// without a proof that it is free. Only methods that prove what they pass set it.
pub const UNPROVEN: u16 = 1;

/// In [`PixelBlock::unproven`]: the driver ended loops of the pixel early, so that anything may be
/// missing.
pub const LOOPS_ENDED: u16 = 2;

/// One pixel of the storage buffer at binding 2 of group 0: 32 bytes. In the shader `status` and
/// `unproven` are the lower and the upper half of one word.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PixelBlock {
    /// Linear red, green and blue; alpha is 1.
    pub color: [f32; 4],
    /// Distance along the (unit) ray to the hit, or to where the ray ended.
    pub depth: f32,
    /// 0 miss, 1 hit, 2 capped (ran out of steps).
    pub status: u16,
    /// [`UNPROVEN`] and [`LOOPS_ENDED`], or 0.
    pub unproven: u16,
    /// Evaluations of the field for this pixel, those of shadow rays and reflections included.
    pub evaluations: u32,
    /// Evaluations of the field for the camera ray.
    pub primary_evaluations: u32,
}
