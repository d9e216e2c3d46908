//! Recognising affine maps of the point, and mapping boxes back through them.

use rustc_hash::FxHashMap;

use super::deriver::Deriver;
use super::ends::Ends;
use super::zone::Zone;
use crate::node::{Binary, Dim, Node, NodeId, Unary};
use crate::polynomial::{Polynomial, similarity_scale_squared};
use crate::walk::reachable;

/// `slopes · p + offset`, where slopes and offset are scalars that do not depend on p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Form {
    slopes: [NodeId; 3],
    offset: NodeId,
}

/// The affine forms of a node's lanes; `None` where a lane is not affine.
type Forms = [Option<Form>; 4];

impl Deriver<'_> {
    /// The node q as an affine map of the point of a level, by lane.
    pub(super) fn affine(&mut self, q: NodeId, level: u16) -> Forms {
        let mut known: FxHashMap<NodeId, Forms> = FxHashMap::default();
        for id in reachable(self.graph, &[q]) {
            let forms = self.forms(id, level, &known);
            known.insert(id, forms);
        }
        known.remove(&q).unwrap_or_default()
    }

    fn forms(&mut self, id: NodeId, level: u16, known: &FxHashMap<NodeId, Forms>) -> Forms {
        let width = self.graph.ty(id).width();
        if self.graph.levels(id) <= level {
            return self.lanes(width, |this, i| {
                let offset = this.graph.lane(id, i);
                Some(this.uniform(offset))
            });
        }
        let get = |id: NodeId, lane: usize| known.get(&id).and_then(|forms| forms[lane]);
        match self.graph.node(id) {
            Node::Point(own, _) if own == level => self.lanes(width, |this, i| {
                let (zero, one) = (this.graph.number(0.0), this.graph.number(1.0));
                let mut slopes = [zero; 3];
                slopes[i] = one;
                Some(Form { slopes, offset: zero })
            }),
            Node::Unary(Unary::Neg, a) => self.lanes(width, |this, i| {
                let minus = this.graph.number(-1.0);
                Some(this.scaled(get(a, i)?, minus))
            }),
            Node::Binary(op, a, b) => self.lanes(width, |this, i| {
                let (a, b) = (get(a, i)?, get(b, i)?);
                if op == Binary::Add {
                    Some(this.form_sum(a, b))
                } else if op == Binary::Sub {
                    Some(this.form_difference(a, b))
                } else if op == Binary::Mul {
                    this.product(a, b)
                } else if op == Binary::Div && this.is_uniform(b) {
                    Some(this.map(a, |this, part| this.graph.end_quotient(part, b.offset)))
                } else {
                    None
                }
            }),
            Node::Splat(_, a) => [get(a, 0); 4],
            Node::Compose(_, parts) => parts.map(|part| get(part, 0)),
            Node::Swizzle(_, a, lanes) => lanes.map(|lane| get(a, usize::from(lane))),
            Node::Transform(columns, v) => self.lanes(width, |this, row| {
                let zero = this.graph.number(0.0);
                let mut sum = this.uniform(zero);
                for (j, column) in columns.into_iter().enumerate() {
                    let term = this.product(get(column, row)?, get(v, j)?)?;
                    sum = this.form_sum(sum, term);
                }
                Some(sum)
            }),
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Ternary(..)
            | Node::Sample(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::MaterialAt(..) => [None; 4],
        }
    }

    fn lanes(
        &mut self,
        width: usize,
        mut lane: impl FnMut(&mut Self, usize) -> Option<Form>,
    ) -> Forms {
        let mut forms = [None; 4];
        for (i, form) in forms.iter_mut().enumerate().take(width) {
            *form = lane(self, i);
        }
        forms
    }

    fn uniform(&mut self, offset: NodeId) -> Form {
        Form { slopes: [self.graph.number(0.0); 3], offset }
    }

    fn is_uniform(&self, form: Form) -> bool {
        form.slopes.iter().all(|&slope| self.graph.is_number(slope, 0.0))
    }

    fn map(&mut self, form: Form, mut part: impl FnMut(&mut Self, NodeId) -> NodeId) -> Form {
        let slopes = form.slopes.map(|slope| part(self, slope));
        Form { slopes, offset: part(self, form.offset) }
    }

    fn scaled(&mut self, form: Form, factor: NodeId) -> Form {
        self.map(form, |this, part| this.graph.end_product(part, factor))
    }

    fn form_sum(&mut self, a: Form, b: Form) -> Form {
        let slopes = [0, 1, 2].map(|i| self.graph.end_sum(a.slopes[i], b.slopes[i]));
        Form { slopes, offset: self.graph.end_sum(a.offset, b.offset) }
    }

    fn form_difference(&mut self, a: Form, b: Form) -> Form {
        let slopes = [0, 1, 2].map(|i| self.graph.end_difference(a.slopes[i], b.slopes[i]));
        Form { slopes, offset: self.graph.end_difference(a.offset, b.offset) }
    }

    fn product(&mut self, a: Form, b: Form) -> Option<Form> {
        if self.is_uniform(a) {
            Some(self.scaled(b, a.offset))
        } else if self.is_uniform(b) {
            Some(self.scaled(a, b.offset))
        } else {
            None
        }
    }

    /// True if each axis of the image depends on exactly one axis of the point.
    pub(super) fn is_along_axes(&self, rows: &Forms, dim: Dim) -> bool {
        let is_one =
            |row: &Option<Form>| row.is_some_and(|form| self.varying_axes(form).count() == 1);
        rows[..dim.point_type().width()].iter().all(is_one)
    }

    /// The axes along which a form changes.
    fn varying_axes(&self, form: Form) -> impl Iterator<Item = usize> {
        (0..3).filter(move |&axis| !self.graph.is_number(form.slopes[axis], 0.0))
    }

    /// A box that contains every p whose image lies in the target. Rows with one slope bound one
    /// axis each. A square map with more slopes is inverted as a whole if it is rigid or constant.
    pub(super) fn preimage(&mut self, target: Zone, rows: &Forms, from: Dim, to: Dim) -> Zone {
        let mut zone = Zone::everywhere(self.graph);
        zone.tight = target.tight;
        let width = to.point_type().width();
        let mut mixing = false;
        for (row, &ends) in rows.iter().zip(&target.axes).take(width) {
            let Some(form) = *row else {
                zone.tight = false;
                continue;
            };
            let moved = self.subtracted(ends, form.offset);
            let axes: Vec<usize> = self.varying_axes(form).collect();
            if let [axis] = axes[..] {
                let ends = self.divided(moved, form.slopes[axis]);
                zone.axes[axis] = self.graph.common_ends(zone.axes[axis], ends);
            } else {
                mixing |= !axes.is_empty();
            }
        }
        if !mixing {
            return zone;
        }
        let complete: Option<Vec<Form>> = rows[..width].iter().copied().collect();
        let inverse = complete.filter(|_| from == to).and_then(|rows| self.inverse(&rows));
        match (inverse, rows) {
            (Some(inverse), &[Some(a), Some(b), c, _]) => {
                let offsets = [a.offset, b.offset, c.map_or(a.offset, |c| c.offset)];
                let image = self.image(target, &inverse, offsets);
                zone.overlap(self.graph, image)
            }
            (None, _) | (Some(_), [..]) => zone.loose(),
        }
    }

    fn subtracted(&mut self, ends: Ends, offset: NodeId) -> Ends {
        ends.map(|end| self.graph.end_difference(end, offset))
    }

    /// The interval divided by a slope; all numbers where the slope may be 0.
    fn divided(&mut self, [lo, hi]: Ends, slope: NodeId) -> Ends {
        let range = self.range(slope);
        let (positive, negative) = (range.lo() > 0.0, range.hi() < 0.0);
        if !positive && !negative {
            return self.graph.all_ends();
        }
        let infinite = [lo, hi].map(|end| self.graph.is_infinite(end));
        let mut over = |end: NodeId, infinite: bool| match (infinite, positive) {
            (true, true) => end,
            (true, false) => self.graph.end_negated(end),
            (false, true | false) => self.graph.end_quotient(end, slope),
        };
        let (a, b) = (over(lo, infinite[0]), over(hi, infinite[1]));
        if positive { [a, b] } else { [b, a] }
    }

    /// The rows of the linear part of the inverse map.
    fn inverse(&mut self, rows: &[Form]) -> Option<Vec<[NodeId; 3]>> {
        let n = rows.len();
        let numbers: Option<Vec<[f64; 3]>> = rows
            .iter()
            .map(|row| {
                let [x, y, z] = row.slopes.map(|slope| self.graph.as_number(slope));
                Some([x?, y?, z?])
            })
            .collect();
        if let Some(numbers) = numbers {
            let inverse = invert(&numbers)?;
            return Some(
                inverse[..n].iter().map(|row| row.map(|x| self.graph.number(x))).collect(),
            );
        }
        let zero = self.graph.number(0.0);
        let transposed = |i: usize| {
            let mut row = [zero; 3];
            for (entry, form) in row.iter_mut().zip(rows) {
                *entry = form.slopes[i];
            }
            row
        };
        self.is_rigid(rows).then(|| (0..n).map(transposed).collect())
    }

    /// True if the rows are orthonormal for all values of the params.
    fn is_rigid(&self, rows: &[Form]) -> bool {
        let polynomials = |row: &Form| {
            let [x, y, z] = row.slopes.map(|slope| Polynomial::of(self.graph, slope));
            Some([x?, y?, z?])
        };
        let rows: Option<Vec<_>> = rows.iter().map(polynomials).collect();
        let square = rows.and_then(|rows| similarity_scale_squared(&rows)?.constant());
        square.is_some_and(|square| (square - 1.0).abs() < 1e-12)
    }

    /// The box around the target, after subtracting the offsets and applying a linear map.
    fn image(&mut self, target: Zone, rows: &[[NodeId; 3]], offsets: [NodeId; 3]) -> Zone {
        let mut zone = Zone::everywhere(self.graph);
        zone.tight = target.tight;
        let sides = [0, 1, 2].map(|j| self.subtracted(target.axes[j], offsets[j]));
        for (axis, row) in zone.axes.iter_mut().zip(rows) {
            let zero = self.graph.number(0.0);
            let mut sum = [zero; 2];
            for (&factor, ends) in row.iter().zip(sides).take(rows.len()) {
                let [lo, hi] = self.multiplied(ends, factor);
                sum = [self.graph.end_sum(sum[0], lo), self.graph.end_sum(sum[1], hi)];
            }
            *axis = sum;
        }
        zone
    }

    fn multiplied(&mut self, [lo, hi]: Ends, factor: NodeId) -> Ends {
        let unbounded = [lo, hi].into_iter().any(|end| self.graph.is_infinite(end));
        if unbounded && self.graph.as_number(factor).is_none() {
            return self.graph.all_ends();
        }
        let (a, b) = (self.graph.end_product(lo, factor), self.graph.end_product(hi, factor));
        [self.graph.end_min(a, b), self.graph.end_max(a, b)]
    }
}

/// The inverse of a matrix of 2 or 3 rows, padded with the identity; `None` if it is singular.
fn invert(rows: &[[f64; 3]]) -> Option<[[f64; 3]; 3]> {
    let mut m = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (entry, row) in m.iter_mut().zip(rows) {
        *entry = *row;
    }
    // Cofactors; the cyclic indices give their signs.
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    let size = m.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
    if determinant.abs() <= 1e-9 * size.powi(3) {
        return None;
    }
    Some([0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(j, i) / determinant)))
}
