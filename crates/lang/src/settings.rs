//! The settings and their parameters, what they take and what they are for: one row each.

use crate::hir::{SettingKind, Type};

/// What `march(method: ...)` may name, the default first: the ray methods of `sdfc-march`, save those that are
/// there to compare with.
pub const RAY_METHODS: [&str; 9] = [
    "auto",
    "fixed",
    "sphere",
    "sphere-cone",
    "relaxed",
    "accelerated",
    "auto-relaxed",
    "segment",
    "interval",
];

/// One parameter of a setting.
#[derive(Clone, Debug)]
pub struct SettingParameter {
    /// Its name.
    pub name: &'static str,
    /// Its type.
    pub ty: Type,
    /// Whether it may be left out.
    pub optional: bool,
    /// What it is, with its unit and its default.
    pub about: &'static str,
}

/// One setting.
#[derive(Clone, Debug)]
pub struct SettingRow {
    /// Which.
    pub kind: SettingKind,
    /// Its name in the language.
    pub name: &'static str,
    /// Whether it may stand only once.
    pub once: bool,
    /// What it does, in a sentence or two.
    pub summary: &'static str,
    /// A line that uses it.
    pub example: &'static str,
    /// Its parameters in order; `hir::Setting::args` has one place for each.
    pub parameters: Vec<SettingParameter>,
}

/// All settings.
pub fn table() -> Vec<SettingRow> {
    use SettingKind as Kind;
    use Type::{Angle, Color, Int, Number, Shadow, Text};
    let vec3 = Type::Vec(3);
    let position = ("position", vec3.clone(), false, "where it is, in scene units");
    let color = ("color", Color, true, "its colour; white if not given");
    let strength = ("strength", Number, true, "what its colour is multiplied by; 1 if not given");
    let brightness = (
        "strength",
        Number,
        true,
        "what its colour is multiplied by at distance 1, a quarter of it at 2; 1 if not given",
    );
    let shadow = (
        "shadow",
        Shadow,
        true,
        "`hard`, or `soft(k)` whose edge fades over 1 / k of the way from what throws it; none if not given",
    );
    vec![
        row(
            (Kind::Camera, "camera", ONCE),
            "Where the picture is seen from. Without a camera the view is fitted to the scene.",
            "camera(eye: [4, 3, 5], target: [0, 0.5, 0], fov: 35deg)",
            &[
                ("eye", vec3.clone(), false, "where the eye is, in scene units"),
                ("target", vec3.clone(), true, "what it looks at; the origin if not given"),
                ("up", vec3.clone(), true, "what is up in the picture; y if not given"),
                ("fov", Angle, true, "vertical field of view; 40deg if not given"),
                (
                    "height",
                    Number,
                    true,
                    "of a picture by parallel rays, instead of `fov`, in scene units",
                ),
            ],
        ),
        row(
            (Kind::Ambient, "ambient", ONCE),
            "Light from everywhere alike. Without it what no light reaches is black.",
            "ambient(#dfe9ff, 0.3)",
            &[
                color.clone(),
                ("strength", Number, true, "what its colour is multiplied by; 0.2 if not given"),
            ],
        ),
        row(
            (Kind::Sky, "sky", ONCE),
            "What is seen, and mirrored, where nothing is met: the horizon's colour turns into the zenith's \
             upwards. It lights nothing; `ambient` does.",
            "sky(zenith: #4477bb, horizon: #dde8f0)",
            &[
                ("zenith", Color, true, "the colour straight up; #4477bb if not given"),
                (
                    "horizon",
                    Color,
                    true,
                    "the colour at the horizon and below it; #dde8f0 if not given",
                ),
            ],
        ),
        row(
            (Kind::Fog, "fog", ONCE),
            "What is far away fades: of a surface at distance t its colour stays by exp(-density * t).",
            "fog(density: 0.05)",
            &[
                ("density", Number, true, "how fast, per scene unit; 0.05 if not given"),
                (
                    "color",
                    Color,
                    true,
                    "what it fades to; the sky or the background behind it if not given",
                ),
            ],
        ),
        row(
            (Kind::Background, "background", ONCE),
            "What is seen where nothing is met.",
            "background(#1b1e26)",
            &[("color", Color, false, "its colour")],
        ),
        row(
            (Kind::AmbientOcclusion, "ambient_occlusion", ONCE),
            "Corners that little ambient light reaches are darker.",
            "ambient_occlusion(radius: 0.3)",
            &[
                (
                    "radius",
                    Number,
                    true,
                    "how far away things count, in scene units; 0.3 if not given",
                ),
                ("strength", Number, true, "0 for none to 1 for all of it; 1 if not given"),
            ],
        ),
        row(
            (Kind::Reflections, "reflections", ONCE),
            "Surfaces mirror one another and what lies behind, all alike.",
            "reflections(count: 2, strength: 0.5)",
            &[
                ("count", Int, true, "how many mirrors a ray follows, at most 8; 1 if not given"),
                (
                    "strength",
                    Number,
                    true,
                    "what each mirror is multiplied by, 0 to 1; 0.3 if not given",
                ),
            ],
        ),
        row(
            (Kind::Antialias, "antialias", ONCE),
            "Several rays for each pixel, averaged. `--samples` goes before it.",
            "antialias(samples: 4)",
            &[("samples", Int, true, "how many, at most 1024; 4 if not given")],
        ),
        row(
            (Kind::March, "march", ONCE),
            "How rays find surfaces, where the compiler shall not choose.",
            "march(method: \"sphere\", steps: 200, epsilon: 0.001)",
            &[
                ("steps", Int, true, "at most so many steps a ray; 256 if not given"),
                (
                    "epsilon",
                    Number,
                    true,
                    "nearer than this is a hit, in scene units, for `fixed` and `sphere`",
                ),
                ("distance", Number, true, "where rays end, in scene units"),
                ("method", Text, true, "the ray method; \"auto\" if not given"),
                (
                    "tolerance",
                    Number,
                    true,
                    "nearer than this is a hit, in widths of a pixel there, for all other methods; 0.25 if not given",
                ),
            ],
        ),
        row(
            (Kind::Sun, "sun", false),
            "A light from far away, alike everywhere.",
            "sun(direction: [1, 2, 1], shadow: hard)",
            &[
                (
                    "direction",
                    vec3.clone(),
                    true,
                    "towards it, of any length; [1, 2, 1] if not given",
                ),
                color.clone(),
                strength.clone(),
                shadow.clone(),
            ],
        ),
        row(
            (Kind::PointLight, "point_light", false),
            "A light at a place, which shines in all directions.",
            "point_light(position: [0, 3, 0], strength: 5)",
            &[position.clone(), color.clone(), brightness.clone(), shadow.clone()],
        ),
        row(
            (Kind::SpotLight, "spot_light", false),
            "A light at a place, which shines in a cone.",
            "spot_light(position: [0, 3, 0], angle: 20deg, strength: 9)",
            &[
                position,
                ("target", vec3, true, "what it shines at; the origin if not given"),
                (
                    "angle",
                    Angle,
                    true,
                    "from the middle of the cone to its edge; 30deg if not given",
                ),
                color,
                brightness,
                shadow,
            ],
        ),
    ]
}

/// Of a setting that may stand only once.
const ONCE: bool = true;

/// Name, type, whether it may be left out, and what it is.
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
