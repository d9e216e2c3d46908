//! The queries of the grammar fit it, and colour every word by its role.

use std::collections::BTreeMap;

use sdfc_syntax::Class;
use sdfc_test_support::repository;
use tree_sitter::{Query, QueryCursor, StreamingIterator};

use crate::parsed;

/// The folders with queries.
const FOLDERS: [&str; 3] = ["tree-sitter-sdf/queries", "helix/queries/sdf", "zed/languages/sdf"];

fn query(path: &str) -> Query {
    let text = std::fs::read_to_string(repository().join("editors").join(path)).unwrap();
    Query::new(&sdfc_tree_sitter::language(), &text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

#[test]
fn every_query_fits_the_grammar() {
    let mut count = 0;
    for folder in FOLDERS {
        for entry in std::fs::read_dir(repository().join("editors").join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".scm") {
                query(&format!("{folder}/{name}"));
                count += 1;
            }
        }
    }
    assert!(count >= 13, "{count}");
}

/// Returns true if a token of a class may have a name in one of the files of highlights.
fn fits(class: Class, name: &str) -> bool {
    let starts = |roots: &[&str]| roots.iter().any(|root| name.starts_with(root));
    match class {
        Class::Comment => starts(&["comment"]) && !name.contains("doc"),
        Class::Docs => starts(&["comment"]) && name.contains("doc"),
        Class::Keyword => starts(&["keyword", "type", "boolean", "constant.builtin.boolean"]),
        Class::Name => starts(&["variable", "function", "property", "type", "constant", "keyword"]),
        Class::Number => starts(&["number", "constant.numeric"]),
        Class::Color => name == "constant",
        Class::Text => name == "string",
        Class::Operator => name == "operator",
        Class::Open | Class::Close => name == "punctuation.bracket",
        Class::Punctuation => name == "punctuation.delimiter",
        Class::Unknown => false,
    }
}

#[test]
fn every_token_has_a_colour_of_its_role() {
    for folder in FOLDERS {
        check_colours(&query(&format!("{folder}/highlights.scm")));
    }
}

fn check_colours(query: &Query) {
    for (file, text) in sdfc_fuzz::texts::files().unwrap() {
        let tree = parsed(&text);
        if tree.root_node().has_error() {
            continue;
        }
        let mut colours: BTreeMap<(usize, usize), (usize, &str)> = BTreeMap::new();
        let mut cursor = QueryCursor::new();
        let mut matches = cursor.matches(query, tree.root_node(), text.as_bytes());
        while let Some(found) = matches.next() {
            for capture in found.captures {
                let range = (capture.node.start_byte(), capture.node.end_byte());
                let name = query.capture_names()[capture.index as usize];
                let colour = colours.entry(range).or_insert((found.pattern_index, name));
                if found.pattern_index >= colour.0 {
                    *colour = (found.pattern_index, name);
                }
            }
        }
        for (class, range) in sdfc_syntax::classes(&text) {
            let word = &text[range.clone()];
            let colour = colours.get(&(range.start, range.end));
            let fits = colour.is_some_and(|(_, name)| fits(class, name));
            assert!(fits, "{file}: {word:?} at {} is a {class:?}: {colour:?}", range.start);
        }
    }
}
