//! Divides space until every cell is empty or small enough.

use std::ops::ControlFlow;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::error::{MeshError, Phase, Progress};
use crate::examine::{Sizes, Verdict, examine};
use crate::field::{Prober, is_inside};
use crate::grid::{Cell, Corner, Grid};
use crate::loops::loops;
use crate::patch::Placer;
use crate::tree::Tree;

/// Cells that are examined between two reports of progress.
const CHUNK: usize = 16_384;

/// The signs of corners: true for inside.
pub(crate) type Signs = FxHashMap<Corner, bool>;

/// Reports progress; stops the work if it breaks.
pub(crate) type OnProgress<'a> = &'a mut dyn FnMut(Progress) -> ControlFlow<()>;

/// Calls a progress function.
pub(crate) fn report(
    progress: OnProgress<'_>,
    phase: Phase,
    done: usize,
    total: usize,
) -> Result<(), MeshError> {
    let report = Progress { phase, done: done as u64, total: total as u64 };
    match progress(report) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(MeshError::Cancelled),
    }
}

/// What refinement needs.
pub(crate) struct Refiner<'a, 'f> {
    pub(crate) prober: &'a Prober<'f>,
    pub(crate) grid: &'a Grid,
    pub(crate) error: f64,
    pub(crate) sizes: Sizes,
    pub(crate) max_cells: u64,
}

impl Refiner<'_, '_> {
    /// Examines cells and their descendants, and adds them to the tree.
    pub(crate) fn grow(
        &self,
        tree: &mut Tree,
        cells: Vec<Cell>,
        progress: OnProgress<'_>,
    ) -> Result<(), MeshError> {
        let mut waiting = cells;
        let mut done = 0;
        while !waiting.is_empty() {
            let chunk = waiting.split_off(waiting.len().saturating_sub(CHUNK));
            done += chunk.len();
            let verdicts: Vec<Verdict> = chunk
                .par_iter()
                .map_init(|| self.prober.clone(), |prober, cell| self.examine(prober, *cell))
                .collect();
            for (cell, verdict) in chunk.into_iter().zip(verdicts) {
                match verdict {
                    Verdict::Empty => {}
                    Verdict::Leaf => tree.leaves.push(cell),
                    Verdict::Split => {
                        tree.split(cell);
                        waiting.extend(cell.children());
                    }
                }
            }
            if (tree.splits() * 8) as u64 > self.max_cells {
                return Err(MeshError::TooManyCells { limit: self.max_cells });
            }
            report(progress, Phase::Refining, done, done + waiting.len())?;
        }
        Ok(())
    }

    fn examine(&self, prober: &mut Prober<'_>, cell: Cell) -> Verdict {
        let mut placer = Placer { prober, grid: self.grid, error: self.error };
        examine(&mut placer, cell, self.sizes)
    }

    /// Splits leaves until the surface crosses the boundary of each in one loop, except in cells of
    /// the smallest size.
    pub(crate) fn untangle(
        &self,
        tree: &mut Tree,
        signs: &mut Signs,
        progress: OnProgress<'_>,
    ) -> Result<(), MeshError> {
        loop {
            self.add_signs(tree, signs);
            let sign = |at: Corner| signs.get(&at).copied().unwrap_or(false);
            let is_tangled = |cell: &Cell| cell.size > 1 && loops(tree, *cell, sign).is_err();
            let tangled: Vec<bool> = tree.leaves.par_iter().map(is_tangled).collect();
            if !tangled.contains(&true) {
                return Ok(());
            }
            let leaves = std::mem::take(&mut tree.leaves);
            let mut children = Vec::new();
            for (cell, is_tangled) in leaves.into_iter().zip(tangled) {
                if is_tangled {
                    tree.split(cell);
                    children.extend(cell.children());
                } else {
                    tree.leaves.push(cell);
                }
            }
            self.grow(tree, children, progress)?;
        }
    }

    /// Computes the signs of all corners of smallest edges of leaves.
    fn add_signs(&self, tree: &Tree, signs: &mut Signs) {
        let known = &*signs;
        let mut missing: Vec<Corner> = tree
            .leaves
            .par_iter()
            .flat_map_iter(|cell| {
                let mut corners = Vec::new();
                tree.faces_of(*cell, |face, _| {
                    for (side, _) in face.sides() {
                        tree.edges(side, &mut |edge| corners.extend(edge.ends()));
                    }
                });
                corners.sort_unstable();
                corners.dedup();
                corners.retain(|corner| !known.contains_key(corner));
                corners
            })
            .collect();
        missing.par_sort_unstable();
        missing.dedup();
        let found: Vec<bool> = missing
            .par_iter()
            .map_init(
                || self.prober.clone(),
                |prober, corner| is_inside(prober.value(self.grid.position(*corner))),
            )
            .collect();
        signs.extend(missing.into_iter().zip(found));
    }
}
