//! The explanation of a scene, as `sdfc explain` prints it.

use serde::Serialize;

/// How a scene was compiled, and what is known of its field.
///
/// Other tools rely on the keys of its JSON: new ones may be added, none is renamed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Explanation {
    /// Leaves that one evaluation of the field evaluates.
    pub leaves: usize,
    /// Nodes of the flat field, including constants and per-frame nodes.
    pub nodes: usize,
    /// Arithmetic operations per evaluation of the field. A vector operation counts once.
    pub ops_per_eval: usize,
    /// Arithmetic operations per evaluation of the gradient, which only hits need.
    pub ops_per_gradient: usize,
    /// Arithmetic operations per frame, on the CPU.
    pub ops_per_frame: usize,
    /// `parts` if the gradient is summed up part by part, `sweep` if one reverse sweep computes it.
    pub gradient: &'static str,
    /// The largest number of values that the gradient keeps alive at once.
    pub gradient_live: usize,
    /// The same for one reverse sweep.
    pub gradient_live_of_sweep: usize,
    /// `loops` if similar parts are loops, otherwise `unrolled`.
    pub code: &'static str,
    /// Why that was chosen.
    pub code_why: String,
    /// Number of parts in each loop.
    pub loops: Vec<usize>,
    /// Shapes that `auto` intersects analytically.
    pub analytic: Vec<String>,
    /// Shapes that `auto` marches.
    pub marched: Vec<String>,
    /// Costly shapes that shaders evaluate only near the box around them: where it is nearer than
    /// the rest, or within a pixel of it. Each with its line, as in `text at line 3`.
    pub guarded: Vec<String>,
    /// Arithmetic operations of the analytic pre-intersection, per ray.
    pub ops_per_ray: usize,
    /// Arithmetic operations of the marched operands, per step.
    pub ops_per_step: usize,
    /// SPIR-V instructions of the field's function, as emitted.
    pub spirv_instructions: usize,
    /// Arithmetic instructions among them.
    pub spirv_arithmetic: usize,
    /// Features of the picture's shader: `material`, `shadow` and so on.
    pub features: Vec<String>,
    /// The ray method that pictures are drawn with; `none` for regions.
    pub method: &'static str,
    /// Why this method was chosen, if the field is uncertified.
    pub method_why: Option<String>,
    /// Number of regions that a planar picture paints one over the other; 0 for solids.
    pub layers: usize,
    /// Arithmetic operations of a pixel of a planar picture; 0 for solids.
    pub ops_per_pixel: usize,
    /// Factor that turns a distance into a safe step. Always 1: the field is already divided by its
    /// constant.
    pub step_scale: f64,
    /// True if every part has a Lipschitz constant.
    pub certified: bool,
    /// Bounds of the scene.
    pub bounds: Bounds,
    /// Params, and `time` and `frame` if they are used.
    pub inputs: Vec<Input>,
    /// The calls that make the most expensive shapes: at most 5, each with at least 5 % of the
    /// operations. Empty if the scene has less than 200 operations, or more than 500 calls.
    pub costs: Vec<CallCost>,
    /// The shapes that calls in the scene made, in source order.
    pub quality: Vec<QualityRow>,
}

/// An axis-aligned box. `None` (null) is infinite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Bounds {
    /// Lowest coordinates.
    pub min: [Option<f64>; 3],
    /// Highest coordinates.
    pub max: [Option<f64>; 3],
}

impl Bounds {
    /// Makes a box from its corners.
    pub(crate) fn of(corners: [[f64; 3]; 2]) -> Self {
        let [min, max] =
            corners.map(|corner| corner.map(|value| value.is_finite().then_some(value)));
        Self { min, max }
    }
}

/// What the shapes of one call cost.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CallCost {
    /// Name: that of its `let`, or of its definition.
    pub name: String,
    /// Line of the call, from 1.
    pub line: u32,
    /// Column of the call, from 1.
    pub column: u32,
    /// Arithmetic operations of one evaluation of its shapes by themselves.
    pub operations: usize,
    /// `operations` divided by those of the whole scene, without loops that stand for similar
    /// parts. Calls can share operations, so shares can add up to more than 1.
    pub share: f64,
}

/// A param, `time` or `frame`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Input {
    /// Its name.
    pub name: String,
    /// Evaluation rate: `frame` if it changes without recompiling, `compile` if the scene is
    /// compiled again for another value.
    pub stage: &'static str,
    /// True if the field, the material or a setting uses it.
    pub used: bool,
}

/// The properties of the field of one shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct QualityRow {
    /// Name: that of its `let`, or of its definition.
    pub name: String,
    /// Line of the call that made the shape, from 1.
    pub line: u32,
    /// Column of the call, from 1.
    pub column: u32,
    /// Promise outside the surface: `exact`, `bound` or `none`.
    pub outside: String,
    /// Promise inside the surface: `exact`, `bound` or `none`.
    pub inside: String,
    /// Lipschitz constant; null if it depends on a param or is unknown.
    pub lipschitz: Option<f64>,
    /// True if the constant depends on a param.
    pub lipschitz_per_frame: bool,
    /// The operation at which the field may jump; null if the field has a constant.
    pub jump: Option<&'static str>,
    /// Blend margin: where all operands are farther away than this, the result has no surface.
    /// Null for a shape without operands, and if unknown.
    pub blend_margin: Option<f64>,
    /// Bounds about the shape's own origin, at the params' defaults.
    pub bounds: Bounds,
    /// True if the shape has a constant, or is a bound without one.
    pub certified: bool,
    /// Why the shape is uncertified, or how a constant above 1 is handled.
    pub why: Option<String>,
}

impl std::fmt::Display for Explanation {
    /// The explanation as text for people.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "leaves              {}", self.leaves)?;
        writeln!(f, "operations          {} per field evaluation", self.ops_per_eval)?;
        match self.layers {
            0 => {
                writeln!(f, "                    {} per gradient, at hits", self.ops_per_gradient)?
            }
            1 => writeln!(f, "                    {} per pixel", self.ops_per_pixel)?,
            many => {
                writeln!(f, "                    {} per pixel, {many} layers", self.ops_per_pixel)?;
            }
        }
        writeln!(f, "                    {} per frame, on the CPU", self.ops_per_frame)?;
        let (live, of_sweep) = (self.gradient_live, self.gradient_live_of_sweep);
        match self.gradient {
            "parts" => writeln!(
                f,
                "gradient            summed up part by part ({live} values alive at once, {of_sweep} in one \
                 sweep)"
            )?,
            _ => {
                writeln!(f, "gradient            one reverse sweep ({live} values alive at once)")?
            }
        }
        writeln!(f, "code                {} ({})", self.code, self.code_why)?;
        if !self.analytic.is_empty() {
            writeln!(f, "analytic            {}", listed(&self.analytic))?;
            writeln!(f, "marched             {}", listed(&self.marched))?;
        }
        if !self.guarded.is_empty() {
            writeln!(f, "skipped far away    {}", listed(&self.guarded))?;
        }
        if self.ops_per_ray > 0 {
            writeln!(f, "operations of auto  {} per ray, analytic", self.ops_per_ray)?;
            writeln!(f, "                    {} per step, marched", self.ops_per_step)?;
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
        for input in &self.inputs {
            let unused = if input.used { "" } else { ", unused" };
            let rate = match input.stage {
                "compile" => "decides what the scene consists of; another value recompiles it",
                _ => "per frame",
            };
            writeln!(f, "param               {}: {rate}{unused}", input.name)?;
        }
        for (number, call) in self.costs.iter().enumerate() {
            let label = if number == 0 { "most operations" } else { "" };
            let percent = 100.0 * call.share;
            writeln!(
                f,
                "{label:<19} {} ({percent:.0} %) in `{}` at line {}",
                call.operations, call.name, call.line
            )?;
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

/// Returns a number with up to four decimal places.
pub(crate) fn short(value: f64) -> String {
    format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Lists names, each once with its count.
fn listed(names: &[String]) -> String {
    let mut counts: Vec<(&String, usize)> = Vec::new();
    for name in names {
        match counts.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    let entry = |(name, count): &(&String, usize)| match count {
        1 => (*name).clone(),
        _ => format!("{count} {name}"),
    };
    match counts.is_empty() {
        true => "nothing".to_owned(),
        false => counts.iter().map(entry).collect::<Vec<_>>().join(", "),
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
