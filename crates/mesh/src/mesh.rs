//! Makes a mesh from a program.

use std::ops::ControlFlow;

use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;

use crate::error::{MeshError, MeshOptions, Progress};
use crate::field::{Field, LocalField};
use crate::grid::Grid;
use crate::make::Maker;
use crate::surface::Mesh;
use crate::vector::longest_side;

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
    let MeshOptions { bounds, error, max_cells, .. } = *options;
    check(bounds, error)?;
    let grid = fitting(error, |error| Grid::around(bounds, error))?;
    let local = LocalField::new(field.distance(), frame);
    let maker =
        Maker { field: &local, truth: &local, grid: &grid, error, max_cells, has_arcs: false };
    let (mut mesh, proof) = maker.make::<Mesh>(progress)?;
    if mesh.triangles.is_empty() {
        // Parts that are far smaller than the error look as if faces touched.
        let is_empty = proof.certificate.is_proven && proof.certificate.touching_boxes == 0;
        return Err(if is_empty { MeshError::Empty } else { MeshError::NothingFound { error } });
    }
    if mesh.open_edges() > 0 {
        return Err(MeshError::Open);
    }
    mesh.certificate = proof.certificate;
    mesh.colors = field.colors(frame, &mesh.vertices);
    Ok(mesh)
}

/// Checks that the bounds are finite.
pub(crate) fn check_bounds(bounds: [[f64; 3]; 2]) -> Result<(), MeshError> {
    for (axis, name) in ['x', 'y', 'z'].into_iter().enumerate() {
        if !(bounds[1][axis] - bounds[0][axis]).is_finite() {
            return Err(MeshError::Unbounded { axis: name });
        }
    }
    Ok(())
}

/// Checks that the bounds are finite, and that an error relative to them is a positive number.
pub(crate) fn check_relative(bounds: [[f64; 3]; 2], relative: f64) -> Result<(), MeshError> {
    check_bounds(bounds)?;
    let is_valid = relative > 0.0 && relative.is_finite();
    if is_valid { Ok(()) } else { Err(MeshError::Error(relative)) }
}

/// Checks that the bounds are finite, and that the error is a positive number and not too large.
pub(crate) fn check(bounds: [[f64; 3]; 2], error: f64) -> Result<(), MeshError> {
    // The bounds first, because an error relative to infinite bounds is infinite.
    check_relative(bounds, error)?;
    let longest = longest_side(bounds);
    // Such an error allows a mesh that misses the whole scene. A scene without a size has its own
    // message.
    if longest > 0.0 && error > longest {
        return Err(MeshError::TooCoarse { error, longest });
    }
    Ok(())
}

/// Returns the grid for an error, or the smallest error that has a grid.
pub(crate) fn fitting(error: f64, grid: impl Fn(f64) -> Option<Grid>) -> Result<Grid, MeshError> {
    grid(error).ok_or_else(|| {
        let powers = std::iter::successors(Some(error), |error| Some(2.0 * error));
        let least = powers.take(2000).find(|error| grid(*error).is_some());
        MeshError::TooFine { error, least: least.unwrap_or(f64::INFINITY) }
    })
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
        let MeshOptions { bounds, error, max_cells, .. } = options;
        let field = Field::new(&program).ok().flatten();
        let grid = Grid::around(bounds, error);
        let (Some(field), Some(grid)) = (field, grid) else { panic!("a field and its grid") };
        let whole = LocalField::new(field.distance(), &frame);
        let [local, fixed] = [whole.clone(), whole.fixed()].map(|field| {
            let maker = Maker {
                field: &field,
                truth: &field,
                grid: &grid,
                error,
                max_cells,
                has_arcs: false,
            };
            let made = maker.make::<Mesh>(&mut |_| ControlFlow::Continue(()));
            made.map(|(mesh, proof)| (mesh, proof.certificate))
        });
        assert!(local.as_ref().is_ok_and(|(mesh, _)| mesh.triangles.len() > 1000));
        assert_eq!(local, fixed);
    }
}
