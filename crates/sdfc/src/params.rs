//! Sets the params of a scene for one frame.

use sdfc_diagnostics::{Sources, has_errors};
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Param, ParamKind};
use sdfc_lang::CompileValues;

use crate::scene::Scene;

/// Why a param cannot be set to a value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParamError {
    /// The scene has no param with this name.
    #[error("the scene has no param `{name}`; {}", known_params(name, known))]
    Unknown {
        /// The name.
        name: String,
        /// Names of all params of the scene.
        known: Vec<String>,
    },
    /// The value does not fit the kind of the param.
    #[error("the param `{name}` takes {expected}, not `{text}`")]
    NotAValue {
        /// The param.
        name: String,
        /// The value as text.
        text: String,
        /// The values that the param takes.
        expected: String,
    },
    /// The param is a constant of the compiled scene.
    #[error(
        "the param `{name}` decides what the scene consists of, so it cannot change in a compiled \
         scene: compile the scene with the value"
    )]
    Fixed {
        /// The param.
        name: String,
    },
    /// The value lies outside the param's range.
    #[error("the param `{name}` takes {range}; {text} is outside")]
    Outside {
        /// The param.
        name: String,
        /// The value as text.
        text: String,
        /// The range as a scene writes it.
        range: String,
    },
}

/// Says which param a name may have meant: params of imported files that end in the name, one with
/// nearly the name, or all.
fn known_params(name: &str, known: &[String]) -> String {
    let is_in_a_file = |param: &&String| {
        let before = param.strip_suffix(name);
        before.is_some_and(|before| before.ends_with(['.', '/']))
    };
    let quoted = |param: &String| format!("`{param}`");
    let in_files: Vec<String> = known.iter().filter(is_in_a_file).map(quoted).collect();
    if !name.is_empty() && !in_files.is_empty() {
        return format!("write {}", in_files.join(" or "));
    }
    if name == "time" {
        return "on the command line, `--time` sets the time".to_owned();
    }
    if let Some(near) = sdfc_lang::nearest_name(name, known.iter().map(String::as_str)) {
        return format!("did you mean `{near}`?");
    }
    match known {
        [] => "it has no params".to_owned(),
        known => format!("it has {}", known.join(", ")),
    }
}

/// A value of a param.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// A number, an integer, or an angle in radians.
    Number(f64),
    /// A truth value.
    Bool(bool),
    /// A colour: linear red, green, blue, alpha.
    Color([f64; 4]),
    /// The name of a choice.
    Choice(&'a str),
}

impl From<f64> for Value<'_> {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<f32> for Value<'_> {
    fn from(number: f32) -> Self {
        Self::Number(f64::from(number))
    }
}

impl From<i32> for Value<'_> {
    fn from(number: i32) -> Self {
        Self::Number(f64::from(number))
    }
}

impl From<bool> for Value<'_> {
    fn from(truth: bool) -> Self {
        Self::Bool(truth)
    }
}

impl From<[f64; 4]> for Value<'_> {
    fn from(color: [f64; 4]) -> Self {
        Self::Color(color)
    }
}

impl<'a> From<&'a str> for Value<'a> {
    fn from(choice: &'a str) -> Self {
        Self::Choice(choice)
    }
}

impl std::fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Bool(truth) => truth.fmt(f),
            Self::Color(lanes) => write!(f, "{lanes:?}"),
            Self::Choice(name) => f.write_str(name),
        }
    }
}

impl Scene {
    /// Returns the value that a text states for a param, written as for [`Self::set_param`]. It may
    /// be a param that is [fixed](Self::is_fixed).
    ///
    /// # Errors
    ///
    /// [`ParamError`], except [`ParamError::Fixed`].
    pub fn param_value(&self, name: &str, text: &str) -> Result<[f64; 4], ParamError> {
        parsed(self.params(), name, text)
    }

    /// True if a param decides what the scene consists of: a count, the length of a list, a string.
    /// It is a constant of the compiled scene; [`Compiler::values`](crate::Compiler::values) sets
    /// it.
    pub fn is_fixed(&self, name: &str) -> bool {
        self.params().iter().any(|param| param.name == name && param.fixed.is_some())
    }

    /// True if the scene must be compiled again for these values, since a param that is
    /// [fixed](Self::is_fixed) has another one. Values that a param does not take are ignored.
    pub fn needs_compile(&self, values: &CompileValues) -> bool {
        self.params().iter().any(|param| {
            let given = values.get(&param.name).filter(|lanes| param.accepts(**lanes));
            param.fixed.is_some_and(|fixed| fixed != *given.unwrap_or(&param.default))
        })
    }

    /// The values of fixed params as arguments of `sdfc compile`.
    pub(crate) fn fixed_arguments(&self) -> String {
        let argument = |param: &Param| {
            let [number, ..] = param.fixed?;
            let value = match param.kind {
                ParamKind::Number | ParamKind::Int => number.to_string(),
                ParamKind::Angle => in_degrees(number),
                ParamKind::Bool => (number != 0.0).to_string(),
                ParamKind::Color => format!("{:?}", param.fixed?),
                ParamKind::Choice => param.choices.get(number as usize)?.clone(),
            };
            Some(format!(" --set {}={value}", param.name))
        };
        self.params().iter().filter_map(argument).collect()
    }

    /// Sets one param of a frame.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let text = "param r = 1 in 0..2\nparam lid = true\nsphere(r)";
    /// let scene = Compiler::new().compile("a.sdf", text)?;
    /// let mut frame = scene.defaults();
    /// scene.set(&mut frame, "r", 0.5)?;
    /// scene.set(&mut frame, "lid", false)?;
    /// assert_eq!([frame.params[0][0], frame.params[1][0]], [0.5, 0.0]);
    /// assert!(scene.set(&mut frame, "r", f64::NAN).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ParamError`], also for infinite numbers and NaN. The frame is not changed.
    pub fn set<'v>(
        &self,
        frame: &mut FrameValues,
        name: &str,
        value: impl Into<Value<'v>>,
    ) -> Result<(), ParamError> {
        set(self.params(), frame, name, value.into())
    }

    /// Sets one param of a frame from text, written as in a scene: `0.5`, `-2`, `90deg`, `true`,
    /// `#d94f30`, or the name of a choice.
    ///
    /// ```
    /// let scene = sdfc::Compiler::new().compile("a.sdf", "param r = 1 in 0..2\nsphere(r)")?;
    /// let mut frame = scene.defaults();
    /// scene.set_param(&mut frame, "r", "0.5")?;
    /// assert_eq!(frame.params[0][0], 0.5);
    /// let error = scene.set_param(&mut frame, "r", "3").expect_err("outside");
    /// assert_eq!(error.to_string(), "the param `r` takes 0..2; 3 is outside");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ParamError`]. The frame is not changed.
    pub fn set_param(
        &self,
        frame: &mut FrameValues,
        name: &str,
        text: &str,
    ) -> Result<(), ParamError> {
        put(self.params(), frame, name, |param| value(param, text))
    }
}

/// Sets one param of a frame.
pub(crate) fn set(
    params: &[Param],
    frame: &mut FrameValues,
    name: &str,
    value: Value<'_>,
) -> Result<(), ParamError> {
    put(params, frame, name, |param| {
        let text = value.to_string();
        let lanes = value.lanes(param).ok_or_else(|| not_a_value(param, &text))?;
        within_range(param, lanes, &text)
    })
}

fn find<'p>(params: &'p [Param], name: &str) -> Result<(usize, &'p Param), ParamError> {
    let found = params.iter().enumerate().find(|(_, param)| param.name == name);
    found.ok_or_else(|| {
        let known = params.iter().map(|param| param.name.clone()).collect();
        ParamError::Unknown { name: name.to_owned(), known }
    })
}

fn put(
    params: &[Param],
    frame: &mut FrameValues,
    name: &str,
    value: impl FnOnce(&Param) -> Result<[f64; 4], ParamError>,
) -> Result<(), ParamError> {
    let (index, param) = find(params, name)?;
    let value = value(param)?;
    if param.fixed.is_some_and(|fixed| fixed != value) {
        return Err(ParamError::Fixed { name: name.to_owned() });
    }
    if frame.params.len() < params.len() {
        frame.params = FrameValues::defaults(params).params;
    }
    frame.params[index] = value;
    Ok(())
}

/// Parses values for params by name.
///
/// # Errors
///
/// [`ParamError`], except [`ParamError::Fixed`].
pub(crate) fn parse_values(
    params: &[Param],
    set: &[(&str, &str)],
) -> Result<CompileValues, ParamError> {
    let one = |(name, text): &(&str, &str)| Ok(((*name).to_owned(), parsed(params, name, text)?));
    set.iter().map(one).collect()
}

fn parsed(params: &[Param], name: &str, text: &str) -> Result<[f64; 4], ParamError> {
    let (_, param) = find(params, name)?;
    value(param, text)
}

/// Parses the value of a param.
fn value(param: &Param, text: &str) -> Result<[f64; 4], ParamError> {
    let text = text.trim();
    let refused = || not_a_value(param, text);
    if param.kind == ParamKind::Choice {
        let index = param.choices.iter().position(|choice| choice == text.trim_matches('"'));
        return index.map(|index| [index as f64, 0.0, 0.0, 0.0]).ok_or_else(refused);
    }
    let (kind, lanes) = literal(text).ok_or_else(refused)?;
    let [number, ..] = lanes;
    let fits = match param.kind {
        ParamKind::Int => kind == ParamKind::Number && number.fract() == 0.0,
        // 0 needs no unit, as in a scene.
        ParamKind::Angle => kind == ParamKind::Angle || kind == ParamKind::Number && number == 0.0,
        ParamKind::Number | ParamKind::Bool | ParamKind::Color | ParamKind::Choice => {
            kind == param.kind
        }
    };
    if !fits {
        return Err(refused());
    }
    within_range(param, lanes, text)
}

impl Value<'_> {
    /// Returns the lanes of the value for a param, or `None` if it does not fit the param's kind.
    fn lanes(self, param: &Param) -> Option<[f64; 4]> {
        let one = |number: f64| number.is_finite().then_some([number, 0.0, 0.0, 0.0]);
        match (self, param.kind) {
            (Self::Number(number), ParamKind::Number | ParamKind::Angle) => one(number),
            (Self::Number(number), ParamKind::Int) => one(number).filter(|_| number.fract() == 0.0),
            (Self::Bool(truth), ParamKind::Bool) => one(f64::from(u8::from(truth))),
            (Self::Color(lanes), ParamKind::Color) => {
                Some(lanes).filter(|lanes| lanes.iter().all(|lane| lane.is_finite()))
            }
            (Self::Choice(name), ParamKind::Choice) => {
                one(param.choices.iter().position(|choice| choice == name)? as f64)
            }
            (Self::Number(_) | Self::Bool(_) | Self::Color(_) | Self::Choice(_), _) => None,
        }
    }
}

fn not_a_value(param: &Param, text: &str) -> ParamError {
    let (name, text) = (param.name.clone(), text.to_owned());
    ParamError::NotAValue { name, text, expected: expected(param) }
}

fn within_range(param: &Param, lanes: [f64; 4], text: &str) -> Result<[f64; 4], ParamError> {
    let [number, ..] = lanes;
    match param.range {
        Some([lo, hi]) if !(lo..=hi).contains(&number) => Err(ParamError::Outside {
            name: param.name.clone(),
            text: text.to_owned(),
            range: range(param.kind, [lo, hi]),
        }),
        Some(_) | None => Ok(lanes),
    }
}

/// Returns kind and lanes of a constant. It is parsed as the default of a param, so that values are
/// written as in a scene.
fn literal(text: &str) -> Option<(ParamKind, [f64; 4])> {
    // A range would be part of the declaration.
    if text.contains(['\n', '\r']) || text.split_whitespace().any(|word| word == "in") {
        return None;
    }
    let mut sources = Sources::new();
    let file = sources.add("value", format!("param value = {text}\n"));
    let (elaborated, found) = sdfc_lang::front(&mut sources, file);
    let params = elaborated.filter(|_| !has_errors(&found))?.scene.params;
    match &params[..] {
        [param] if param.choices.is_empty() => Some((param.kind, param.default)),
        _ => None,
    }
}

fn expected(param: &Param) -> String {
    match param.kind {
        ParamKind::Number => "a number".to_owned(),
        ParamKind::Int => "an integer".to_owned(),
        ParamKind::Angle => "an angle with its unit, such as 90deg".to_owned(),
        ParamKind::Bool => "true or false".to_owned(),
        ParamKind::Color => "a colour, such as #d94f30".to_owned(),
        ParamKind::Choice => format!("one of {}", param.choices.join(", ")),
    }
}

/// Returns a range as a scene writes it.
fn range(kind: ParamKind, ends: [f64; 2]) -> String {
    let [lo, hi] = ends.map(|end| match kind {
        ParamKind::Angle => in_degrees(end),
        ParamKind::Number
        | ParamKind::Int
        | ParamKind::Bool
        | ParamKind::Color
        | ParamKind::Choice => end.to_string(),
    });
    format!("{lo}..{hi}")
}

/// Returns an angle as a scene writes it.
fn in_degrees(radians: f64) -> String {
    format!("{}deg", degrees(radians))
}

/// Returns an angle in degrees, without the rounding error of the conversion from degrees and back.
///
/// ```
/// let radians = 15f64.to_radians();
/// assert_ne!(radians.to_degrees(), 15.0);
/// assert_eq!(sdfc::degrees(radians), 15.0);
/// ```
pub fn degrees(radians: f64) -> f64 {
    (radians.to_degrees() * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {

    const SCENE: &str = "param r = 1.5 in 0.5..2\nparam n: int = 3 in 1..9\nparam tilt = 10deg in \
                         0deg..45deg\nparam lid = true\nparam wood = #8a5a34\nparam style = \
                         \"round\" in [\"round\", \"flat\"]\nsphere(r)\n";

    fn set(name: &str, text: &str) -> Result<[f64; 4], String> {
        let scene = crate::compiler::Compiler::new().compile("a.sdf", SCENE).unwrap();
        let mut frame = scene.defaults();
        scene.set_param(&mut frame, name, text).map_err(|e| e.to_string())?;
        let index = scene.params().iter().position(|param| param.name == name).unwrap();
        Ok(frame.params[index])
    }

    #[test]
    fn values_are_written_as_in_a_scene() {
        assert_eq!(set("r", "0.5"), Ok([0.5, 0.0, 0.0, 0.0]));
        assert_eq!(set("r", "2"), Ok([2.0, 0.0, 0.0, 0.0]));
        assert_eq!(set("n", "9"), Ok([9.0, 0.0, 0.0, 0.0]));
        let [tilt, ..] = set("tilt", "0.125turn").unwrap();
        assert!((tilt - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
        assert_eq!(set("tilt", "0"), Ok([0.0; 4]));
        assert_eq!(set("lid", "false"), Ok([0.0; 4]));
        assert_eq!(set("wood", "#f00"), Ok([1.0, 0.0, 0.0, 1.0]));
        assert_eq!(set("style", "flat"), Ok([1.0, 0.0, 0.0, 0.0]));
        assert_eq!(set("style", "\"round\""), Ok([0.0; 4]));
    }

    #[test]
    fn an_invalid_value_is_refused_with_a_valid_example() {
        for (name, text, part) in [
            ("q", "1", "it has r, n, tilt, lid, wood, style"),
            ("r", "2.5", "0.5..2; 2.5 is outside"),
            ("r", "nan", "a number"),
            ("r", "1 in 0..5", "a number"),
            ("r", "1\nparam x = 2", "a number"),
            ("r", "", "a number"),
            ("r", "true", "a number"),
            ("n", "2.5", "an integer"),
            ("tilt", "10", "its unit"),
            ("tilt", "90deg", "0deg..45deg"),
            ("lid", "1", "true or false"),
            ("wood", "red", "#d94f30"),
            ("style", "square", "round, flat"),
        ] {
            let message = set(name, text).unwrap_err();
            assert!(message.contains(part), "{name}={text}: {message}");
        }
    }
}
