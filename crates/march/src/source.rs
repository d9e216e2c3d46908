//! Which WGSL files make up a shader.

use crate::features::Features;
use crate::methods::MethodDefinition;

/// The source of a picture's distance and gradient.
///
/// Benchmarks compare pictures that differ in this alone: all but [`FieldSource::Scene`] take the
/// gradient by the same four evaluations of the field. A method's own gradient replaces any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FieldSource {
    /// The scene supplies both.
    #[default]
    Scene,
    /// The scene supplies the distance.
    Distance,
    /// An interpreter of operations on two primitives each, from buffers at bindings 3 to 6.
    Units,
    /// A stack machine, from a buffer at binding 3.
    Tape,
}

impl FieldSource {
    /// The files of `field` and of `field_gradient`.
    fn files(self) -> [&'static str; 2] {
        const SCENE: &str = include_str!("wgsl/field.wgsl");
        const DERIVATIVE: &str = include_str!("wgsl/gradient.wgsl");
        const DIFFERENCES: &str = include_str!("wgsl/baseline/differences.wgsl");
        match self {
            Self::Scene => [SCENE, DERIVATIVE],
            Self::Distance => [SCENE, DIFFERENCES],
            Self::Units => [include_str!("wgsl/baseline/op_units.wgsl"), DIFFERENCES],
            Self::Tape => [include_str!("wgsl/baseline/tape.wgsl"), DIFFERENCES],
        }
    }
}

/// The form of a picture's shader: its stages and what it writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Form {
    /// A compute stage, one invocation for each pixel of a tile, that writes a buffer.
    #[default]
    Compute,
    /// As [`Form::Compute`], but pixels hold the position and the normal of the hit in place of a
    /// colour, and only camera rays are traced.
    Normals,
    /// A full-screen triangle and a fragment stage; the target's first row is the topmost.
    Fragment,
    /// As [`Form::Fragment`]; the target's first row is the lowest.
    FragmentUp,
    /// A function of the pixel's position, the picture's size, the mouse and the clock, without
    /// buffers.
    Shadertoy,
}

impl Form {
    /// The files of a picture that rays draw.
    fn files(self) -> &'static [&'static str] {
        const PICTURE: &str = include_str!("wgsl/picture.wgsl");
        const BUFFER: &str = include_str!("wgsl/view_buffer.wgsl");
        const COMPUTE: &str = include_str!("wgsl/compute.wgsl");
        const FRAGMENT: &str = include_str!("wgsl/fragment.wgsl");
        match self {
            Self::Compute => &[PICTURE, BUFFER, COMPUTE],
            Self::Normals => &[include_str!("wgsl/normals.wgsl"), BUFFER, COMPUTE],
            Self::Fragment => &[PICTURE, BUFFER, include_str!("wgsl/rows_down.wgsl"), FRAGMENT],
            Self::FragmentUp => &[PICTURE, BUFFER, include_str!("wgsl/rows_up.wgsl"), FRAGMENT],
            Self::Shadertoy => &[PICTURE, SRGB, include_str!("wgsl/shadertoy.wgsl")],
        }
    }

    /// The files of a planar picture. It has no normals.
    fn planar_files(self) -> &'static [&'static str] {
        const PICTURE: &str = include_str!("wgsl/planar.wgsl");
        const BUFFER: &str = include_str!("wgsl/view_buffer.wgsl");
        const COMPUTE: &str = include_str!("wgsl/compute.wgsl");
        const FRAGMENT: &str = include_str!("wgsl/fragment.wgsl");
        match self {
            Self::Compute | Self::Normals => &[PICTURE, BUFFER, COMPUTE],
            Self::Fragment => &[PICTURE, BUFFER, include_str!("wgsl/rows_down.wgsl"), FRAGMENT],
            Self::FragmentUp => &[PICTURE, BUFFER, include_str!("wgsl/rows_up.wgsl"), FRAGMENT],
            Self::Shadertoy => &[PICTURE, SRGB, include_str!("wgsl/planar_shadertoy.wgsl")],
        }
    }
}

/// Returns the source of a picture's shader, whole files joined. Branches on `features.wgsl` still
/// have both sides.
pub fn source(method: &MethodDefinition, features: Features) -> String {
    source_with(FieldSource::Scene, Form::Compute, method, features)
}

/// Returns the same as [`source`] with another source of the field, or in another form.
pub fn source_with(
    field: FieldSource,
    form: Form,
    method: &MethodDefinition,
    features: Features,
) -> String {
    let [field, gradient] = field.files();
    let shade = if features.materials {
        include_str!("wgsl/shade_material.wgsl")
    } else {
        include_str!("wgsl/shade_default.wgsl")
    };
    let mut files = vec![
        include_str!("wgsl/features.wgsl"),
        include_str!("wgsl/view.wgsl"),
        ACTIVE_LAYOUT,
        include_str!("wgsl/read_cells.wgsl"),
        include_str!("wgsl/active_lists.wgsl"),
        field,
        method.gradient.unwrap_or(gradient),
        include_str!("wgsl/frame.wgsl"),
        include_str!("wgsl/loops.wgsl"),
        RANGES,
        RAY,
        BRACKET,
        PENUMBRA,
        SAMPLING,
    ];
    files.extend(method.files());
    files.extend([
        include_str!("wgsl/light.wgsl"),
        include_str!("wgsl/occlusion.wgsl"),
        include_str!("wgsl/shade.wgsl"),
        shade,
        include_str!("wgsl/secondary.wgsl"),
        include_str!("wgsl/background.wgsl"),
        include_str!("wgsl/tone.wgsl"),
        PIXEL_LAYOUT,
        include_str!("wgsl/pixel.wgsl"),
    ]);
    files.extend(if features.planar { form.planar_files() } else { form.files() });
    files.join("\n")
}

/// Returns the source of a ray method alone, for a shader of the embedder's. Its entry point is
/// there only to keep `trace` and `intersect`.
pub fn ray_source(method: &MethodDefinition) -> String {
    let [field, gradient] = FieldSource::Scene.files();
    let features = include_str!("wgsl/features.wgsl");
    let gradient = method.gradient.unwrap_or(gradient);
    let mut files = vec![features, field, gradient, RANGES, RAY, BRACKET, PENUMBRA, SAMPLING];
    files.extend(method.files());
    files.extend([include_str!("wgsl/intersect.wgsl"), include_str!("wgsl/anchor.wgsl")]);
    files.join("\n")
}

/// Returns the source of the shader that runs before a picture with [`Features::culled`]. Its entry
/// points are `mark` and `list` for tiles; `mark_groups` and `list_cells` for cells.
pub fn culling_source() -> String {
    let files = [
        include_str!("wgsl/features.wgsl"),
        include_str!("wgsl/view.wgsl"),
        ACTIVE_LAYOUT,
        include_str!("wgsl/frame.wgsl"),
        RAY,
        include_str!("wgsl/view_buffer.wgsl"),
        include_str!("wgsl/culling.wgsl"),
        include_str!("wgsl/read_cells.wgsl"),
        include_str!("wgsl/culling_cells.wgsl"),
    ];
    files.join("\n")
}

/// Returns the source of the shader that writes pixels into a texture that a window shows. Its
/// entry point is `main`, one invocation for each pixel of a tile.
pub fn display_source() -> String {
    [PIXEL_LAYOUT, SRGB, include_str!("wgsl/display.wgsl")].join("\n")
}

const ACTIVE_LAYOUT: &str = include_str!("wgsl/active_layout.wgsl");
const PIXEL_LAYOUT: &str = include_str!("wgsl/pixel_layout.wgsl");
const SRGB: &str = include_str!("wgsl/srgb.wgsl");
const RANGES: &str = include_str!("wgsl/ranges.wgsl");
const RAY: &str = include_str!("wgsl/ray.wgsl");
const BRACKET: &str = include_str!("wgsl/bracket.wgsl");
const PENUMBRA: &str = include_str!("wgsl/penumbra.wgsl");
const SAMPLING: &str = include_str!("wgsl/sampling.wgsl");

/// The GLSL that precedes the functions of [`Form::Shadertoy`] on shadertoy.com.
pub const SHADERTOY_HEAD: &str = include_str!("shadertoy/head.glsl");
/// The GLSL that follows them: the entry point.
pub const SHADERTOY_TAIL: &str = include_str!("shadertoy/tail.glsl");
