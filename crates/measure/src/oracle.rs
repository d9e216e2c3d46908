//! Finds the first root of the field along a ray by interval arithmetic.

use sdfc_graph::Program;
use sdfc_graph::eval::{BranchPath, Evaluator, FrameValues, Interval, Number, Tape, TapeError};

/// A segment this short, as a fraction of the distance, is not split again.
const FINEST: f64 = 1e-9;
/// A proven root is narrowed to this width, as a fraction of the distance.
const CLOSE: f64 = 1e-13;
/// Distances from an unproven segment, in its widths, at which signs are tested.
const SEARCH: [f64; 4] = [0.0, 1.0, 4.0, 16.0];
/// A root counts although a segment before it is unproven, if that is nearer to it than this
/// fraction of the distance: a ten-thousandth of a pixel.
const DOUBT: f64 = 1e-7;
/// The interval of the field at a single point is at most this wide, as a fraction of the point's
/// magnitude, except on a jump.
const NARROW: f64 = 1e-10;

/// A segment with more jumps than this is split before the paths through them are separated.
const FEW_JUMPS: usize = 2;
/// At most this many jumps are separated on a segment that is not split again.
const MOST_JUMPS: usize = 12;

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start, in scene units.
    pub origin: [f64; 3],
    /// Direction, a unit vector.
    pub direction: [f64; 3],
    /// Length, in scene units.
    pub t_max: f64,
}

impl Ray {
    /// Returns the point at a distance.
    pub fn at(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|axis| self.origin[axis] + t * self.direction[axis])
    }
}

/// The oracle's result for a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The ray hits the surface first at this distance. A ray that starts inside, or on the surface
    /// within the precision of f64, hits at 0.
    Hit(f64),
    /// The ray hits nothing.
    Miss,
    /// The ray hits nothing before this distance; what follows is not proven.
    Undecided(f64),
}

/// A verdict and its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// The result.
    pub verdict: Verdict,
    /// Interval evaluations of the field or its gradient.
    pub evaluations: u32,
}

/// Why a program has no oracle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OracleError {
    /// The program draws nothing.
    NothingDrawn,
    /// The program is not flat.
    NotFlat(TapeError),
}

impl std::fmt::Display for OracleError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NothingDrawn => f.write_str("the scene draws nothing"),
            Self::NotFlat(error) => write!(f, "the program is not flat: {error}"),
        }
    }
}

impl std::error::Error for OracleError {}

impl From<TapeError> for OracleError {
    fn from(error: TapeError) -> Self {
        Self::NotFlat(error)
    }
}

/// A scene's field, prepared for proofs along rays.
#[derive(Clone, Debug)]
pub struct Oracle {
    field: Tape,
    gradient: Option<Tape>,
}

impl Oracle {
    /// Prepares the field of a program.
    ///
    /// # Errors
    ///
    /// [`OracleError`].
    pub fn new(program: &Program) -> Result<Self, OracleError> {
        let distance = program.distance.ok_or(OracleError::NothingDrawn)?;
        let tape = |root| Tape::new(&program.graph, &[root]);
        let gradient = program.gradient.map(tape).transpose()?;
        Ok(Self { field: tape(distance)?, gradient })
    }

    /// Returns a prober for one frame. Each thread takes its own.
    pub fn prober(&self, frame: &FrameValues) -> Prober<'_> {
        Prober {
            range: self.field.prepare(frame),
            slopes: self.gradient.as_ref().map(|tape| tape.prepare(frame)),
            path: BranchPath::default(),
            value: self.field.prepare(frame),
            gradient: self.gradient.as_ref().map(|tape| tape.prepare(frame)),
            evaluations: 0,
        }
    }
}

/// An [`Oracle`] with the registers of its evaluators.
#[derive(Clone, Debug)]
pub struct Prober<'o> {
    range: Evaluator<'o, Interval>,
    slopes: Option<Evaluator<'o, Interval>>,
    path: BranchPath,
    value: Evaluator<'o, f64>,
    gradient: Option<Evaluator<'o, f64>>,
    evaluations: u32,
}

impl Prober<'_> {
    /// A ray that needs more interval evaluations stays undecided.
    pub const BUDGET: u32 = 100_000;

    /// Returns the field at a point, in scene units.
    pub fn distance(&mut self, point: [f64; 3]) -> f64 {
        self.value.scalar(point)
    }

    /// Returns the gradient at a point; NaN if the program has none.
    pub fn gradient(&mut self, point: [f64; 3]) -> [f64; 3] {
        let Some(gradient) = &mut self.gradient else { return [f64::NAN; 3] };
        let lanes = gradient.eval(point).first().copied().unwrap_or([f64::NAN; 4]);
        [lanes[0], lanes[1], lanes[2]]
    }

    /// Finds what the ray hits first.
    pub fn first_hit(&mut self, ray: &Ray) -> Probe {
        self.evaluations = 0;
        let verdict = self.search(ray);
        Probe { verdict, evaluations: self.evaluations }
    }

    fn search(&mut self, ray: &Ray) -> Verdict {
        let start = self.over(ray, 0.0, 0.0);
        // If the ray starts on a jump, the interval at its start is wide and proves nothing.
        let size = ray.origin.iter().fold(1.0, |size, x| x.abs().max(size));
        let is_narrow = start.hi() - start.lo() <= NARROW * size;
        if start.hi() <= 0.0 || (start.lo() <= 0.0 && is_narrow) {
            return Verdict::Hit(0.0);
        }
        // Segments that may contain the root, the nearest on top.
        let mut stretches = vec![(0.0, ray.t_max)];
        // The first unproven segment that is too short to split.
        let mut doubt = None;
        while let Some((from, to)) = stretches.pop() {
            if self.evaluations > Self::BUDGET {
                return Verdict::Undecided(doubt.unwrap_or(from));
            }
            let root = match self.look(ray, from, to) {
                Found::Nothing => continue,
                Found::OneRoot => self.closed_in(ray, from, to),
                Found::Maybe if to - from > FINEST * to => {
                    let middle = from + 0.5 * (to - from);
                    stretches.push((middle, to));
                    stretches.push((from, middle));
                    continue;
                }
                Found::Maybe => match self.crossing_about(ray, from, to) {
                    Some((from, to)) => self.closed_in(ray, from, to),
                    None => {
                        doubt.get_or_insert(from);
                        continue;
                    }
                },
            };
            return match doubt {
                Some(from) if root - from > DOUBT * root => Verdict::Undecided(from),
                Some(_) | None => Verdict::Hit(root),
            };
        }
        doubt.map_or(Verdict::Miss, Verdict::Undecided)
    }

    /// Classifies a segment by interval arithmetic.
    fn look(&mut self, ray: &Ray, from: f64, to: f64) -> Found {
        if self.is_free(ray, from, to) {
            return Found::Nothing;
        }
        if !self.path.is_empty() || self.path.is_open() {
            return Found::Maybe;
        }
        let Some(slope) = self.slope_over(ray, from, to) else { return Found::Maybe };
        let half = 0.5 * (to - from);
        let about = Interval::new(-half, half);
        let middle = self.over(ray, from + half, from + half);
        if !middle.add(slope.mul(about)).contains(0.0) {
            return Found::Nothing;
        }
        if slope.contains(0.0) {
            return Found::Maybe;
        }
        // The field is monotonic here, so the signs at the ends decide.
        let (first, last) = (self.over(ray, from, from), self.over(ray, to, to));
        match (sign(first), sign(last)) {
            (Some(first), Some(last)) if first == last => Found::Nothing,
            (Some(_), Some(_)) => Found::OneRoot,
            _ => Found::Maybe,
        }
    }

    /// Returns true if the field has one sign on a segment, on all paths through its jumps.
    /// Otherwise the path records if the segment has jumps.
    fn is_free(&mut self, ray: &Ray, from: f64, to: f64) -> bool {
        let most = if to - from > FINEST * to { FEW_JUMPS } else { MOST_JUMPS };
        let mut side = None;
        self.path.clear();
        loop {
            self.evaluations += 1;
            let range = self.range.scalar_along(stretch(ray, from, to), &mut self.path);
            match sign(range) {
                None if self.path.fork(most) => {}
                None => return false,
                found if side.is_some() && side != found => return false,
                found if self.path.advance() => side = found,
                Some(_) => return true,
            }
        }
    }

    /// Bisects a segment with one root down to the precision of f64.
    fn closed_in(&mut self, ray: &Ray, mut from: f64, mut to: f64) -> f64 {
        while to - from > CLOSE * to {
            let middle = from + 0.5 * (to - from);
            match sign(self.over(ray, middle, middle)) {
                Some(Sign::Outside) => from = middle,
                Some(Sign::Inside) => to = middle,
                None => return middle,
            }
        }
        from + 0.5 * (to - from)
    }

    /// Returns distances around an unproven segment between which the field goes from outside to
    /// inside.
    fn crossing_about(&mut self, ray: &Ray, from: f64, to: f64) -> Option<(f64, f64)> {
        let width = to - from;
        let mut find = |place: &dyn Fn(f64) -> f64| {
            let mut places = SEARCH.iter().map(|times| place(times * width));
            places.find_map(|t| sign(self.over(ray, t, t)).map(|sign| (t, sign)))
        };
        let (from, before) = find(&|away| (from - away).max(0.0))?;
        let (to, beyond) = find(&|away| (to + away).min(ray.t_max))?;
        (before == Sign::Outside && beyond == Sign::Inside).then_some((from, to))
    }

    /// Returns the interval of the field on a segment.
    fn over(&mut self, ray: &Ray, from: f64, to: f64) -> Interval {
        self.evaluations += 1;
        self.range.scalar(stretch(ray, from, to))
    }

    /// Returns the interval of the field's derivative along the ray on a segment.
    fn slope_over(&mut self, ray: &Ray, from: f64, to: f64) -> Option<Interval> {
        let slopes = self.slopes.as_mut()?;
        self.evaluations += 1;
        let [x, y, z, _] = *slopes.eval(stretch(ray, from, to)).first()?;
        let [dx, dy, dz] = ray.direction.map(Interval::constant);
        Some(x.mul(dx).add(y.mul(dy)).add(z.mul(dz)))
    }
}

/// The classification of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Found {
    Nothing,
    OneRoot,
    Maybe,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    Outside,
    Inside,
}

fn sign(range: Interval) -> Option<Sign> {
    if range.lo() > 0.0 {
        Some(Sign::Outside)
    } else if range.hi() < 0.0 {
        Some(Sign::Inside)
    } else {
        None
    }
}

/// Returns the bounding box of a ray segment.
fn stretch(ray: &Ray, from: f64, to: f64) -> [Interval; 3] {
    let t = Interval::new(from, to);
    std::array::from_fn(|axis| {
        let [origin, direction] = [ray.origin[axis], ray.direction[axis]].map(Interval::constant);
        origin.add(direction.mul(t))
    })
}
