//! The rules of the analysis.

use libtest_mimic::{Failed, Trial};
use sdfc::accuracy_data::Metrics;
use sdfc_analyze::Rule;

use crate::{Subject, compiled};

/// Plain steps by the field, from the eye on: what looks ahead sees less of a scene's field.
const PLAIN: &str = "sphere";
/// For what is known of a ray before it is marched.
const AHEAD: &str = "auto";
/// Error in depth that 99 of 100 pixels of a right picture keep, in widths of a pixel.
const DEPTH: f64 = 0.5;

/// Each rule and the scene in this folder that stands for it.
const RULES: [(Rule, &str); 25] = [
    (Rule::Affine, "affine"),
    (Rule::Sum, "sum"),
    (Rule::Product, "product"),
    (Rule::Dot, "dot"),
    (Rule::Extreme, "extreme"),
    (Rule::Map, "map"),
    (Rule::Compose, "compose"),
    (Rule::Swizzle, "swizzle"),
    (Rule::Sample, "sample"),
    (Rule::Mix, "mix"),
    (Rule::Select, "select"),
    (Rule::Loop, "loop"),
    (Rule::Claim, "claim"),
    (Rule::Apart, "apart"),
    (Rule::Jump, "jump"),
    (Rule::Unbounded, "unbounded"),
    (Rule::Children, "children"),
    (Rule::Stated, "stated"),
    (Rule::Premise, "premise"),
    (Rule::Division, "division"),
    (Rule::Continuation, "continuation"),
    (Rule::Within, "within"),
    (Rule::Similarity, "similarity"),
    (Rule::Reach, "reach"),
    (Rule::Copies, "copies"),
];

pub fn trials() -> Vec<Trial> {
    let trial = |(rule, name)| Trial::test(format!("rule {name}"), move || is_noticed(rule, name));
    RULES.into_iter().map(trial).collect()
}

fn is_noticed(rule: Rule, name: &str) -> Result<(), Failed> {
    let subject = Subject::read(&format!("mutants/{name}"))?;
    let name = if matches!(rule, Rule::Reach | Rule::Copies) { AHEAD } else { PLAIN };
    let method = sdfc::march::method(name).ok_or("no such method")?;
    let is_wrong = |metrics: &Metrics| {
        metrics.missed + metrics.false_hits + metrics.nan > 0 || metrics.depth.pixels.p99 > DEPTH
    };
    if subject.scene.is_certified() {
        let whole = subject.drawn(&subject.scene, method)?;
        if is_wrong(&whole) {
            return Err(format!("the picture is wrong with all rules whole: {whole:?}").into());
        }
    }
    let mutant = rule.while_broken(|| compiled(&subject.text))?;
    if !mutant.is_certified() {
        return Err("with the rule broken the scene is uncertified: it promises nothing".into());
    }
    let broken = subject.drawn(&mutant, method)?;
    if !is_wrong(&broken) {
        return Err(format!("the picture is right with the rule broken: {broken:?}").into());
    }
    Ok(())
}

/// A rule without a scene would go unnoticed.
#[expect(dead_code, reason = "does not compile when a rule is missing here")]
fn every_rule_is_listed(rule: Rule) {
    match rule {
        Rule::Affine
        | Rule::Sum
        | Rule::Product
        | Rule::Dot
        | Rule::Extreme
        | Rule::Map
        | Rule::Compose
        | Rule::Swizzle
        | Rule::Sample
        | Rule::Mix
        | Rule::Select
        | Rule::Loop
        | Rule::Claim
        | Rule::Apart
        | Rule::Jump
        | Rule::Unbounded
        | Rule::Children
        | Rule::Stated
        | Rule::Premise
        | Rule::Division
        | Rule::Continuation
        | Rule::Within
        | Rule::Similarity
        | Rule::Reach
        | Rule::Copies => {}
    }
}
