//! Linear maps whose coefficients are per-frame values, such as rotations by a param.

use sdfc_graph::{Binary, Graph, Node, NodeId, Polynomial, squared_lengths_of_orthogonal};

use crate::certify::affine::is_fixed;
use crate::certify::branches::{Lane, branches, lane_of};

/// Largest number of operations that are followed.
const MAX_STEPS: usize = 128;

/// A rotation, after which each lane is scaled by a number.
pub(super) struct ScaledRotation {
    /// The values that are rotated.
    pub(super) values: Vec<Lane>,
    /// The factors of the lanes.
    pub(super) factors: Vec<f64>,
}

/// Finds values of which the lanes are a scaled rotation for all values of the params. `None` if
/// there are none, or if these are the lanes themselves.
pub(super) fn scaled_rotation(
    graph: &mut Graph,
    lanes: &[Lane],
    level: u16,
) -> Option<ScaledRotation> {
    let mut sums = Sums { values: Vec::new(), rows: Vec::new(), steps: MAX_STEPS };
    for &lane in lanes {
        sums.rows.push(Default::default());
        sums.add(graph, lane, &Polynomial::number(1.0), level)?;
    }
    if sums.values == lanes {
        return None;
    }
    let squares = squared_lengths_of_orthogonal(&sums.rows)?;
    let factors: Option<Vec<f64>> =
        squares.iter().map(|square| Some(square.constant()?.max(0.0).sqrt())).collect();
    Some(ScaledRotation { values: sums.values, factors: factors? })
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
    if let Node::Binary(Binary::Mul, a, b) = graph.node(node)
        && (is_fixed(a) || is_fixed(b))
    {
        let (factor, value) = if is_fixed(a) { (a, b) } else { (b, a) };
        Some(vec![(lane_of(graph, value, at), coefficient(graph, factor, at)?)])
    } else if let Node::Transform(columns, v) = graph.node(node)
        && columns.iter().all(|&column| is_fixed(column))
    {
        let term = |i: usize| Some((lane_of(graph, v, i), coefficient(graph, columns[i], at)?));
        (0..columns.len()).map(term).collect()
    } else {
        None
    }
}

fn coefficient(graph: &mut Graph, id: NodeId, lane: usize) -> Option<Polynomial> {
    let (id, lane) = lane_of(graph, id, lane);
    let component = graph.component(id, lane as u8);
    Polynomial::of(graph, component)
}
