//! What a ray method wants of a scene beside its field, and what `auto` is where the field promises nothing.

use std::borrow::Cow;

use sdfc_graph::Program;
use sdfc_march::{FALLBACK_METHOD, METHODS, method, stubs};
use sdfc_render::{CpuScene, HIT, MISS, View};

use crate::{Error, Scene};

/// Rays that are tried on the CPU, as a picture of so many pixels.
const TRIED: [u32; 2] = [8, 6];
/// The pixels of the picture that they stand for are so many times narrower.
const FINER: f64 = 80.0;
/// Most rays out of steps.
const MOST_CAPPED: usize = 1;

/// A scene as a ray method marches it: see [`Scene::marched`].
#[derive(Clone, Debug)]
pub struct Marched<'s> {
    /// The program that pictures are drawn by, with what the method asks for beside the field.
    pub program: Cow<'s, Program>,
    /// The method that marches.
    pub method: String,
    /// Why it is another than the one asked for, or what it cannot promise, in one line.
    pub note: Option<String>,
}

impl Scene {
    /// The method that pictures are marched with unless told otherwise.
    pub fn method(&self) -> &str {
        self.program.settings.march.method.as_deref().unwrap_or(sdfc_march::METHODS[0].name)
    }

    /// What draws pictures where the ray method of that name is asked for, on an adapter.
    pub fn marched(&self, name: &str) -> Marched<'_> {
        let method = self.marched_by(name);
        let program = with_stretches(self.drawn(), method);
        Marched { program, method: method.to_owned(), note: self.why_marched_by(name) }
    }

    /// The same on the CPU, which has few of the methods: `auto` stands in for the others.
    pub fn marched_on_cpu(&self, name: &str) -> Marched<'_> {
        let auto = METHODS[0].name;
        let (known, other) = match method(name) {
            Some(found) if !CpuScene::METHODS.contains(&found.name) => {
                (auto, Some(format!("the CPU renderer has no method `{name}`, `{auto}` stands in")))
            }
            Some(_) | None => (name, None),
        };
        let method = self.marched_by(known);
        let program = with_stretches(self.drawn(), method);
        let notes: Vec<String> = other.into_iter().chain(self.why_marched_by(known)).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        Marched { program, method: method.to_owned(), note }
    }

    /// The ray method that marches where one is asked for by name: `auto` is `interval` where the field may exceed the
    /// distance, so that nothing is missed, unless intervals do not end on it within the steps that a ray has.
    pub fn marched_by<'n>(&self, name: &'n str) -> &'n str {
        let is_auto = METHODS.first().is_some_and(|auto| auto.name == name);
        if is_auto && !self.is_certified() && self.intervals_end() { FALLBACK_METHOD } else { name }
    }

    /// Why [`Scene::marched_by`] says what it does, in one line; `None` where the field is certified or another method
    /// than `auto` is asked for.
    pub(crate) fn why_marched_by(&self, name: &str) -> Option<String> {
        let is_auto = METHODS.first().is_some_and(|auto| auto.name == name);
        if !is_auto || self.is_certified() {
            return None;
        }
        Some(if self.intervals_end() {
            format!("the field is uncertified: `{name}` is `{FALLBACK_METHOD}`")
        } else {
            format!(
                "the field is uncertified and its bounds are too wide for `{FALLBACK_METHOD}`: \
                 `{name}` takes it for the distance"
            )
        })
    }

    fn intervals_end(&self) -> bool {
        // A scene of which no ray can be tried has no picture either.
        let tried = || self.capped_by_intervals().unwrap_or(0) <= MOST_CAPPED;
        *self.intervals_end.get_or_init(tried)
    }

    /// How many of a few rays run out of steps.
    fn capped_by_intervals(&self) -> Result<usize, Error> {
        let frame = self.defaults();
        let view = self.view(&frame, TRIED)?;
        let view = View { tolerance: view.tolerance / FINER, ..view };
        let program = with_stretches(self.drawn(), FALLBACK_METHOD);
        let depths = CpuScene::new(&program)?.depth_map::<f32>(&view, &frame, FALLBACK_METHOD)?;
        let ended = |status: u32| status == HIT || status == MISS;
        Ok(depths.pixels().iter().filter(|pixel| !ended(pixel.status)).count())
    }
}

/// A program with what the method of that name asks for: bounds along stretches of rays, where it looks at such.
pub(crate) fn with_stretches<'p>(program: &'p Program, name: &str) -> Cow<'p, Program> {
    let calls = |stub| method(name).is_some_and(|method| method.calls(stub));
    let (range, slope) = (calls(stubs::RANGE), calls(stubs::SLOPE_RANGE));
    if range || slope {
        Cow::Owned(program.with_segment_bounds(range, slope))
    } else {
        Cow::Borrowed(program)
    }
}
