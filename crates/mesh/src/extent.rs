//! How far a solid reaches along an axis.

use crate::field::{Prism, Prober};
use crate::vector::{Vec3, between};

/// Boxes that one proof may examine.
const MOST_BOXES: usize = 20_000;
/// Steps of a bisection.
const MOST_STEPS: usize = 60;

/// The result of examining a box.
enum Found {
    /// It is proven that nothing of the box is inside.
    Nothing,
    /// A point that is proven to be inside.
    Inside(Vec3),
    /// Neither.
    Undecided,
}

/// Returns how far the solid within a box reaches along an axis, upwards or downwards: a coordinate
/// that it is proven to reach, and one that it is proven not to exceed. `inner` is inside.
pub(crate) fn reach(
    prober: &mut Prober<'_>,
    bounds: [Vec3; 2],
    inner: Vec3,
    axis: usize,
    is_up: bool,
    tolerance: f64,
) -> [f64; 2] {
    let mut reached = inner[axis];
    let mut limit = bounds[usize::from(is_up)][axis];
    for _ in 0..MOST_STEPS {
        if (limit - reached).abs() <= tolerance {
            break;
        }
        let middle = 0.5 * (reached + limit);
        let mut slab = bounds;
        slab[usize::from(!is_up)][axis] = middle;
        slab[usize::from(is_up)][axis] = limit;
        match search(prober, slab, [axis, usize::from(!is_up)], 0.25 * tolerance) {
            Found::Nothing => limit = middle,
            Found::Inside(point) => reached = point[axis],
            Found::Undecided => break,
        }
    }
    [reached, limit]
}

/// Looks for a point that is inside. Boxes are tried at their middles and at the middles of one
/// side. They are divided until they are smaller than a size.
fn search(
    prober: &mut Prober<'_>,
    bounds: [Vec3; 2],
    [axis, side]: [usize; 2],
    least: f64,
) -> Found {
    let mut waiting = vec![bounds];
    let mut is_undecided = false;
    let mut examined = 0;
    while let Some(bounds) = waiting.pop() {
        examined += 1;
        if prober.side_over(&Prism::aligned(bounds)) == Some(false) {
            continue;
        }
        let middle = between(bounds[0], bounds[1], 0.5);
        let mut at_side = middle;
        at_side[axis] = bounds[side][axis];
        for point in [at_side, middle] {
            if prober.proven_side(point) == Some(true) {
                return Found::Inside(point);
            }
        }
        let size = |axis: &usize| bounds[1][*axis] - bounds[0][*axis];
        let longest = [0, 1, 2].into_iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let longest = longest.unwrap_or(0);
        if size(&longest) <= least || examined > MOST_BOXES {
            is_undecided = true;
            continue;
        }
        let mut halves = [bounds; 2];
        halves[0][1][longest] = middle[longest];
        halves[1][0][longest] = middle[longest];
        waiting.extend(halves);
        if examined > MOST_BOXES {
            break;
        }
    }
    if is_undecided { Found::Undecided } else { Found::Nothing }
}
