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
    /// The picture's camera.
    pub camera: Camera,
    /// Of each pixel, row by row.
    pub verdicts: Vec<Verdict>,
    /// Of each pixel.
    pub kinds: Vec<Kind>,
    /// Evaluations over intervals, in all.
    pub evaluations: u64,
}

/// Pixels by verdict and kind. An edge or undecided pixel is one of them and nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counts {
    /// Meet the surface.
    pub hit: u64,
    /// Meet nothing.
    pub miss: u64,
    /// Within a pixel of a silhouette.
    pub edge: u64,
    /// Not known.
    pub undecided: u64,
}

/// Pixels that one thread takes at a time.
const GROUP: usize = 64;

impl Truth {
    /// Asks the oracle about every pixel, on all threads. `progress` is told after each group how many pixels it had, and is called from any thread.
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

    /// As [`Truth::find`], unless `progress` says that it is not to go on: then there is none.
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

    /// How many pixels are what.
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

/// A verdict, the gradient where it is a hit, and what it took.
type Look = (Verdict, [f64; 3], u32);

/// Of each pixel, on all threads. Once `goes_on` denies it, the rest is left out.
fn looks(
    oracle: &Oracle,
    frame: &FrameValues,
    camera: &Camera,
    goes_on: &(dyn Fn(usize) -> bool + Sync),
) -> Vec<Look> {
    let mut found = vec![(Verdict::Miss, [0.0; 3], 0); camera.pixels()];
    let groups = found.par_chunks_mut(GROUP).enumerate();
    // What ends it early is known to who denied it.
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
