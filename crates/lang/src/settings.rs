//! The settings of a scene (camera, lights, background, ...), their parameters and documentation.

use sdfc_graph::Tone;

use crate::hir::{SettingKind, Type};

/// The ray methods that `march(method: ...)` can name, the default first. These are the methods of
/// `sdfc-march`, except those that exist only for comparison.
pub const RAY_METHODS: [&str; 5] = ["auto", "fixed", "sphere", "segment", "interval"];

/// The tone curves that `exposure(tone: ...)` can name, the default first.
pub const TONES: [(&str, Tone); 3] =
    [("neutral", Tone::Neutral), ("film", Tone::Film), ("clip", Tone::Clip)];

/// One parameter of a setting.
#[derive(Clone, Debug)]
pub struct SettingParameter {
    /// Its name.
    pub name: &'static str,
    /// Its type.
    pub ty: Type,
    /// True if it can be omitted.
    pub optional: bool,
    /// Its meaning, unit and default.
    pub about: &'static str,
}

/// One setting.
#[derive(Clone, Debug)]
pub struct SettingRow {
    /// The kind of setting.
    pub kind: SettingKind,
    /// Its name in the language.
    pub name: &'static str,
    /// True if a scene can contain it only once.
    pub once: bool,
    /// Its effect, in a sentence or two.
    pub summary: &'static str,
    /// A line of a scene that uses it.
    pub example: &'static str,
    /// Its parameters in order; `hir::Setting::args` has one element for each.
    pub parameters: Vec<SettingParameter>,
}

/// All settings.
pub fn table() -> Vec<SettingRow> {
    use SettingKind as Kind;
    use Type::{Angle, Color, Int, Number, Shadow, Text};
    let vec3 = Type::Vec(3);
    let position = ("position", vec3.clone(), false, "position, in scene units");
    let color = ("color", Color, true, "colour; default white");
    let strength = ("strength", Number, true, "factor of the colour; default 1");
    let brightness = (
        "strength",
        Number,
        true,
        "factor of the colour at distance 1; it falls with the square of the distance; default 1",
    );
    let shadow = (
        "shadow",
        Shadow,
        true,
        "`hard`, or `soft(k)`, whose penumbra is (distance from the occluder) / k wide: a smaller k gives a softer shadow; default no shadow",
    );
    vec![
        row(
            (Kind::Camera, "camera", ONCE),
            "The camera. Without this setting the view is fitted to the scene. A planar picture \
             takes its middle from `target` and needs `height`.",
            "camera(eye: [4, 3, 5], target: [0, 0.5, 0], fov: 35deg)",
            &[
                ("eye", vec3.clone(), false, "position of the camera, in scene units"),
                ("target", vec3.clone(), true, "the point that it looks at; default the origin"),
                ("up", vec3.clone(), true, "direction that is up in the image; default y"),
                ("fov", Angle, true, "vertical field of view; default 40deg"),
                (
                    "height",
                    Number,
                    true,
                    "height of the view in scene units, for a parallel projection, instead of `fov`",
                ),
            ],
        ),
        row(
            (Kind::Ambient, "ambient", ONCE),
            "Light that comes equally from all directions. Without it, surfaces that no light reaches are black.",
            "ambient(#dfe9ff, 0.3)",
            &[color.clone(), ("strength", Number, true, "factor of the colour; default 0.2")],
        ),
        row(
            (Kind::Sky, "sky", ONCE),
            "A sky behind the scene, also seen in reflections: a gradient from the horizon's colour to the \
             zenith's, and below to the ground's. It does not light the scene; use `ambient` for that. \
             `sky(image: \"studio.hdr\")` is a picture of the surroundings instead, in place of the \
             gradient. It lights the scene, too: materials mirror it, the rougher the more blurred, and \
             it is the ambient light unless the scene has `ambient`. Its light casts no shadows.",
            "sky(zenith: #4477bb, horizon: #dde8f0)",
            &[
                ("zenith", Color, true, "colour straight up; default #4477bb"),
                ("horizon", Color, true, "colour at the horizon; default #dde8f0"),
                ("ground", Color, true, "colour straight down; default the horizon's colour"),
                (
                    "image",
                    Text,
                    true,
                    "a Radiance picture (.hdr) of all directions, twice as wide as high, beside the scene; its middle is in the direction -z",
                ),
                (
                    "turn",
                    Angle,
                    true,
                    "angle by which the picture is turned about y, towards x from z; default 0deg",
                ),
                ("strength", Number, true, "factor of the picture's light; default 1"),
            ],
        ),
        row(
            (Kind::Fog, "fog", ONCE),
            "Fog: a surface at distance t keeps the fraction exp(-density * t) of its colour.",
            "fog(density: 0.05)",
            &[
                ("density", Number, true, "density per scene unit; default 0.05"),
                (
                    "color",
                    Color,
                    true,
                    "colour of the fog; default the sky or background behind the surface",
                ),
            ],
        ),
        row(
            (Kind::Background, "background", ONCE),
            "The colour of rays that hit nothing.",
            "background(#1b1e26)",
            &[("color", Color, false, "the colour")],
        ),
        row(
            (Kind::AmbientOcclusion, "ambient_occlusion", ONCE),
            "Ambient occlusion: darkens corners that little ambient light reaches.",
            "ambient_occlusion(radius: 0.3)",
            &[
                (
                    "radius",
                    Number,
                    true,
                    "distance within which surfaces occlude, in scene units; default a twelfth of the height of the view at the camera's target",
                ),
                ("strength", Number, true, "from 0 (no effect) to 1 (full effect); default 1"),
            ],
        ),
        row(
            (Kind::Reflections, "reflections", ONCE),
            "Reflections: surfaces mirror the scene and the sky or background, metals and smooth surfaces more, and every surface more at grazing angles. Without this setting, materials mirror the sky alone.",
            "reflections(count: 2)",
            &[
                (
                    "count",
                    Int,
                    true,
                    "number of reflections that a ray follows, at most 8; default 1",
                ),
                ("strength", Number, true, "factor of each reflection, from 0 to 1; default 1"),
            ],
        ),
        row(
            (Kind::Exposure, "exposure", ONCE),
            "Exposure and the tone curve, which turns bright light into colours that a picture can show.",
            "exposure(stops: 0.5)",
            &[
                ("stops", Number, true, "each stop doubles all light; default 0"),
                (
                    "tone",
                    Text,
                    true,
                    "\"neutral\" keeps colours up to 0.8 and compresses brighter ones, \"film\" adds contrast, \"clip\" cuts off at white; default \"neutral\"",
                ),
            ],
        ),
        row(
            (Kind::Antialias, "antialias", ONCE),
            "Antialiasing: averages several rays per pixel. The command line option `--samples` overrides it.",
            "antialias(samples: 4)",
            &[("samples", Int, true, "number of rays per pixel, at most 1024; default 4")],
        ),
        row(
            (Kind::Isolines, "isolines", ONCE),
            "Isolines of a planar picture: lines where the distance is a multiple of the spacing, and a \
             wider one where it is 0. The command line option `--isolines` overrides it.",
            "isolines(spacing: 0.1)",
            &[("spacing", Number, false, "distance between two lines, in scene units")],
        ),
        row(
            (Kind::March, "march", ONCE),
            "Overrides how rays find surfaces. Without this setting the compiler chooses.",
            "march(method: \"sphere\", steps: 200, epsilon: 0.001)",
            &[
                ("steps", Int, true, "largest number of steps per ray; default 256"),
                (
                    "epsilon",
                    Number,
                    true,
                    "for `fixed` and `sphere`: distance to the surface that counts as a hit, in scene units",
                ),
                ("distance", Number, true, "length of the rays, in scene units"),
                ("method", Text, true, "the ray method; default \"auto\""),
                (
                    "tolerance",
                    Number,
                    true,
                    "for all other methods: distance to the surface that counts as a hit, in pixel widths at the hit; default 0.25",
                ),
            ],
        ),
        row(
            (Kind::Sun, "sun", false),
            "A distant light: its direction and brightness are the same everywhere.",
            "sun(direction: [1, 2, 1], shadow: hard)",
            &[
                (
                    "direction",
                    vec3.clone(),
                    true,
                    "direction towards the light, of any length but 0; default [1, 2, 1]",
                ),
                color.clone(),
                strength.clone(),
                shadow.clone(),
            ],
        ),
        row(
            (Kind::PointLight, "point_light", false),
            "A light at a point that shines in all directions.",
            "point_light(position: [0, 3, 0], strength: 5)",
            &[position.clone(), color.clone(), brightness.clone(), shadow.clone()],
        ),
        row(
            (Kind::SpotLight, "spot_light", false),
            "A light at a point that shines in a cone.",
            "spot_light(position: [0, 3, 0], angle: 20deg, strength: 9)",
            &[
                position,
                ("target", vec3, true, "the point that it shines at; default the origin"),
                (
                    "angle",
                    Angle,
                    true,
                    "angle from the axis of the cone to its edge; default 30deg",
                ),
                color,
                brightness,
                shadow,
            ],
        ),
    ]
}

/// Marks a setting that can appear only once.
const ONCE: bool = true;

/// Name, type, whether it is optional, and description.
type Parameter = (&'static str, Type, bool, &'static str);

fn row(
    (kind, name, once): (SettingKind, &'static str, bool),
    summary: &'static str,
    example: &'static str,
    parameters: &[Parameter],
) -> SettingRow {
    let parameters = parameters
        .iter()
        .cloned()
        .map(|(name, ty, optional, about)| SettingParameter { name, ty, optional, about });
    SettingRow { kind, name, once, summary, example, parameters: parameters.collect() }
}
