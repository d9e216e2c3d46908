//! Parses values of arguments.

use std::error::Error;
use std::str::FromStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use sdfc::{Method, Plane};
use sdfc_lang::settings::RAY_METHODS;
use sdfc_render::{MAX_PIXELS, MAX_SIDE};

/// Values of params and time.
#[derive(clap::Args, Debug)]
pub struct Values {
    /// Values of params.
    #[command(flatten)]
    pub params: Params,
    /// Time in seconds
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true,
          value_parser = finite)]
    pub time: f64,
}

/// Values of params.
#[derive(clap::Args, Debug)]
pub struct Params {
    /// Set a param, with the value written as in a scene: 0.5, 90deg, true, #d94f30, or the name
    /// of a choice
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
}

/// Numbers of the scene as params.
#[derive(clap::Args, Debug)]
pub struct LiveLiterals {
    /// Turn the numbers in the scene into params, named at_LINE_COLUMN, that change without
    /// recompiling
    #[arg(long)]
    pub live_literals: bool,
}

/// A param and its value as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// The param.
    pub name: String,
    /// The value, as written.
    pub value: String,
}

/// Parses one of some names. Each has a summary for the help.
pub(super) fn named<T>(
    names: impl IntoIterator<Item = [&'static str; 2]>,
) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err: Error + Send + Sync> + Clone + Send + Sync + 'static,
{
    let possible = |[name, summary]: [&'static str; 2]| PossibleValue::new(name).help(summary);
    let possible = names.into_iter().map(possible);
    PossibleValuesParser::new(possible).try_map(|name| name.parse::<T>())
}

/// Parses the name of any ray method. The help lists those for users.
pub(super) fn methods() -> impl TypedValueParser<Value = Method> {
    parser(Method::all())
}

/// Parses the name of a ray method that scenes can name.
pub(super) fn scene_methods() -> impl TypedValueParser<Value = Method> {
    parser(Method::all().filter(|method| RAY_METHODS.contains(&method.name())))
}

pub(super) fn parser(
    methods: impl Iterator<Item = Method>,
) -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(methods.map(described)).try_map(|name| name.parse::<Method>())
}

pub(super) fn described(method: Method) -> PossibleValue {
    let is_for_users = Method::for_users().any(|other| other == method);
    PossibleValue::new(method.name()).help(method.summary()).hide(!is_for_users)
}

/// Parses `NAME=VALUE`.
pub(super) fn assignment(text: &str) -> Result<Assignment, String> {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() || value.is_empty() {
        return Err("expected NAME=VALUE, such as wall=0.1 or tilt=90deg".to_owned());
    }
    Ok(Assignment { name: name.to_owned(), value: value.to_owned() })
}

/// Parses a plane: `z=0.5`, or `1,1,0=2` with a normal.
pub(super) fn plane(text: &str) -> Result<Plane, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let parsed = text.split_once('=').and_then(|(normal, offset)| {
        let normal = match normal.trim() {
            "x" => vec![1.0, 0.0, 0.0],
            "y" => vec![0.0, 1.0, 0.0],
            "z" => vec![0.0, 0.0, 1.0],
            other => other.split(',').map(number).collect::<Option<Vec<f64>>>()?,
        };
        Plane::new(normal.try_into().ok()?, number(offset)?)
    });
    let expected = "expected an axis or a normal and a length, such as z=0.5 or 1,1,0=2";
    parsed.ok_or_else(|| expected.to_owned())
}

/// Parses a finite number.
pub(super) fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "expected a number of seconds, such as 1.5".to_owned())
}

/// Parses a number of pixel widths above 0.
pub(super) fn pixel_widths(text: &str) -> Result<f64, String> {
    above_0(text, "a number of pixel widths above 0, such as 0.05")
}

/// Parses a length or a fraction above 0.
pub(super) fn length(text: &str) -> Result<f64, String> {
    above_0(text, "a number above 0, such as 0.01")
}

fn above_0(text: &str, what: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| format!("expected {what}"))
}

/// Parses `640x400` as `[640, 400]`.
pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(w, h)| (w.parse::<u32>(), h.parse::<u32>()));
    let Some((Ok(width), Ok(height))) = sides else {
        return Err("expected WIDTHxHEIGHT, such as 640x400".to_owned());
    };
    if width == 0 || height == 0 {
        return Err("width and height must be at least 1".to_owned());
    }
    if width.max(height) > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "a picture has at most {MAX_SIDE} pixels per side and {MAX_PIXELS} in total"
        ));
    }
    Ok([width, height])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_parsed_or_refused() {
        assert_eq!(plane("z=0.5"), Ok(Plane::new([0.0, 0.0, 1.0], 0.5).unwrap()));
        assert_eq!(plane("1, 1,0 = -2"), Ok(Plane::new([1.0, 1.0, 0.0], -2.0).unwrap()));
        for wrong in ["", "z", "z=", "w=1", "1,2=3", "0,0,0=1", "1,2,3,4=5", "z=inf", "z=1=2"] {
            assert!(plane(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn assignments_need_a_name_and_a_value() {
        let parsed = assignment(" tilt = 90deg ").unwrap();
        assert_eq!([&parsed.name[..], &parsed.value[..]], ["tilt", "90deg"]);
        for wrong in ["", "tilt", "tilt=", "=1", " = "] {
            assert!(assignment(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_are_parsed_or_refused() {
        assert_eq!(size("640x400"), Ok([640, 400]));
        assert_eq!(size("1x1"), Ok([1, 1]));
        for wrong in ["", "640", "640x", "0x4", "4x0", "-1x4", "4x4x4", "99999x1", "32768x32768"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
