//! Chooses the ray method that draws a scene, and adds what it needs to the program.

use std::borrow::Cow;

use sdfc_graph::Program;
use sdfc_march::{Method, stubs};
use sdfc_render::{CpuScene, HIT, MISS, View};

use crate::error::Error;
use crate::scene::Scene;

/// Size in pixels of the picture whose rays are traced on the CPU to test `interval`.
const TRIAL_SIZE: [u32; 2] = [8, 6];
/// The pixels of the drawn picture are this many times narrower than those of the trial.
const FINER: f64 = 80.0;
/// At most this many rays of the trial may run out of steps.
const MAX_CAPPED: usize = 1;

/// A program with the ray method that marches it: see [`Scene::marched`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Marched<'s> {
    /// The program that pictures are drawn with, including what the method needs beside the field.
    pub program: Cow<'s, Program>,
    /// The method that marches.
    pub method: Method,
    /// One line that says why the method differs from the requested one, or what is not certain.
    pub note: Option<String>,
}

impl Scene {
    /// The ray method that pictures are drawn with by default: the scene's, or `auto`.
    pub fn method(&self) -> Method {
        let name = self.program.settings.march.method.as_deref();
        // The checker refuses names that no method has.
        name.and_then(|name| name.parse().ok()).unwrap_or_default()
    }

    /// The program and the method that draw pictures on a GPU if `method` is requested.
    pub fn marched(&self, method: Method) -> Marched<'_> {
        let used = self.marched_by(method);
        let program = with_segment_bounds(self.drawn(), used);
        Marched { program, method: used, note: self.why_marched_by(method) }
    }

    /// The program and the method that draw pictures on the CPU if `method` is requested. `auto`
    /// replaces the methods that the CPU renderer does not have.
    pub fn marched_on_cpu(&self, method: Method) -> Marched<'_> {
        let (known, other) = if CpuScene::METHODS.contains(&method) {
            (method, None)
        } else {
            let auto = Method::Auto;
            let note =
                format!("the CPU renderer has no method `{method}`, `{auto}` is used instead");
            (auto, Some(note))
        };
        let used = self.marched_by(known);
        let program = with_segment_bounds(self.drawn(), used);
        let notes: Vec<String> = other.into_iter().chain(self.why_marched_by(known)).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        Marched { program, method: used, note }
    }

    /// The ray method that draws if `method` is requested.
    ///
    /// For an uncertified field `auto` falls back to `interval`, so that no surface is missed,
    /// unless the rays of a trial run out of steps with it.
    pub fn marched_by(&self, method: Method) -> Method {
        let falls_back = method == Method::Auto && !self.is_certified() && self.intervals_end();
        if falls_back { Method::FALLBACK } else { method }
    }

    /// Returns one line that explains the choice of [`Scene::marched_by`]. `None` if the field is
    /// certified or `method` is not `auto`.
    pub(crate) fn why_marched_by(&self, method: Method) -> Option<String> {
        if method != Method::Auto || self.is_certified() {
            return None;
        }
        let fallback = Method::FALLBACK;
        Some(if self.intervals_end() {
            format!("the field is uncertified: `{method}` falls back to `{fallback}`")
        } else {
            format!(
                "the field is uncertified and its bounds are too wide for `{fallback}`: \
                 `{method}` treats the field as a distance"
            )
        })
    }

    fn intervals_end(&self) -> bool {
        // A scene without a valid view has no picture either.
        let tried = || self.capped_by_intervals().unwrap_or(0) <= MAX_CAPPED;
        *self.intervals_end.get_or_init(tried)
    }

    /// Returns how many rays of the trial run out of steps.
    fn capped_by_intervals(&self) -> Result<usize, Error> {
        let frame = self.defaults();
        let view = self.view(&frame, TRIAL_SIZE)?;
        let view = View { tolerance: view.tolerance / FINER, ..view };
        let program = with_segment_bounds(self.drawn(), Method::FALLBACK);
        let depths = CpuScene::new(&program)?.depth_map::<f32>(&view, &frame, Method::FALLBACK)?;
        let ended = |status: u32| status == HIT || status == MISS;
        Ok(depths.pixels().iter().filter(|pixel| !ended(pixel.status)).count())
    }
}

/// Returns the program with the functions that a ray method needs: bounds along ray segments.
pub(crate) fn with_segment_bounds(program: &Program, method: Method) -> Cow<'_, Program> {
    let definition = method.definition();
    let (range, slope) = (definition.calls(stubs::RANGE), definition.calls(stubs::SLOPE_RANGE));
    if range || slope {
        Cow::Owned(program.with_segment_bounds(range, slope))
    } else {
        Cow::Borrowed(program)
    }
}
