//! Bounds of a field along a stretch of a ray, as nodes.
//!
//! For each node of a field there are nodes for the least and for the greatest value that it may have anywhere on a straight
//! stretch between two points, and how fast it may change there. They are ordinary math: they fold, merge and are
//! written and evaluated like any other.
//!
//! What follows from the point by affine maps changes evenly along the stretch and is known by its values at the ends
//! ([`Extent::Line`]), however the maps turn it. Lengths of such vectors are bounded exactly. All else is bounded by
//! intervals ([`Extent::Span`]).
//!
//! *Rounding.* What is computed in f32 holds what the field yields in f32 and in real arithmetic: each operation that rounds
//! widens its result, by 2^-22 of it after sums and products, by twice that after roots and quotients, by 2^-20 of the
//! terms' magnitudes after affine maps, and by 2^-16 after sines, arcs and powers, for which devices promise less.
//! Numbers of 1e15 and more count as infinite, and so does what follows from them.

mod arithmetic;
mod endless;
mod extent;
mod functions;
mod repeat;
mod slope;

use extent::{Extent, Line};
use rustc_hash::FxHashMap;
use slope::Known;

use crate::ids::IdMap;
use crate::walk::computed_where;
use crate::{Binary, Graph, LoopId, Node, NodeId, Type};

/// The least and the greatest value of a scalar on the stretch from one point to another, as two nodes.
///
/// `point` is the node that stands for a point of the stretch, `ends` are nodes of its type. `None` where the root
/// samples a shape, or is no number.
///
/// ```
/// use sdfc_graph::eval::{FrameValues, evaluate_frame};
/// use sdfc_graph::{Dim, FrameInput, Graph, Type, enclosure};
///
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let (length, radius) = (graph.length(p), graph.number(1.0));
/// let ball = graph.sub(length, radius);
/// let ends = [0, 1].map(|i| graph.frame_input(FrameInput::Param(i), Type::Vec3));
/// let range = enclosure(&mut graph, ball, p, ends).expect("flat math");
///
/// // From one side of the ball to the other.
/// let params = vec![[-3.0, 0.5, 0.0, 0.0], [2.0, 0.5, 0.0, 0.0]];
/// let values = evaluate_frame(&graph, &range, &FrameValues { params, ..FrameValues::default() });
/// assert!((values[0][0] + 0.5).abs() < 1e-5);
/// assert!((values[1][0] - (9.25_f64.sqrt() - 1.0)).abs() < 1e-5);
/// ```
pub fn enclosure(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    ends: [NodeId; 2],
) -> Option<[NodeId; 2]> {
    let mut enclosing = Enclosing::new(graph, None);
    let known = enclosing.of(root, point, ends)?;
    let span = enclosing.span(known.value);
    Some([span.lo, span.hi])
}

/// The least and the greatest slope of a scalar on a stretch, its derivative by s at `p + s * direction`, where the stretch
/// leads along `direction`. Where the value may jump there are no bounds: they are -1e15 and 1e15.
///
/// Two values on the stretch differ by no more than the slopes between them allow.
pub fn slope_enclosure(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    ends: [NodeId; 2],
    direction: NodeId,
) -> Option<[NodeId; 2]> {
    let mut enclosing = Enclosing::new(graph, Some(direction));
    let known = enclosing.of(root, point, ends)?;
    let slope = enclosing.slope(known);
    let span = enclosing.span(slope);
    Some([span.lo, span.hi])
}

/// A graph while bounds of its nodes are added to it.
struct Enclosing<'g> {
    graph: &'g mut Graph,
    /// Along what slopes are taken, if they are wanted.
    direction: Option<NodeId>,
    known: IdMap<Known>,
    loops: FxHashMap<LoopId, Vec<Known>>,
}

impl<'g> Enclosing<'g> {
    fn new(graph: &'g mut Graph, direction: Option<NodeId>) -> Self {
        Self { graph, direction, known: IdMap::default(), loops: FxHashMap::default() }
    }

    fn of(&mut self, root: NodeId, point: NodeId, ends: [NodeId; 2]) -> Option<Known> {
        if self.graph.ty(root) != Type::Scalar {
            return None;
        }
        let sizes = ends.map(|end| self.graph.abs(end));
        let size = self.graph.max(sizes[0], sizes[1]);
        let value = Extent::Line(Line { ends, size });
        let slope = self.direction.map(|direction| {
            let size = self.graph.abs(direction);
            Extent::Line(Line { ends: [direction; 2], size })
        });
        for id in computed_where(self.graph, &[root, point], |id| id != point) {
            if id == point {
                self.known.insert(id, Known { value, slope });
            } else {
                self.visit(id)?;
            }
        }
        self.known.get(root)
    }

    /// Bounds a node whose arguments are bounded.
    fn visit(&mut self, id: NodeId) -> Option<()> {
        if self.known.get(id).is_none() {
            let known = self.bounded(id)?;
            self.known.insert(id, known);
        }
        Some(())
    }

    fn bounded(&mut self, id: NodeId) -> Option<Known> {
        let node = self.graph.node(id);
        let of = |s: &Self, id| s.known.get(id);
        Some(match node {
            Node::Const(_) | Node::Frame(..) | Node::Variable(..) => {
                Known::fixed(Extent::Fixed(id))
            }
            Node::Unary(op, a) => {
                let x = of(self, a)?;
                let value = self.unary(op, x.value);
                let slope = self.unary_slope(op, x, value);
                Known { value, slope }
            }
            Node::Binary(op, a, b) => {
                let (x, y) = (of(self, a)?, of(self, b)?);
                // One argument twice is not two that vary apart.
                let value = if a == b && op == Binary::Mul {
                    self.square(x.value)
                } else if a == b && op == Binary::Dot {
                    self.square_of_length(x.value)
                } else {
                    self.binary(op, x.value, y.value)
                };
                let slope = self.binary_slope(op, x, y, value);
                Known { value, slope }
            }
            Node::Ternary(op, arguments) => {
                let [x, y, z] = arguments.map(|id| of(self, id));
                let all = [x?, y?, z?];
                let value = self.ternary(op, all.map(|known| known.value));
                let moves = all.iter().any(|known| known.slope.is_some())
                    || !matches!(all[0].value, Extent::Fixed(_));
                let slope = if moves && self.direction.is_some() {
                    self.ternary_slope(op, all)
                } else {
                    None
                };
                Known { value, slope }
            }
            Node::Splat(ty, a) => {
                let x = of(self, a)?;
                let value = self.splat(ty, x.value);
                Known { value, slope: x.slope.map(|slope| self.splat(ty, slope)) }
            }
            Node::Swizzle(ty, a, lanes) => {
                let x = of(self, a)?;
                let lanes = &lanes[..ty.width()];
                let mut moved = |x| self.moved(x, |graph, node| graph.swizzle(node, lanes));
                Known { value: moved(x.value), slope: x.slope.map(moved) }
            }
            Node::Compose(ty, parts) => {
                let mut all = Vec::with_capacity(ty.width());
                for &part in &parts[..ty.width()] {
                    all.push(of(self, part)?);
                }
                let values: Vec<Extent> = all.iter().map(|known| known.value).collect();
                let value = self.compose(&values);
                let slope = if all.iter().any(|known| known.slope.is_some()) {
                    let slopes: Vec<Extent> =
                        all.into_iter().map(|known| self.slope(known)).collect();
                    Some(self.compose(&slopes))
                } else {
                    None
                };
                Known { value, slope }
            }
            Node::Transform(columns, v) => {
                let [a, b, c] = columns.map(|id| of(self, id));
                let (columns, v) = ([a?, b?, c?], of(self, v)?);
                self.transformed(columns, v)
            }
            Node::Loop(repeated, position, _) => {
                if !self.loops.contains_key(&repeated) {
                    let results = self.repeat(repeated)?;
                    self.loops.insert(repeated, results);
                }
                *self.loops[&repeated].get(usize::from(position))?
            }
            Node::Element(table, at, _) => {
                let at = of(self, at)?;
                let table = self.graph.table(table).clone();
                self.element(&table, at)
            }
            Node::Point(..) | Node::Sample(..) | Node::MaterialAt(..) => return None,
        })
    }

    fn transformed(&mut self, columns: [Known; 3], v: Known) -> Known {
        let value = self.transform(columns.map(|column| column.value), v.value);
        let mut slope =
            v.slope.map(|slope| self.transform(columns.map(|column| column.value), slope));
        if columns.iter().any(|column| column.slope.is_some()) {
            let turned = columns.map(|column| self.slope(column));
            let turned = self.transform(turned, v.value);
            slope = Some(match slope {
                Some(slope) => self.binary(Binary::Add, slope, turned),
                None => turned,
            });
        }
        Known { value, slope }
    }
}
