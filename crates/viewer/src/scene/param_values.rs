//! The values that the user has set for params and live literals, and the source that keeps them.

use std::collections::BTreeMap;

use sdfc::FrameValues;
use sdfc_diagnostics::Span;
use sdfc_graph::Param;
use sdfc_lang::live_literals::LiveLiteral;

use crate::scene::document::with_replacements;
use crate::scene::model::Model;
use crate::scene::number_text::{angle_text, number_text, value_text};

/// The changed values; everything else has the value that the scene gives it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParamValues {
    /// Changed params by name. They are kept when the source is edited.
    pub params: BTreeMap<String, [f64; 4]>,
    /// Changed literals by position, valid for one source only.
    literals: BTreeMap<Span, f64>,
}

impl ParamValues {
    /// The values of a frame, with `time` in seconds and the `frame` number.
    pub fn frame(&self, model: &Model, time: f64, frame: f64) -> FrameValues {
        let mut values = model.defaults();
        (values.time, values.frame) = (time, frame);
        for (param, lanes) in model.declared().iter().zip(&mut values.params) {
            let changed = self.params.get(&param.name);
            if let Some(changed) = changed.filter(|changed| param.accepts(**changed)) {
                *lanes = *changed;
            }
        }
        for (literal, param) in model.literals() {
            let changed = self.literals.get(&literal.span).map(|value| [*value, 0.0, 0.0, 0.0]);
            if let (Some(changed), Some(lanes)) = (
                changed.filter(|changed| param.accepts(*changed)),
                values.params.get_mut(literal.param),
            ) {
                *lanes = changed;
            }
        }
        values
    }

    /// Sets a live literal. Setting the value that the source has removes the change.
    pub fn set_literal(&mut self, literal: &LiveLiteral, value: f64) {
        if value == literal.value {
            self.literals.remove(&literal.span);
        } else if value.is_finite() {
            self.literals.insert(literal.span, value);
        }
    }

    /// The current value of a live literal.
    pub fn literal(&self, literal: &LiveLiteral) -> f64 {
        self.literals.get(&literal.span).copied().unwrap_or(literal.value)
    }

    /// The number of changed live literals.
    pub fn changed_literals(&self) -> usize {
        self.literals.len()
    }

    /// Removes all changes of live literals, whose positions are valid for one source only.
    pub fn reset_literals(&mut self) {
        self.literals.clear();
    }

    /// The source with the changed literals in it.
    pub fn source_with_values(&self, model: &Model) -> String {
        let edit = |(literal, _): (&LiveLiteral, &Param)| {
            let value = *self.literals.get(&literal.span)?;
            Some((literal.span, literal_text(model, literal, value)))
        };
        let edits: Vec<(Span, String)> = model.literals().filter_map(edit).collect();
        with_replacements(&model.source, &edits)
    }

    /// The params' values as arguments of `sdfc render`.
    pub fn arguments(&self, model: &Model) -> String {
        let values = self.frame(model, 0.0, 0.0);
        let each = model.declared().iter().zip(&values.params);
        let arguments = each.map(|(param, lanes)| {
            let value = value_text(param, *lanes);
            let quote = if value.contains(['#', ' ']) { "'" } else { "" };
            format!("--set {quote}{}={value}{quote}", param.name)
        });
        arguments.collect::<Vec<_>>().join(" ")
    }
}

/// A number as it replaces a literal, in the literal's unit.
fn literal_text(model: &Model, literal: &LiveLiteral, value: f64) -> String {
    let span = literal.span.start as usize..literal.span.end as usize;
    let written = model.source.get(span).unwrap_or_default();
    let unit = written.trim_start_matches(|c: char| c.is_ascii_digit() || ".eE_+-".contains(c));
    if unit.is_empty() { number_text(value) } else { angle_text(value, unit) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::model;

    const TEXT: &str = "param r = 0.5 in 0.1..2\nparam lid = true\nparam wood = #8a5a34\n\
                        param style = \"round\" in [\"round\", \"flat\"]\n\
                        sphere(r).translate(x: 1.5).rotate(y: 30deg)\n";

    #[test]
    fn changed_params_are_kept_across_edits_while_they_are_valid() {
        let mut values = ParamValues::default();
        values.params.insert("r".to_owned(), [1.5, 0.0, 0.0, 0.0]);
        values.params.insert("gone".to_owned(), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(values.frame(&model(TEXT), 2.0, 60.0).params[0][0], 1.5);
        let narrower = model("param r = 0.5 in 0.1..1\nsphere(r)\n");
        assert_eq!(values.frame(&narrower, 0.0, 0.0).params[0][0], 0.5);
    }

    #[test]
    fn changed_literals_are_written_in_place_and_in_their_unit() {
        let model = model(TEXT);
        let mut values = ParamValues::default();
        let literal = |at: &str| {
            let start = TEXT.find(at).unwrap() as u32;
            model.literals().find(|(literal, _)| literal.span.start == start).unwrap().0.clone()
        };
        values.set_literal(&literal("1.5"), -0.25);
        values.set_literal(&literal("30deg"), 45f64.to_radians());
        let frame = values.frame(&model, 0.0, 0.0);
        assert!(frame.params.iter().any(|lanes| lanes[0] == -0.25));
        let text = values.source_with_values(&model);
        assert!(text.ends_with("translate(x: -0.25).rotate(y: 45deg)\n"), "{text}");
        values.set_literal(&literal("1.5"), 1.5);
        assert_eq!(values.changed_literals(), 1);
    }

    #[test]
    fn the_arguments_set_the_same_values_on_the_command_line() {
        let model = model(TEXT);
        let mut values = ParamValues::default();
        values.params.insert("style".to_owned(), [1.0, 0.0, 0.0, 0.0]);
        values.params.insert("lid".to_owned(), [0.0; 4]);
        let text = values.arguments(&model);
        assert_eq!(text, "--set r=0.5 --set lid=false --set 'wood=#8a5a34' --set style=flat");
        for argument in text.split("--set ").filter(|text| !text.is_empty()) {
            let (name, value) = argument.trim().trim_matches('\'').split_once('=').unwrap();
            let mut frame = model.defaults();
            model.scene.set_param(&mut frame, name, value).unwrap();
        }
    }

    #[test]
    fn written_literals_parse_to_the_same_values() {
        let sources =
            ["sphere(0.5)\n", "sphere(1).rotate(y: 0.5deg)\n", "sphere(1).rotate(y: 0.5turn)\n"];
        for text in sources {
            let at = text.find("0.5").unwrap() as u32;
            let literal = |model: &Model| {
                model.literals().find(|(literal, _)| literal.span.start == at).unwrap().0.clone()
            };
            let model_before = model(text);
            for value in [0.1 + 0.2, 1e-7, 1.0 / 3.0, 12_345.678_9, 0.123_456_789_012_345_6] {
                let mut values = ParamValues::default();
                values.set_literal(&literal(&model_before), value);
                let written = values.source_with_values(&model_before);
                let back = literal(&model(&written)).value;
                let digits = f64::EPSILON * value;
                assert!((back - value).abs() <= digits, "{written}: {back} is not {value}");
                assert!(
                    back == value || text.contains("rotate"),
                    "{written}: {back} is not {value}"
                );
            }
        }
    }
}
