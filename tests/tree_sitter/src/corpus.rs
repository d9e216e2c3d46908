//! The corpus tests of the grammar, as `tree-sitter test` runs them.

use sdfc_test_support::repository;

use crate::parsed;

/// One test of a corpus file.
struct Case<'t> {
    /// The name, and attributes such as `:error` on lines of their own.
    head: &'t [&'t str],
    source: String,
    tree: String,
}

/// The tests of a file: a head between lines of `=`, the source, a line of `-`, the tree.
fn cases<'t>(lines: &'t [&'t str]) -> Vec<Case<'t>> {
    let is_line = |i: usize, of: char| lines[i].len() > 2 && lines[i].chars().all(|it| it == of);
    let bars: Vec<usize> = (0..lines.len()).filter(|&i| is_line(i, '=')).collect();
    let heads: Vec<&[usize]> = bars.chunks_exact(2).collect();
    let ends = heads.iter().skip(1).map(|head| head[0]).chain([lines.len()]);
    let case = |(head, end): (&&'_ [usize], usize)| {
        let from = head[1] + 1;
        let middle = (from..end).find(|&i| is_line(i, '-')).unwrap();
        Case {
            head: &lines[head[0] + 1..head[1]],
            source: lines[from..middle].join("\n"),
            tree: lines[middle + 1..end].join(" "),
        }
    };
    heads.iter().zip(ends).map(case).collect()
}

/// The tree without the names of fields and with single spaces.
fn plain(tree: &str) -> String {
    let words = tree.split_whitespace().filter(|word| !word.ends_with(':'));
    words.collect::<Vec<_>>().join(" ").replace(" )", ")")
}

#[test]
fn every_corpus_test_has_its_tree() {
    let folder = repository().join("editors/tree-sitter-sdf/test/corpus");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for Case { head, source, tree } in cases(&lines) {
            let parsed = parsed(&source);
            if head.contains(&":error") {
                assert!(parsed.root_node().has_error(), "{head:?}");
            } else {
                assert_eq!(plain(&parsed.root_node().to_sexp()), plain(&tree), "{head:?}");
            }
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}
