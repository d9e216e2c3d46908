//! For arbitrary text the parser never panics, and all spans of its diagnostics and trees are
//! valid.

use proptest::prelude::*;
use sdfc_diagnostics::{Diagnostic, FileId, Sources, Span, render};
use sdfc_syntax::ast::File;
use sdfc_syntax::{MAX_ERRORS, parse};

const FILE: FileId = FileId(0);

/// Parses a text and checks the properties that hold for every text.
fn check(text: &str) -> (File, Vec<Diagnostic>) {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    let (tree, found) = parse(&sources, file);
    for diagnostic in &found {
        assert!(fits(text, diagnostic.span), "{diagnostic:?} in {text:?}");
        for note in &diagnostic.notes {
            assert!(note.span.is_none_or(|span| fits(text, span)), "{note:?} in {text:?}");
        }
    }
    assert!(found.len() <= MAX_ERRORS);
    let mut starts: Vec<u32> = found.iter().map(|found| found.span.start).collect();
    starts.dedup();
    assert_eq!(starts.len(), found.len(), "two errors at one place in {text:?}");
    assert!(starts.is_sorted());
    // Rendering falls back to a bare line for an invalid span, which must not happen.
    let rendered = render(&sources, &found, false);
    assert_eq!(rendered.matches("┌─ scene.sdf").count(), found.len());
    for span in spans_printed(&format!("{tree:?}")) {
        assert!(fits(text, span), "{span:?} in the tree of {text:?}");
    }
    let broken = format!("{tree:?}").contains("kind: Error");
    assert!(!broken || !found.is_empty(), "silently broken: {text:?}");
    (tree, found)
}

fn fits(text: &str, span: Span) -> bool {
    span.file == FILE && text.get(span.start as usize..span.end as usize).is_some()
}

/// Returns every span of a tree, read from its debug output.
fn spans_printed(tree: &str) -> Vec<Span> {
    let number = |text: &str| -> Option<u32> {
        text.chars().take_while(char::is_ascii_digit).collect::<String>().parse().ok()
    };
    let span = |part: &str| {
        let (_, start) = part.split_once("start: ")?;
        let (_, end) = part.split_once("end: ")?;
        Some(Span::new(FILE, number(start)?, number(end)?))
    };
    tree.split("Span { file: ").skip(1).filter_map(span).collect()
}

/// Words and symbols of the language, and some that are not.
fn token() -> impl Strategy<Value = &'static str> {
    let words = [
        "let",
        "param",
        "fn",
        "solid",
        "region",
        "shape",
        "import",
        "if",
        "else",
        "for",
        "in",
        "true",
        "false",
        "exact",
        "bound",
        "lipschitz",
        "bounds",
        "material",
        "require",
        "from",
        "as",
        "a",
        "p",
        "sphere",
        "1",
        "0.5",
        "90deg",
        ".5",
        "3mm",
        "#fff",
        "#1",
        "\"s\"",
        "\"",
        "..",
        "...",
        "->",
        "==",
        "<",
        "&&",
        "|",
        "-",
        "!",
        "=",
        "*",
        ".",
        ",",
        ":",
        ";",
        "(",
        ")",
        "{",
        "}",
        "[",
        "]",
        "\n",
        "\n",
        "\n  ",
        " ",
        "// c\n",
        "/// d\n",
        "“",
        "é",
        "°",
        "\u{a0}",
        "@",
        "\\",
        "\r\n",
        "\u{feff}",
    ];
    prop::sample::select(words.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1000,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn arbitrary_texts(text in any::<String>()) {
        check(&text);
    }

    #[test]
    fn arbitrary_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        check(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn arbitrary_tokens(tokens in prop::collection::vec((token(), any::<bool>()), 0..80)) {
        let text: String = tokens
            .iter()
            .flat_map(|&(token, space)| [token, if space { " " } else { "" }])
            .collect();
        check(&text);
    }

    #[test]
    fn arbitrary_tokens_in_a_formula(tokens in prop::collection::vec(token(), 0..40)) {
        let before = "solid s(r: length = 1 in 0..inf)\n  exact\n  = {\n    let a = f(r, [1, ";
        check(&format!("{before}{}\n    a\n  }}\nlet b = 2\n", tokens.join(" ")));
    }
}

#[test]
fn an_error_in_one_item_does_not_affect_the_next() {
    for wrong in [
        "let a = ",
        "f(",
        "fn g(",
        "let a = [1, {\n  let b = 2",
        "solid s(r) bounds =",
        "param",
        "a b",
    ] {
        let (tree, found) = check(&format!("{wrong}\nlet good = 1\n"));
        assert!(!found.is_empty(), "{wrong}");
        let last = format!("{:?}", tree.items.last());
        assert!(last.contains("good") && !last.contains("Error"), "{wrong}: {last}");
    }
}
