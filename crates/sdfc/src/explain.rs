//! What was modelled and why, as `sdfc explain` shows it.

use sdfc_march::Features;
use serde::Serialize;

/// The explanation of a scene. The keys are a promise to other tools: some may be added, none renamed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Leaf shapes evaluated in one evaluation of the field.
    pub leaves: usize,
    /// Nodes of the flat field, constants and per-frame ones included.
    pub nodes: usize,
    /// Arithmetic operations of one evaluation of the field; a vector operation counts once.
    pub ops_per_eval: usize,
    /// Arithmetic operations of one evaluation of the gradient, which hits alone need.
    pub ops_per_gradient: usize,
    /// Arithmetic operations done once a frame on the CPU.
    pub ops_per_frame: usize,
    /// How the field is written: `inline`, or `rolled` into loops over alike parts.
    pub writing: &'static str,
    /// Why.
    pub writing_why: String,
    /// How many parts each loop stands for.
    pub loops: Vec<usize>,
    /// Shapes that rays meet in closed form, by the methods that ask for it.
    pub closed: Vec<String>,
    /// Shapes that are left to march by these methods.
    pub marched: Vec<String>,
    /// Arithmetic operations of what such a method asks of a ray before it marches, and of each step of the march.
    pub ops_per_ray: usize,
    /// See [`Self::ops_per_ray`].
    pub ops_per_step: usize,
    /// Instructions of the field's function in SPIR-V, all kinds, as emitted.
    pub spirv_instructions: usize,
    /// Arithmetic ones among them.
    pub spirv_arithmetic: usize,
    /// What the shader holds beside the march: `material`, `shadow`, ...
    pub features: Vec<String>,
    /// Ray method.
    pub method: String,
    /// Why, where it is not for a certified field.
    pub method_why: Option<String>,
    /// By what a distance is multiplied to be a safe step; 1, since the field is divided where it must be.
    pub step_scale: f64,
    /// Whether every part has a Lipschitz constant.
    pub certified: bool,
    /// Where the scene lies.
    pub bounds: Bounds,
    /// Params, and the stage at which each is known.
    pub knobs: Vec<Knob>,
    /// Every shape of the scene that a call in it made, in order of place.
    pub quality: Vec<QualityRow>,
}

/// What of the shading a shader holds, by the names that people see.
pub(crate) fn feature_names(features: Features) -> Vec<String> {
    let Features {
        materials,
        analytic,
        marched: _,
        clipped,
        copies,
        shadows,
        soft_shadows,
        positional_lights,
        spot_lights,
        reflections,
        occlusion,
        sky,
        fog,
        fog_color: _,
        parallel,
        culled,
        instrumented: _,
    } = features;
    let names = [
        ("material", materials),
        ("closed form", analytic),
        ("clip", clipped),
        ("copies in closed form", copies),
        ("shadow", shadows),
        ("soft shadow", soft_shadows),
        ("point light", positional_lights),
        ("spot light", spot_lights),
        ("reflection", reflections),
        ("ambient occlusion", occlusion),
        ("sky", sky),
        ("fog", fog),
        ("parallel camera", parallel),
        ("tile lists", culled),
    ];
    names.iter().filter(|name| name.1).map(|name| name.0.to_owned()).collect()
}

/// Lowest and highest coordinates; `None` (null) where infinite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Bounds {
    /// Lowest.
    pub min: [Option<f64>; 3],
    /// Highest.
    pub max: [Option<f64>; 3],
}

impl Bounds {
    /// Of two corners.
    pub(crate) fn of(corners: [[f64; 3]; 2]) -> Self {
        let [min, max] =
            corners.map(|corner| corner.map(|value| value.is_finite().then_some(value)));
        Self { min, max }
    }
}

/// A param or other per-frame input.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Knob {
    /// Its name.
    pub name: String,
    /// `frame`: it moves without a recompile.
    pub stage: &'static str,
    /// Whether the field, the material or a setting uses it.
    pub used: bool,
}

/// What is known of one shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QualityRow {
    /// Its name: the scene's `let`, or its definition.
    pub name: String,
    /// Line of the call that made it, from 1.
    pub line: u32,
    /// Column, from 1.
    pub column: u32,
    /// `exact`, `bound` or `none`.
    pub outside: String,
    /// `exact`, `bound` or `none`.
    pub inside: String,
    /// Its Lipschitz constant; null where it follows a param or is not known.
    pub lipschitz: Option<f64>,
    /// Whether the constant follows a param.
    pub lipschitz_per_frame: bool,
    /// The operation at which its field may jump; null where it has a constant.
    pub jump: Option<&'static str>,
    /// How far an operator may carry the surface: where all distances that it joins exceed this, nothing of it is. Null for a shape
    /// that joins none, and where it is not known.
    pub blend_margin: Option<f64>,
    /// Where it lies about its own origin, at the params' defaults.
    pub bounds: Bounds,
    /// Whether it has a constant or is a bound without one.
    pub certified: bool,
    /// Why it is not certified, or what is done about a constant above 1.
    pub why: Option<String>,
}

impl std::fmt::Display for Explanation {
    /// The explanation as a page of text.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "leaves              {}", self.leaves)?;
        writeln!(f, "operations          {} per field evaluation", self.ops_per_eval)?;
        writeln!(f, "                    {} per gradient, at hits", self.ops_per_gradient)?;
        writeln!(f, "                    {} per frame, on the CPU", self.ops_per_frame)?;
        writeln!(f, "written             {} ({})", self.writing, self.writing_why)?;
        if !self.closed.is_empty() {
            writeln!(f, "closed form         {}", listed(&self.closed))?;
            writeln!(f, "marched             {}", listed(&self.marched))?;
        }
        if self.ops_per_ray > 0 {
            writeln!(f, "operations of auto  {} per ray", self.ops_per_ray)?;
            writeln!(f, "                    {} per step", self.ops_per_step)?;
        }
        let (all, arithmetic) = (self.spirv_instructions, self.spirv_arithmetic);
        writeln!(f, "SPIR-V              {all} instructions, {arithmetic} of them arithmetic")?;
        let features =
            if self.features.is_empty() { "none".to_owned() } else { self.features.join(", ") };
        writeln!(f, "features            {features}")?;
        let why = self.method_why.as_ref().map_or_else(String::new, |why| format!(" ({why})"));
        writeln!(f, "method              {}{why}", self.method)?;
        writeln!(f, "certified           {}", if self.certified { "yes" } else { "no" })?;
        writeln!(f, "bounds              {}", self.bounds)?;
        for knob in &self.knobs {
            let unused = if knob.used { "" } else { ", unused" };
            writeln!(f, "knob                {}: per {}{unused}", knob.name, knob.stage)?;
        }
        if !self.quality.is_empty() {
            writeln!(
                f,
                "\n  line  shape             outside  inside   lipschitz  jump   blend    bounds"
            )?;
        }
        for row in &self.quality {
            let constant = match row.lipschitz {
                Some(value) => short(value),
                None if row.lipschitz_per_frame => "per frame".to_owned(),
                None if row.certified => "none".to_owned(),
                None => "unknown".to_owned(),
            };
            write!(
                f,
                "{:>6}  {:<16}  {:<7}  {:<7}  {constant:<9}  {:<5}  {:<7}  {}",
                row.line,
                row.name,
                row.outside,
                row.inside,
                row.jump.unwrap_or("-"),
                row.blend_margin.map_or_else(|| "-".to_owned(), short),
                row.bounds
            )?;
            match &row.why {
                Some(why) if row.certified => writeln!(f, "  ({why})")?,
                Some(why) => writeln!(f, "  (uncertified: {why})")?,
                None => writeln!(f)?,
            }
        }
        Ok(())
    }
}

/// A number with up to four digits behind the point.
fn short(value: f64) -> String {
    format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Names, each once with how often it stands there.
fn listed(names: &[String]) -> String {
    let mut counts: Vec<(&String, usize)> = Vec::new();
    for name in names {
        match counts.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    let of = |(name, count): &(&String, usize)| match count {
        1 => (*name).clone(),
        _ => format!("{count} {name}"),
    };
    match counts.is_empty() {
        true => "nothing".to_owned(),
        false => counts.iter().map(of).collect::<Vec<_>>().join(", "),
    }
}

impl std::fmt::Display for Bounds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let end = |value: Option<f64>, infinite: &str| {
            value.map_or_else(|| infinite.to_owned(), |v| format!("{:.4}", v + 0.0))
        };
        let point =
            |ends: [Option<f64>; 3], infinite| ends.map(|value| end(value, infinite)).join(", ");
        write!(f, "[{}] .. [{}]", point(self.min, "-inf"), point(self.max, "inf"))
    }
}
