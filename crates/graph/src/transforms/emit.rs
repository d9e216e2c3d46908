//! Building the cheapest code for an affine form.

use super::affine::{Affine, Row};
use super::cone::TRANSFORM_COST;
use crate::coefficient::Coefficient;
use crate::graph::Graph;
use crate::node::NodeId;

/// A way to compute a form, and its cost in scalar operations.
pub(super) struct Plan {
    pub(super) cost: usize,
    shape: Shape,
    /// The form, with factors snapped to 0, 1 and -1.
    form: Affine,
}

enum Shape {
    /// Each row is one scaled atom.
    Selected([u8; 3]),
    /// Each row is a sum.
    Rows,
    /// One row that uses every atom.
    Dot,
    /// A 3x3 matrix.
    Transform,
}

/// The cheapest plan; `None` for a form that does not depend on the point.
pub(super) fn plan(form: &Affine) -> Option<Plan> {
    let form = form.snapped();
    let atoms = form.atoms.iter().flatten().count();
    if atoms == 0 {
        return None;
    }
    let offset = offset_cost(&form);
    let mut best = Plan { cost: rows_cost(&form) + offset, shape: Shape::Rows, form };
    let mut offer = |cost: usize, shape: Shape| {
        if cost + offset <= best.cost {
            best = Plan { cost: cost + offset, shape, form };
        }
    };
    if form.width == 1 && atoms > 1 && terms(&form.rows[0]) == atoms {
        offer(2 * atoms - 1, Shape::Dot);
    }
    if form.width == 3 && atoms == 3 {
        offer(TRANSFORM_COST, Shape::Transform);
    }
    if let Some(lanes) = selected(&form) {
        let scaled =
            rows(&form).zip(lanes).any(|(row, lane)| !row.factors[usize::from(lane)].is(1.0));
        offer(if scaled { form.width } else { 0 }, Shape::Selected(lanes));
    }
    Some(best)
}

fn rows(form: &Affine) -> impl Iterator<Item = &Row> {
    form.rows[..form.width].iter()
}

fn terms(row: &Row) -> usize {
    row.factors.iter().filter(|factor| !factor.is(0.0)).count()
}

fn rows_cost(form: &Affine) -> usize {
    rows(form).map(row_cost).sum()
}

/// Products with factors other than 1 and -1, the additions between terms, and a negation where no
/// term is positive.
fn row_cost(row: &Row) -> usize {
    let factors = &row.factors;
    let products = factors.iter().filter(|f| !f.is(0.0) && !f.is(1.0) && !f.is(-1.0)).count();
    let terms = terms(row);
    let negations = factors.iter().filter(|factor| factor.is(-1.0)).count();
    let negated = usize::from(terms > 0 && negations == terms);
    products + terms.saturating_sub(1) + negated
}

fn offset_cost(form: &Affine) -> usize {
    let moved = rows(form).any(|row| !row.offset.is(0.0));
    if moved { form.width } else { 0 }
}

/// The atom of each row, if each row has exactly one.
fn selected(form: &Affine) -> Option<[u8; 3]> {
    let mut lanes = [0; 3];
    for (lane, row) in lanes.iter_mut().zip(rows(form)) {
        let mut factors = row.factors.iter();
        *lane = factors.position(|factor| !factor.is(0.0))? as u8;
        if factors.any(|factor| !factor.is(0.0)) {
            return None;
        }
    }
    Some(lanes)
}

impl Plan {
    /// Builds the form over atoms: its own, or their new nodes.
    pub(super) fn build(&self, graph: &mut Graph, atoms: &[NodeId]) -> NodeId {
        let form = &self.form;
        let base = graph.compose(atoms);
        let linear = match self.shape {
            Shape::Selected(lanes) => {
                let selected: Vec<NodeId> =
                    lanes[..form.width].iter().map(|&lane| atoms[usize::from(lane)]).collect();
                let selected = graph.compose(&selected);
                let factors = [0, 1, 2].map(|i| form.rows[i].factors[usize::from(lanes[i])]);
                let factors = vector(graph, &factors[..form.width]);
                graph.mul(selected, factors)
            }
            Shape::Rows => {
                let sums: Vec<NodeId> = rows(form).map(|row| sum(graph, atoms, row)).collect();
                graph.compose(&sums)
            }
            Shape::Dot => {
                let weights = vector(graph, &form.rows[0].factors[..atoms.len()]);
                graph.dot(base, weights)
            }
            Shape::Transform => {
                let columns = [0, 1, 2].map(|j| {
                    let column = form.rows.map(|row| row.factors[j]);
                    vector(graph, &column)
                });
                graph.transform(columns, base)
            }
        };
        let offsets = form.rows.map(|row| row.offset);
        let offset = vector(graph, &offsets[..form.width]);
        graph.add(linear, offset)
    }
}

fn vector(graph: &mut Graph, coefficients: &[Coefficient]) -> NodeId {
    let parts: Vec<NodeId> = coefficients.iter().map(|part| part.node(graph)).collect();
    graph.compose(&parts)
}

fn sum(graph: &mut Graph, atoms: &[NodeId], row: &Row) -> NodeId {
    let mut sum = graph.number(0.0);
    for (&atom, factor) in atoms.iter().zip(row.factors).filter(|(_, factor)| !factor.is(0.0)) {
        let factor = factor.node(graph);
        let term = graph.mul(atom, factor);
        sum = graph.add(sum, term);
    }
    sum
}
