//! The rules of ray methods, each a line of the method's file.

use libtest_mimic::{Failed, Trial};
use sdfc::march::{Method, method};

use crate::{Subject, wrong};

/// A method, a line of it, what is put in its place, and a scene under `tests` that it matters to.
type Mutant = (&'static str, &'static str, &'static str, &'static str);

const TAKEN_BACK: &str = "if stride > radius + abs(distance) {";

const MUTANTS: [Mutant; 16] = [
    (
        "auto",
        "if !bracket.crossed && !close && stride > last.y + max(distance, 0.0) + hit {",
        "if false {",
        "stability/thin_shell",
    ),
    ("auto", "if abs(distance) < hit {", "if abs(distance) < 64.0 * hit {", "stability/bumps"),
    ("auto", "if sampled.x <= min(sampled.y, end) {", "if sampled.x <= end {", "mutants/copies"),
    ("relaxed", TAKEN_BACK, "if false {", "stability/plates"),
    ("accelerated", TAKEN_BACK, "if false {", "stability/thin_shell"),
    ("auto-relaxed", TAKEN_BACK, "if false {", "stability/thin_shell"),
    ("sphere", "t += distance;", "t += 2.0 * distance;", "stability/thin_shell"),
    (
        "sphere-cone",
        "distance < tolerance(ray, t)",
        "distance < 8.0 * tolerance(ray, t)",
        "stability/past_a_ball",
    ),
    ("fixed", "stride *= 0.5;", "stride *= 1.0;", "stability/tips"),
    ("fixed", "if crossed {", "if false {", "stability/tips"),
    ("segment", "max(-slopes.x, 1e-6)", "max(-slopes.y, 0.5)", "stability/plates"),
    (
        "segment",
        "width(bracket) < hit_within(ray, t, near)",
        "width(bracket) < 64.0 * near",
        "stability/bumps",
    ),
    (
        "segment",
        "if step == 0u && distance < hit_within(ray, t, near) {",
        "if false {",
        "stability/resting_eye",
    ),
    ("interval", "if least > 0.0 ||", "if least > -1.0 ||", "stability/plates"),
    (
        "interval",
        "if evaluations == 0u && distance < hit_within(ray, t, tolerance(ray, t)) {",
        "if false {",
        "stability/resting_eye",
    ),
    (
        "interval",
        "width(bracket) < hit_within(ray, t, near)",
        "width(bracket) < 64.0 * near",
        "stability/bumps",
    ),
];

pub fn trials() -> Vec<Trial> {
    let trial = |(index, mutant): (usize, Mutant)| {
        Trial::test(format!("method {} {index}", mutant.0), move || is_noticed(mutant))
    };
    MUTANTS.into_iter().enumerate().map(trial).collect()
}

fn is_noticed((name, line, instead, scene): Mutant) -> Result<(), Failed> {
    let whole = method(name).ok_or("no such method")?;
    if !whole.source.contains(line) {
        return Err(format!("`{name}` has no `{line}`").into());
    }
    // A method of the table is static; this one lives as long as the test.
    let source = whole.source.replacen(line, instead, 1).leak();
    let mutant = Method { source, ..*whole };
    let subject = Subject::read(scene)?;
    let [right, broken] =
        [subject.drawn(&subject.scene, whole)?, subject.drawn(&subject.scene, &mutant)?];
    // A pixel in a thousand, or half as far off again.
    let slack = u64::from(crate::SIZE[0] * crate::SIZE[1]) / 1000;
    let worse = wrong(&broken) > wrong(&right) + slack
        || broken.depth.pixels.p99 > 1.5 * right.depth.pixels.p99 + 0.01;
    if worse { Ok(()) } else { Err(format!("whole: {right:?}, broken: {broken:?}").into()) }
}
