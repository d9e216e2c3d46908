//! The choice between unrolled operands and loops.

use sdfc_graph::{Graph, NodeId, Settings, Shadow, fold_transforms};

use crate::cost::{cost, operations_outside_loops};
use crate::reroll::cullable::cullable_loops;
use crate::reroll::kinds::OperandBounds;
use crate::reroll::rewrite::reroll;

/// The strategy by which the similar operands of a scene become code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoopStrategy {
    /// [`LoopStrategy::Looped`] if loops replace more operations than
    /// [`Report::unrolled_limit`](crate::Report::unrolled_limit), otherwise
    /// [`LoopStrategy::Unrolled`].
    #[default]
    Auto,
    /// Every operand has its own code.
    Unrolled,
    /// Operands that are equal up to constants are loops over lists of these constants.
    Looped,
}

/// Numbers of operations above which loops that skip iterations compile and run faster than
/// unrolled code: in scenes with primary rays only, and in scenes whose secondary rays use the
/// lists of culling cells.
const UNROLLED_LIMITS: [usize; 2] = [425, 1200];
/// Operations to add to the limit for each loop, which costs time to compile and to enter.
const LOOP_COSTS: [usize; 2] = [125, 250];
/// The limit for loops that run all of their iterations.
const LIMIT_WITHOUT_LISTS: usize = 4500;

/// The largest number of operations that stay unrolled where this many cullable loops could
/// replace them.
fn unrolled_limit(settings: &Settings, loops: usize) -> usize {
    if loops == 0 {
        return LIMIT_WITHOUT_LISTS;
    }
    let kind = usize::from(has_secondary_rays(settings));
    UNROLLED_LIMITS[kind] + loops * LOOP_COSTS[kind]
}

impl LoopStrategy {
    /// Decides if a field becomes loops. Also returns the number of operations that loops must
    /// replace at least for [`LoopStrategy::Auto`]. `lipschitz` is as for [`cullable_loops`].
    pub(crate) fn uses_loops(
        self,
        graph: &Graph,
        distance: NodeId,
        settings: &Settings,
        lipschitz: Option<f64>,
    ) -> (bool, usize) {
        let (is_faster, unrolled_limit) = prefers_loops(graph, distance, settings, lipschitz);
        let uses_loops = match self {
            Self::Auto => is_faster,
            Self::Unrolled => false,
            Self::Looped => true,
        };
        (uses_loops, unrolled_limit)
    }
}

/// Decides if loops are faster, and returns the number of operations that they must replace.
fn prefers_loops(
    graph: &Graph,
    distance: NodeId,
    settings: &Settings,
    lipschitz: Option<f64>,
) -> (bool, usize) {
    let operations = cost(graph, &[distance]).operations;
    let limit = unrolled_limit(settings, 1);
    if operations <= limit || operations > LIMIT_WITHOUT_LISTS {
        return (operations > limit, limit);
    }
    // The number of loops is only known once they are built, which happens on a copy of the field.
    let trial = graph.extract(&[distance], &[]);
    let Some(distance) = trial.node(distance) else { return (false, limit) };
    let mut trial = trial.graph;
    let folded = fold_transforms(&mut trial, &[distance]).roots;
    let roots = reroll(&mut trial, &folded, &OperandBounds::default()).roots;
    let limit = unrolled_limit(settings, cullable_loops(&mut trial, &roots, lipschitz).len());
    // What no loop replaces has the same code either way.
    let replaced = operations.saturating_sub(operations_outside_loops(&trial, &roots));
    (replaced > limit, limit)
}

/// True if the field is evaluated on other rays than primary rays.
pub(crate) fn has_secondary_rays(settings: &Settings) -> bool {
    let has_shadows = settings.lights.iter().any(|light| light.shadow != Shadow::Off);
    let has_reflections = settings.reflections.is_some_and(|reflections| reflections.count > 0);
    has_shadows || has_reflections || settings.occlusion.is_some()
}
