//! The first root of the field along a ray, isolated by intervals.

use std::collections::HashSet;

use sdfc_graph::eval::{Evaluator, FrameValues, Interval, Number, Tape, TapeError};
use sdfc_graph::{Binary, Graph, Node, NodeId, Place, Program, Ternary, Unary, reachable};

/// A stretch this short, in parts of the distance, is not cut again.
const FINEST: f64 = 1e-9;
/// A proven root is closed in to this width, in parts of the distance.
const CLOSE: f64 = 1e-13;
/// Signs about an unproven stretch are looked for so many times its width away.
const SEARCH: [f64; 4] = [0.0, 1.0, 4.0, 16.0];
/// A root counts although something before it is not proven, if that is nearer to it than this part of
/// the distance: a ten-thousandth of a pixel.
const DOUBT: f64 = 1e-7;

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, in scene units.
    pub origin: [f64; 3],
    /// A unit vector.
    pub direction: [f64; 3],
    /// Where it ends, in scene units from its origin.
    pub t_max: f64,
}

impl Ray {
    /// The point at a distance.
    pub fn at(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|axis| self.origin[axis] + t * self.direction[axis])
    }
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The surface, first at this distance. A ray that starts inside is there at once.
    Hit(f64),
    /// Nothing.
    Miss,
    /// Nothing before this distance; what is there is not proven.
    Undecided(f64),
}

/// A verdict, and the evaluations over intervals that it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// What the ray meets.
    pub verdict: Verdict,
    /// Evaluations of the field or of its gradient.
    pub evaluations: u32,
}

/// Why a program has no oracle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OracleError {
    /// It draws nothing.
    NothingDrawn,
    /// It is not flat.
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

/// A scene's field, made ready to be asked.
#[derive(Clone, Debug)]
pub struct Oracle {
    field: Tape,
    /// Distance and gradient, for fields that the gradient describes everywhere.
    slopes: Option<Tape>,
    gradient: Option<Tape>,
}

impl Oracle {
    /// Of a program.
    ///
    /// # Errors
    ///
    /// [`OracleError`].
    pub fn new(program: &Program) -> Result<Self, OracleError> {
        let distance = program.distance.ok_or(OracleError::NothingDrawn)?;
        let tape = |root| Tape::new(&program.graph, &[root]);
        let gradient = program.gradient.map(tape).transpose()?;
        let slopes = if jumps(program, distance) { None } else { gradient.clone() };
        Ok(Self { field: tape(distance)?, slopes, gradient })
    }

    /// Whether derivatives help to decide: not where the formula can jump.
    pub fn uses_derivatives(&self) -> bool {
        self.slopes.is_some()
    }

    /// Ready for the rays of one frame; threads each take their own.
    pub fn prober(&self, frame: &FrameValues) -> Prober<'_> {
        Prober {
            range: self.field.prepare(frame),
            slopes: self.slopes.as_ref().map(|tape| tape.prepare(frame)),
            value: self.field.prepare(frame),
            gradient: self.gradient.as_ref().map(|tape| tape.prepare(frame)),
            evaluations: 0,
        }
    }
}

/// Whether the formula has an operation that jumps at a point: there its gradient does not tell how
/// it changes.
fn jumps(program: &Program, distance: NodeId) -> bool {
    let graph = &program.graph;
    // The number of a loop's round is the same at every point, and so is what follows from it.
    let mut moving = HashSet::new();
    reachable(graph, &[distance]).into_iter().any(|id| {
        let node = graph.node(id);
        let moves = matches!(node, Node::Point(..) | Node::Variable(_, Place::State(_), _))
            || graph.arguments(id).any(|argument| moving.contains(&argument));
        if moves {
            moving.insert(id);
        }
        moves && may_jump(graph, &node)
    })
}

/// Poles count as smooth: about one the interval of the derivative is infinite, which proves nothing.
fn may_jump(graph: &Graph, node: &Node) -> bool {
    match node {
        Node::Unary(op, _) => match op {
            Unary::Sign
            | Unary::Floor
            | Unary::Ceil
            | Unary::Round
            | Unary::Trunc
            | Unary::Fract
            | Unary::Normalize => true,
            Unary::Neg
            | Unary::Abs
            | Unary::Sqrt
            | Unary::InverseSqrt
            | Unary::Exp
            | Unary::Exp2
            | Unary::Log
            | Unary::Log2
            | Unary::Sin
            | Unary::Cos
            | Unary::Tan
            | Unary::Asin
            | Unary::Acos
            | Unary::Atan
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Tanh
            | Unary::Saturate
            | Unary::Length
            | Unary::Not => false,
        },
        Node::Binary(op, ..) => match op {
            Binary::Rem | Binary::Step | Binary::Hash | Binary::Atan2 => true,
            Binary::Add
            | Binary::Sub
            | Binary::Mul
            | Binary::Div
            | Binary::Min
            | Binary::Max
            | Binary::Pow
            | Binary::Dot
            | Binary::Cross
            | Binary::Lt
            | Binary::Le
            | Binary::Eq
            | Binary::Ne
            | Binary::And
            | Binary::Or => false,
        },
        Node::Ternary(op, _) => match op {
            Ternary::Select => true,
            Ternary::Mix | Ternary::Clamp | Ternary::Smoothstep => false,
        },
        Node::Loop(id, ..) => graph.repeated(*id).go_on.is_some(),
        Node::Element(..) | Node::Sample(..) | Node::MaterialAt(..) => true,
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..)
        | Node::Transform(..) => false,
    }
}

/// An [`Oracle`] with its registers.
#[derive(Clone, Debug)]
pub struct Prober<'o> {
    range: Evaluator<'o, Interval>,
    slopes: Option<Evaluator<'o, Interval>>,
    value: Evaluator<'o, f64>,
    gradient: Option<Evaluator<'o, f64>>,
    evaluations: u32,
}

impl Prober<'_> {
    /// A ray that needs more evaluations over intervals stays undecided.
    pub const BUDGET: u32 = 100_000;

    /// The field at a point, in scene units.
    pub fn distance(&mut self, point: [f64; 3]) -> f64 {
        self.value.scalar(point)
    }

    /// The gradient at a point; NaN without one.
    pub fn gradient(&mut self, point: [f64; 3]) -> [f64; 3] {
        let Some(gradient) = &mut self.gradient else { return [f64::NAN; 3] };
        let lanes = gradient.eval(point).first().copied().unwrap_or([f64::NAN; 4]);
        [lanes[0], lanes[1], lanes[2]]
    }

    /// What the ray meets first.
    pub fn first_hit(&mut self, ray: &Ray) -> Probe {
        self.evaluations = 0;
        let verdict = self.search(ray);
        Probe { verdict, evaluations: self.evaluations }
    }

    fn search(&mut self, ray: &Ray) -> Verdict {
        if self.over(ray, 0.0, 0.0).hi() <= 0.0 {
            return Verdict::Hit(0.0);
        }
        // Stretches that may hold the root, the nearest on top.
        let mut stretches = vec![(0.0, ray.t_max)];
        // The first stretch too short to cut of which nothing is proven.
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

    /// What intervals say of a stretch.
    fn look(&mut self, ray: &Ray, from: f64, to: f64) -> Found {
        let range = self.over(ray, from, to);
        if !range.contains(0.0) {
            return Found::Nothing;
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
        // The field only rises or only falls here: the signs at the ends tell all.
        let (first, last) = (self.over(ray, from, from), self.over(ray, to, to));
        match (sign(first), sign(last)) {
            (Some(first), Some(last)) if first == last => Found::Nothing,
            (Some(_), Some(_)) => Found::OneRoot,
            _ => Found::Maybe,
        }
    }

    /// Halves a stretch with one root until it is as narrow as f64 can tell.
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

    /// Distances about a stretch too short to cut between which the field leads from outside to inside.
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

    /// All values of the field on a stretch.
    fn over(&mut self, ray: &Ray, from: f64, to: f64) -> Interval {
        self.evaluations += 1;
        self.range.scalar(stretch(ray, from, to))
    }

    /// All derivatives of the field along the ray on a stretch.
    fn slope_over(&mut self, ray: &Ray, from: f64, to: f64) -> Option<Interval> {
        let slopes = self.slopes.as_mut()?;
        self.evaluations += 1;
        let [x, y, z, _] = *slopes.eval(stretch(ray, from, to)).first()?;
        let [dx, dy, dz] = ray.direction.map(Interval::constant);
        Some(x.mul(dx).add(y.mul(dy)).add(z.mul(dz)))
    }
}

/// What a stretch holds.
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

/// The box about a stretch of a ray.
fn stretch(ray: &Ray, from: f64, to: f64) -> [Interval; 3] {
    let t = Interval::new(from, to);
    std::array::from_fn(|axis| {
        let [origin, direction] = [ray.origin[axis], ray.direction[axis]].map(Interval::constant);
        origin.add(direction.mul(t))
    })
}
