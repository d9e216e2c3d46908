//! Writes the values of params into the source as their defaults.

use std::collections::BTreeMap;

use sdfc_diagnostics::{Sources, Span};
use sdfc_graph::Param;
use sdfc_syntax::ast::Item;
use sdfc_syntax::parse;

use crate::scene::document::with_replacements;
use crate::scene::number_text::value_text;

/// The source with other defaults for some of its params.
///
/// # Errors
///
/// The message names a changed param that another file declares.
pub fn with_param_defaults(
    source: &str,
    declared: &[Param],
    values: &BTreeMap<String, [f64; 4]>,
) -> Result<String, String> {
    let spans = default_spans(source);
    let mut edits = Vec::new();
    for param in declared {
        let Some(lanes) = values.get(&param.name).filter(|lanes| param.accepts(**lanes)) else {
            continue;
        };
        let Some(span) = spans.get(&param.name) else {
            let name = &param.name;
            return Err(format!(
                "not saved: another file declares `param {name}`; change it there"
            ));
        };
        let value = value_text(param, *lanes);
        edits.push((*span, if param.choices.is_empty() { value } else { format!("{value:?}") }));
    }
    Ok(with_replacements(source, &edits))
}

/// Where the default of each param stands that the source declares.
fn default_spans(source: &str) -> BTreeMap<String, Span> {
    let mut sources = Sources::new();
    let file = sources.add("scene", source);
    let (tree, _) = parse(&sources, file);
    let span = |item: Item| match item {
        Item::Param(param) => Some((param.name.text, param.default.span)),
        Item::Import(_) | Item::Decl(_) | Item::Let(_) | Item::Expr(_) => None,
    };
    tree.items.into_iter().filter_map(span).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::model;

    #[test]
    fn saved_params_have_the_same_values_as_defaults() {
        let source = "param r = 0.5 in 0.1..2 // radius\nparam lid = true\nparam wood = #8a5a34\n\
                      param style = \"round\" in [\"round\", \"flat\"]\nparam lean: angle = 10deg\n\
                      sphere(r)\n";
        let before = model(source);
        let values = BTreeMap::from([
            ("r".to_owned(), [1.5, 0.0, 0.0, 0.0]),
            ("lid".to_owned(), [0.0; 4]),
            ("wood".to_owned(), [1.0, 0.0, 0.0, 0.0]),
            ("style".to_owned(), [1.0, 0.0, 0.0, 0.0]),
            ("lean".to_owned(), [12.5_f64.to_radians(), 0.0, 0.0, 0.0]),
            ("gone".to_owned(), [1.0; 4]),
        ]);
        let text = with_param_defaults(source, before.declared(), &values).unwrap();
        let expected = "param r = 1.5 in 0.1..2 // radius\nparam lid = false\n\
                        param wood = #ff0000\nparam style = \"flat\" in [\"round\", \"flat\"]\n\
                        param lean: angle = 12.5deg\nsphere(r)\n";
        assert_eq!(text, expected);
        for param in model(&text).declared() {
            assert_eq!(param.default[..3], values[&param.name][..3], "{}", param.name);
        }
    }

    #[test]
    fn a_param_of_another_file_is_not_saved() {
        let before = model("param r = 0.5\nsphere(r)\n");
        let values = BTreeMap::from([("r".to_owned(), [1.0, 0.0, 0.0, 0.0])]);
        let why = with_param_defaults("sphere(1)\n", before.declared(), &values).unwrap_err();
        assert!(why.contains("`param r`"), "{why}");
    }
}
