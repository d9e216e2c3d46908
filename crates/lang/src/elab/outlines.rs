//! Outlines: the kernel function `polygon_edges`, and boundaries as values.

use sdfc_graph::Type;

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::kernel::Application;
use super::value::Value;
use crate::outline::{Piece, Point};
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
