//! The grammar of editors accepts the files that the compiler accepts, and builds the same
//! operators; its queries fit it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod corpus;
mod operators;
mod queries;

use std::collections::BTreeMap;

use sdfc_diagnostics::{Code, Diagnostic, Sources};
use sdfc_fuzz::texts::mutated;
use sdfc_syntax::ast::File;
use tree_sitter::{Parser, Tree};

/// The number of mutated files.
const MUTATIONS: usize = 5_000;

/// Parses with the grammar of editors.
pub fn parsed(text: &str) -> Tree {
    let mut parser = Parser::new();
    parser.set_language(&sdfc_tree_sitter::language()).unwrap();
    parser.parse(text, None).unwrap()
}

/// Parses with the compiler.
pub fn compiled(text: &str) -> (File, Vec<Diagnostic>) {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    sdfc_syntax::parse(&sources, file)
}

/// Why the grammar accepts a text that the compiler refuses. `None` if that is a mistake of the
/// grammar.
fn reason(text: &str, found: &[Diagnostic]) -> Option<&'static str> {
    // Each reason is that of all errors, so that none hides behind another.
    let all = |is: &dyn Fn(&Diagnostic) -> bool| found.iter().all(is);
    if all(&|it| it.code == Code::RESERVED && it.message.starts_with("`p` is the point")) {
        return Some("`p` is reserved in shapes only");
    }
    if all(&|it| it.code == Code::BAD_NUMBER && it.message.contains("too large")) {
        return Some("a number is too large");
    }
    if all(&|it| it.code == Code::NESTING) {
        return Some("brackets or chains exceed a limit");
    }
    if all(&|it| it.code == Code::BAD_NUMBER && it.message.contains("both sides of the point")) {
        let joined =
            |it: &Diagnostic| text[it.span.start as usize..it.span.end as usize].to_owned();
        return all(&|it| joined(it).ends_with('.'))
            .then_some("a line ends in a number and a point");
    }
    // The compiler ends a block at a `let` in the first column behind indented lines.
    let indented = text.replace("\nlet", "\n let");
    compiled(&indented).1.is_empty().then_some("a block has a `let` in the first column")
}

/// Returns the line of the first error of the grammar.
fn first_error<'t>(tree: &Tree, text: &'t str) -> &'t str {
    let mut open = vec![tree.root_node()];
    let mut first = text.len();
    while let Some(node) = open.pop() {
        if node.is_error() || node.is_missing() {
            first = first.min(node.start_byte());
        }
        let mut cursor = node.walk();
        open.extend(node.children(&mut cursor));
    }
    let start = text[..first].rfind('\n').map_or(0, |at| at + 1);
    text[start..].lines().next().unwrap_or_default()
}

/// Returns the reason of a difference; `Ok(None)` if both agree.
fn difference(text: &str) -> Result<Option<&'static str>, String> {
    let (tree, (file, found)) = (parsed(text), compiled(text));
    let accepts = !tree.root_node().has_error();
    match (accepts, found.is_empty()) {
        (true, true) => {
            let (theirs, ours) = (operators::of_grammar(&tree), operators::of_compiler(&file));
            let other = theirs.symmetric_difference(&ours).next();
            other.map_or(Ok(None), |it| Err(format!("other operands: `{}`", &text[it.0..it.1])))
        }
        (false, false) => Ok(None),
        (false, true) => Err(format!("only the compiler accepts `{}`", first_error(&tree, text))),
        (true, false) => match reason(text, &found) {
            Some(reason) => Ok(Some(reason)),
            None => {
                let line = text[found[0].span.start as usize..].lines().next();
                let line = line.unwrap_or_default();
                Err(format!("only the grammar accepts `{line}`: {}", found[0].message))
            }
        },
    }
}

#[test]
fn every_scene_and_snippet_means_the_same() {
    let files = sdfc_fuzz::texts::files().unwrap();
    assert!(files.len() > 300, "{}", files.len());
    for (name, text) in files {
        assert_eq!(difference(&text), Ok(None), "{name}");
    }
}

#[test]
fn five_thousand_mutations_are_accepted_or_refused_alike() {
    let files = sdfc_fuzz::texts::files().unwrap();
    let mut random = fastrand::Rng::with_seed(23);
    let mut accepted = 0;
    let mut differences: BTreeMap<&str, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for _ in 0..MUTATIONS {
        let text = mutated(&files, &mut random);
        accepted += usize::from(!parsed(&text).root_node().has_error());
        match difference(&text) {
            Ok(None) => {}
            Ok(Some(reason)) => *differences.entry(reason).or_default() += 1,
            Err(why) => wrong.push(why),
        }
    }
    println!("{accepted} of {MUTATIONS} mutations accepted; differences: {differences:#?}");
    assert!((500..MUTATIONS - 500).contains(&accepted), "{accepted} accepted");
    assert!(
        wrong.is_empty(),
        "{} differences without a reason:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// Texts that mutations seldom make.
#[test]
fn hard_cases_are_accepted_or_refused_alike() {
    let mut wrong = Vec::new();
    for text in [
        "",
        ";",
        "a;",
        "a;;",
        "a\n;b",
        "a\n;\n;b",
        "\u{feff}a",
        "a b",
        "a\nb",
        "a\n(b)",
        "a\n[b]",
        "a // c\n(b)",
        "a // c\n.b",
        "a\n// c\n\n// d\n| b",
        "a |\n b",
        "a\n!= b",
        "a\n!b",
        "a\n= b",
        "a\n.5",
        "a\n..b",
        "a\n...b",
        "f(\n(a)\n(b))",
        "f(a\n,b\n)",
        "f(a,)",
        "f(,)",
        "f()",
        "f(())",
        "1.x",
        "1.5.x",
        "1 .x",
        "1..2",
        "1...2",
        "1. .2",
        "1.e5",
        "1e5",
        "1e+5deg",
        "1e",
        "1E5",
        "3mm",
        "3 mm",
        "param k = 3in 0..1",
        "param k = 3 in 0..1",
        "param k = 3\nin 0..1",
        "param k = #fffin 0..1",
        "param k = 1 index",
        "#fff",
        "#ffff5",
        "#ff",
        "#g",
        "# fff",
        r#""a\"b""#,
        r#""a\qb""#,
        r#""\u{20ac}""#,
        r#""\u{d800}""#,
        r#""\u{0d800}""#,
        r#""\u{}""#,
        r#""\u{000041}""#,
        r#""\u{110000}""#,
        r#""\u{10ffff}""#,
        "\"a",
        "\"a\nb\"",
        "'a'",
        "\"// a\"",
        "\" a  // b \"",
        "a.\nb",
        "a . b",
        "a.let",
        "let let = 1",
        "letter",
        "lettuce(1)",
        "f(let: 1)",
        "f(if: 1)",
        "if a {b} else {c}",
        "if a {b} elsewhere",
        "if a {b} elseif c {d} else {e}",
        "if a {b}\nelse\nif c {d} else {e}",
        "if a {b}",
        "fn(x) = x",
        "fn (x) = x",
        "fn f(x) = x",
        "fn f (x)\n-> number\nlipschitz 2\neverywhere\n= x",
        "fn f(x) exact = x",
        "fn f(x) material m = x",
        "solid s() exact bound outside if a inside = p",
        "solid s() exact outside if a bounds 1..2 = p",
        "solid s() lipschitz 2everywhere = p",
        "solid s() copies copies = p",
        "solid s() hits a = p",
        "solid s() require a, \"b\" require c, \"d\" = p",
        "solid s() require a = p",
        "solid s = p",
        "solid s() = { let a = 1; a }",
        "solid s() = { let a = 1\n a\n }",
        "{ a; }",
        "{ a\n;}",
        "{ }",
        "{ let a = 1 }",
        "{ a\nb }",
        "{ a; let b = 1; b }",
        "{ let a = 1 a }",
        "{ let a = 1\n;a }",
        "a | b & c",
        "a & b | c",
        "a | b + c & d",
        "(a | b) & c",
        "a | (b & c)",
        "a - b & c",
        "a & b & c",
        "a < b < c",
        "a < b == c",
        "a..b..c",
        "a..b < c..d",
        "a < b && c < d || !e",
        "--a",
        "!-!a",
        "a - -b",
        "a--b",
        "a ->b",
        "a &&& b",
        "a &| b",
        "a =b",
        "a == = b",
        "[for x in a if b: c]",
        "[for x in a: for y in b: c, d]",
        "[a: 1]",
        "f(a: for x in b: c)",
        "f(for x in b: a: c)",
        "[for p in a: b]",
        "f(fn(x) = x, 1)",
        "fn(x) = x..1..2",
        "1..fn(x) = x..2",
        "a + fn(x) = x * 2 < 1",
        "f(a)(b)[c].d(e)",
        "{a}(b)",
        "if a {b} else {c}.d",
        "import a from \"b\"",
        "import a as b, c from \"d\"",
        "import from from \"b\"",
        "import as as as from \"b\"",
        "import a, from \"b\"",
        "import solid from \"b\"",
        "import a\nfrom\n\"b\"",
        "let exact = 1\nlet from = exact",
        "fn f(a: [fn(vec3, [number]) -> solid]) = a",
        "fn f(a: fn() -> x) = a",
        "fn f(a: fn(x,) -> y) = a",
        "fn f(a: fn(,) -> y) = a",
        "fn f(a...) = a",
        "fn f(a: b...) = a",
        "fn f(a: b ... = 1 in 0..1,) = a",
        "fn f(let) = 1",
        "region r(q: let) = p",
        "let p = 1",
        "/* a */ b",
        "a /* b */",
        "a // b",
        "//// a\n/// b\n///\na",
        "a\u{a0}b",
        "é",
        "a\tb",
        "a\u{c}",
        "a\r\nb",
        "a\rb",
        "1_000",
        "$",
        "a ? b : c",
        "a }",
        ") a",
    ] {
        let found = difference(text);
        if found != Ok(None) {
            wrong.push(format!("{text:?}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Each of the differences that the README of the grammar lists.
#[test]
fn known_differences_have_their_reasons() {
    let deep = format!("{}a{}", "(".repeat(300), ")".repeat(300));
    for (text, reason) in [
        ("solid s(p) = 1", "`p` is reserved in shapes only"),
        ("sphere(1e999)", "a number is too large"),
        (&deep, "brackets or chains exceed a limit"),
        ("let a = 1.\nx", "a line ends in a number and a point"),
        ("{\n  let a = 1\nlet b = 2\n  b\n}", "a block has a `let` in the first column"),
    ] {
        assert_eq!(difference(text), Ok(Some(reason)), "{text}");
    }
}
