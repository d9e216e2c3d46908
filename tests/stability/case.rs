//! A case: a scene, its frames, and the error bounds of `auto`.
//!
//! The comment at the start of a case's file explains what fails and why. It ends with lines that
//! are parsed here:
//!
//! ```text
//! // Frames: k = 0.5; k = 0.
//! // Exempt: why the bounds of the other cases do not hold here.
//! // Auto: missed 1 %, depth 0.05 px.
//! ```
//!
//! Bounds that `Auto` does not name are 0. A line `Outdone: segment, interval` names the methods
//! that take fewer evaluations than `auto` and are more accurate. Without `Frames` the case has one
//! frame, with params at their defaults.

use std::path::{Path, PathBuf};

use libtest_mimic::Failed;
use sdfc::{FrameValues, Scene};
use sdfc_tests::repository;

/// The largest bound on the depth error of a case that is not exempt, in pixel widths.
const MAX_DEPTH: f64 = 0.05;

/// A case.
#[derive(Clone, Debug)]
pub struct Case {
    /// The name of the file without its extension.
    pub name: String,
    /// The path below the repository.
    pub path: String,
    /// The source of the scene.
    pub text: String,
    /// The first sentence of the comment.
    pub title: String,
    /// The reason why it has other bounds than the rest.
    pub exempt: Option<String>,
    /// The error bounds of `auto`.
    pub auto: Bounds,
    /// The methods that take fewer evaluations than `auto` and are more accurate.
    pub outdone: Vec<String>,
    /// The values of params in each frame.
    frames: Vec<Vec<(String, String)>>,
}

/// Percentages of pixels, and an error in depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Rays that passed through a surface.
    pub missed: f64,
    /// Rays that ended where there is no surface.
    pub false_hits: f64,
    /// Rays that ran out of steps.
    pub capped: f64,
    /// Pixels that are not a number.
    pub nan: f64,
    /// Pixels that the oracle cannot decide.
    pub undecided: f64,
    /// The 99th percentile of the depth error, in pixel widths.
    pub depth: f64,
}

/// Returns all cases, sorted by name.
pub fn cases() -> Result<Vec<Case>, Failed> {
    let top = repository();
    let mut paths: Vec<PathBuf> = Vec::new();
    for folder in ["tests/stability", "examples/faults"] {
        for entry in std::fs::read_dir(top.join(folder))? {
            paths.push(Path::new(folder).join(entry?.file_name()));
        }
    }
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "sdf"));
    paths.sort_by_key(|path| path.file_name().map(ToOwned::to_owned));
    paths.iter().map(|path| Case::read(&top, path)).collect()
}

impl Case {
    fn read(top: &Path, path: &Path) -> Result<Self, Failed> {
        let text = std::fs::read_to_string(top.join(path))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Self::parse(&name, &path.display().to_string(), text)
            .map_err(|why| format!("{}: {why}", path.display()).into())
    }

    fn parse(name: &str, path: &str, text: String) -> Result<Self, String> {
        let lines: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("//")).collect();
        let comment = lines.iter().map(|line| line.trim()).take_while(|line| !line.is_empty());
        let comment = comment.collect::<Vec<_>>().join(" ");
        let title = comment.split(". ").next().map(|title| title.trim_end_matches('.').to_owned());
        let keyed = |key: &str| {
            let mut values = lines.iter().filter_map(|line| line.trim().strip_prefix(key));
            values.next().map(|value| value.trim().trim_end_matches('.').to_owned())
        };
        let exempt = keyed("Exempt:");
        let auto = Bounds::parse(&keyed("Auto:").ok_or("no line `Auto:`")?)?;
        let general = Bounds { depth: auto.depth.min(MAX_DEPTH), ..Bounds::default() };
        if exempt.is_none() && auto != general {
            return Err("weaker bounds than all cases hold, and no line `Exempt:`".to_owned());
        }
        let outdone = keyed("Outdone:").map_or_else(Vec::new, |names| {
            names.split(',').map(|name| name.trim().to_owned()).collect()
        });
        let frames = keyed("Frames:").map_or_else(|| Ok(vec![Vec::new()]), |all| frames(&all))?;
        Ok(Self {
            name: name.to_owned(),
            path: path.to_owned(),
            title: title.ok_or("no leading comment")?,
            exempt,
            auto,
            outdone,
            frames,
            text,
        })
    }

    /// Returns the values of params in each frame.
    pub fn frames(&self, scene: &Scene) -> Result<Vec<FrameValues>, Failed> {
        let frame = |values: &Vec<(String, String)>| {
            let mut frame = FrameValues::defaults(scene.params());
            for (param, value) in values {
                scene.set_param(&mut frame, param, value)?;
            }
            Ok(frame)
        };
        self.frames.iter().map(frame).collect()
    }
}

/// Parses frames such as `k = 0.5, n = 2; k = 0`.
fn frames(text: &str) -> Result<Vec<Vec<(String, String)>>, String> {
    let pair = |text: &str| {
        let (param, value) = text.split_once('=').ok_or(format!("`{text}` sets no param"))?;
        Ok((param.trim().to_owned(), value.trim().to_owned()))
    };
    text.split(';').map(|frame| frame.split(',').map(pair).collect()).collect()
}

impl Bounds {
    /// Parses bounds such as `missed 1 %, depth 0.05 px`.
    fn parse(text: &str) -> Result<Self, String> {
        let mut bounds = Self::default();
        for part in text.split(',') {
            let mut words = part.split_whitespace();
            let (name, value) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
            let (bound, unit) = match name {
                "missed" => (&mut bounds.missed, "%"),
                "false" => (&mut bounds.false_hits, "%"),
                "capped" => (&mut bounds.capped, "%"),
                "nan" => (&mut bounds.nan, "%"),
                "undecided" => (&mut bounds.undecided, "%"),
                "depth" => (&mut bounds.depth, "px"),
                _ => return Err(format!("`{name}` is no bound")),
            };
            *bound = value.parse().map_err(|_| format!("`{value}` is no number"))?;
            if words.next() != Some(unit) {
                return Err(format!("`{name}` is in {unit}"));
            }
        }
        Ok(bounds)
    }
}
