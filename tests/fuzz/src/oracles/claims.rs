//! What the compiler claims of a field, checked at points. The field is evaluated in f64, and no
//! rule of the compiler takes part in the check.

use fastrand::Rng;
use sdfc::{Compiler, Field, LoopStrategy, Scene};

use super::{Outcome, Subject, Verdict, finding};
use crate::repair::NAME;

/// The number of points at which a claim is checked.
const POINTS: usize = 120;
/// The points around each of them for claims about a neighbourhood.
const NEIGHBOURS: usize = 8;
/// Points lie in a cube of this half side around the origin.
const REACH: f64 = 3.0;
/// The step of a difference quotient, and how far quotients of both sides may differ where the
/// field is smooth: relative to 1 or to the quotient, if that is more.
const STEP: f64 = 1e-6;
const SMOOTH: f64 = 1e-4;
/// The largest difference between a gradient and a quotient, as above.
const SLOPE: f64 = 1e-3;
/// Rounding of two sums of the same terms in f64, relative to 1 or to the sum.
const ROUNDING: f64 = 1e-9;

/// Points in a cube around the origin, half of them close to it.
fn points(random: &mut Rng) -> Vec<[f64; 3]> {
    let mut coordinate = |reach: f64| reach * (2.0 * random.f64() - 1.0);
    let point = |at| [REACH, REACH / 3.0][at % 2];
    (0..POINTS).map(|at| [(); 3].map(|()| coordinate(point(at)))).collect()
}

/// A seed that is the same for equal texts.
fn random(subject: &Subject) -> Rng {
    let bytes = subject.text.bytes().map(u64::from);
    Rng::with_seed(bytes.fold(7, |seed, byte| seed.wrapping_mul(31).wrapping_add(byte)))
}

fn field_of(scene: &Scene) -> Result<Field<'_>, super::Finding> {
    scene.field(&scene.defaults()).map_err(|error| finding("no field", error))
}

/// The gradient is the slope of the field where quotients of both sides agree.
pub(super) fn gradient(subject: &Subject) -> Outcome {
    let mut field = field_of(&subject.scene)?;
    for point in points(&mut random(subject)) {
        let sample = field.gradient(point);
        for axis in 0..3 {
            let mut at = |step: f64| {
                let mut moved = point;
                moved[axis] += step;
                field.distance(moved)
            };
            let [below, above] = [at(-STEP), at(STEP)];
            let (left, right) =
                ((sample.distance - below) / STEP, (above - sample.distance) / STEP);
            let slope = f64::midpoint(left, right);
            let scale = slope.abs().max(1.0);
            let is_smooth = (right - left).abs() <= SMOOTH * scale;
            // Written so that a gradient that is no number differs.
            let agrees = (sample.gradient[axis] - slope).abs() <= SLOPE * scale;
            if is_smooth && !agrees {
                let found = sample.gradient[axis];
                let message = format!("at {point:?}, axis {axis}: {found}, and the slope {slope}");
                return Err(finding("another slope", message));
            }
        }
    }
    Ok(Verdict::Holds)
}

/// A certified field is no more than the distance to the surface: it does not change its sign
/// within that distance.
pub(super) fn certificate(subject: &Subject) -> Outcome {
    if !subject.scene.is_certified() {
        return Ok(Verdict::LeftOut);
    }
    let mut random = random(subject);
    let mut field = field_of(&subject.scene)?;
    for point in points(&mut random) {
        let distance = field.distance(point);
        if !distance.is_finite() || distance <= 0.0 {
            continue;
        }
        // Within the reach, a large field is a sphere around most points.
        let radius = distance.min(4.0 * REACH) * (1.0 - ROUNDING);
        for _ in 0..NEIGHBOURS {
            let near = on_sphere(point, radius * random.f64().cbrt(), &mut random);
            let found = field.distance(near);
            if found < -ROUNDING * (1.0 + distance) {
                let message =
                    format!("{distance} at {point:?}, and {found} at {near:?}, {radius} away");
                return Err(finding("too far", message));
            }
        }
    }
    Ok(Verdict::Holds)
}

/// A point at a distance from another, in a random direction.
fn on_sphere(center: [f64; 3], radius: f64, random: &mut Rng) -> [f64; 3] {
    let (z, turn) = (2.0 * random.f64() - 1.0, std::f64::consts::TAU * random.f64());
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let direction = [ring * turn.cos(), ring * turn.sin(), z];
    [0, 1, 2].map(|axis| center[axis] + radius * direction[axis])
}

/// Nothing is inside outside of the scene's bounds.
pub(super) fn bounds(subject: &Subject) -> Outcome {
    let scene = &subject.scene;
    let Some([lo, hi]) = scene.bounds_at(&scene.defaults()) else { return Ok(Verdict::LeftOut) };
    let mut field = field_of(scene)?;
    let mut outside = 0;
    for point in points(&mut random(subject)) {
        // A region is the same in all planes.
        let axes = if scene.is_planar() { 2 } else { 3 };
        let is_inside = (0..axes).all(|axis| {
            let margin = ROUNDING * (1.0 + point[axis].abs());
            point[axis] >= lo[axis] - margin && point[axis] <= hi[axis] + margin
        });
        if is_inside {
            continue;
        }
        outside += 1;
        let distance = field.distance(point);
        if distance < -ROUNDING {
            let message = format!("{distance} at {point:?}, outside of {lo:?} to {hi:?}");
            return Err(finding("outside of the bounds", message));
        }
    }
    Ok(if outside > 0 { Verdict::Holds } else { Verdict::LeftOut })
}

/// Loops over lists and plain formulas are one field.
pub(super) fn loops(subject: &Subject) -> Outcome {
    let compiled = |strategy| {
        let scene = Compiler::new().loops(strategy).compile(NAME, &subject.text);
        scene.map_err(|errors| finding("refused", errors))
    };
    let looped = compiled(LoopStrategy::Looped)?;
    if looped.report().loops.is_empty() {
        return Ok(Verdict::LeftOut);
    }
    let plain = compiled(LoopStrategy::Unrolled)?;
    let (mut plain, mut looped) = (field_of(&plain)?, field_of(&looped)?);
    for point in points(&mut random(subject)) {
        let (a, b) = (plain.distance(point), looped.distance(point));
        if a.is_finite() && (a - b).abs() > ROUNDING * (1.0 + a.abs()) || a.is_nan() != b.is_nan() {
            return Err(finding("another field", format!("{a} and in loops {b} at {point:?}")));
        }
    }
    Ok(Verdict::Holds)
}
