//! The generator's contract, and the shrinker.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeSet;

use sdfc_fuzz::catalogue::Catalogue;
use sdfc_fuzz::tree::Program;
use sdfc_fuzz::{LEFT_OUT, generate, repair, shrink};
use sdfc_lang::reference;

/// The number of programs that are checked.
const CHECKED: u64 = 60;
/// The number of programs that together use the whole reference.
const GENERATED: u64 = 2000;
/// At most one in this many parts may have to be replaced.
const PARTS_PER_REPLACED: usize = 20;

#[test]
fn the_checker_accepts_generated_programs() {
    let catalogue = Catalogue::read().unwrap();
    let (mut replaced, mut parts) = (0, 0);
    for seed in 0..CHECKED {
        let accepted = repair(generate(&catalogue, seed)).unwrap_or_else(|(program, errors)| {
            panic!("seed {seed}: {errors}\n{}", program.text());
        });
        replaced += accepted.replaced;
        parts += accepted.program.size();
    }
    assert!(replaced * PARTS_PER_REPLACED < parts, "{replaced} of {parts} parts were replaced");
}

#[test]
fn generated_programs_use_the_whole_reference() {
    let catalogue = Catalogue::read().unwrap();
    let mut used = BTreeSet::new();
    for seed in 0..GENERATED {
        let text = generate(&catalogue, seed).text();
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        used.extend(words.map(str::to_owned));
    }
    let entries = reference::entries();
    let names = entries.iter().filter(|entry| !["type", "syntax"].contains(&entry.kind));
    let left_out = |name: &str| LEFT_OUT.iter().any(|row| row.0 == name);
    let missing: Vec<&str> = names
        .map(|entry| entry.name.as_str())
        .filter(|name| !used.contains(*name) && !left_out(name))
        .collect();
    assert!(missing.is_empty(), "never used: {missing:?}");
}

#[test]
fn a_seed_gives_one_program() {
    let catalogue = Catalogue::read().unwrap();
    let text = |seed| generate(&catalogue, seed).text();
    assert_eq!(text(7), text(7));
    assert_ne!(text(7), text(8));
}

#[test]
fn a_program_shrinks_to_what_a_fault_needs() {
    let catalogue = Catalogue::read().unwrap();
    let has_torus = |program: &Program| {
        program.text().contains("torus(")
            && sdfc::Compiler::new().compile("a", &program.text()).is_ok()
    };
    let accepted = |seed| repair(generate(&catalogue, seed)).ok().map(|it| it.program);
    let large = |program: &Program| program.size() > 100 && has_torus(program);
    let program = (0..100).filter_map(accepted).find(large).unwrap();
    let small = shrink(&program, 10_000, &mut |program| has_torus(program));
    assert!(has_torus(&small) && small.size() <= 6, "{}", small.text());
}
