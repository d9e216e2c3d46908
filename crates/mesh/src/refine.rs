//! Divides space until every cell is empty or small enough.

use std::ops::ControlFlow;

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::error::{MeshError, Phase, Progress};
use crate::examine::{Sizes, Verdict, examine, is_near};
use crate::field::{LocalField, Prober, is_inside};
use crate::grid::{Cell, Corner, Grid};
use crate::loops::{Boundary, LoopStep, boundary};
use crate::patch::Placer;
use crate::tree::Tree;

/// Cells that are divided between two reports of progress.
const CHUNK: usize = 2048;

/// The signs of corners: true for inside.
pub(crate) type Signs = FxHashMap<Corner, bool>;

/// The cells of a surface.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    pub(crate) tree: Tree,
    pub(crate) signs: Signs,
    /// Leaves whose triangles are near the surface beside smaller leaves, with the number of
    /// crossings of their loops: if that has not changed, they need no further look.
    near: FxHashMap<Cell, usize>,
    /// Leaves that need no look at their boundary: no cell beside them was split after the last.
    settled: FxHashSet<Cell>,
    /// The boundaries of leaves beside smaller ones whose triangles were not yet compared with the
    /// surface.
    refined: FxHashMap<Cell, Vec<Vec<LoopStep>>>,
}

impl Cells {
    /// Returns the leaves of a tree, none of which is settled.
    pub(crate) fn new(tree: Tree) -> Self {
        Self { tree, ..Self::default() }
    }

    /// Returns the leaves that are not settled, after those are taken into account that were split
    /// since the last call: each changes the boundary of leaves beside it that are not smaller.
    fn unsettled(&mut self, grid: &Grid) -> Vec<Cell> {
        let news = self.tree.take_news();
        if !self.settled.is_empty() {
            for cell in news {
                for at in cell.beside(grid) {
                    let leaf = self.tree.leaf_at(grid.root(), at);
                    if leaf.size >= cell.size {
                        self.settled.remove(&leaf);
                    }
                }
            }
        }
        let leaves = self.tree.leaves.iter().copied();
        leaves.filter(|leaf| !self.settled.contains(leaf)).collect()
    }
}

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

/// The field, the grid and the limits that decide where cells are split.
pub(crate) struct Refiner<'a, 'f> {
    pub(crate) prober: &'a Prober<'f>,
    pub(crate) field: &'a LocalField<'f>,
    pub(crate) grid: &'a Grid,
    pub(crate) error: f64,
    pub(crate) sizes: Sizes,
    pub(crate) max_cells: u64,
}

/// A cell that is split, and the field around it.
struct Task<'f> {
    cell: Cell,
    field: LocalField<'f>,
}

impl<'f> Refiner<'_, 'f> {
    /// Splits cells, examines their descendants, and adds all to the tree.
    pub(crate) fn grow(
        &self,
        tree: &mut Tree,
        cells: Vec<Cell>,
        progress: OnProgress<'_>,
    ) -> Result<(), MeshError> {
        let task = |cell| Task { cell, field: self.field.clone() };
        let mut waiting: Vec<Task<'_>> = cells.into_iter().map(task).collect();
        let mut done = 0;
        while !waiting.is_empty() {
            let chunk = waiting.split_off(waiting.len().saturating_sub(CHUNK));
            done += chunk.len();
            let found: Vec<_> = chunk.into_par_iter().map(|task| self.divide(task)).collect();
            for (task, verdicts) in found {
                tree.split(task.cell);
                for (cell, verdict) in self.grid.children(task.cell).zip(verdicts) {
                    match verdict {
                        Verdict::Empty => {}
                        Verdict::Leaf => tree.leaves.push(cell),
                        Verdict::Split => waiting.push(Task { cell, field: task.field.clone() }),
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

    /// Specialises the field to a cell, and examines its children.
    fn divide(&self, Task { cell, field }: Task<'f>) -> (Task<'f>, Vec<Verdict>) {
        let field = field.around(self.grid.bounds(cell), self.grid.length(cell.size));
        let mut prober = field.prober();
        let mut placer = Placer { prober: &mut prober, grid: self.grid, error: self.error };
        let children = self.grid.children(cell);
        let verdicts = children.map(|child| examine(&mut placer, child, self.sizes)).collect();
        drop(prober);
        (Task { cell, field }, verdicts)
    }

    /// Splits leaves until the surface crosses the boundary of each in one loop, except in cells of
    /// the smallest size, and until their triangles are near the surface as far as samples tell.
    pub(crate) fn untangle(
        &self,
        cells: &mut Cells,
        progress: OnProgress<'_>,
    ) -> Result<(), MeshError> {
        loop {
            let unsettled = cells.unsettled(self.grid);
            self.add_signs(&cells.tree, &unsettled, &mut cells.signs);
            let mut fails = FxHashSet::default();
            for (cell, boundary) in boundaries(cells, unsettled) {
                cells.refined.remove(&cell);
                cells.settled.insert(cell);
                match boundary {
                    Boundary::Plain => {}
                    Boundary::Refined(loops) => {
                        cells.refined.insert(cell, loops);
                    }
                    Boundary::Tangled => {
                        fails.insert(cell);
                    }
                }
            }
            if fails.is_empty() {
                fails = self.far(cells);
            }
            if fails.is_empty() {
                return Ok(());
            }
            let leaves = std::mem::take(&mut cells.tree.leaves);
            let (divided, kept) = leaves.into_iter().partition(|cell| fails.contains(cell));
            cells.tree.leaves = kept;
            self.grow(&mut cells.tree, divided, progress)?;
        }
    }

    /// Returns the leaves beside smaller ones whose triangles are far from the surface.
    ///
    /// `examine` decides about a cell without its neighbours. If one of them is smaller, the loop
    /// has more crossings, and the vertex within the cell moves.
    fn far(&self, cells: &mut Cells) -> FxHashSet<Cell> {
        let refined: Vec<_> = std::mem::take(&mut cells.refined).into_iter().collect();
        let known = &cells.near;
        let compare = |prober: &mut Prober<'f>, (cell, loops): (Cell, Vec<Vec<LoopStep>>)| {
            let count = loops.iter().map(Vec::len).sum();
            if known.get(&cell) == Some(&count) {
                return (cell, count, true);
            }
            let mut placer = Placer { prober, grid: self.grid, error: self.error };
            (cell, count, is_near(&mut placer, cell, &loops))
        };
        let found: Vec<(Cell, usize, bool)> =
            refined.into_par_iter().map_init(|| self.prober.clone(), compare).collect();
        let mut far = FxHashSet::default();
        for (cell, count, is_near) in found {
            if is_near {
                cells.near.insert(cell, count);
            } else {
                far.insert(cell);
            }
        }
        far
    }

    /// Computes the signs of all corners of smallest edges of some leaves.
    fn add_signs(&self, tree: &Tree, leaves: &[Cell], signs: &mut Signs) {
        let known = &*signs;
        let mut missing: Vec<Corner> = leaves
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

/// Returns leaves with how the surface crosses their boundaries.
fn boundaries(Cells { tree, signs, .. }: &Cells, leaves: Vec<Cell>) -> Vec<(Cell, Boundary)> {
    let sign = |at: Corner| signs.get(&at).copied().unwrap_or(false);
    leaves.into_par_iter().map(|cell| (cell, boundary(tree, cell, sign))).collect()
}
