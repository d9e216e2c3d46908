//! The oracle's verdict on every pixel of a picture.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use sdfc_graph::eval::FrameValues;

use crate::camera::Camera;
use crate::edges::{Kind, edges};
use crate::oracle::{Oracle, Prober, Ray, Verdict};

/// The oracle's verdict on every pixel.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The camera.
    pub camera: Camera,
    /// The verdict for each pixel, row by row.
    pub verdicts: Vec<Verdict>,
    /// The kind of each pixel.
    pub kinds: Vec<Kind>,
    /// Total number of interval evaluations.
    pub evaluations: u64,
}

/// Numbers of pixels by verdict and kind. Edge and undecided pixels count once, as such.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counts {
    /// Plain pixels that hit the surface.
    pub hit: u64,
    /// Plain pixels that hit nothing.
    pub miss: u64,
    /// Pixels within one pixel of a silhouette.
    pub edge: u64,
    /// Undecided pixels.
    pub undecided: u64,
}

/// Number of pixels that a thread processes at a time.
const GROUP: usize = 64;

impl Truth {
    /// Asks the oracle about every pixel, on all threads. After each group of pixels, `progress` is
    /// called with their number, from any thread.
    pub fn find(
        oracle: &Oracle,
        frame: &FrameValues,
        camera: Camera,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Self {
        let goes_on = |pixels| {
            progress(pixels);
            true
        };
        Self::of(camera, &looks(oracle, frame, &camera, &goes_on))
    }

    /// Like [`Truth::find`], but returns `None` as soon as `progress` returns false.
    pub fn find_while(
        oracle: &Oracle,
        frame: &FrameValues,
        camera: Camera,
        progress: &(dyn Fn(usize) -> bool + Sync),
    ) -> Option<Self> {
        let stopped = AtomicBool::new(false);
        let goes_on = |pixels| {
            let on = progress(pixels);
            stopped.fetch_or(!on, Ordering::Relaxed);
            on
        };
        let found = looks(oracle, frame, &camera, &goes_on);
        (!stopped.into_inner()).then(|| Self::of(camera, &found))
    }

    fn of(camera: Camera, found: &[Look]) -> Self {
        let verdicts: Vec<Verdict> = found.iter().map(|(verdict, ..)| *verdict).collect();
        let gradients: Vec<[f64; 3]> = found.iter().map(|(_, gradient, _)| *gradient).collect();
        let kinds = edges(&camera, &verdicts, &gradients);
        let evaluations = found.iter().map(|(.., count)| u64::from(*count)).sum();
        Self { camera, verdicts, kinds, evaluations }
    }

    /// Counts the pixels by verdict and kind.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for (kind, verdict) in self.kinds.iter().zip(&self.verdicts) {
            let place = match (kind, verdict) {
                (Kind::Undecided, _) => &mut counts.undecided,
                (Kind::Edge, _) => &mut counts.edge,
                (Kind::Plain, Verdict::Hit(_)) => &mut counts.hit,
                (Kind::Plain, _) => &mut counts.miss,
            };
            *place += 1;
        }
        counts
    }
}

/// A verdict, the gradient at a hit, and the number of evaluations.
type Look = (Verdict, [f64; 3], u32);

/// Probes each pixel, on all threads. Stops as soon as `goes_on` returns false.
fn looks(
    oracle: &Oracle,
    frame: &FrameValues,
    camera: &Camera,
    goes_on: &(dyn Fn(usize) -> bool + Sync),
) -> Vec<Look> {
    let mut found = vec![(Verdict::Miss, [0.0; 3], 0); camera.pixels()];
    let groups = found.par_chunks_mut(GROUP).enumerate();
    // The caller knows if `goes_on` ended it early.
    let _ = groups.try_for_each_init(
        || oracle.prober(frame),
        |prober, (group, pixels)| {
            for (index, place) in pixels.iter_mut().enumerate() {
                *place = look(prober, &camera.ray(group * GROUP + index));
            }
            goes_on(pixels.len()).then_some(())
        },
    );
    found
}

fn look(prober: &mut Prober<'_>, ray: &Ray) -> Look {
    let probe = prober.first_hit(ray);
    let gradient = match probe.verdict {
        Verdict::Hit(t) => prober.gradient(ray.at(t)),
        Verdict::Miss | Verdict::Undecided(_) => [f64::NAN; 3],
    };
    (probe.verdict, gradient, probe.evaluations)
}
