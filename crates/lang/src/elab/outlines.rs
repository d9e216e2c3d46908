//! Outlines: the kernel functions `polygon_edges` and `outline_cells`, and boundaries as values.

use sdfc_graph::{NodeId, Type};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::kernel::Application;
use super::value::Value;
use crate::cells::{self, Layout};
use crate::outline::{Curve, Piece, Point};
use crate::polygon;

impl<'p> Elaborator<'p> {
    /// `polygon_edges(points)`: an empty list if a corner is not constant.
    pub(super) fn polygon_edges(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        self.tick(at.span)?;
        let points = at.args.first().ok_or(Poison)?;
        let points = self.sequence(env, points, "the corners of a polygon")?;
        let corners: Option<Vec<Point>> = points.iter().map(|point| self.corner(point)).collect();
        let corners = corners.filter(|corners| corners.len() <= polygon::MAX_CORNERS);
        let Some(corners) = corners else { return Ok(Value::List([].into())) };
        // Pairs of edges are compared much faster than expressions are evaluated.
        self.steps += (corners.len() * corners.len() / 64) as u64;
        Ok(self.pieces(polygon::boundary(&corners)))
    }

    /// `outline_cells(pieces, corner, side, counts)`: the indices of the first items of all cells
    /// and of their end, the items, and the largest number of items of a cell. Without any cell if
    /// an argument is not constant, or not allowed.
    pub(super) fn outline_cells(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        self.tick(at.span)?;
        let [pieces, layout @ ..] = at.args else { return Err(Poison) };
        let pieces = self.sequence(env, pieces, "the pieces of an outline")?;
        let [corner, side, counts] = self.numbers(env, layout)?;
        let curves: Option<Vec<Curve>> = pieces.iter().map(|piece| self.curve(piece)).collect();
        let (mut starts, mut items) = (Vec::new(), Vec::new());
        if let (Some(curves), Some(layout)) = (curves, self.layout(corner, side, counts)) {
            let cells = cells::cells(&curves, layout);
            // Distances and lists are computed much faster than expressions are evaluated.
            self.steps += (cells.distances / 64 + cells.items.len() / 4) as u64;
            (starts, items) = (cells.starts, cells.items);
        }
        let most = starts.windows(2).map(|ends| ends[1] - ends[0]).max().unwrap_or(0);
        let mut list = |indices: Vec<usize>| {
            let number = |index: usize| Value::Node(self.graph.number(index as f64));
            Value::List(indices.into_iter().map(number).collect())
        };
        Ok(Value::List([list(starts), list(items), list(vec![most])].into()))
    }

    fn layout(&self, corner: NodeId, side: NodeId, counts: NodeId) -> Option<Layout> {
        let constant = |node| Some(self.graph.as_const(node)?.lanes());
        let ([x, y, ..], [side, ..]) = (constant(corner)?, constant(side)?);
        let [columns, rows, ..] = constant(counts)?;
        let is_count = |count: f64| count >= 1.0 && count <= cells::MAX_CELLS as f64;
        if ![columns, rows, columns * rows].into_iter().all(is_count) || side <= 0.0 {
            return None;
        }
        let counts = [columns as usize, rows as usize];
        Some(Layout { corner: [x, y], side, counts })
    }

    /// The curve of a piece in the form of [`Self::pieces`].
    fn curve(&self, piece: &Value<'p>) -> Option<Curve> {
        let Value::List(pairs) = piece else { return None };
        let [start, control, end, ..] = &pairs[..] else { return None };
        Some([self.corner(start)?, self.corner(control)?, self.corner(end)?])
    }

    fn corner(&self, point: &Value<'p>) -> Option<Point> {
        let Value::Node(node) = point else { return None };
        let [x, y, ..] = self.graph.as_const(*node)?.lanes();
        (x.is_finite() && y.is_finite()).then_some([x, y])
    }

    /// The pieces of a boundary as lists of four vectors: start, control point, end, corners.
    pub(super) fn pieces(&mut self, pieces: Vec<Piece>) -> Value<'p> {
        self.steps += 4 * pieces.len() as u64;
        let piece = |Piece { curve: [start, control, end], corners }: Piece| {
            let pairs = [start, control, end, corners];
            let pairs = pairs.map(|pair| Value::Node(self.graph.constant(Type::Vec2, &pair)));
            Value::List(pairs.into())
        };
        Value::List(pieces.into_iter().map(piece).collect())
    }
}
