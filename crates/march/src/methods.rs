//! The ray methods: what each is for, what it costs to tune, and the WGSL file that holds it.

use std::fmt;
use std::str::FromStr;

/// A ray method: how a shader finds where a ray meets the surface.
///
/// [`Method::for_users`] gives the methods that a scene or a command line may ask for. The others
/// exist so that charts can compare `auto` with published work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// Relaxed sphere tracing that intersects simple shapes analytically first.
    #[default]
    Auto,
    /// Steps of constant length.
    Fixed,
    /// Sphere tracing up to an absolute distance.
    Sphere,
    /// Sphere tracing up to a fraction of the pixel's width.
    SphereCone,
    /// Over-relaxed sphere tracing.
    Relaxed,
    /// Sphere tracing accelerated by the slope of the last step.
    Accelerated,
    /// Sphere tracing accelerated by the mean slope of all steps so far.
    AutoRelaxed,
    /// Steps by bounds on the slope of the field along ray segments.
    Segment,
    /// Steps by bounds on the value of the field along ray segments.
    Interval,
    /// The naive marcher of a classroom exercise.
    Practical,
}

impl Method {
    /// The method that `auto` falls back to where the field is uncertified: it finds the first hit
    /// whatever the field promises.
    pub const FALLBACK: Self = Self::Interval;

    /// All methods, the default first.
    pub fn all() -> impl ExactSizeIterator<Item = Self> {
        METHODS.iter().map(|definition| definition.method)
    }

    /// The methods that users choose from, the default first.
    pub fn for_users() -> impl Iterator<Item = Self> {
        Self::all().filter(|method| method.definition().audience == Audience::Users)
    }

    /// The method's name in scenes and on the command line.
    pub fn name(self) -> &'static str {
        self.definition().name
    }

    /// One sentence that says what the method is for.
    pub fn summary(self) -> &'static str {
        self.definition().summary
    }

    /// The method's row of [`METHODS`].
    pub fn definition(self) -> &'static MethodDefinition {
        // A test checks that the rows stand in the order of the variants.
        &METHODS[self as usize]
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = UnknownMethod;

    /// Reads a method's name. All methods are known, those for charts too.
    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        let known = Self::all().find(|method| method.name() == name);
        known.ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}

/// The error of a name that no ray method has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownMethod(pub String);

impl fmt::Display for UnknownMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = Method::all().map(Method::name).collect();
        write!(f, "unknown ray method `{}`; there are {}", self.0, names.join(", "))
    }
}

impl std::error::Error for UnknownMethod {}

/// Who a ray method is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Audience {
    /// Everyone: scenes, the command line and the viewer offer the method.
    Users,
    /// Charts only: the method is there to compare others with.
    Charts,
}

/// A row of [`METHODS`]: a ray method's description and its shader source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodDefinition {
    /// The method that the row describes.
    pub method: Method,
    /// Its name in scenes and on the command line.
    pub name: &'static str,
    /// One sentence that says what it is for.
    pub summary: &'static str,
    /// Who may choose it.
    pub audience: Audience,
    /// Contents of its WGSL file.
    pub source: &'static str,
    /// Contents of a file with a gradient that belongs to the method; `None` uses the scene's.
    pub gradient: Option<&'static str>,
    /// True if the method asks for the analytic pre-intersection (`pre_intersection.wgsl`) before
    /// it marches.
    pub pre_intersects: bool,
    /// True if the method may pass a part that is thinner than one of its steps, whatever is known
    /// of the field.
    pub misses_thin_parts: bool,
    /// The setting that trades the method's cost for its error; `None` if it has none.
    pub parameter: Option<MethodParameter>,
    /// The values of the parameter that a chart shows, as multiples of the scene's own value or
    /// else of the default.
    pub chart_factors: &'static [f64],
}

impl MethodDefinition {
    /// The source files of the method: those that it or its soft shadows may call, then its own.
    pub(crate) fn files(&self) -> Vec<&'static str> {
        let analytic = include_str!("wgsl/analytic.wgsl");
        vec![analytic, include_str!("wgsl/pre_intersection.wgsl"), self.source]
    }

    /// Returns true if the method's own file calls the function of that name, one of
    /// [`stubs`](crate::stubs).
    pub fn calls(&self, stub: &str) -> bool {
        self.source.contains(&format!("{stub}("))
    }
}

/// A setting that trades the cost of a ray for its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodParameter {
    /// The number of steps that a ray may take.
    Steps,
    /// The absolute distance from the surface below which a point is a hit.
    Epsilon,
    /// The same distance as a multiple of the pixel's width at the point.
    Tolerance,
}

impl MethodParameter {
    /// Its name in a scene's `march(...)`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Epsilon => "epsilon",
            Self::Tolerance => "tolerance",
        }
    }

    /// The unit of its values.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Epsilon => "scene units",
            Self::Tolerance => "widths of a pixel",
        }
    }

    /// The value where a scene states none. That of [`Self::Epsilon`] holds for a camera at
    /// distance 1 from its target, and scales with that distance.
    pub fn default_value(self) -> f64 {
        match self {
            Self::Steps => 256.0,
            // About 100 times the rounding error of f32 at distance 1.
            Self::Epsilon => 5e-5,
            Self::Tolerance => 0.25,
        }
    }
}

/// Factors of the default tolerance, a quarter of a pixel: from half a pixel's width down to a
/// hundredth of it.
const PIXEL_FACTORS: [f64; 4] = [2.0, 1.0, 0.2, 0.04];

/// All ray methods, the default first.
pub static METHODS: [MethodDefinition; 10] = [
    MethodDefinition {
        method: Method::Auto,
        name: "auto",
        summary: "The fastest and most accurate choice for almost every scene: simple shapes are \
                  intersected analytically, the rest by relaxed sphere tracing.",
        audience: Audience::Users,
        source: include_str!("wgsl/auto.wgsl"),
        gradient: None,
        pre_intersects: true,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::Fixed,
        name: "fixed",
        summary: "Steps of constant length, for fields that are not distances at all; parts \
                  thinner than a step may be missed.",
        audience: Audience::Users,
        source: include_str!("wgsl/fixed.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: true,
        parameter: Some(MethodParameter::Steps),
        chart_factors: &[0.25, 0.5, 1.0, 2.0, 4.0],
    },
    MethodDefinition {
        method: Method::Sphere,
        name: "sphere",
        summary: "Plain sphere tracing, the textbook method: each step is as long as the distance, \
                  up to an absolute tolerance.",
        audience: Audience::Users,
        source: include_str!("wgsl/sphere.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Epsilon),
        chart_factors: &[100.0, 10.0, 1.0, 0.1],
    },
    MethodDefinition {
        method: Method::SphereCone,
        name: "sphere-cone",
        summary: "Sphere tracing that stops at a fraction of the pixel's width.",
        audience: Audience::Charts,
        source: include_str!("wgsl/sphere_cone.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::Relaxed,
        name: "relaxed",
        summary: "Over-relaxed sphere tracing: steps are longer than the distance, and taken back \
                  where they skipped something.",
        audience: Audience::Charts,
        source: include_str!("wgsl/relaxed.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::Accelerated,
        name: "accelerated",
        summary: "Sphere tracing whose steps extrapolate the slope of the last step, and are taken \
                  back where they skipped something.",
        audience: Audience::Charts,
        source: include_str!("wgsl/accelerated.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::AutoRelaxed,
        name: "auto-relaxed",
        summary: "Sphere tracing whose steps extrapolate the mean slope of all steps so far, and \
                  are taken back where they skipped something.",
        audience: Audience::Charts,
        source: include_str!("wgsl/auto_relaxed.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::Segment,
        name: "segment",
        summary: "Steps as long as bounds on the field's slope allow, for smooth fields that \
                  exceed the distance; slower than `auto`.",
        audience: Audience::Users,
        source: include_str!("wgsl/segment.wgsl"),
        gradient: None,
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::Interval,
        name: "interval",
        summary: "Finds the first hit by interval bounds even where the field exceeds the distance \
                  or jumps; slower than `auto`, which falls back to it.",
        audience: Audience::Users,
        source: include_str!("wgsl/interval.wgsl"),
        gradient: None,
        pre_intersects: true,
        misses_thin_parts: false,
        parameter: Some(MethodParameter::Tolerance),
        chart_factors: &PIXEL_FACTORS,
    },
    MethodDefinition {
        method: Method::Practical,
        name: "practical",
        summary: "The naive marcher of a classroom exercise, with its faults and its normals.",
        audience: Audience::Charts,
        source: include_str!("wgsl/baseline/naive.wgsl"),
        gradient: Some(include_str!("wgsl/baseline/central.wgsl")),
        pre_intersects: false,
        misses_thin_parts: false,
        parameter: None,
        chart_factors: &[1.0],
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_the_variants() {
        for (index, row) in METHODS.iter().enumerate() {
            assert_eq!(row.method as usize, index, "{}", row.name);
            assert_eq!(row.method.definition(), row);
        }
    }

    #[test]
    fn names_are_read_back_as_they_are_written() {
        for method in Method::all() {
            assert_eq!(method.to_string().parse(), Ok(method));
        }
        let error = "spere".parse::<Method>().unwrap_err();
        assert!(error.to_string().starts_with("unknown ray method `spere`; there are auto, fixed"));
    }

    #[test]
    fn users_choose_from_the_default_the_fallback_and_what_is_no_comparison() {
        let names: Vec<_> = Method::for_users().map(Method::name).collect();
        assert_eq!(names, ["auto", "fixed", "sphere", "segment", "interval"]);
        assert_eq!(METHODS[0].method, Method::default());
    }
}
