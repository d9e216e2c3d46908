//! The shader that finds out, before a picture, which rounds of loops can matter to rays from the eye.

use naga::{Function, GlobalVariable, Handle, Module};
use rustc_hash::FxHashMap;
use sdfc_graph::{CullableLoop, Program, SkipCondition};
use sdfc_march::{Features, culling_source, stubs};

use crate::inputs::declare_slots;
use crate::lower::function_of_round;
use crate::picture::{LISTS, SLOTS, skeleton, used_slots};
use crate::reflect::Parts;
use crate::tables::Tables;
use crate::{Error, Shader, link};

/// A shader to run before a picture's, on the tiles that it is to draw.
///
/// Its entry points are `mark`, one invocation for each 32 rounds (x), tile of the level (y) and loop (z), to be run for each level from the
/// highest down, and `list`, one for each tile (x), both in workgroups of 64 by 1. Those for cells are `least_of_groups` and
/// `mark_groups`, one for each group of cells (x), 32 rounds (y) and loop (z), and `list_cells`, one for each cell (x). Its bindings are those
/// of the picture, in place of the pixels storage arrays of words, at 4 `active_lists`, which the picture reads, at 5 `masks`, and at 7 `counters`, and
/// at 6 the uniform `level`.
#[derive(Debug)]
pub struct Culling {
    /// The shader.
    pub shader: Shader,
    /// How many iterations each loop has.
    pub iterations: Vec<u32>,
    /// Whether rays go by cells, and if so for each loop whether no round need be visited outside all cells.
    pub cells: Option<Vec<bool>>,
}

/// What finds the rounds that matter, if the program has loops that can do without some.
pub(crate) fn culling(program: &Program, features: Features) -> Result<Option<Culling>, Error> {
    if !features.culled {
        return Ok(None);
    }
    let visits: Vec<&CullableLoop> =
        program.cullable_loops.iter().take(stubs::CULLING_BOUNDS.len()).collect();
    let roots: Vec<_> = visits.iter().map(|visit| visit.culling_bounds).collect();
    let used = used_slots(program, roots.clone());
    let mut module = skeleton(&culling_source(), features, &used, &[])?;
    let (mut inputs, load_frame) = declare_slots(&mut module, program, &used, SLOTS);
    if let Some(load_frame) = load_frame {
        link::fill(&mut module, stubs::LOAD_FRAME, load_frame)?;
    }
    inputs.tables = Tables::in_buffer(LISTS);
    inputs.tables.declare(&mut module, program, &roots)?;
    for (stub, root) in stubs::CULLING_BOUNDS.into_iter().zip(roots) {
        let function = function_of_round(program, &inputs, &mut module.types, stub, root)?;
        link::fill(&mut module, stub, function)?;
    }
    let parts = Parts { lists: inputs.tables.into_buffer(), ..Parts::default() };
    let shader = Shader::new(module, parts, features)?;
    let iterations = visits.iter().map(|visit| visit.iterations).collect();
    let is_joined = || visits.iter().map(|visit| visit.is_union_operand).collect();
    Ok(Some(Culling { shader, iterations, cells: features.culls_by_cell().then(is_joined) }))
}

/// Where functions find which rounds to visit.
#[derive(Debug)]
pub(crate) struct Visits {
    /// The lists.
    pub(crate) lists: Handle<GlobalVariable>,
    /// How many rounds of each loop to visit, and where the first one's number stands.
    pub(crate) spans: Handle<GlobalVariable>,
    /// What counts the rounds that are visited; none: nothing does.
    pub(crate) visited: Option<Handle<GlobalVariable>>,
    /// What sets that for a place, and how near what is left out can be there; none: it is the same everywhere.
    pub(crate) at: Option<(Handle<Function>, Handle<GlobalVariable>)>,
    /// The place of each loop's span.
    loops: FxHashMap<SkipCondition, u32>,
}

impl Visits {
    /// Those of a picture's module; `None` where all rounds are visited.
    pub(crate) fn of(module: &Module, program: &Program) -> Option<Self> {
        let lists = link::find_variable(module, stubs::ACTIVE_LISTS)?;
        let spans = link::find_variable(module, stubs::ACTIVE_SPANS)?;
        let visited = link::find_variable(module, stubs::ITERATIONS_RUN);
        let free = link::find_variable(module, stubs::INACTIVE_DISTANCE);
        let at = link::find_function(module, stubs::SELECT_LISTS).zip(free);
        let loops = program.cullable_loops.iter().map(|visit| visit.skip).zip(0..);
        let loops = loops.take(stubs::CULLING_BOUNDS.len()).collect();
        Some(Self { lists, spans, visited, at, loops })
    }

    /// The place of a loop's span, by what it says of its rounds.
    pub(crate) fn number(&self, inert: Option<SkipCondition>) -> Option<u32> {
        self.loops.get(&inert?).copied()
    }
}
