//! Every rule that the steps of rays rest on is broken on purpose, one at a time, and a picture has to show it.
//!
//! A rule of the analysis: the scene that stands for it, drawn by plain steps, is right, or the analysis says that
//! nothing is promised; with the rule broken it promises as before, or more, and the picture is wrong. A rule of a ray method: the
//! method's own text with a line changed does worse on its scene than as it stands.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

mod methods;
mod rules;

use libtest_mimic::{Arguments, Failed};
use sdfc::accuracy_data::{Metrics, Truth, compare};
use sdfc::march::Method;
use sdfc::render::{Gpu, View, testing};
use sdfc::{FrameValues, Scene};

/// Width and height in pixels.
const SIZE: [u32; 2] = [96, 72];

fn main() {
    let without_gpu = testing::without_gpu();
    let mut trials = rules::trials();
    trials.extend(methods::trials());
    let trials = trials.into_iter().map(|trial| trial.with_ignored_flag(without_gpu)).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A scene under `tests`, and where its rays really meet it.
struct Subject {
    text: String,
    scene: Scene,
    view: View,
    frame: FrameValues,
    truth: Truth,
}

impl Subject {
    /// Of a path under `tests`, without its ending.
    fn read(path: &str) -> Result<Self, Failed> {
        let path = format!("{}/../../tests/{path}.sdf", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path)?;
        let scene = compiled(&text)?;
        let frame = FrameValues::defaults(scene.params());
        let view = scene.view(&frame, SIZE)?;
        let truth = scene.truth(&view, &frame, &|_| ())?;
        Ok(Self { text, scene, view, frame, truth })
    }

    /// What a method makes of the scene, or of another whose surface is the same.
    fn drawn(&self, scene: &Scene, method: &Method) -> Result<Metrics, Failed> {
        let sampler = scene.sampler(&Gpu::new()?, method)?;
        let samples = sampler.samples(&self.view, &self.frame)?;
        Ok(compare(&self.scene.oracle()?, &self.frame, &self.truth, &samples))
    }
}

fn compiled(text: &str) -> Result<Scene, Failed> {
    let compiled = sdfc::compile("mutant.sdf", text);
    let findings = compiled.diagnostics_text(false);
    compiled.scene.ok_or_else(|| Failed::from(findings))
}

/// Pixels that are plainly wrong.
fn wrong(metrics: &Metrics) -> u64 {
    metrics.missed + metrics.false_hits + metrics.nan + metrics.capped
}
