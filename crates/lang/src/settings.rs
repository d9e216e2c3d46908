//! The settings and their parameters: one row each.

use crate::hir::{SettingKind, Type};

/// One parameter of a setting.
#[derive(Clone, Debug)]
pub struct SettingParameter {
    /// Its name.
    pub name: &'static str,
    /// Its type.
    pub ty: Type,
    /// Whether it may be left out.
    pub optional: bool,
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
    /// Its parameters in order; `hir::Setting::args` has one place for each.
    pub parameters: Vec<SettingParameter>,
}

/// All settings.
pub fn table() -> Vec<SettingRow> {
    use SettingKind as Kind;
    use Type::{Angle, Color, Int, Number, Shadow, Text};
    let vec3 = Type::Vec(3);
    let row = |kind, name, once, parameters: &[(&'static str, Type, bool)]| SettingRow {
        kind,
        name,
        once,
        parameters: parameters
            .iter()
            .map(|(name, ty, optional)| SettingParameter {
                name,
                ty: ty.clone(),
                optional: *optional,
            })
            .collect(),
    };
    vec![
        row(
            Kind::Camera,
            "camera",
            true,
            &[
                ("eye", vec3.clone(), false),
                ("target", vec3.clone(), true),
                ("up", vec3.clone(), true),
                ("fov", Angle, true),
                ("height", Number, true),
            ],
        ),
        row(Kind::Ambient, "ambient", true, &[("color", Color, true), ("strength", Number, true)]),
        row(Kind::Sky, "sky", true, &[("zenith", Color, true), ("horizon", Color, true)]),
        row(Kind::Fog, "fog", true, &[("density", Number, true), ("color", Color, true)]),
        row(Kind::Background, "background", true, &[("color", Color, false)]),
        row(
            Kind::AmbientOcclusion,
            "ambient_occlusion",
            true,
            &[("radius", Number, true), ("strength", Number, true)],
        ),
        row(
            Kind::Reflections,
            "reflections",
            true,
            &[("count", Int, true), ("strength", Number, true)],
        ),
        row(Kind::Antialias, "antialias", true, &[("samples", Int, true)]),
        row(
            Kind::March,
            "march",
            true,
            &[
                ("steps", Int, true),
                ("epsilon", Number, true),
                ("distance", Number, true),
                ("method", Text, true),
            ],
        ),
        row(
            Kind::Sun,
            "sun",
            false,
            &[
                ("direction", vec3.clone(), true),
                ("color", Color, true),
                ("strength", Number, true),
                ("shadow", Shadow, true),
            ],
        ),
        row(
            Kind::PointLight,
            "point_light",
            false,
            &[
                ("position", vec3.clone(), false),
                ("color", Color, true),
                ("strength", Number, true),
                ("shadow", Shadow, true),
            ],
        ),
        row(
            Kind::SpotLight,
            "spot_light",
            false,
            &[
                ("position", vec3.clone(), false),
                ("target", vec3, true),
                ("angle", Angle, true),
                ("color", Color, true),
                ("strength", Number, true),
                ("shadow", Shadow, true),
            ],
        ),
    ]
}
