//! A case: a scene, the frames at which it is looked at, and what `auto` has to hold there.
//!
//! The leading comment of a case's file says what fails and why, and ends in lines that are read here:
//!
//! ```text
//! // Frames: k = 0.5; k = 0.
//! // Exempt: why the bounds that hold for every other case do not hold here.
//! // Auto: missed 1 %, depth 0.05 px.
//! ```
//!
//! What `Auto` does not name is 0. A line `Outdone: segment, interval` names the methods that take
//! fewer evaluations than `auto` and err less. Without `Frames` the case is one frame, params at
//! their defaults.

use std::path::{Path, PathBuf};

use libtest_mimic::Failed;
use sdfc::{FrameValues, Scene};
use sdfc_tests::repository;

/// Most error in depth that a case may allow unless it is exempt, in widths of a pixel.
const MOST_DEPTH: f64 = 0.05;

/// One file.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name of the file without its ending.
    pub name: String,
    /// Path from the top of the repository.
    pub path: String,
    /// Text of the scene.
    pub text: String,
    /// The comment's first line.
    pub title: String,
    /// Why it is held to other bounds than the rest.
    pub exempt: Option<String>,
    /// What `auto` has to hold.
    pub auto: Bounds,
    /// Methods that take fewer evaluations than `auto` and err less.
    pub outdone: Vec<String>,
    /// Values of params, by frame.
    frames: Vec<Vec<(String, String)>>,
}

/// Shares of the pixels, in percent, and an error in depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Led through a surface.
    pub missed: f64,
    /// Ended where there is none.
    pub false_hits: f64,
    /// Out of steps.
    pub capped: f64,
    /// Not a number.
    pub nan: f64,
    /// Not known to the oracle.
    pub undecided: f64,
    /// In widths of a pixel, 99 of 100 pixels.
    pub depth: f64,
}

/// The cases, by name.
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
        let general = Bounds { depth: auto.depth.min(MOST_DEPTH), ..Bounds::default() };
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

    /// The frames at which the scene is looked at.
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

/// `k = 0.5, n = 2; k = 0`
fn frames(text: &str) -> Result<Vec<Vec<(String, String)>>, String> {
    let pair = |text: &str| {
        let (param, value) = text.split_once('=').ok_or(format!("`{text}` sets no param"))?;
        Ok((param.trim().to_owned(), value.trim().to_owned()))
    };
    text.split(';').map(|frame| frame.split(',').map(pair).collect()).collect()
}

impl Bounds {
    /// `missed 1 %, depth 0.05 px`
    fn parse(text: &str) -> Result<Self, String> {
        let mut bounds = Self::default();
        for part in text.split(',') {
            let mut words = part.split_whitespace();
            let (name, value) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
            let (place, unit) = match name {
                "missed" => (&mut bounds.missed, "%"),
                "false" => (&mut bounds.false_hits, "%"),
                "capped" => (&mut bounds.capped, "%"),
                "nan" => (&mut bounds.nan, "%"),
                "undecided" => (&mut bounds.undecided, "%"),
                "depth" => (&mut bounds.depth, "px"),
                _ => return Err(format!("`{name}` is no bound")),
            };
            *place = value.parse().map_err(|_| format!("`{value}` is no number"))?;
            if words.next() != Some(unit) {
                return Err(format!("`{name}` is in {unit}"));
            }
        }
        Ok(bounds)
    }
}
