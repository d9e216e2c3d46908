//! Similarities whose coefficients are per-frame values, such as rotations by a param.

use sdfc_graph::{Graph, Node, NodeId, Polynomial, similarity_scale_squared};

use crate::certify::affine::is_fixed;
use crate::certify::branches::{Lane, branches};

/// Largest number of operations that are followed.
const MAX_STEPS: usize = 128;

/// Finds values of which the lanes are linear functions that scale all distances alike, for all
/// values of the params. Returns the factor and the values. `None` if there are none, or if these
/// are the lanes themselves.
pub(super) fn similarity(
    graph: &mut Graph,
    lanes: &[Lane],
    level: u16,
) -> Option<(f64, Vec<Lane>)> {
    let mut sums = Sums { values: Vec::new(), rows: Vec::new(), steps: MAX_STEPS };
    for &lane in lanes {
        sums.rows.push(Default::default());
        sums.add(graph, lane, &Polynomial::number(1.0), level)?;
    }
    if sums.values == lanes {
        return None;
    }
    let square = similarity_scale_squared(&sums.rows)?.constant()?;
    Some((square.sqrt(), sums.values))
}

/// Linear functions of at most three values.
struct Sums {
    values: Vec<Lane>,
    /// The coefficients of the values in each function.
    rows: Vec<[Polynomial; 3]>,
    /// How many more operations are followed.
    steps: usize,
}

impl Sums {
    /// Adds a multiple of a lane to the last function.
    fn add(
        &mut self,
        graph: &mut Graph,
        lane: Lane,
        factor: &Polynomial,
        level: u16,
    ) -> Option<()> {
        self.steps = self.steps.checked_sub(1)?;
        if is_fixed(graph, lane.0, level) {
            return Some(());
        }
        let Some(terms) = terms(graph, lane, level) else { return self.add_value(lane, factor) };
        for (inner, coefficient) in terms {
            self.add(graph, inner, &factor.times(&coefficient)?, level)?;
        }
        Some(())
    }

    fn add_value(&mut self, lane: Lane, factor: &Polynomial) -> Option<()> {
        let known = self.values.iter().position(|&value| value == lane);
        let at = known.unwrap_or(self.values.len());
        let coefficient = self.rows.last_mut()?.get_mut(at)?;
        *coefficient = coefficient.plus(factor);
        if known.is_none() {
            self.values.push(lane);
        }
        Some(())
    }
}

/// The lanes that a lane is a sum of multiples of; `None` if it is no such sum.
fn terms(graph: &mut Graph, lane: Lane, level: u16) -> Option<Vec<(Lane, Polynomial)>> {
    let (node, at) = lane;
    if let Some([terms]) = branches(graph, lane, level).as_deref() {
        let number = |&(lane, factor): &(Lane, f64)| (lane, Polynomial::number(factor));
        return Some(terms.iter().map(number).collect());
    }
    let is_fixed = |id: NodeId| is_fixed(graph, id, level);
    match graph.node(node) {
        Node::Binary(sdfc_graph::Binary::Mul, a, b) if is_fixed(a) || is_fixed(b) => {
            let (factor, value) = if is_fixed(a) { (a, b) } else { (b, a) };
            Some(vec![(own(graph, value, at), coefficient(graph, factor, at)?)])
        }
        Node::Transform(columns, v) if columns.iter().all(|&column| is_fixed(column)) => {
            let term = |i: usize| Some((own(graph, v, i), coefficient(graph, columns[i], at)?));
            (0..columns.len()).map(term).collect()
        }
        _ => None,
    }
}

/// A lane of a value; a number is the same in all lanes.
fn own(graph: &Graph, id: NodeId, lane: usize) -> Lane {
    (id, if graph.ty(id).width() == 1 { 0 } else { lane })
}

fn coefficient(graph: &mut Graph, id: NodeId, lane: usize) -> Option<Polynomial> {
    let (id, lane) = own(graph, id, lane);
    let component = graph.component(id, lane as u8);
    Polynomial::of(graph, component)
}
