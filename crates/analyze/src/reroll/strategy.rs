//! Whether a field is written out, or as loops over what is alike in it.

use sdfc_graph::{Graph, NodeId, Settings, Shadow, fold_transforms};

use crate::cost::cost;
use crate::reroll::cullable::visits;
use crate::reroll::rewrite::reroll;

/// How a field of many parts is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoopStrategy {
    /// As costs less: [`LoopStrategy::Looped`] where the field takes more operations than [`Report::unrolled_limit`](crate::Report::unrolled_limit) says.
    #[default]
    Auto,
    /// All that there is, one operation after the other.
    Unrolled,
    /// Parts that are equal up to constants as loops over lists, where there are such.
    Looped,
}

/// More operations of a field take longer to compile and to evaluate than loops that visit what matters: of a scene all of whose rays come
/// from the eye, of one whose rays to lamps and mirrored rays go by lists for cells, and of one with soft shadows, which visit all rounds.
const MOST_INLINE: [usize; 3] = [425, 1200, 4500];
/// So many more for each loop, which is compiled too, and entered at each place.
const MORE_FOR_A_LOOP: [usize; 3] = [125, 250, 0];
/// The same where loops visit all rounds.
const MOST_WITHOUT_LISTS: usize = 4500;

/// How many operations a field may take that is written out though so many loops with lists could stand in its place.
fn unrolled_limit(settings: &Settings, loops: usize) -> usize {
    if loops == 0 {
        return MOST_WITHOUT_LISTS;
    }
    let kind = if settings.lights.iter().any(|light| matches!(light.shadow, Shadow::Soft(_))) {
        2
    } else {
        usize::from(has_secondary_rays(settings))
    };
    MOST_INLINE[kind] + loops * MORE_FOR_A_LOOP[kind]
}

impl LoopStrategy {
    /// Whether a field is written as loops, and up to how many operations it is not of its own accord. `steepest` is as for
    /// [`visits`].
    pub(crate) fn rolls(
        self,
        graph: &Graph,
        distance: NodeId,
        settings: &Settings,
        steepest: Option<f64>,
    ) -> (bool, usize) {
        let (pays, unrolled_limit) = loops_pay(graph, distance, settings, steepest);
        let rolls = match self {
            Self::Auto => pays,
            Self::Unrolled => false,
            Self::Looped => true,
        };
        (rolls, unrolled_limit)
    }
}

/// Whether loops cost less, and up to how many operations they do not.
fn loops_pay(
    graph: &Graph,
    distance: NodeId,
    settings: &Settings,
    steepest: Option<f64>,
) -> (bool, usize) {
    let operations = cost(graph, &[distance]).operations;
    let least = unrolled_limit(settings, 1);
    if operations <= least || operations > MOST_WITHOUT_LISTS {
        return (operations > least, least);
    }
    let mut trial = graph.clone();
    let folded = fold_transforms(&mut trial, &[distance]).roots;
    let rolled = reroll(&mut trial, &folded).0;
    let most = unrolled_limit(settings, visits(&mut trial, &rolled, steepest).len());
    (operations > most, most)
}

/// Whether the field is asked for elsewhere than on rays from the eye.
pub(crate) fn has_secondary_rays(settings: &Settings) -> bool {
    let shaded = settings.lights.iter().any(|light| light.shadow != Shadow::Off);
    let mirrored = settings.reflections.is_some_and(|mirrors| mirrors.count > 0);
    shaded || mirrored || settings.occlusion.is_some()
}
