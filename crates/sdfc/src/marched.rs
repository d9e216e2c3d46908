//! Chooses the ray method that draws a scene, and adds what it needs to the program.

use std::borrow::Cow;

use sdfc_graph::Program;
use sdfc_march::{FALLBACK_METHOD, METHODS, method, stubs};
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
    pub method: String,
    /// One line that says why the method differs from the requested one, or what is not certain.
    pub note: Option<String>,
}

impl Scene {
    /// The ray method that pictures are drawn with by default: the scene's, or `auto`.
    pub fn method(&self) -> &str {
        self.program.settings.march.method.as_deref().unwrap_or(sdfc_march::METHODS[0].name)
    }

    /// The program and the method that draw pictures on a GPU if `name` is requested.
    pub fn marched(&self, name: &str) -> Marched<'_> {
        let method = self.marched_by(name);
        let program = with_segment_bounds(self.drawn(), method);
        Marched { program, method: method.to_owned(), note: self.why_marched_by(name) }
    }

    /// The program and the method that draw pictures on the CPU if `name` is requested. `auto`
    /// replaces the methods that the CPU renderer does not have.
    pub fn marched_on_cpu(&self, name: &str) -> Marched<'_> {
        let auto = METHODS[0].name;
        let (known, other) = match method(name) {
            Some(found) if !CpuScene::METHODS.contains(&found.name) => (
                auto,
                Some(format!("the CPU renderer has no method `{name}`, `{auto}` is used instead")),
            ),
            Some(_) | None => (name, None),
        };
        let method = self.marched_by(known);
        let program = with_segment_bounds(self.drawn(), method);
        let notes: Vec<String> = other.into_iter().chain(self.why_marched_by(known)).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        Marched { program, method: method.to_owned(), note }
    }

    /// The ray method that draws if `name` is requested.
    ///
    /// For an uncertified field `auto` falls back to `interval`, so that no surface is missed,
    /// unless the rays of a trial run out of steps with it.
    pub fn marched_by<'n>(&self, name: &'n str) -> &'n str {
        let is_auto = METHODS.first().is_some_and(|auto| auto.name == name);
        if is_auto && !self.is_certified() && self.intervals_end() { FALLBACK_METHOD } else { name }
    }

    /// Returns one line that explains the choice of [`Scene::marched_by`]. `None` if the field is
    /// certified or `name` is not `auto`.
    pub(crate) fn why_marched_by(&self, name: &str) -> Option<String> {
        let is_auto = METHODS.first().is_some_and(|auto| auto.name == name);
        if !is_auto || self.is_certified() {
            return None;
        }
        Some(if self.intervals_end() {
            format!("the field is uncertified: `{name}` falls back to `{FALLBACK_METHOD}`")
        } else {
            format!(
                "the field is uncertified and its bounds are too wide for `{FALLBACK_METHOD}`: \
                 `{name}` treats the field as a distance"
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
        let program = with_segment_bounds(self.drawn(), FALLBACK_METHOD);
        let depths = CpuScene::new(&program)?.depth_map::<f32>(&view, &frame, FALLBACK_METHOD)?;
        let ended = |status: u32| status == HIT || status == MISS;
        Ok(depths.pixels().iter().filter(|pixel| !ended(pixel.status)).count())
    }
}

/// Returns the program with the functions that a ray method needs: bounds along ray segments.
pub(crate) fn with_segment_bounds<'p>(program: &'p Program, name: &str) -> Cow<'p, Program> {
    let calls = |stub| method(name).is_some_and(|method| method.calls(stub));
    let (range, slope) = (calls(stubs::RANGE), calls(stubs::SLOPE_RANGE));
    if range || slope {
        Cow::Owned(program.with_segment_bounds(range, slope))
    } else {
        Cow::Borrowed(program)
    }
}
