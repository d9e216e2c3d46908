//! Draws a scene with every ray method and compares the pictures with the oracle's verdict.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use sdfc::{Error, Method, Scene};
use sdfc_codegen::render_module;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{
    Clock, FrameTimes, Gpu, OnProgress, Pipeline, Progress, RenderOptions, View, uniform_values,
};

use crate::chart::{Chart, FrameMs, Row};
use crate::metrics::compare;
use crate::sampler::Sampler;
use crate::scene::{OracleOptions, operations, oracle, truth};

/// Options of [`chart()`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ChartOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The ray methods; empty for all.
    pub methods: Vec<Method>,
    /// True if methods are charted at their defaults only.
    pub defaults_only: bool,
    /// Number of timed frames, after one that is not timed; at least 1.
    pub repetitions: u32,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
}

impl ChartOptions {
    /// The default options: 320 by 180 pixels, all methods at all their settings, three frames.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets width and height in pixels.
    #[must_use]
    pub fn size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// Sets the ray methods; none are all.
    #[must_use]
    pub fn methods(self, methods: Vec<Method>) -> Self {
        Self { methods, ..self }
    }

    /// Sets if methods are charted at their default setting only.
    #[must_use]
    pub fn defaults_only(self, defaults_only: bool) -> Self {
        Self { defaults_only, ..self }
    }

    /// Sets the number of timed frames.
    #[must_use]
    pub fn repetitions(self, repetitions: u32) -> Self {
        Self { repetitions, ..self }
    }

    /// Sets the values of params, time and frame.
    #[must_use]
    pub fn frame(self, frame: FrameValues) -> Self {
        Self { frame: Some(frame), ..self }
    }
}

impl Default for ChartOptions {
    /// As [`ChartOptions::new`].
    fn default() -> Self {
        let (size, methods) = ([320, 180], Vec::new());
        Self { size, methods, defaults_only: false, repetitions: 3, frame: None }
    }
}

/// Draws the scene with every method at several settings, and compares each picture with the
/// oracle's verdict. `progress` counts the pictures and may cancel.
///
/// # Errors
///
/// [`Error::NothingDrawn`], [`Error::Planar`], [`Error::View`], [`Error::Codegen`],
/// [`Error::Render`].
pub fn chart(
    scene: &Scene,
    name: &str,
    gpu: &Gpu,
    options: &ChartOptions,
    oracle_options: OracleOptions<'_>,
    progress: &mut OnProgress<'_>,
) -> Result<Chart, Error> {
    scene.needs_solids("a comparison of ray methods")?;
    let frame = options.frame.clone();
    let frame = frame.unwrap_or_else(|| scene.defaults());
    let view = scene.view(&frame, options.size)?;
    let truth = truth(scene, &view, &frame, oracle_options)?;
    let oracle = oracle(scene)?;

    let methods = match options.methods.is_empty() {
        true => Method::all().collect(),
        false => options.methods.clone(),
    };
    let parts = |method: Method| {
        let all = method.definition().chart_factors.iter().copied();
        all.filter(|part| !options.defaults_only || *part == 1.0)
    };
    let total = methods.iter().map(|method| parts(*method).count() as u64).sum();
    let mut chart = Chart {
        scene: name.to_owned(),
        leaves: scene.report().leaves,
        certified: scene.is_certified(),
        adapter: gpu.info().name.clone(),
        driver: gpu.info().driver.clone(),
        size: options.size,
        made: None,
        oracle: truth.counts(),
        methods: Vec::new(),
    };
    for method in methods {
        let marched = scene.marched(method);
        let program = &marched.program;
        let shader = render_module(program, marched.method)?;
        let pipeline = Pipeline::new(gpu, shader, program.uniforms.len())?;
        let uniforms = uniform_values(program, &frame);
        let sampler = Sampler::new(scene, gpu, method)?;
        for part in parts(method) {
            let view = view.with_scaled_parameter(method.definition().parameter, part);
            let frame_ms = timed(&pipeline, &view, &uniforms, options.repetitions)?;
            let samples = sampler.samples(&view, &frame)?;
            let metrics = compare(&oracle, &frame, &truth, &samples);
            let set = method
                .definition()
                .parameter
                .map(|parameter| (parameter.name(), view.parameter(parameter)));
            let settings = BTreeMap::from_iter(set);
            let operations = operations(scene, &marched, metrics.evaluations.mean);
            let default = part == 1.0;
            let row = Row::new(method.name(), settings, default, &metrics, operations, frame_ms);
            chart.methods.push(row);
            let done = chart.methods.len() as u64;
            if let ControlFlow::Break(()) = progress(Progress { done, total }) {
                return Err(Error::Render(sdfc_render::RenderError::Cancelled));
            }
        }
    }
    chart.mark_front();
    Ok(chart)
}

/// Measures the time of a frame.
fn timed(
    pipeline: &Pipeline,
    view: &View,
    uniforms: &[[f32; 4]],
    repetitions: u32,
) -> Result<FrameMs, Error> {
    let draw = || {
        let options = RenderOptions::default();
        pipeline.render(view, uniforms, &options, &mut sdfc_render::no_progress)
    };
    let first = draw()?;
    let mut times = Vec::new();
    for _ in 0..repetitions.max(1) {
        times.push(draw()?.milliseconds);
    }
    let times = FrameTimes::of(&times, first.clock).ok_or(Error::NothingDrawn)?;
    let clock = match first.clock {
        Clock::Gpu => "gpu",
        Clock::Wall => "wall",
    };
    Ok(FrameMs { median: times.median, clock })
}
#[cfg(test)]
mod tests {
    use sdfc_lang::settings::RAY_METHODS;
    use sdfc_march::Method;

    /// The language cannot depend on the crate that has the methods.
    #[test]
    fn a_scene_may_name_the_methods_that_are_for_users() {
        let for_users: Vec<&str> = Method::for_users().map(Method::name).collect();
        assert_eq!(for_users, RAY_METHODS);
    }

    #[test]
    fn a_chart_includes_every_method_at_its_default() {
        for method in Method::all() {
            assert!(method.definition().chart_factors.contains(&1.0), "{method}");
        }
    }
}
