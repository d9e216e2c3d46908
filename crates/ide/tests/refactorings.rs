//! Refactorings keep the meaning of a scene. `$0` marks the cursor or both ends of the selection.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test that cannot be set up fails")]

use sdfc_ide::{
    Action, ActionKind, Analysis, Edit, Found, NoFiles, Severity, actions, diagnostics, selection,
};
use sdfc_test_support::example_sources;

fn scene(text: &str) -> Analysis {
    Analysis::new("scene.sdf", text, &NoFiles)
}

fn applied(text: &str, edits: &[Edit]) -> String {
    let mut edits = edits.to_vec();
    edits.sort();
    let mut text = text.to_owned();
    for edit in edits.iter().rev() {
        text.replace_range(edit.at.range(), &edit.text);
    }
    text
}

/// The text after the first refactoring whose title begins with some words.
fn refactored(marked: &str, title: &str) -> Option<String> {
    let parts: Vec<&str> = marked.split("$0").collect();
    let (text, start) = (parts.concat(), parts[0].len());
    let end = if parts.len() > 2 { start + parts[1].len() } else { start };
    let found = actions(&scene(&text), start..end);
    let action = found.iter().find(|it| it.title.starts_with(title))?;
    assert_ne!(action.kind, ActionKind::Fix);
    Some(applied(&text, &action.edits))
}

#[test]
fn a_number_becomes_a_param() {
    let param = |text| refactored(text, "make it the param");
    assert_eq!(
        param("// A ball.\nsphere($00.5)\n").as_deref(),
        Some("// A ball.\nparam r: length = 0.5 in 0.25..1\nsphere(r)\n")
    );
    assert_eq!(
        param("let a = 1\nsphere(a).rotate(x: 4$00deg)").as_deref(),
        Some("let a = 1\nparam x2 = 40deg in -180deg..180deg\nsphere(a).rotate(x: x2)")
    );
    assert_eq!(
        param("let a = 1; let r = a; sphere($02)").as_deref(),
        Some("let a = 1; let r = a; param r2: length = 2 in 1..4; sphere(r2)")
    );
    assert_eq!(
        param("fn f(n: int) = 2 * n\nsphere(f($03))").as_deref(),
        Some("fn f(n: int) = 2 * n\nparam n2: int = 3 in 1..6\nsphere(f(n2))")
    );
    assert_eq!(
        param("sphere(1).roughness($00.8)").as_deref(),
        Some("param value = 0.8 in 0.4..1\nsphere(1).roughness(value)")
    );
    assert_eq!(param("sphere(1) - $0sphere(2)"), None);
    assert_eq!(param("sphere(1)\nmarch(epsilon: $00.01)"), None);
    assert_eq!(param("param r = $01\nsphere(r)"), None);
    assert_eq!(param("union(for i in 0..$05: sphere(i))"), None);
    assert_eq!(param("solid a(r: length = $01) = length(p) - r\na()"), None);
}

#[test]
fn an_expression_gets_a_name() {
    let name = |text| refactored(text, "give it the name");
    assert_eq!(
        name("$0sphere(1).translate(x: 1)$0 | box(1)\n").as_deref(),
        Some("let part = sphere(1).translate(x: 1)\npart | box(1)\n")
    );
    assert_eq!(
        name("solid a(r: length) = {\n  let q = p\n  length($0 q * 2 $0) - r\n}\na(1)").as_deref(),
        Some(
            "solid a(r: length) = {\n  let q = p\n  let value = q * 2\n  length( value ) - r\n}\na(1)"
        )
    );
    assert_eq!(
        name("solid a() = { let q = $02 * p$0; length(q) - 1 }\na()").as_deref(),
        Some("solid a() = { let value = 2 * p; let q = value; length(q) - 1 }\na()")
    );
    assert_eq!(
        name("solid a() = length(p) - $02 * 3$0\na()").as_deref(),
        Some("let value = 2 * 3\nsolid a() = length(p) - value\na()")
    );
    // There is no statement before which these names are known.
    assert_eq!(name("solid a() = $0length(p)$0 - 1\na()"), None);
    assert_eq!(name("union(for i in 0..5: sphere($0i / 2$0))"), None);
    assert_eq!(name("let a = sphere(1)\n$0a$0"), None);
    assert_eq!(name("$0sphere$0(1)"), None);
    assert_eq!(name("sphere($01 + 2) | bo$0x(1)"), None);
}

#[test]
fn a_call_becomes_a_method_call_and_back() {
    let cases = [
        ("translate($0sphere(1), x: 1)", "sphere(1).translate(x: 1)"),
        ("shel$0l(sphere(1) - box(1), 0.1)", "(sphere(1) - box(1)).shell(0.1)"),
        ("let a = s$0in(1deg)\nsphere(a)", "let a = (1deg).sin()\nsphere(a)"),
    ];
    for (call, method) in cases {
        let call = call.replacen("translate($0", "trans$0late(", 1);
        assert_eq!(refactored(&call, "call it as a method").as_deref(), Some(method));
        let at = method.find(".shell").or(method.find(".sin")).or(method.find(".translate"));
        let mut marked = method.to_owned();
        marked.insert_str(at.unwrap() + 2, "$0");
        let back = refactored(&marked, "call it as a function");
        assert_eq!(back, Some(call.replace("$0", "")));
    }
    assert_eq!(refactored("sphere(r$0: 1)", "call it"), None);
    assert_eq!(refactored("cam$0era([1, 2, 3])\nsphere(1)", "call it"), None);
    assert_eq!(refactored("union$0(for i in 0..3: sphere(i))", "call it"), None);
    assert_eq!(refactored("shell$0( // thin\n  sphere(1), 0.1)", "call it"), None);
}

/// Every refactoring at some positions of the examples gives a scene without errors. The range of a
/// new param is a guess, so what is computed from it may leave the range of another parameter.
#[test]
fn refactored_examples_have_no_errors() {
    let errors = |text: &str, ignored: &[&str]| -> Vec<Found> {
        let found = diagnostics(&scene(text), false).into_iter();
        let errors = found.filter(|it| it.severity == Severity::Error);
        errors.filter(|it| !ignored.contains(&it.code)).collect()
    };
    let mut counts = [0; 3];
    for (name, text) in example_sources().unwrap() {
        if !errors(&text, &[]).is_empty() {
            continue;
        }
        let analysis = scene(&text);
        let mut seen: Vec<Action> = Vec::new();
        for at in (0..text.len()).step_by((text.len() / 40).max(1)) {
            let selected = selection(&analysis, at);
            let ranges = selected.into_iter().take(3).chain(std::iter::once(at..at));
            seen.extend(ranges.flat_map(|range| actions(&analysis, range)));
        }
        seen.retain(|it| it.kind != ActionKind::Fix);
        seen.sort_by(|a, b| a.edits.cmp(&b.edits));
        seen.dedup();
        for action in seen.iter().step_by((seen.len() / 4).max(1)) {
            let is_param = action.title.contains("param");
            let ignored: &[&str] = if is_param { &["E0309", "E0310"] } else { &[] };
            let found = errors(&applied(&text, &action.edits), ignored);
            assert_eq!(found, [], "{name}: {action:?}");
            let is_rewrite = action.kind == ActionKind::Rewrite;
            counts[usize::from(is_param) + 2 * usize::from(is_rewrite)] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}
