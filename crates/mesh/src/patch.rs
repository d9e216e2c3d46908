//! The triangles of one cell: a fan or a cone over each loop on the cell's boundary.

use crate::field::{Prober, is_inside};
use crate::grid::{Cell, Corner, Face, Grid};
use crate::qef::nearest_to_planes;
use crate::vector::{SurfacePoint, Vec3, add, between, dot, length, scale, sub, unit};

/// A vertex of a loop on the boundary of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoopVertex {
    pub(crate) id: u32,
    pub(crate) point: SurfacePoint,
    /// Bits of the cell's sides that contain the vertex.
    pub(crate) sides: u8,
}

/// How a loop is filled.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Filling {
    /// Triangles from the vertex at this index.
    Fan(usize),
    /// Triangles from a vertex within the cell.
    Cone(Vec3),
}

/// A vertex is placed within the face or the cell, if without it the surface is farther away than
/// this fraction of the error.
const FLAT: f64 = 0.35;
/// Roots are found to this fraction of the error.
pub(crate) const ROOT: f64 = 1e-3;

/// Returns the index from which a fan lies within the cell: no segment between other vertices is on
/// a side that contains this vertex.
fn fan_start(vertices: &[LoopVertex]) -> Option<usize> {
    let count = vertices.len();
    (0..count).find(|&start| {
        (1..count - 1).all(|step| {
            let [a, b] = [step, step + 1].map(|step| vertices[(start + step) % count].sides);
            vertices[start].sides & a & b == 0
        })
    })
}

/// What vertices are placed with.
pub(crate) struct Placer<'a, 'f> {
    pub(crate) prober: &'a mut Prober<'f>,
    pub(crate) grid: &'a Grid,
    /// The allowed error.
    pub(crate) error: f64,
}

impl Placer<'_, '_> {
    /// True if a corner of the grid is inside.
    pub(crate) fn is_inside(&mut self, at: Corner) -> bool {
        is_inside(self.prober.value(self.grid.position(at)))
    }

    /// Returns the point where the surface crosses an edge between two corners.
    pub(crate) fn crossing(&mut self, ends: [Vec3; 2], size: u32) -> SurfacePoint {
        let values = ends.map(|end| self.prober.value(end));
        let span = self.grid.length(size);
        let margin = self.grid.margin(size) / span;
        let t = self.prober.root(ends, values, ROOT * self.error).clamp(margin, 1.0 - margin);
        let position = self.grid.rounded(between(ends[0], ends[1], t));
        self.at(position)
    }

    /// Returns the unit normal at a point; 0 where the field has no gradient.
    pub(crate) fn normal(&mut self, point: Vec3) -> Vec3 {
        self.at(point).normal
    }

    fn at(&mut self, position: Vec3) -> SurfacePoint {
        let (_, gradient) = self.prober.sample(position);
        SurfacePoint { position, normal: unit(gradient).unwrap_or([0.0; 3]) }
    }

    /// Returns the vertex within a face between two crossings, if a straight chord is not enough.
    pub(crate) fn in_face(&mut self, face: Face, ends: [SurfacePoint; 2]) -> Option<SurfacePoint> {
        let axis = usize::from(face.axis);
        let flat = ends.map(|end| {
            let mut normal = end.normal;
            normal[axis] = 0.0;
            SurfacePoint { position: end.position, normal: unit(normal).unwrap_or([0.0; 3]) }
        });
        let middle = between(ends[0].position, ends[1].position, 0.5);
        let bulge = flat.map(|end| dot(end.normal, sub(middle, end.position)).abs());
        if bulge[0].max(bulge[1]) <= FLAT * self.error {
            return None;
        }
        let lo = self.grid.position(face.at);
        let hi = lo.map(|x| x + self.grid.length(face.size));
        let mut limits = inner([lo, hi], self.grid.margin(face.size));
        limits[0][axis] = lo[axis];
        limits[1][axis] = lo[axis];
        let target = nearest_to_planes(middle, &flat, limits);
        let mut normal = add(flat[0].normal, flat[1].normal);
        normal[axis] = 0.0;
        let position = self.towards(middle, target, normal, limits)?;
        let chord = unit(sub(ends[1].position, ends[0].position))?;
        let offset = sub(position, middle);
        let away = length(sub(offset, scale(chord, dot(offset, chord))));
        (away > FLAT * self.error).then(|| self.at(position))
    }

    /// Returns how the loops of a cell are filled.
    pub(crate) fn fillings(&mut self, cell: Cell, loops: &[Vec<LoopVertex>]) -> Vec<Filling> {
        let is_alone = loops.len() == 1;
        loops.iter().map(|vertices| self.filling(cell, vertices, is_alone)).collect()
    }

    fn filling(&mut self, cell: Cell, vertices: &[LoopVertex], is_alone: bool) -> Filling {
        let sum = vertices.iter().fold([0.0; 3], |sum, v| add(sum, v.point.position));
        let middle = scale(sum, 1.0 / vertices.len() as f64);
        let limits = inner(self.grid.bounds(cell), self.grid.margin(cell.size));
        let fan = fan_start(vertices);
        if let Some(start) = fan
            && (self.is_flat(vertices, middle) || (!is_alone && vertices.len() == 3))
        {
            return Filling::Fan(start);
        }
        let fallback = clamped(middle, limits);
        if !is_alone {
            // Beside other loops, only the hull of this one is free.
            return Filling::Cone(self.grid.rounded(fallback));
        }
        let planes: Vec<SurfacePoint> = vertices.iter().map(|v| v.point).collect();
        let target = nearest_to_planes(clamped(middle, limits), &planes, limits);
        let normal = planes.iter().fold([0.0; 3], |sum, plane| add(sum, plane.normal));
        let apex = self.towards(middle, target, normal, limits);
        Filling::Cone(apex.unwrap_or_else(|| self.grid.rounded(fallback)))
    }

    fn is_flat(&self, vertices: &[LoopVertex], middle: Vec3) -> bool {
        vertices.iter().all(|vertex| {
            let SurfacePoint { position, normal } = vertex.point;
            dot(normal, sub(middle, position)).abs() <= FLAT * self.error
        })
    }

    /// Returns a point of the surface within limits: in the direction of the target if there is
    /// one, else along the normal.
    fn towards(
        &mut self,
        middle: Vec3,
        target: Vec3,
        normal: Vec3,
        limits: [Vec3; 2],
    ) -> Option<Vec3> {
        let middle = clamped(middle, limits);
        let start = self.prober.value(middle);
        let reach = length(sub(limits[1], limits[0]));
        let along = unit(normal).map(|n| {
            let sign = if is_inside(start) { 1.0 } else { -1.0 };
            add(middle, scale(n, sign * reach))
        });
        let distance = length(sub(target, middle));
        let target = (distance > 1e-6 * reach && distance.is_finite()).then_some(target);
        let beyond = target.map(|target| add(middle, scale(sub(target, middle), 1.5)));
        for end in [target, beyond, along].into_iter().flatten() {
            let end = clipped(middle, end, limits);
            let value = self.prober.value(end);
            if is_inside(value) != is_inside(start) {
                let t = self.prober.root([middle, end], [start, value], ROOT * self.error);
                return Some(self.grid.rounded(clamped(between(middle, end, t), limits)));
            }
        }
        None
    }
}

/// Returns the box, smaller by a margin on all sides.
fn inner([lo, hi]: [Vec3; 2], margin: f64) -> [Vec3; 2] {
    [lo.map(|x| x + margin), hi.map(|x| x - margin)]
}

fn clamped(point: Vec3, [lo, hi]: [Vec3; 2]) -> Vec3 {
    std::array::from_fn(|axis| point[axis].clamp(lo[axis], hi[axis]))
}

/// Returns the last point within a box on the way from a point of it to another point.
fn clipped(from: Vec3, to: Vec3, limits: [Vec3; 2]) -> Vec3 {
    let mut t: f64 = 1.0;
    for axis in 0..3 {
        let step = to[axis] - from[axis];
        let room = limits[usize::from(step > 0.0)][axis] - from[axis];
        if step.abs() > room.abs() {
            t = t.min(room / step);
        }
    }
    clamped(between(from, to, t), limits)
}
