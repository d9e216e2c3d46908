//! Makes a mesh from a program.

use std::ops::ControlFlow;

use rustc_hash::FxHashSet;
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;

use crate::certify::{Proof, Prover, changes};
use crate::contour::Contour;
use crate::error::{MeshError, MeshOptions, Progress};
use crate::examine::Sizes;
use crate::field::{Field, LocalField};
use crate::grid::{Cell, Grid};
use crate::refine::{OnProgress, Refiner, Signs};
use crate::surface::Mesh;
use crate::tree::Tree;
use crate::vector::Vec3;

/// How often cells about undecided boxes are divided.
const ROUNDS: u32 = 4;

/// Makes a closed mesh of a program's surface, with a certificate.
///
/// The work runs on all threads of the current rayon pool. It stops if `progress` breaks.
///
/// # Errors
///
/// [`MeshError`].
pub fn mesh(
    program: &Program,
    frame: &FrameValues,
    options: &MeshOptions,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Mesh, MeshError> {
    let field = Field::new(program)?.ok_or(MeshError::NothingDrawn)?;
    let grid = grid(options)?;
    let local = LocalField::new(field.distance(), frame);
    let maker = Maker { field: &local, grid: &grid, options };
    let mut mesh = maker.mesh(progress)?;
    if mesh.open_edges() > 0 {
        return Err(MeshError::Open);
    }
    mesh.colors = field.colors(frame, &mesh.vertices);
    Ok(mesh)
}

/// Returns the grid for the options.
fn grid(options: &MeshOptions) -> Result<Grid, MeshError> {
    let MeshOptions { bounds, error, .. } = *options;
    if !(error > 0.0 && error.is_finite()) {
        return Err(MeshError::Error(error));
    }
    for (axis, name) in ['x', 'y', 'z'].into_iter().enumerate() {
        if !(bounds[1][axis] - bounds[0][axis]).is_finite() {
            return Err(MeshError::Unbounded { axis: name });
        }
    }
    Grid::around(bounds, error).ok_or_else(|| {
        let powers = std::iter::successors(Some(error), |error| Some(2.0 * error));
        let least = powers.take(2000).find(|error| Grid::around(bounds, *error).is_some());
        MeshError::TooFine { error, least: least.unwrap_or(f64::INFINITY) }
    })
}

struct Maker<'a> {
    field: &'a LocalField<'a>,
    grid: &'a Grid,
    options: &'a MeshOptions,
}

impl Maker<'_> {
    fn mesh(&self, progress: OnProgress<'_>) -> Result<Mesh, MeshError> {
        let Self { field, grid, .. } = *self;
        let prober = &field.prober();
        let MeshOptions { error, max_cells, .. } = *self.options;
        let sizes = Sizes::of(grid);
        let mut refiner = Refiner { prober, field, grid, error, sizes, max_cells };
        let mut tree = Tree::default();
        let mut signs = Signs::default();
        refiner.grow(&mut tree, vec![grid.root()], progress)?;
        let mut best: Option<(Mesh, Vec<[Vec3; 2]>)> = None;
        for _ in 0..=ROUNDS {
            refiner.untangle(&mut tree, &mut signs, progress)?;
            let contour = Contour { prober, grid, tree: &tree, signs: &signs, error };
            let mut mesh = contour.mesh(progress)?;
            let changes = best.as_ref().map(|(before, undecided)| {
                let mut found = changes(before, &mesh);
                found.extend(undecided);
                found
            });
            let prover = Prover { field, mesh: &mesh, error, changes };
            let Proof { certificate, undecided } =
                prover.prove(grid.bounds(grid.root()), max_cells, progress)?;
            mesh.certificate = certificate;
            if let Some((before, _)) = &best {
                mesh.certificate.add_proofs(&before.certificate);
                let volume = before.certificate.undecided_volume;
                if mesh.certificate.undecided_volume >= volume {
                    break;
                }
            }
            let divided = divide(&mut tree, grid, &undecided);
            best = Some((mesh, undecided));
            if divided.is_empty() {
                break;
            }
            refiner.sizes = Sizes::STRICT;
            refiner.grow(&mut tree, divided, progress)?;
        }
        Ok(best.map(|(mesh, _)| mesh).unwrap_or_default())
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

#[cfg(test)]
mod tests {
    use sdfc_graph::{Dim, Graph, NodeId, Type};

    use super::*;

    /// Returns a ring of balls, a cube and a smooth blend, cut by a ball.
    fn program() -> Program {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let ball = |graph: &mut Graph, center: [f64; 3], radius: f64| -> NodeId {
            let center = graph.constant(Type::Vec3, &center);
            let offset = graph.sub(p, center);
            let (length, radius) = (graph.length(offset), graph.number(radius));
            graph.sub(length, radius)
        };
        let mut root = ball(&mut graph, [0.0, 0.0, 0.1], 0.3);
        for i in 0..8 {
            let (sine, cosine) = (f64::from(i) * 0.7).sin_cos();
            let next = ball(&mut graph, [0.7 * cosine, 0.7 * sine, 0.0], 0.2);
            root = graph.min(root, next);
        }
        let sides = [0, 1, 2].map(|axis| {
            let (x, half) = (graph.component(p, axis), graph.number(0.25));
            let x = graph.abs(x);
            graph.sub(x, half)
        });
        let cube = sides.into_iter().reduce(|a, b| graph.max(a, b));
        root = cube.map_or(root, |cube| graph.min(root, cube));
        let cutter = ball(&mut graph, [0.5, 0.3, 0.6], 0.5);
        let outside = graph.neg(cutter);
        root = graph.max(root, outside);
        Program { graph, distance: Some(root), ..Program::default() }
    }

    #[test]
    fn a_field_that_is_specialized_to_boxes_gives_the_same_mesh_and_certificate() {
        let (program, frame) = (program(), FrameValues::default());
        let options = MeshOptions::new([[-1.0; 3], [1.0; 3]], 0.03);
        let field = Field::new(&program).ok().flatten();
        let grid = grid(&options).ok();
        let (Some(field), Some(grid)) = (field, grid) else { panic!("a field and its grid") };
        let whole = LocalField::new(field.distance(), &frame);
        let [local, fixed] = [whole.clone(), whole.fixed()].map(|field| {
            let maker = Maker { field: &field, grid: &grid, options: &options };
            maker.mesh(&mut |_| ControlFlow::Continue(()))
        });
        assert!(local.as_ref().is_ok_and(|mesh| mesh.triangles.len() > 1000));
        assert_eq!(local, fixed);
    }
}
