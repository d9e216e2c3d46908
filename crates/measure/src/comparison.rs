//! Compares pictures of a view with the oracle's verdict on each pixel.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use sdfc::{Error, Scene};
use sdfc_graph::eval::FrameValues;
use sdfc_render::{Image, Progress, RenderError, View};

use crate::camera::Camera;
use crate::metrics::{Metrics, PixelSample, compare};
use crate::oracle::Oracle;
use crate::sampler::status;
use crate::scene::oracle;
use crate::truth::{Counts, Truth};

/// A view of a scene, with the oracle's verdict on every pixel.
#[derive(Debug)]
pub struct Comparison {
    oracle: Oracle,
    view: View,
    frame: FrameValues,
    truth: Truth,
}

impl Comparison {
    /// Asks the oracle about every pixel of a view.
    ///
    /// `progress` counts pixels, is called from any thread, and may cancel.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Evaluate`]; [`Error::Render`] if `progress` cancelled.
    pub fn new(
        scene: &Scene,
        view: View,
        frame: FrameValues,
        progress: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
    ) -> Result<Self, Error> {
        let oracle = oracle(scene)?;
        let camera = Camera::of(&view);
        let (total, done) = (camera.pixels() as u64, AtomicUsize::new(0));
        let goes_on = |pixels| {
            let done = (done.fetch_add(pixels, Ordering::Relaxed) + pixels) as u64;
            progress(Progress { done, total }).is_continue()
        };
        let truth = Truth::find_while(&oracle, &frame, camera, &goes_on)
            .ok_or(Error::Render(RenderError::Cancelled))?;
        Ok(Self { oracle, view, frame, truth })
    }

    /// The view.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The frame's values.
    pub fn frame(&self) -> &FrameValues {
        &self.frame
    }

    /// Numbers of pixels by the oracle's verdict.
    pub fn counts(&self) -> Counts {
        self.truth.counts()
    }

    /// Compares a picture of the view, drawn with one ray per pixel. A picture stores no normals,
    /// so the metrics have no errors of normals.
    pub fn metrics(&self, image: &Image) -> Metrics {
        let sample = |pixel: &sdfc_march::PixelBlock| PixelSample {
            status: status(pixel),
            t: f64::from(pixel.depth),
            evaluations: pixel.primary_evaluations,
            normal: None,
        };
        let samples: Vec<PixelSample> = image.pixels().iter().map(sample).collect();
        compare(&self.oracle, &self.frame, &self.truth, &samples)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU64;

    use sdfc_march::{Method, MethodParameter};
    use sdfc_render::{CpuScene, RenderOptions, no_progress};

    use super::*;

    const SIZE: [u32; 2] = [48, 32];

    fn scene() -> Scene {
        let text = "union(sphere(0.5), box(0.4).translate(x: 0.5), blend: smooth(0.2))\n\
                    camera(eye: [0, 1, 3], target: 0, fov: 40deg)";
        sdfc::Compiler::new().compile("blend.sdf", text).expect("compiles")
    }

    #[test]
    fn a_coarser_picture_has_greater_errors() {
        let scene = scene();
        let frame = FrameValues::defaults(scene.params());
        let view = scene.view(&frame, SIZE).expect("a view");
        let goes_on = |_| ControlFlow::Continue(());
        let compared = Comparison::new(&scene, view, frame, &goes_on).expect("a verdict");
        let counts = compared.counts();
        assert!(counts.hit > 100 && counts.undecided == 0, "{counts:?}");
        let cpu = CpuScene::new(scene.drawn()).expect("evaluates");
        let error = |epsilon: f64| {
            let view = compared.view().with_parameter(MethodParameter::Epsilon, epsilon);
            let options = RenderOptions::default();
            let method = Method::Sphere;
            let drawn = cpu.render(&view, compared.frame(), method, &options, &mut no_progress);
            compared.metrics(&drawn.expect("a picture").image)
        };
        let (fine, coarse) = (error(1e-4), error(0.1));
        assert_eq!(fine.missed + fine.false_hits, 0, "{fine:?}");
        assert!(fine.depth.pixels.p99 < 0.1 && coarse.depth.pixels.p99 > 0.3, "{coarse:?}");
        assert!(fine.evaluations.mean > coarse.evaluations.mean);
    }

    #[test]
    fn a_cancelled_comparison_stops() {
        let scene = scene();
        let frame = FrameValues::defaults(scene.params());
        let view = scene.view(&frame, [640, 480]).expect("a view");
        let calls = AtomicU64::new(0);
        let stops = |_| {
            calls.fetch_add(1, Ordering::Relaxed);
            ControlFlow::Break(())
        };
        let cancelled = Comparison::new(&scene, view, frame, &stops);
        assert!(matches!(cancelled, Err(Error::Render(RenderError::Cancelled))));
        assert!(calls.into_inner() < 1000);
    }
}
