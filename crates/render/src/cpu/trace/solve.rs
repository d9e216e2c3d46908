//! The search for the only surface along rays on which the field falls.

use sdfc_graph::eval::{Evaluator, Packet, vectorized};

use super::group::GROUP;
use crate::cpu::ray::{LANES, Real, packed_from};

/// After this many evaluations, every second one halves the interval.
const SECANTS: u32 = 4;
/// The maximum number of evaluations.
const MOST: u32 = 40;
/// Beyond the end of any ray.
const FAR: f64 = 1e30;

/// A part of a ray that may hit a surface, and on which the field falls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate<T> {
    pub(super) index: usize,
    pub(super) from: T,
    pub(super) to: T,
    /// Where the surface is expected, and how much the field falls there per unit of length.
    pub(super) guess: T,
    pub(super) slope: T,
    /// How much the field falls per unit of length at least and at most.
    pub(super) flat: T,
    pub(super) steep: T,
    /// The largest error of the surface's position.
    pub(super) error: T,
}

/// A search along several rays.
pub(super) struct Search<T> {
    count: usize,
    index: [usize; GROUP],
    /// The interval in which the field is 0, if it is anywhere.
    low: [T; GROUP],
    high: [T; GROUP],
    /// The end of the part of the ray.
    end: [T; GROUP],
    guess: [T; GROUP],
    /// The last guess, and the field there.
    last: [T; GROUP],
    before: [T; GROUP],
    slope: [T; GROUP],
    flat: [T; GROUP],
    steep: [T; GROUP],
    error: [T; GROUP],
    value: [T; GROUP],
    status: [Status; GROUP],
    points: Vec<[Packet<T, LANES>; 3]>,
    values: Vec<Packet<T, LANES>>,
    found: Vec<(usize, Option<T>, u32)>,
}

/// The result of the search along a ray so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Status {
    Open,
    Hit,
    Free,
    /// The field is undefined at a guess.
    Undefined,
}

impl<T: Real> Search<T> {
    pub(super) fn new() -> Self {
        let zeros = [T::constant(0.0); GROUP];
        Self {
            count: 0,
            index: [0; GROUP],
            low: zeros,
            high: zeros,
            end: zeros,
            guess: zeros,
            last: zeros,
            before: zeros,
            slope: zeros,
            flat: zeros,
            steep: zeros,
            error: zeros,
            value: zeros,
            status: [Status::Open; GROUP],
            points: Vec::new(),
            values: Vec::new(),
            found: Vec::with_capacity(GROUP),
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.found.clear();
    }

    /// Adds a ray; at most [`GROUP`] of them.
    pub(super) fn push(&mut self, candidate: Candidate<T>) {
        let Candidate { index, from, to, guess, slope, flat, steep, error } = candidate;
        let place = self.count.min(GROUP - 1);
        self.index[place] = index;
        self.low[place] = from;
        self.high[place] = T::constant(FAR);
        self.end[place] = to;
        self.guess[place] = guess;
        self.slope[place] = slope;
        self.flat[place] = flat;
        self.steep[place] = steep;
        self.error[place] = error;
        self.count = place + 1;
    }

    /// The rays of the last search: for each its index, the position of its surface if there is
    /// one (NaN if the field is undefined on the way), and the number of evaluations.
    pub(super) fn found(&self) -> &[(usize, Option<T>, u32)] {
        &self.found
    }

    /// Searches all rays. `point` gives the point of a ray at a position.
    pub(super) fn run(
        &mut self,
        field: &mut Evaluator<'_, Packet<T, LANES>>,
        point: impl Fn(usize, T) -> [T; 3],
    ) {
        for evaluations in 1..=MOST {
            if self.count == 0 {
                return;
            }
            self.evaluate(field, &point);
            vectorized(
                #[inline(always)]
                || self.advance(evaluations),
            );
            let mut kept = 0;
            for place in 0..self.count {
                if self.status[place] == Status::Open && evaluations < MOST {
                    self.keep(kept, place);
                    kept += 1;
                    continue;
                }
                let (guess, undefined) = (self.guess[place], T::constant(f64::NAN));
                let hit = match self.status[place] {
                    // An open search that has seen no inside has found no surface.
                    Status::Open => (self.high[place] <= self.end[place]).then_some(guess),
                    Status::Hit => Some(guess),
                    Status::Free => None,
                    Status::Undefined => Some(undefined),
                };
                self.found.push((self.index[place], hit, evaluations));
            }
            self.count = kept;
        }
    }

    /// Evaluates the field at the guesses.
    fn evaluate(
        &mut self,
        field: &mut Evaluator<'_, Packet<T, LANES>>,
        point: impl Fn(usize, T) -> [T; 3],
    ) {
        let count = self.count;
        let (indices, guesses) = (&self.index[..count], &self.guess[..count]);
        self.points.clear();
        for (indices, guesses) in indices.chunks(LANES).zip(guesses.chunks(LANES)) {
            let pairs = indices.iter().zip(guesses);
            self.points.push(packed_from(pairs.map(|(&index, &guess)| point(index, guess))));
        }
        self.values.resize(self.points.len(), Packet([T::constant(0.0); LANES]));
        field.scalars(&self.points, &mut self.values);
        for (lanes, Packet(values)) in self.value.chunks_mut(LANES).zip(&self.values) {
            lanes.copy_from_slice(values);
        }
    }

    /// Takes the values of the field at the guesses, and makes the next guesses.
    #[inline(always)]
    fn advance(&mut self, evaluations: u32) {
        let (zero, half) = (T::constant(0.0), T::constant(0.5));
        let is_first = evaluations == 1;
        let halves = evaluations > SECANTS && evaluations % 2 == 1;
        for place in 0..self.count.min(GROUP) {
            let (guess, value) = (self.guess[place], self.value[place]);
            let (flat, steep) = (self.flat[place], self.steep[place]);
            // The field is 0 this far ahead, at least and at most; behind if it is negative.
            let (near, far) = (value.div(steep), value.div(flat));
            let is_outside = value > zero;
            let (nearer, farther) = if is_outside { (near, far) } else { (far, near) };
            let low = self.low[place].max(guess + nearer);
            let high = self.high[place].min(guess + farther);
            let end = self.end[place];
            let secant = (self.before[place] - value).div(guess - self.last[place]);
            let slope = if is_first { self.slope[place] } else { secant };
            let slope = if slope > flat { slope } else { flat };
            let slope = if slope < steep { slope } else { steep };
            let until = high.min(end);
            let next = guess + value.div(slope);
            let next = if next < until { next } else { until };
            let next = if next > low { next } else { low };
            let error = self.error[place];
            let is_hit = (high - low <= error) | (value.abs() <= error * flat);
            let middle = half * (low + until);
            self.guess[place] = if halves & !is_hit { middle } else { next };
            (self.last[place], self.before[place]) = (guess, value);
            (self.low[place], self.high[place]) = (low, high);
            let is_defined = is_outside | (value <= zero);
            self.status[place] = if !is_defined {
                Status::Undefined
            } else if low > end {
                Status::Free
            } else if is_hit {
                Status::Hit
            } else {
                Status::Open
            };
        }
    }

    /// Moves a ray to an earlier place.
    fn keep(&mut self, to: usize, from: usize) {
        self.index[to] = self.index[from];
        for row in [
            &mut self.low,
            &mut self.high,
            &mut self.end,
            &mut self.guess,
            &mut self.last,
            &mut self.before,
            &mut self.slope,
            &mut self.flat,
            &mut self.steep,
            &mut self.error,
        ] {
            row[to] = row[from];
        }
    }
}
