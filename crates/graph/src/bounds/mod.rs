//! Bounds of shapes: stated, or derived from formulas.
//!
//! Stated bounds are taken as they are. Otherwise rules find where the shape's formula does not
//! exceed 0. They keep per-frame values: the hull for `min`, the intersection for `max`, a limit
//! that travels through sums, factors and signs, and boxes seen through affine maps of the point.
//! For a blend of finite width, the rule is the hull of both operands, with the limit raised by the
//! depth of the blend; for a long chain of blends, it is the hull of all operands, with the limit
//! raised by the width. An operator without a rule is shown to stay positive wherever its samples
//! are far enough from their surfaces. A leaf that states nothing is searched by interval
//! exclusion: first half-spaces, then slabs that move the faces inwards. If a rule lost precision,
//! the result is tightened by the same search over the whole formula.
//!
//! Every step is conservative for all values of the params. Numbers are computed in f64; symbolic
//! faces may carry its rounding errors. A face that cannot be found is infinite.

mod affine;
mod deriver;
mod ends;
mod level_set;
mod opaque;
mod search;
mod tighten;
mod zone;

use rustc_hash::FxHashMap;

use self::deriver::{Deriver, Memo};
use crate::eval::{FrameValues, Interval};
use crate::graph::Graph;
use crate::node::{NodeId, ShapeId};
use crate::scene::Param;

/// Derives the bounds of the shapes of one arena, each once. Must not be used with another arena.
#[derive(Debug)]
pub struct Bounds {
    ranges: FrameValues<Interval>,
    memo: Memo,
    known: FxHashMap<ShapeId, [NodeId; 2]>,
}

/// The bounds of one shape: see [`Bounds::of`].
pub fn bounds(graph: &mut Graph, shape: ShapeId, params: &[Param]) -> [NodeId; 2] {
    Bounds::new(params).of(graph, shape)
}

impl Bounds {
    /// Starts without any bounds derived. Bounds hold for all values in the params' ranges; a
    /// number without a range can be any.
    pub fn new(params: &[Param]) -> Self {
        let ranges = FrameValues::ranges(params);
        Self { ranges, memo: Memo::default(), known: FxHashMap::default() }
    }

    /// The lowest and the highest corner of a box that contains the shape: vectors of its dimension
    /// and of stage `Const` or `Frame`.
    ///
    /// A component is infinite where the box is unbounded. `lo > hi` in any component means that
    /// the shape is empty. A shape whose arguments depend on outer points gets a box for all of
    /// them.
    pub fn of(&mut self, graph: &mut Graph, shape: ShapeId) -> [NodeId; 2] {
        if let Some(&known) = self.known.get(&shape) {
            return known;
        }
        let mut deriver = Deriver { graph, ranges: &self.ranges, memo: &mut self.memo };
        let corners = deriver.corners(shape);
        self.known.insert(shape, corners);
        corners
    }

    /// The maximum distance by which an operator may move the surface outwards: the shape is empty
    /// wherever all distances that its formula samples exceed this.
    ///
    /// It is 0 for a hard union, a quarter of the width for a smooth one, and the radius for
    /// rounding. It holds for all values of the params, and is never less than 2^-22 unless it is
    /// 0. `None` for a shape that samples none, and where no such number was found.
    pub fn max_offset(&mut self, graph: &mut Graph, shape: ShapeId) -> Option<f64> {
        Deriver { graph, ranges: &self.ranges, memo: &mut self.memo }.reach(shape)
    }
}
