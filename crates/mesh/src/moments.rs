//! Volume and moments of a solid, as intervals that are proven to hold the truth.

use std::collections::BinaryHeap;

use rayon::prelude::*;
use sdfc_graph::eval::{Interval, Number};

use crate::error::{MeshError, Phase};
use crate::field::{Frame, LocalField, Prism, Prober};
use crate::half_space::Share;
use crate::refine::{OnProgress, report};
use crate::vector::{Vec3, add, between, length, sub, total, unit};

/// Boxes that are divided at once.
const CHUNK: usize = 512;
/// Planes are tried where a greater part of a box is unknown.
const ROUGH: f64 = 0.05;
/// Distances of the planes from the middle that are tried, as parts of what is unknown.
const THICKNESSES: [f64; 3] = [1e-3, 0.02, 0.2];
/// Boxes are divided together if they are at least this part as badly known as the worst one.
const ALIKE: f64 = 0.25;

/// The integrals of 1, of the coordinates and of their products, over a solid. The products are
/// xx, yy, zz, xy, xz, yz. Coordinates are relative to a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    pub(crate) volume: Interval,
    pub(crate) first: [Interval; 3],
    pub(crate) second: [Interval; 6],
}

/// The axes of the products.
pub(crate) const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

impl Moments {
    fn zero() -> Self {
        let zero = Interval::constant(0.0);
        Self { volume: zero, first: [zero; 3], second: [zero; 6] }
    }

    fn plus(self, other: Self) -> Self {
        let first = [0, 1, 2].map(|i| self.first[i].add(other.first[i]));
        let second = [0, 1, 2, 3, 4, 5].map(|i| self.second[i].add(other.second[i]));
        Self { volume: self.volume.add(other.volume), first, second }
    }

    /// Returns the moments of a whole box.
    fn of_box([lo, hi]: [Vec3; 2], about: Vec3) -> Self {
        let volume = volume([lo, hi]);
        let number = Interval::constant;
        let half = [0, 1, 2].map(|i| number(hi[i]).sub(number(lo[i])).mul(number(0.5)));
        let middle = [0, 1, 2].map(|i| number(lo[i]).add(half[i]).sub(number(about[i])));
        let first = middle.map(|x| volume.mul(x));
        let second = PAIRS.map(|[i, j]| {
            let product = if i == j {
                middle[i].square().add(half[i].square().div(number(3.0)))
            } else {
                middle[i].mul(middle[j])
            };
            volume.mul(product)
        });
        Self { volume, first, second }
    }

    /// Returns the moments of an unknown part of a box, of which only its size is known.
    fn of_part([lo, hi]: [Vec3; 2], inside: Interval, about: Vec3) -> Self {
        let volume = volume([lo, hi]).mul(inside);
        let range = [0, 1, 2].map(|i| {
            let about = Interval::constant(about[i]);
            Interval::new(lo[i], hi[i]).sub(about)
        });
        let first = range.map(|x| volume.mul(x));
        let second = PAIRS.map(|[i, j]| {
            let product = if i == j { range[i].square() } else { range[i].mul(range[j]) };
            volume.mul(product)
        });
        Self { volume, first, second }
    }

    /// Returns the moments relative to a point that is moved by `by`.
    fn moved(self, by: Vec3) -> Self {
        let by = by.map(Interval::constant);
        let first = [0, 1, 2].map(|i| self.first[i].sub(by[i].mul(self.volume)));
        let second: [Interval; 6] = std::array::from_fn(|index| {
            let [i, j] = PAIRS[index];
            let mixed = by[i].mul(self.first[j]).add(by[j].mul(self.first[i]));
            self.second[index].sub(mixed).add(by[i].mul(by[j]).mul(self.volume))
        });
        Self { volume: self.volume, first, second }
    }
}

fn volume([lo, hi]: [Vec3; 2]) -> Interval {
    let side = |i: usize| Interval::constant(hi[i]).sub(Interval::constant(lo[i]));
    side(0).mul(side(1)).mul(side(2))
}

/// A box that is inside in part, and the field around it.
struct Open<'f> {
    bounds: [Vec3; 2],
    inside: Interval,
    /// The estimated area of the surface in the box.
    area: f64,
    /// How badly the volume of the inside and its position are known, as a volume.
    width: f64,
    field: LocalField<'f>,
}

impl PartialEq for Open<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open<'_> {}

impl PartialOrd for Open<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open<'_> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.width.total_cmp(&other.width)
    }
}

/// The result of examining a box.
enum Outcome<'f> {
    Outside,
    Inside([Vec3; 2]),
    Open(Open<'f>),
}

/// A solid that is measured.
pub(crate) struct Integrator<'a, 'f> {
    pub(crate) field: &'a LocalField<'f>,
    /// A box that contains the solid.
    pub(crate) bounds: [Vec3; 2],
    /// The volume is known to this part of itself at the end, and the center of mass to this part
    /// of the longest side.
    pub(crate) relative: f64,
    pub(crate) max_cells: u64,
}

/// The integrals over a solid.
pub(crate) struct Integrals {
    pub(crate) moments: Moments,
    /// The point that the moments are relative to: about the center of mass.
    pub(crate) about: Vec3,
    pub(crate) area: f64,
    /// The middle of a box that is proven to be inside.
    pub(crate) inner: Option<Vec3>,
    pub(crate) cells: u64,
    /// True if the volume is not known as well as it was asked for.
    pub(crate) is_limited: bool,
}

impl<'f> Integrator<'_, 'f> {
    /// Divides the boxes that are known worst until the whole solid is known well enough.
    pub(crate) fn integrate(&self, progress: OnProgress<'_>) -> Result<Integrals, MeshError> {
        let [lo, hi] = self.bounds;
        let about = between(lo, hi, 0.5);
        let side = (0..3).fold(0.0, |side: f64, axis| side.max(hi[axis] - lo[axis]));
        // A cube a little larger than the bounds, so that round numbers of the scene are not on
        // the sides of boxes.
        let cube = [about.map(|x| x - 0.5087 * side), about.map(|x| x + 0.5113 * side)];
        let mut open = BinaryHeap::new();
        let mut sums = Moments::zero();
        let mut inner: Option<[Vec3; 2]> = None;
        match examine(cube, self.field, side) {
            Outcome::Open(part) => open.push(part),
            // The solid reaches beyond the bounds, and fills them.
            Outcome::Inside(_) => {
                sums = Moments::of_box(self.bounds, about);
                inner = Some(self.bounds);
            }
            Outcome::Outside => {}
        }
        let mut finished = Vec::new();
        let mut cells = 1;
        let mut width: f64 = open.iter().map(|part| part.width).sum();
        let mut known = 0.0;
        let mut is_limited = false;
        while !open.is_empty() && width > 2.0 * self.relative * known {
            if cells > self.max_cells {
                is_limited = true;
                break;
            }
            let chunk = worst(&mut open);
            width -= chunk.iter().map(|part| part.width).sum::<f64>();
            let (chunk, tiny): (Vec<_>, Vec<_>) =
                chunk.into_iter().partition(|part| is_divisible(part.bounds));
            is_limited |= !tiny.is_empty();
            finished.extend(tiny);
            let outcomes: Vec<Vec<Outcome<'f>>> =
                chunk.into_par_iter().map(|part| divide(part, side)).collect();
            for outcome in outcomes.into_iter().flatten() {
                cells += 1;
                match outcome {
                    Outcome::Outside => {}
                    Outcome::Inside(bounds) => {
                        sums = sums.plus(Moments::of_box(bounds, about));
                        known = sums.volume.lo();
                        if inner.is_none_or(|best| volume(best).lo() < volume(bounds).lo()) {
                            inner = Some(bounds);
                        }
                    }
                    Outcome::Open(part) => {
                        width += part.width;
                        open.push(part);
                    }
                }
            }
            report(progress, Phase::Measuring, cells as usize, cells as usize + 8 * open.len())?;
        }
        finished.extend(open);
        let parts = |about: Vec3| {
            let of = |part: &Open<'_>| Moments::of_part(part.bounds, part.inside, about);
            finished.iter().map(of).fold(Moments::zero(), Moments::plus)
        };
        let rough = sums.plus(parts(about));
        let middle = |x: Interval| 0.5 * (x.lo() + x.hi());
        let shift = rough.first.map(|first| middle(first) / middle(rough.volume));
        let shift = if shift.iter().all(|x| x.is_finite()) { shift } else { [0.0; 3] };
        let target = add(about, shift);
        // The shift as it was rounded.
        let moved = sums.moved(sub(target, about));
        Ok(Integrals {
            moments: moved.plus(parts(target)),
            about: target,
            area: total(finished.iter().map(|part| part.area)),
            inner: inner.map(|[lo, hi]| between(lo, hi, 0.5)),
            cells,
            is_limited,
        })
    }
}

/// Takes the boxes that are known worst.
fn worst<'f>(open: &mut BinaryHeap<Open<'f>>) -> Vec<Open<'f>> {
    let limit = open.peek().map_or(0.0, |part| ALIKE * part.width);
    let mut found = Vec::new();
    while found.len() < CHUNK && open.peek().is_some_and(|part| part.width >= limit) {
        found.extend(open.pop());
    }
    found
}

/// True if the middle of a box is not on its sides.
fn is_divisible([lo, hi]: [Vec3; 2]) -> bool {
    let middle = between(lo, hi, 0.5);
    (0..3).all(|axis| {
        let size = lo[axis].abs().max(hi[axis].abs());
        lo[axis] < middle[axis] && middle[axis] < hi[axis] && hi[axis] - lo[axis] > 1e-13 * size
    })
}

fn divide<'f>(part: Open<'f>, longest: f64) -> Vec<Outcome<'f>> {
    let field = part.field.around(part.bounds, 0.0);
    crate::certify::parts(part.bounds, false)
        .map(|bounds| examine(bounds, &field, longest))
        .collect()
}

/// Decides about a box. `longest` is the longest side of the solid's bounds.
fn examine<'f>(bounds: [Vec3; 2], field: &LocalField<'f>, longest: f64) -> Outcome<'f> {
    let mut prober = field.prober();
    let prism = Prism::aligned(bounds);
    match prober.side_over(&prism) {
        Some(false) => return Outcome::Outside,
        Some(true) => return Outcome::Inside(bounds),
        None => {}
    }
    let (center, slopes, error) = prober.affine_over(&prism).terms();
    let half = [0, 1, 2].map(|axis| 0.5 * (bounds[1][axis] - bounds[0][axis]));
    let mut share = Share::of(center, slopes, error);
    let mut gradient = length([0, 1, 2].map(|axis| slopes[axis] / half[axis]));
    let unknown = share.inside.hi() - share.inside.lo();
    if unknown > ROUGH
        && let Some(found) = between_planes(&mut prober, bounds, half, unknown)
    {
        share = found;
        gradient = 1.0;
    }
    let Share { inside, density } = share;
    let size = volume(bounds).hi();
    let area = size * density * gradient;
    // The undecided volume, plus the undecided first moment in units of the longest side.
    let position = inside.hi() * (bounds[1][0] - bounds[0][0]) / longest;
    let width = size * (inside.hi() - inside.lo() + position);
    Outcome::Open(Open { bounds, inside, area, width, field: field.clone() })
}

/// Returns what follows from two parallel planes between which the surface is proven to lie.
///
/// Where a formula has kinks that cancel each other, such as `max(x, 0) + min(x, 0)`, its bounds
/// are rough over a box that is cut by the kink, and good on both sides of it.
fn between_planes(
    prober: &mut Prober<'_>,
    bounds: [Vec3; 2],
    half: Vec3,
    unknown: f64,
) -> Option<Share> {
    let middle = between(bounds[0], bounds[1], 0.5);
    let (value, gradient) = prober.sample(middle);
    let normal = unit(gradient)?;
    let height = -value / length(gradient);
    let frame = Frame::around(bounds, normal);
    let thickest = unknown * frame.half[0];
    let thickness = THICKNESSES
        .map(|part| part * thickest)
        .into_iter()
        .find(|part| prober.is_between(&frame, 0.0, height - part, height + part))?;
    let slopes = [0, 1, 2].map(|axis| normal[axis] * half[axis]);
    Some(Share::of(-height, slopes, thickness * (1.0 + 1e-9) + 1e-12 * frame.half[0]))
}
