//! The loops in which the surface meets the boundary of a cell.

use crate::grid::{Cell, Corner, Edge, Face};
use crate::tree::{Tangled, Tree};

/// A crossing of a loop, and the face that leads to the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoopStep {
    pub(crate) edge: Edge,
    pub(crate) face: Face,
}

/// Returns the loops on the boundary of a cell, counter-clockwise around the normal that points
/// outside.
pub(crate) fn loops(
    tree: &Tree,
    cell: Cell,
    is_inside: impl Fn(Corner) -> bool,
) -> Result<Vec<Vec<LoopStep>>, Tangled> {
    let mut chords: Vec<(Edge, Edge, Face)> = Vec::new();
    let mut is_tangled = false;
    tree.faces_of(cell, |face, is_upper| match tree.chords(face, &is_inside) {
        Ok(found) => {
            let ends =
                found.iter().map(|[a, b]| if is_upper { (b, a, face) } else { (a, b, face) });
            chords.extend(ends);
            is_tangled |= found.len() > 1 && cell.size > 1;
        }
        Err(Tangled) => is_tangled = true,
    });
    if is_tangled {
        return Err(Tangled);
    }
    let mut loops = Vec::new();
    while let Some((first, mut next, face)) = chords.pop() {
        let mut steps = vec![LoopStep { edge: first, face }];
        while next != first {
            // Each crossing is the end of one chord and the start of another.
            let Some(at) = chords.iter().position(|(from, ..)| *from == next) else {
                return Err(Tangled);
            };
            let (edge, to, face) = chords.swap_remove(at);
            steps.push(LoopStep { edge, face });
            next = to;
        }
        loops.push(steps);
    }
    if loops.len() > 1 && cell.size > 1 { Err(Tangled) } else { Ok(loops) }
}

/// How the surface crosses the boundary of a leaf.
#[derive(Clone, Debug)]
pub(crate) enum Boundary {
    /// As the leaf alone tells.
    Plain,
    /// In loops with more crossings, because a neighbour is smaller.
    Refined(Vec<Vec<LoopStep>>),
    /// In a way that only a leaf of the smallest size may have.
    Tangled,
}

/// Returns how the surface crosses the boundary of a leaf. That of a square is never refined.
pub(crate) fn boundary(tree: &Tree, cell: Cell, is_inside: impl Fn(Corner) -> bool) -> Boundary {
    let is_refined = |step: &LoopStep| step.edge.size.min(step.face.size) < cell.size;
    if cell.size == 1 {
        return Boundary::Plain;
    }
    if tree.is_flat {
        let is_plain = tree.chords(cell.base(), is_inside).is_ok_and(|found| found.len() < 2);
        return if is_plain { Boundary::Plain } else { Boundary::Tangled };
    }
    match loops(tree, cell, is_inside) {
        Ok(loops) if loops.iter().flatten().any(is_refined) => Boundary::Refined(loops),
        Ok(_) => Boundary::Plain,
        Err(Tangled) => Boundary::Tangled,
    }
}
