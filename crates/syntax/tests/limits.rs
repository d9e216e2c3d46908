//! Exceeded limits are reported at the right position, and nothing overflows the stack.

#![allow(clippy::panic, reason = "these are tests")]

use sdfc_diagnostics::{Code, Diagnostic, Sources};
use sdfc_syntax::ast::File;
use sdfc_syntax::{MAX_BYTES, MAX_ERRORS, MAX_HEIGHT, MAX_NESTING, format, parse};

fn parsed(text: &str) -> (File, Vec<Diagnostic>) {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    parse(&sources, file)
}

/// Runs everything that recurses over a tree, on a small stack.
fn use_on_a_small_stack(text: String) -> Vec<Diagnostic> {
    let work = move || {
        let (tree, found) = parsed(&text);
        let copy = tree.clone();
        assert!(copy == tree);
        assert!(format!("{copy:?}").len() > 10);
        let mut sources = Sources::new();
        let file = sources.add("scene.sdf", &text);
        assert_eq!(format(&sources, file).is_ok(), found.is_empty());
        found
    };
    let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(work);
    thread.ok().and_then(|thread| thread.join().ok()).unwrap_or_else(|| panic!("overflow"))
}

fn codes(found: &[Diagnostic]) -> Vec<(Code, u32)> {
    found.iter().map(|found| (found.code, found.span.start)).collect()
}

/// Ways to nest: the text that opens a level, the innermost text, the text that closes a level.
const NESTINGS: &[(&str, &str, &str)] = &[
    ("(", "1", ")"),
    ("[", "1", "]"),
    ("f(", "1", ")"),
    ("f(a: ", "1", ")"),
    ("a[", "1", "]"),
    ("{", "1", "}"),
    ("if a {", "1", "} else { 2 }"),
    ("if a { 2 } else {", "1", "}"),
    ("fn(x) = ", "1", ""),
    ("{ let a = ", "1", "; a }"),
    ("-(", "1", ")"),
];

#[test]
fn the_first_level_past_the_limit_is_reported() {
    for (open, inner, close) in NESTINGS {
        let nested = |levels: usize| {
            format!("let x = {}{inner}{}", open.repeat(levels), close.repeat(levels))
        };
        let limit = MAX_NESTING as usize;
        assert_eq!(codes(&use_on_a_small_stack(nested(limit - 1))), [], "{open}");
        let found = use_on_a_small_stack(nested(100_000));
        let [(code, start)] = codes(&found)[..] else { panic!("{open}: {found:?}") };
        assert_eq!(code, Code::NESTING, "{open}");
        let level = (start as usize - "let x = ".len()) / open.len();
        assert!((limit - 1..=limit).contains(&level), "{open}: refused at level {level}");
    }
}

#[test]
fn the_limit_applies_to_types_and_comprehensions() {
    for (open, inner, close) in [("[", "number", "]"), ("fn(", "number", ") -> number")] {
        let text = |levels: usize| {
            format!("fn f(a: {}{inner}{}) = 1", open.repeat(levels), close.repeat(levels))
        };
        assert_eq!(codes(&use_on_a_small_stack(text(100))), []);
        assert_eq!(use_on_a_small_stack(text(100_000))[0].code, Code::NESTING);
    }
    let text = |levels: usize| format!("let x = [{}i]", "for i in 0..2: ".repeat(levels));
    assert_eq!(codes(&use_on_a_small_stack(text(200))), []);
    assert_eq!(use_on_a_small_stack(text(100_000))[0].code, Code::NESTING);
}

#[test]
fn the_first_link_of_a_chain_past_the_limit_is_reported() {
    let chains: &[(&str, &str, &str)] = &[
        ("a", " | a", ""),
        ("a", "\n  - a", ""),
        ("a", ".f()", ""),
        ("a", ".f", ""),
        ("a", "(1)", ""),
        ("a", "[1]", ""),
        ("", "-", "a"),
        ("", "!", "a"),
        ("", "if a { 1 } else ", "{ 2 }"),
    ];
    let sum = |links: u32| format!("let x = a{}", " + a".repeat(links as usize));
    assert_eq!(codes(&use_on_a_small_stack(sum(MAX_HEIGHT))), []);
    assert_eq!(codes(&use_on_a_small_stack(sum(MAX_HEIGHT + 1))).len(), 1);
    for (first, link, last) in chains {
        let chain = |links: u32| format!("let x = {first}{}{last}", link.repeat(links as usize));
        let few = MAX_HEIGHT / 2 - 2;
        assert_eq!(codes(&use_on_a_small_stack(chain(few))), [], "{link}");
        let found = use_on_a_small_stack(chain(1_000_000 / link.len() as u32));
        assert_eq!(found.len(), 1, "{link}: {found:?}");
        assert_eq!(found[0].code, Code::NESTING);
        assert!(found[0].message.contains("4096"), "{}", found[0].message);
    }
}

#[test]
fn nested_chains_count_together() {
    let mut text = "a".to_owned();
    for _ in 0..20 {
        text = format!("({text}{})", " + a".repeat(1000));
    }
    let found = use_on_a_small_stack(format!("let x = {text}\nlet y = 1 +"));
    let codes: Vec<Code> = found.iter().map(|found| found.code).collect();
    assert_eq!(codes, [Code::NESTING, Code::EXPECTED]);
}

#[test]
fn long_lists_are_allowed() {
    let text = format!("union({})", "sphere(1), ".repeat(20_000));
    assert_eq!(codes(&use_on_a_small_stack(text)), []);
    let text = "ball\n".repeat(20_000);
    assert_eq!(parsed(&text).0.items.len(), 20_000);
}

#[test]
fn a_file_past_the_limit_is_not_parsed() {
    let text = " ".repeat(MAX_BYTES);
    assert_eq!(parsed(&text).1, []);
    let (tree, found) = parsed(&(text + "1"));
    assert_eq!((tree.items.len(), found[0].code), (0, Code::TOO_LARGE));
}

#[test]
fn errors_past_the_limit_are_counted() {
    let (_, found) = parsed(&"let x = * 1\n".repeat(MAX_ERRORS + 23));
    assert_eq!(found.len(), MAX_ERRORS);
    let notes: Vec<&str> = found.iter().flat_map(|f| &f.notes).map(|n| &*n.message).collect();
    assert_eq!(notes, ["23 more errors in this file are not shown"]);
}
