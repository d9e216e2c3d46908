//! Where shapes lie: stated bounds, or bounds derived from formulas.
//!
//! What a shape states is taken. Otherwise its formula is asked where it does not exceed 0, by rules that
//! keep per-frame values: hull for `min`, overlap for `max`, a limit that travels through sums, factors and
//! signs, and boxes seen through affine maps of the point; of a blend that ends, the hull of both beyond the limit by as much as it is
//! deep. An operator without a rule is shown
//! to stay positive wherever its samples are far enough from their surfaces. A leaf that states nothing is searched by
//! interval exclusion: half-spaces first, then slabs that move the faces inwards. The result of a rule that
//! gave something away is tightened in the same manner, on the whole formula.
//!
//! Every step is sound for all values that the params can take; numbers are computed in f64, whose rounding
//! symbolic faces may carry. A face that cannot be found is infinite.

mod affine;
mod ends;
mod level_set;
mod opaque;
mod search;
mod zone;

use rustc_hash::{FxHashMap, FxHashSet};

use self::level_set::{Question, RED_ZONE, STACK_STEP};
use self::zone::Zone;
use crate::eval::{FrameValues, Interval, Number, Tape, direct};
use crate::{
    Blends, Dim, Expander, Graph, Node, NodeId, Param, ParamKind, Shape, ShapeId, Stage,
    reachable_where,
};

/// A closed box of a shape of more parts is not tightened: a search of 32 evaluations, all that it would be granted, hardly
/// moves a face of it.
const MOST_TIGHTENED: usize = 512;

/// Derives the bounds of shapes of one arena, each once. It must not be used with another arena.
#[derive(Debug)]
pub struct Bounds {
    ranges: FrameValues<Interval>,
    memo: Memo,
    known: FxHashMap<ShapeId, [NodeId; 2]>,
}

/// What was found on the way.
#[derive(Debug, Default)]
struct Memo {
    shapes: FxHashMap<(ShapeId, NodeId), Zone>,
    tightened: FxHashMap<ShapeId, Zone>,
    questions: FxHashMap<Question, Zone>,
    exact: FxHashMap<ShapeId, bool>,
    expander: Expander,
    blends: Blends,
}

/// A derivation under way.
struct Deriver<'b> {
    graph: &'b mut Graph,
    ranges: &'b FrameValues<Interval>,
    memo: &'b mut Memo,
}

/// The bounds of one shape; see [`Bounds::of`].
pub fn bounds(graph: &mut Graph, shape: ShapeId, params: &[Param]) -> [NodeId; 2] {
    Bounds::new(params).of(graph, shape)
}

impl Bounds {
    /// Nothing derived yet. Bounds will hold for all values in the params' ranges; a number without a range
    /// can be any.
    pub fn new(params: &[Param]) -> Self {
        let ranges = FrameValues::ranges(params);
        Self { ranges, memo: Memo::default(), known: FxHashMap::default() }
    }

    /// The lowest and highest corner of a box that holds the shape: vectors of its dimension and of stage `Const`
    /// or `Frame`. A component is infinite where the box is open; `lo > hi` in any component means that there is
    /// nothing. A shape whose arguments depend on outer points gets a box for all of them.
    pub fn of(&mut self, graph: &mut Graph, shape: ShapeId) -> [NodeId; 2] {
        if let Some(&known) = self.known.get(&shape) {
            return known;
        }
        let mut deriver = Deriver { graph, ranges: &self.ranges, memo: &mut self.memo };
        let corners = deriver.corners(shape);
        self.known.insert(shape, corners);
        corners
    }

    /// How far an operator may carry the surface: nothing is inside where each distance that its formula samples exceeds
    /// this. 0 of a hard union, a quarter of the width of a smooth one, the radius of what rounds. `None` for a shape that
    /// samples none, and where no such number was found. It holds for all values of the params, and is never found
    /// to be less than 2^-22.
    pub fn reach(&mut self, graph: &mut Graph, shape: ShapeId) -> Option<f64> {
        Deriver { graph, ranges: &self.ranges, memo: &mut self.memo }.reach(shape)
    }
}

impl FrameValues<Interval> {
    /// All values that per-frame inputs can have, those of params by their ranges. A number without a range can be any.
    pub fn ranges(params: &[Param]) -> Self {
        Self {
            params: params.iter().map(|param| [range_of(param); 4]).collect(),
            time: Interval::ENTIRE,
            frame: Interval::ENTIRE,
        }
    }

    /// The values that the first lane of a node can have, whatever the point.
    pub fn range(&self, graph: &Graph, node: NodeId) -> Interval {
        let tape = Tape::new(graph, &[node]);
        tape.map_or(Interval::ENTIRE, |tape| tape.prepare_in(self).scalar([Interval::ENTIRE; 3]))
    }
}

/// The values that a param can take.
fn range_of(param: &Param) -> Interval {
    match (param.range, param.kind) {
        (Some([lo, hi]), _) => Interval::new(lo, hi),
        (None, ParamKind::Bool | ParamKind::Color) => Interval::new(0.0, 1.0),
        (None, ParamKind::Choice) => {
            Interval::new(0.0, param.choices.len().saturating_sub(1) as f64)
        }
        (None, ParamKind::Number | ParamKind::Int | ParamKind::Angle) => Interval::ENTIRE,
    }
}

impl Deriver<'_> {
    fn corners(&mut self, shape: ShapeId) -> [NodeId; 2] {
        let zone = self.tight_zone(shape);
        let axes = zone.axes.map(|[lo, hi]| {
            let (lowest, highest) = (self.range(lo).lo(), self.range(hi).hi());
            [self.per_frame(lo, lowest), self.per_frame(hi, highest)]
        });
        let dim = self.graph.shape(shape).dim;
        [0, 1].map(|side| self.vector(dim, axes.map(|ends| ends[side])))
    }

    /// Where a shape's field is not above 0, tightened if a rule gave something away.
    fn tight_zone(&mut self, shape: ShapeId) -> Zone {
        if let Some(&known) = self.memo.tightened.get(&shape) {
            return known;
        }
        let zone = match self.moved(shape) {
            Some(zone) => zone,
            None => self.tightened(shape),
        };
        self.memo.tightened.insert(shape, zone);
        zone
    }

    fn tightened(&mut self, shape: ShapeId) -> Zone {
        let zero = self.graph.number(0.0);
        let zone = self.shape_zone(shape, zero);
        if zone.tight {
            return zone;
        }
        let start = zone.axes.map(|[lo, hi]| [self.range(lo).lo(), self.range(hi).hi()]);
        let width = self.graph.shape(shape).dim.point_type().width();
        let is_closed = start[..width].iter().flatten().all(|end| end.is_finite());
        if is_closed && self.is_large(shape) {
            return zone;
        }
        let region = self.searched_within(shape, start);
        let found = Zone::of_numbers(self.graph, region);
        zone.overlap(self.graph, found)
    }

    /// Where a shape lies that is another one, moved or scaled along the axes if at all: where that one does. Copies, and what only
    /// paints, take no search of their own.
    fn moved(&mut self, shape: ShapeId) -> Option<Zone> {
        let Shape { formula, level, dim, contract, .. } = *self.graph.shape(shape);
        let (child, at) = self.graph.as_sample(formula)?;
        let to = self.graph.shape(child).dim;
        if contract.bounds.is_some() || dim != to {
            return None;
        }
        let rows = self.affine(at, level);
        if !self.is_along_axes(&rows, dim) {
            return None;
        }
        let zone = stacker::maybe_grow(RED_ZONE, STACK_STEP, || self.tight_zone(child));
        Some(self.preimage(zone, &rows, dim, to))
    }

    /// Whether the shape has so many parts that a search could not afford the evaluations to tighten its box.
    fn is_large(&self, shape: ShapeId) -> bool {
        let mut seen = FxHashSet::default();
        let mut left = vec![shape];
        while let Some(shape) = left.pop() {
            if seen.insert(shape) {
                left.extend(&self.graph.shape(shape).children);
            }
            if seen.len() > MOST_TIGHTENED {
                return true;
            }
        }
        false
    }

    /// The end itself, or what bounds it if it is not known per frame.
    fn per_frame(&mut self, end: NodeId, bound: f64) -> NodeId {
        let undefined = self.graph.as_number(end).is_some_and(f64::is_nan);
        if undefined || self.graph.stage(end) == Stage::Point {
            self.graph.number(bound)
        } else {
            end
        }
    }

    fn vector(&mut self, dim: Dim, parts: [NodeId; 3]) -> NodeId {
        let (ty, parts) = (dim.point_type(), &parts[..dim.point_type().width()]);
        let numbers: Option<Vec<f64>> =
            parts.iter().map(|&part| self.graph.as_number(part)).collect();
        match numbers {
            Some(numbers) => self.graph.constant(ty, &numbers),
            None => self.graph.compose(parts),
        }
    }

    /// The values that a scalar or truth value can take, whatever the point.
    fn range(&self, node: NodeId) -> Interval {
        if let Some(number) = self.graph.as_number(node) {
            return Interval::constant(number);
        }
        let graph = &*self.graph;
        let order = reachable_where(graph, &[node], |id| {
            !matches!(graph.node(id), Node::Sample(..) | Node::Loop(..))
        });
        direct::evaluate(graph, &order, |id| self.input(id))
    }

    /// Whether a condition holds for all values of the params.
    fn is_true(&self, condition: NodeId) -> bool {
        self.range(condition).lo() > 0.0
    }

    /// The lanes of a node that is no operation, whatever the point.
    fn input(&self, id: NodeId) -> [Interval; 4] {
        if let Node::Frame(input, _) = self.graph.node(id) {
            [0, 1, 2, 3].map(|lane| self.ranges.lane(input, lane))
        } else {
            [Interval::ENTIRE; 4]
        }
    }
}
