//! Makes a surface of a field, proves its error, and improves it where that fails.

use rustc_hash::FxHashSet;

use crate::build::Builder;
use crate::certify::{Proof, Prover, changes};
use crate::error::MeshError;
use crate::examine::Sizes;
use crate::field::LocalField;
use crate::grid::{Cell, Grid};
use crate::refine::{Cells, OnProgress, Refiner};
use crate::surface::Mesh;
use crate::tree::Tree;
use crate::vector::Vec3;

/// How often cells about undecided boxes are divided.
const ROUNDS: u32 = 4;
/// With more undecided boxes, no cells are divided.
const MANY: usize = 60_000;

/// A surface that is made from the cells of a grid.
pub(crate) trait Surface: Sized {
    /// Makes the surface.
    fn build(builder: &Builder<'_, '_>, progress: OnProgress<'_>) -> Result<Self, MeshError>;

    /// Returns the triangles whose error is proven.
    fn triangles(&self) -> &Mesh;

    /// Returns how far the triangles may be from the surface, as a fraction of the error.
    fn margin(&self) -> f64;
}

impl Surface for Mesh {
    fn build(builder: &Builder<'_, '_>, progress: OnProgress<'_>) -> Result<Self, MeshError> {
        builder.mesh(progress)
    }

    fn triangles(&self) -> &Mesh {
        self
    }

    fn margin(&self) -> f64 {
        0.0
    }
}

/// What a surface is made from.
pub(crate) struct Maker<'a> {
    /// The field that decides what is inside.
    pub(crate) field: &'a LocalField<'a>,
    /// The field that the surface is compared with.
    pub(crate) truth: &'a LocalField<'a>,
    pub(crate) grid: &'a Grid,
    pub(crate) error: f64,
    pub(crate) max_cells: u64,
    /// True if paths may have circular arcs.
    pub(crate) has_arcs: bool,
}

impl Maker<'_> {
    /// Returns the surface and what is proven about it.
    pub(crate) fn make<S: Surface>(
        &self,
        progress: OnProgress<'_>,
    ) -> Result<(S, Proof), MeshError> {
        let Self { field, grid, error, max_cells, .. } = *self;
        let prober = &field.prober();
        let sizes = Sizes::of(grid);
        let mut refiner = Refiner { prober, field, grid, error, sizes, max_cells };
        let mut cells = Cells::new(Tree::new(grid.is_flat));
        refiner.grow(&mut cells.tree, vec![grid.root()], progress)?;
        let mut best = self.attempt::<S>(&refiner, &mut cells, None, progress)?;
        for _ in 0..ROUNDS {
            // Smaller cells serve where the surface is not found, not where nothing can be decided.
            if best.1.undecided.len() > MANY {
                break;
            }
            let divided = divide(&mut cells.tree, grid, &best.1.undecided);
            if divided.is_empty() {
                break;
            }
            refiner.sizes = Sizes::STRICT;
            refiner.grow(&mut cells.tree, divided, progress)?;
            let before = Some(&best);
            let next = self.attempt(&refiner, &mut cells, before, progress)?;
            let volume = |(_, proof): &(S, Proof)| proof.certificate.undecided_volume;
            if volume(&next) >= volume(&best) {
                break;
            }
            best = next;
        }
        Ok(best)
    }

    /// Makes a surface and proves its error, where it differs from an earlier one.
    fn attempt<S: Surface>(
        &self,
        refiner: &Refiner<'_, '_>,
        cells: &mut Cells,
        before: Option<&(S, Proof)>,
        progress: OnProgress<'_>,
    ) -> Result<(S, Proof), MeshError> {
        let Self { truth, grid, error, max_cells, has_arcs, .. } = *self;
        refiner.untangle(cells, progress)?;
        let Cells { tree, signs, .. } = cells;
        let builder = Builder { prober: refiner.prober, grid, tree, signs, error, has_arcs };
        let surface = S::build(&builder, progress)?;
        let changes = before.map(|(before, proof)| {
            let mut found = changes(before.triangles(), surface.triangles());
            found.extend(&proof.undecided);
            found
        });
        let (mesh, rest) = (surface.triangles(), error * (1.0 - surface.margin()));
        let prover = Prover { field: truth, mesh, grid, error: rest, changes };
        let mut proof = prover.prove(max_cells, progress)?;
        proof.certificate.error = error;
        if let Some((_, before)) = before {
            proof.certificate.add_proofs(&before.certificate);
        }
        Ok((surface, proof))
    }
}

/// Takes the leaves about undecided boxes out of the tree.
fn divide(tree: &mut Tree, grid: &Grid, undecided: &[[Vec3; 2]]) -> Vec<Cell> {
    let mut wanted: FxHashSet<Cell> = FxHashSet::default();
    for [lo, hi] in undecided {
        let margin = 0.5 * grid.unit;
        for corner in 0..8 {
            let at = std::array::from_fn(|axis| {
                let x = if corner >> axis & 1 == 1 { hi[axis] + margin } else { lo[axis] - margin };
                let steps = (x - grid.origin[axis]) / grid.unit;
                (steps.max(0.0) as u32).min(grid.size - 1)
            });
            wanted.insert(tree.leaf_at(grid.root(), at));
        }
    }
    let leaves = std::mem::take(&mut tree.leaves);
    let (divided, kept): (Vec<Cell>, Vec<Cell>) =
        leaves.into_iter().partition(|cell| cell.size > 1 && wanted.contains(cell));
    tree.leaves = kept;
    divided
}
