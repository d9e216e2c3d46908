//! The lists of iterations that a picture's loops run.

use naga::{Function, GlobalVariable, Handle, Module};
use rustc_hash::FxHashMap;
use sdfc_graph::{Program, SkipCondition};
use sdfc_march::stubs;

use crate::link::template::{find_function, find_variable};

/// The locations of the lists of iterations that a scene's functions run.
#[derive(Debug)]
pub(crate) struct ActiveLists {
    /// The buffer of the lists.
    pub(crate) lists: Handle<GlobalVariable>,
    /// For each loop, the number of iterations to run and the index of the first one's number.
    pub(crate) spans: Handle<GlobalVariable>,
    /// The counter of iterations that are run; `None` if nothing counts them.
    pub(crate) counter: Option<Handle<GlobalVariable>>,
    /// The function that selects the lists for a point, and the lower bound that it sets on the
    /// distance to what they leave out; `None` if the lists are the same everywhere.
    pub(crate) by_point: Option<(Handle<Function>, Handle<GlobalVariable>)>,
    /// The index of each loop's span.
    loops: FxHashMap<SkipCondition, u32>,
}

impl ActiveLists {
    /// The lists of a picture's module; `None` if all iterations are run.
    pub(crate) fn find(module: &Module, program: &Program) -> Option<Self> {
        let lists = find_variable(module, stubs::ACTIVE_LISTS)?;
        let spans = find_variable(module, stubs::ACTIVE_SPANS)?;
        let counter = find_variable(module, stubs::ITERATIONS_RUN);
        let inactive = find_variable(module, stubs::INACTIVE_DISTANCE);
        let by_point = find_function(module, stubs::SELECT_LISTS).zip(inactive);
        let loops = program.cullable_loops.iter().map(|looped| looped.skip).zip(0..);
        let loops = loops.take(stubs::CULLING_BOUNDS.len()).collect();
        Some(Self { lists, spans, counter, by_point, loops })
    }

    /// The index of a loop's span; a loop is identified by its skip condition.
    pub(crate) fn index_of(&self, inert: Option<SkipCondition>) -> Option<u32> {
        self.loops.get(&inert?).copied()
    }
}
