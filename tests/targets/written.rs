//! Every part of every example in every target, written once for all tests.

use std::sync::OnceLock;

use libtest_mimic::Failed;
use rayon::prelude::*;
use sdfc::{Code, Scene, Target};
use sdfc_tests::compiled_examples;
use sdfc_tests::validators::{PARTS, Part, write};

/// A part of an example in a target.
pub struct Written {
    pub example: &'static str,
    pub scene: &'static Scene,
    pub target: Target,
    pub part: Part,
    /// The shader, or why there is none.
    pub code: Result<Code, String>,
}

/// Returns the parts of all examples, sorted by the path of the example.
pub fn all() -> Result<&'static [Written], Failed> {
    static ALL: OnceLock<Result<Vec<Written>, String>> = OnceLock::new();
    let write_all = || {
        let examples = compiled_examples();
        let examples = examples.map_err(|e| e.message().unwrap_or_default().to_owned())?;
        Ok(examples.par_iter().flat_map_iter(|(name, scene)| of(name, scene)).collect())
    };
    ALL.get_or_init(write_all).as_deref().map_err(|error| error.as_str().into())
}

fn of(example: &'static str, scene: &'static Scene) -> impl Iterator<Item = Written> {
    let parts = Target::ALL.into_iter().flat_map(|target| PARTS.map(|part| (target, part)));
    parts.map(move |(target, part)| {
        let code = write(scene, target, part).map_err(|e| e.to_string());
        Written { example, scene, target, part, code }
    })
}
