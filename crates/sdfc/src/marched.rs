//! Chooses the ray method that draws a scene, and adds what it needs to the program.

use std::borrow::Cow;

use sdfc_graph::Program;
use sdfc_march::{Method, stubs};
use sdfc_render::{CpuScene, View};

use crate::error::Error;
use crate::scene::Scene;

/// Size in pixels of the picture whose rays are traced on the CPU to test `interval`.
const TRIAL_SIZE: [u32; 2] = [8, 6];
/// The pixels of the drawn picture are this many times narrower than those of the trial.
const FINER: f64 = 80.0;
/// If more rays of the trial than this are left unproven, all rays are sampled from the start.
const MAX_UNPROVEN: u64 = 12;

/// The most scalar operations of the trial, about a second. A scene that takes more is not proven
/// in a reasonable time either.
const MAX_TRIAL_OPERATIONS: u64 = 1 << 31;

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
        if self.is_planar() {
            return self.unmarched();
        }
        let program = self.with_bounds_for(self.drawn(), method);
        Marched { program, method: self.marched_by(method), note: self.why_marched_by(method) }
    }

    /// The program and the method that draw pictures on the CPU if `method` is requested. `auto`
    /// replaces the methods that the CPU renderer does not have.
    pub fn marched_on_cpu(&self, method: Method) -> Marched<'_> {
        if self.is_planar() {
            return self.unmarched();
        }
        let (known, other) = if CpuScene::METHODS.contains(&method) {
            (method, None)
        } else {
            let auto = Method::Auto;
            let note =
                format!("the CPU renderer has no method `{method}`, `{auto}` is used instead");
            (auto, Some(note))
        };
        let (program, used) = (self.with_bounds_for(self.drawn(), known), self.marched_by(known));
        let notes: Vec<String> = other.into_iter().chain(self.why_marched_by(known)).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        Marched { program, method: used, note }
    }

    /// A planar picture has no rays, so there is no method. The default one stands for it.
    fn unmarched(&self) -> Marched<'_> {
        let (program, method) = (Cow::Borrowed(self.drawn()), Method::default());
        Marched { program, method, note: None }
    }

    /// The ray method that draws if `method` is requested.
    ///
    /// For an uncertified field `auto` falls back to `interval`, so that no surface is missed where
    /// its bounds tell, and no ray steps by the field's value.
    pub fn marched_by(&self, method: Method) -> Method {
        if self.falls_back(method) { Method::FALLBACK } else { method }
    }

    /// Returns true if `method` draws the field by steps as long as its value, although the field
    /// is uncertified: nothing that such a picture shows is proven.
    #[cfg(feature = "render")]
    pub(crate) fn trusts_uncertified(&self, method: Method) -> bool {
        let bounds = [stubs::RANGE, stubs::SLOPE_RANGE];
        let is_bounded = bounds.into_iter().any(|stub| method.definition().calls(stub));
        !self.is_planar() && !self.is_certified() && !is_bounded
    }

    /// Returns a form of the program with the functions that draw it if `method` is requested.
    pub(crate) fn with_bounds_for<'p>(
        &self,
        program: &'p Program,
        method: Method,
    ) -> Cow<'p, Program> {
        if self.falls_back(method) && !self.intervals_prove() {
            // Without bounds `interval` samples all rays.
            return Cow::Borrowed(program);
        }
        with_segment_bounds(program, self.marched_by(method))
    }

    /// Returns one line that explains the choice of [`Scene::marched_by`]. `None` if the field is
    /// certified or `method` is not `auto`.
    pub(crate) fn why_marched_by(&self, method: Method) -> Option<String> {
        if !self.falls_back(method) {
            return None;
        }
        let fallback = Method::FALLBACK;
        Some(if self.intervals_prove() {
            format!("the field is uncertified: `{method}` falls back to `{fallback}`")
        } else {
            format!(
                "the field is uncertified and its bounds are too wide for a proof: `{method}` \
                 falls back to `{fallback}`, which samples the rays at short steps here"
            )
        })
    }

    fn falls_back(&self, method: Method) -> bool {
        method == Method::Auto && !self.is_certified()
    }

    fn intervals_prove(&self) -> bool {
        // A scene without a valid view has no picture either.
        let tried = || self.unproven_by_intervals().unwrap_or(0) <= MAX_UNPROVEN;
        *self.intervals_prove.get_or_init(tried)
    }

    /// Returns how many rays of the trial are left unproven, as far as that matters.
    fn unproven_by_intervals(&self) -> Result<u64, Error> {
        let frame = self.defaults();
        let view = self.view(&frame, TRIAL_SIZE)?;
        let view = View { tolerance: view.tolerance / FINER, ..view };
        let program = with_segment_bounds(self.drawn(), Method::FALLBACK);
        let scene = CpuScene::new(&program)?;
        let (method, most, work) = (Method::FALLBACK, MAX_UNPROVEN, MAX_TRIAL_OPERATIONS);
        Ok(scene.unproven_rays(&view, &frame, method, most, work)?)
    }
}

/// Returns the program with the functions that a ray method needs: bounds along ray segments.
pub(crate) fn with_segment_bounds(program: &Program, method: Method) -> Cow<'_, Program> {
    let definition = method.definition();
    let (range, slope) = (definition.calls(stubs::RANGE), definition.calls(stubs::SLOPE_RANGE));
    if (range || slope) && !program.is_planar() {
        Cow::Owned(program.with_segment_bounds(range, slope))
    } else {
        Cow::Borrowed(program)
    }
}
