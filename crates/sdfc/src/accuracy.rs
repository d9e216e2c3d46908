//! A scene's pictures against the oracle.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use sdfc_accuracy::chart::{Chart, FrameMs, Row};
use sdfc_accuracy::{Camera, Oracle, OracleError, PixelSample, Status, Truth, compare};
use sdfc_codegen::render_module;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{
    Clock, FrameTimes, Gpu, HIT, Image, MISS, OnProgress, Pipeline, Progress, RenderOptions, View,
    uniform_values,
};

use crate::{Error, Scene};

/// How a chart is made.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Names of the ray methods; empty for all.
    pub methods: Vec<String>,
    /// Frames that are timed, after one that is not; at least 1.
    pub repetitions: u32,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
}

impl Default for ChartOptions {
    /// 320 by 180, all methods, three frames each.
    fn default() -> Self {
        Self { size: [320, 180], methods: Vec::new(), repetitions: 3, frame: None }
    }
}

/// A setting of a method: its name, its value in the view's units, and whether it is the default.
type Setting = (&'static str, f64, bool);

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
        let camera = camera(view);
        let (total, done) = (camera.pixels() as u64, AtomicUsize::new(0));
        let report = |pixels| {
            let done = done.fetch_add(pixels, Ordering::Relaxed) + pixels;
            progress(Progress { done: done as u64, total });
        };
        Ok(Truth::find(&self.oracle()?, frame, camera, &report))
    }

    /// The view of a frame that a picture of that size has.
    ///
    /// # Errors
    ///
    /// [`Error::View`].
    pub fn view(&self, frame: &FrameValues, size: [u32; 2]) -> Result<View, Error> {
        Ok(View::new(&self.program, frame, self.bounds_at(frame), size)?)
    }

    /// The scene's field, to be asked where rays meet it.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Evaluate`].
    pub fn oracle(&self) -> Result<Oracle, Error> {
        Oracle::new(&self.program).map_err(|error| match error {
            OracleError::NothingDrawn => Error::NothingDrawn,
            OracleError::NotFlat(error) => Error::Evaluate(error),
        })
    }

    /// Draws the scene with every method at several settings and compares each picture with the oracle's
    /// verdict. `on_truth` counts its pixels, `progress` the pictures and may cancel.
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
        on_truth: &(dyn Fn(Progress) + Sync),
        progress: &mut OnProgress<'_>,
    ) -> Result<Chart, Error> {
        let frame = options.frame.clone();
        let frame = frame.unwrap_or_else(|| FrameValues::defaults(self.params()));
        let view = self.view(&frame, options.size)?;
        let truth = self.truth(&view, &frame, on_truth)?;
        let oracle = self.oracle()?;

        let all = || sdfc_march::METHODS.iter().map(|method| method.name.to_owned()).collect();
        let names: Vec<String> =
            if options.methods.is_empty() { all() } else { options.methods.clone() };
        let total = names.iter().map(|name| settings(name, &view).len() as u64).sum();
        let mut chart = Chart {
            scene: name.to_owned(),
            leaves: self.report.leaves,
            adapter: gpu.info().name.clone(),
            driver: gpu.info().driver.clone(),
            size: options.size,
            oracle: truth.counts(),
            methods: Vec::new(),
        };
        for method in &names {
            let shader = render_module(&self.program, method)?;
            let pipeline = Pipeline::new(gpu, shader, self.program.uniforms.len())?;
            let mut settings = settings(method, &view);
            settings.sort_by(|a, b| b.1.total_cmp(&a.1));
            for setting in settings {
                let view = with(&view, setting);
                let (image, frame_ms) =
                    self.timed(&pipeline, &view, &frame, options.repetitions)?;
                let metrics = compare(&oracle, &frame, &truth, &samples(&image));
                let settings = BTreeMap::from([(setting.0, setting.1)]);
                let operations = self.report.distance.operations;
                let row = Row::new(method, settings, setting.2, &metrics, operations, frame_ms);
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

    /// A picture and the time that it takes.
    fn timed(
        &self,
        pipeline: &Pipeline,
        view: &View,
        frame: &FrameValues,
        repetitions: u32,
    ) -> Result<(Image, FrameMs), Error> {
        let uniforms = uniform_values(&self.program, frame);
        let draw = || {
            let options = RenderOptions::default();
            pipeline.render(view, &uniforms, &options, &mut sdfc_render::unwatched)
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
        Ok((first.image, FrameMs { median: times.median, clock }))
    }
}

/// The settings at which a method is charted. The values are those that the view takes.
fn settings(method: &str, view: &View) -> Vec<Setting> {
    let steps = f64::from(view.steps);
    match method {
        "fixed" => [0.25, 0.5, 1.0, 2.0, 4.0]
            .map(|factor| ("steps", (steps * factor).round(), factor == 1.0))
            .to_vec(),
        "sphere" => [100.0, 10.0, 1.0, 0.1]
            .map(|factor| ("epsilon", view.epsilon * factor, factor == 1.0))
            .to_vec(),
        _ => vec![("steps", steps, true)],
    }
}

fn with(view: &View, (name, value, _): Setting) -> View {
    let mut view = view.clone();
    match name {
        "epsilon" => view.epsilon = value,
        _ => view.steps = value as u32,
    }
    view
}

fn camera(view: &View) -> Camera {
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

fn samples(image: &Image) -> Vec<PixelSample> {
    let pixels = image.pixels().iter();
    pixels
        .map(|pixel| PixelSample {
            status: match pixel.status {
                HIT => Status::Hit,
                MISS => Status::Miss,
                _ => Status::Capped,
            },
            t: f64::from(pixel.depth),
            evaluations: pixel.primary_evaluations,
        })
        .collect()
}
