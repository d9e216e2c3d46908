//! The questions `sdfc/params` and `sdfc/preview`, and their answers: as plain data and as JSON.

use data_encoding::BASE64;
use serde_json::{Map, Value, json};

/// The most pixels on a side of a preview.
pub const MAX_SIDE: u32 = 2048;

/// A value of a param, as a user interface shows it.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// A number, an integer, or an angle in degrees.
    Number(f64),
    /// A truth value.
    Bool(bool),
    /// A colour such as `#d94f30` or `#d94f3080`, or the name of a choice.
    Text(String),
}

/// A param of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ParamInfo {
    /// The name.
    pub name: String,
    /// `number`, `int`, `angle`, `bool`, `color` or `choice`.
    pub kind: &'static str,
    /// The default.
    pub default: ParamValue,
    /// The least and the greatest value, in degrees for angles; an infinite end is no limit.
    pub range: Option<[f64; 2]>,
    /// The names of the choices.
    pub choices: Vec<String>,
}

/// The lens of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PreviewLens {
    /// A vertical field of view, in degrees.
    Fov(f64),
    /// Parallel rays: the height of the picture in scene units.
    Height(f64),
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviewCamera {
    /// The position of the eye.
    pub eye: [f64; 3],
    /// The point in the middle of the picture.
    pub target: [f64; 3],
    /// The upward direction.
    pub up: [f64; 3],
    /// The lens.
    pub lens: PreviewLens,
}

/// What a preview shows.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviewOptions {
    /// Width and height in pixels, each from 1 to [`MAX_SIDE`].
    pub size: [u32; 2],
    /// The camera; `None` for the scene's own, or one that sees the whole scene with its params at
    /// their defaults.
    pub camera: Option<PreviewCamera>,
    /// Values of params; the others have their defaults.
    pub values: Vec<(String, ParamValue)>,
    /// The time in seconds.
    pub time: f64,
}

/// A preview.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// The file.
    pub png: Vec<u8>,
    /// The camera.
    pub camera: PreviewCamera,
    /// The device that drew it.
    pub device: String,
    /// What a viewer should know: why the CPU drew it, and what part of it is unproven.
    pub notes: Vec<String>,
}

/// What an editor asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Ask {
    /// The params of the scene.
    Params,
    /// A picture of the scene.
    Preview(PreviewOptions),
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// To [`Ask::Params`].
    Params(Vec<ParamInfo>),
    /// To [`Ask::Preview`].
    Preview(Preview),
}

/// Reads a request. `None` if it is none of these two.
///
/// # Errors
///
/// A parameter has a wrong type or value.
pub fn asked(method: &str, params: &Value) -> Option<Result<Ask, String>> {
    match method {
        "sdfc/params" => Some(Ok(Ask::Params)),
        "sdfc/preview" => Some(options(params).map(Ask::Preview)),
        _ => None,
    }
}

fn options(params: &Value) -> Result<PreviewOptions, String> {
    let side = |i: usize| {
        let side = params["size"][i].as_u64().and_then(|side| u32::try_from(side).ok());
        side.filter(|side| (1..=MAX_SIDE).contains(side))
    };
    let size = side(0).zip(side(1)).ok_or_else(|| {
        format!("`size` is width and height in pixels, from 1 to {MAX_SIDE}: [640, 360]")
    })?;
    let camera = optional(&params["camera"], camera)?;
    let values = optional(&params["values"], |it| {
        let values = it.as_object().ok_or("`values` is an object: {\"r\": 0.5}")?;
        values.iter().map(value).collect()
    })?;
    let time = optional(&params["time"], |it| Ok(it.as_f64().ok_or("`time` is in seconds")?))?;
    let (values, time) = (values.unwrap_or_default(), time.unwrap_or_default());
    Ok(PreviewOptions { size: [size.0, size.1], camera, values, time })
}

fn optional<T>(
    value: &Value,
    read: impl FnOnce(&Value) -> Result<T, String>,
) -> Result<Option<T>, String> {
    if value.is_null() { Ok(None) } else { read(value).map(Some) }
}

fn camera(params: &Value) -> Result<PreviewCamera, String> {
    let vector = |name: &str| {
        let axis = |i: usize| params[name][i].as_f64();
        let found = axis(0).zip(axis(1)).zip(axis(2)).map(|((x, y), z)| [x, y, z]);
        found.ok_or_else(|| format!("`camera.{name}` is a list of three numbers"))
    };
    let up = if params["up"].is_null() { [0.0, 1.0, 0.0] } else { vector("up")? };
    let lens = match (params["fov"].as_f64(), params["height"].as_f64()) {
        (Some(fov), None) => PreviewLens::Fov(fov),
        (None, Some(height)) => PreviewLens::Height(height),
        (None, None) | (Some(_), Some(_)) => {
            return Err("`camera` has either `fov`, in degrees, or `height`".to_owned());
        }
    };
    Ok(PreviewCamera { eye: vector("eye")?, target: vector("target")?, up, lens })
}

fn value((name, value): (&String, &Value)) -> Result<(String, ParamValue), String> {
    let read = match value {
        Value::Number(number) => number.as_f64().map(ParamValue::Number),
        Value::Bool(truth) => Some(ParamValue::Bool(*truth)),
        Value::String(text) => Some(ParamValue::Text(text.clone())),
        Value::Null | Value::Array(_) | Value::Object(_) => None,
    };
    let refused = || format!("the value of `{name}` is a number, true, false or a string");
    Ok((name.clone(), read.ok_or_else(refused)?))
}

impl Answer {
    /// The result of the request.
    pub fn to_json(&self) -> Value {
        match self {
            Self::Params(params) => {
                json!({ "params": params.iter().map(param).collect::<Vec<_>>() })
            }
            Self::Preview(it) => json!({
                "png": BASE64.encode(&it.png),
                "camera": it.camera.to_json(),
                "device": it.device,
                "notes": it.notes,
            }),
        }
    }
}

fn param(it: &ParamInfo) -> Value {
    // JSON has no infinite numbers.
    let end = |i: usize| it.range.map(|range| range[i]).filter(|end| end.is_finite());
    let default = match &it.default {
        ParamValue::Number(number) => json!(number),
        ParamValue::Bool(truth) => json!(truth),
        ParamValue::Text(text) => json!(text),
    };
    json!({
        "name": it.name,
        "kind": it.kind,
        "default": default,
        "min": end(0),
        "max": end(1),
        "choices": it.choices,
    })
}

impl PreviewCamera {
    fn to_json(self) -> Value {
        let Self { eye, target, up, lens } = self;
        let mut camera = Map::new();
        camera.extend(
            [("eye", eye), ("target", target), ("up", up)]
                .map(|(name, vector)| (name.to_owned(), json!(vector))),
        );
        let (name, size) = match lens {
            PreviewLens::Fov(fov) => ("fov", fov),
            PreviewLens::Height(height) => ("height", height),
        };
        camera.insert(name.to_owned(), json!(size));
        Value::Object(camera)
    }
}
