//! A scene's pictures against the oracle.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use sdfc_accuracy::chart::{Chart, FrameMs, Row};
use sdfc_accuracy::{Camera, Oracle, OracleError, Truth, TruthStore, compare};
use sdfc_analyze::cost;
use sdfc_codegen::render_module;
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{NodeId, Program};
use sdfc_march::{METHODS, MethodDefinition, method, stubs};
use sdfc_render::{
    Clock, FrameTimes, Gpu, OnProgress, Pipeline, Progress, RenderOptions, View, uniform_values,
};

use crate::marched::with_stretches;
use crate::{Error, Scene};

/// How a chart is made.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Names of the ray methods; empty for all.
    pub methods: Vec<String>,
    /// Whether methods are charted at their defaults only.
    pub defaults_only: bool,
    /// Frames that are timed, after one that is not; at least 1.
    pub repetitions: u32,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
}

impl Default for ChartOptions {
    /// 320 by 180, all methods, three frames each.
    fn default() -> Self {
        let (size, methods) = ([320, 180], Vec::new());
        Self { size, methods, defaults_only: false, repetitions: 3, frame: None }
    }
}

/// How the oracle is asked.
#[derive(Clone, Copy)]
pub struct OracleOptions<'a> {
    /// Is told how many pixels are done; it cannot cancel.
    pub progress: &'a (dyn Fn(Progress) + Sync),
    /// Where its answers are kept; `None` asks anew.
    pub kept: Option<&'a dyn TruthStore>,
}

impl Default for OracleOptions<'_> {
    /// Asks anew and tells nobody.
    fn default() -> Self {
        Self { progress: &|_| (), kept: None }
    }
}

impl Scene {
    /// What the oracle says of a view of the scene. `progress` counts pixels; it cannot cancel.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Evaluate`].
    pub fn truth(
        &self,
        view: &View,
        frame: &FrameValues,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Truth, Error> {
        self.asked(view, frame, OracleOptions { progress, kept: None })
    }

    fn asked(
        &self,
        view: &View,
        frame: &FrameValues,
        options: OracleOptions<'_>,
    ) -> Result<Truth, Error> {
        let camera = camera(view);
        let (total, done) = (camera.pixels() as u64, AtomicUsize::new(0));
        let report = |pixels| {
            let done = done.fetch_add(pixels, Ordering::Relaxed) + pixels;
            (options.progress)(Progress { done: done as u64, total });
        };
        let oracle = self.oracle()?;
        Ok(match options.kept {
            Some(store) => Truth::kept_or_found(store, &oracle, frame, camera, &report),
            None => Truth::find(&oracle, frame, camera, &report),
        })
    }

    /// The scene's field, to be asked where rays meet it.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Evaluate`].
    pub fn oracle(&self) -> Result<Oracle, Error> {
        Oracle::new(self.drawn()).map_err(|error| match error {
            OracleError::NothingDrawn => Error::NothingDrawn,
            OracleError::NotFlat(error) => Error::Evaluate(error),
        })
    }

    /// Draws the scene with every method at several settings and compares each picture with the oracle's
    /// verdict. `progress` counts the pictures and may cancel.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::View`], [`Error::Codegen`] for an unknown method too,
    /// [`Error::Render`].
    pub fn chart(
        &self,
        name: &str,
        gpu: &Gpu,
        options: &ChartOptions,
        asked: OracleOptions<'_>,
        progress: &mut OnProgress<'_>,
    ) -> Result<Chart, Error> {
        let frame = options.frame.clone();
        let frame = frame.unwrap_or_else(|| self.defaults());
        let view = self.view(&frame, options.size)?;
        let truth = self.asked(&view, &frame, asked)?;
        let oracle = self.oracle()?;

        let methods = methods(&options.methods)?;
        let parts = |method: &'static MethodDefinition| {
            let all = method.chart_factors.iter().copied();
            all.filter(|part| !options.defaults_only || *part == 1.0)
        };
        let total = methods.iter().map(|method| parts(method).count() as u64).sum();
        let mut chart = Chart {
            scene: name.to_owned(),
            leaves: self.report.leaves,
            certified: self.is_certified(),
            adapter: gpu.info().name.clone(),
            driver: gpu.info().driver.clone(),
            size: options.size,
            made: None,
            oracle: truth.counts(),
            methods: Vec::new(),
        };
        for method in methods {
            let marched_by = self.marched_by(method.name);
            let program = with_stretches(self.drawn(), marched_by);
            let shader = render_module(&program, marched_by)?;
            let pipeline = Pipeline::new(gpu, shader, program.uniforms.len())?;
            let uniforms = uniform_values(&program, &frame);
            let sampler = self.sampler(gpu, method)?;
            for part in parts(method) {
                let view = view.with_scaled_parameter(method.parameter, part);
                let frame_ms = self.timed(&pipeline, &view, &uniforms, options.repetitions)?;
                let samples = sampler.samples(&view, &frame)?;
                let metrics = compare(&oracle, &frame, &truth, &samples);
                let set = method.parameter.map(|knob| (knob.name(), view.parameter(knob)));
                let settings = BTreeMap::from_iter(set);
                let evaluations = metrics.evaluations.mean;
                let operations = self.operations_of(&program, marched_by, evaluations);
                let default = part == 1.0;
                let row = Row::new(method.name, settings, default, &metrics, operations, frame_ms);
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

    /// Operations of so many evaluations by a method, in a program of [`with_stretches`]. An evaluation by a method that
    /// looks at stretches is the field and what it asks of a stretch, what they share counted once.
    pub(crate) fn operations_of(&self, program: &Program, name: &str, evaluations: f64) -> f64 {
        let Some(method) = method(name) else { return f64::NAN };
        let stretches = [(stubs::RANGE, program.range), (stubs::SLOPE_RANGE, program.slope_range)];
        let asked = stretches.into_iter().filter(|(stub, _)| method.calls(stub));
        let asked: Vec<NodeId> = asked.filter_map(|asked| asked.1).collect();
        if asked.is_empty() {
            return self.report.operations_per_ray(evaluations, method.pre_intersects);
        }
        let roots: Vec<NodeId> = program.distance.into_iter().chain(asked).collect();
        evaluations * cost(&program.graph, &roots).operations as f64
    }

    /// The time that a picture takes.
    fn timed(
        &self,
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
}

/// The methods of those names; all for none.
fn methods(names: &[String]) -> Result<Vec<&'static MethodDefinition>, Error> {
    if names.is_empty() {
        return Ok(METHODS.iter().collect());
    }
    let unknown = |name: &String| sdfc_codegen::Error::UnknownMethod(name.clone());
    let found = |name: &String| method(name).ok_or_else(|| Error::Codegen(unknown(name)));
    names.iter().map(found).collect()
}

pub(crate) fn camera(view: &View) -> Camera {
    Camera {
        size: view.size,
        parallel: view.parallel,
        eye: view.eye.to_array(),
        forward: view.forward.to_array(),
        right: view.right.to_array(),
        up: view.up.to_array(),
        t_max: view.t_max,
        pixel_radius: view.footprint().at(1.0),
    }
}

#[cfg(test)]
mod tests {
    use sdfc_lang::settings::RAY_METHODS;

    use super::*;

    /// The language cannot ask the crate that has the methods.
    #[test]
    fn a_scene_may_name_every_method_but_the_practical() {
        let known: Vec<&str> = METHODS.iter().map(|method| method.name).collect();
        let named: Vec<&str> = RAY_METHODS.into_iter().chain(["practical"]).collect();
        assert_eq!(named, known);
    }

    #[test]
    fn a_chart_shows_every_knob_at_its_default_too() {
        for method in METHODS {
            assert!(method.chart_factors.contains(&1.0), "{}", method.name);
        }
    }
}
