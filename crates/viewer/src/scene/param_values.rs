//! The values that the user has set for params and numbers, and the source that keeps them.

use std::collections::BTreeMap;

use sdfc::FrameValues;
use sdfc_diagnostics::Span;

use crate::scene::document::with_replacements;
use crate::scene::model::Model;
use crate::scene::number_text::value_text;
use crate::scene::source_numbers::SourceNumber;

/// The changed values; everything else has the value that the scene gives it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParamValues {
    /// Changed params by name. They are kept when the source is edited.
    pub params: BTreeMap<String, [f64; 4]>,
    /// Changed numbers by the position of their literal in the source of the model.
    numbers: BTreeMap<usize, (SourceNumber, f64)>,
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
        for (start, (_, value)) in &self.numbers {
            let Some(number) = model.number_at(*start) else { continue };
            let (index, value) = number.param_value(*value);
            let changed = [value, 0.0, 0.0, 0.0];
            if let (Some(param), Some(lanes)) =
                (model.scene.params().get(index), values.params.get_mut(index))
                && param.accepts(changed)
            {
                *lanes = changed;
            }
        }
        values
    }

    /// Sets a number of the source. Setting the value that the source has removes the change.
    pub fn set_number(&mut self, number: &SourceNumber, value: f64) {
        let start = number.span.start as usize;
        if value == number.value {
            self.numbers.remove(&start);
        } else if value.is_finite() {
            self.numbers.insert(start, (number.clone(), value));
        }
    }

    /// The current value of a number of the source.
    pub fn number(&self, number: &SourceNumber) -> f64 {
        self.numbers.get(&(number.span.start as usize)).map_or(number.value, |(_, value)| *value)
    }

    /// How many numbers of the source have been changed.
    pub fn changed_numbers(&self) -> usize {
        self.numbers.len()
    }

    /// Gives all numbers the values that the source has.
    pub fn reset_numbers(&mut self) {
        self.numbers.clear();
    }

    /// Moves the changed numbers to the next version of the source. `positions` maps the start of
    /// a literal to its start in the new source. Returns the numbers that the new source no longer
    /// has and whose values are therefore lost, each as "old text -> new text".
    pub fn rebase(&mut self, model: &Model, positions: &BTreeMap<usize, usize>) -> Vec<String> {
        let mut lost = Vec::new();
        for (start, (number, value)) in std::mem::take(&mut self.numbers) {
            let Some(new_start) = positions.get(&start) else {
                lost.push(format!("{} -> {}", number.text, number.text_of(value)));
                continue;
            };
            // A number that is not live in the new model is kept, to be saved.
            let moved = model.number_at(*new_start).cloned();
            let moved = moved.unwrap_or_else(|| number.moved_to(*new_start));
            if value != moved.value && moved.text_of(value) != moved.text {
                self.numbers.insert(*new_start, (moved, value));
            }
        }
        lost
    }

    /// The changed numbers in the source of the model, moved to another version of it. Numbers that
    /// it no longer has are left out.
    pub fn moved(&self, positions: &BTreeMap<usize, usize>) -> Self {
        let moved = |(start, (number, value)): (&usize, &(SourceNumber, f64))| {
            let start = *positions.get(start)?;
            Some((start, (number.moved_to(start), *value)))
        };
        let numbers = self.numbers.iter().filter_map(moved).collect();
        Self { params: self.params.clone(), numbers }
    }

    /// The source with the changed numbers in it.
    pub fn source_with_values(&self, source: &str) -> String {
        let edit = |(number, value): &(SourceNumber, f64)| {
            let [start, end] = [number.written.start, number.written.end].map(|at| at as u32);
            (Span::new(number.span.file, start, end), number.text_of(*value))
        };
        let edits: Vec<(Span, String)> = self.numbers.values().map(edit).collect();
        with_replacements(source, &edits)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::rebase::{pair_numbers, rebase_numbers};
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
    fn changed_numbers_are_written_in_place_and_in_their_unit() {
        let model = model(TEXT);
        let mut values = ParamValues::default();
        let number = |at: &str| model.number_at(TEXT.find(at).unwrap()).unwrap().clone();
        values.set_number(&number("1.5"), -0.25);
        values.set_number(&number("30deg"), 45f64.to_radians());
        let frame = values.frame(&model, 0.0, 0.0);
        assert!(frame.params.iter().any(|lanes| lanes[0] == -0.25));
        let text = values.source_with_values(TEXT);
        assert!(text.ends_with("translate(x: -0.25).rotate(y: 45deg)\n"), "{text}");
        values.set_number(&number("1.5"), 1.5);
        assert_eq!(values.changed_numbers(), 1);
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
    fn written_numbers_parse_to_the_same_values() {
        let sources =
            ["sphere(0.5)\n", "sphere(1).rotate(y: 0.5deg)\n", "sphere(1).rotate(y: 0.5turn)\n"];
        for text in sources {
            let at = text.find("0.5").unwrap();
            let number = |model: &Model| model.number_at(at).unwrap().clone();
            let model_before = model(text);
            for value in [0.1 + 0.2, 1e-7, 1.0 / 3.0, 12_345.678_9, 0.123_456_789_012_345_6] {
                let mut values = ParamValues::default();
                values.set_number(&number(&model_before), value);
                let written = values.source_with_values(text);
                let back = number(&model(&written)).value;
                let digits = f64::EPSILON * value;
                assert!((back - value).abs() <= digits, "{written}: {back} is not {value}");
                assert!(
                    back == value || text.contains("rotate"),
                    "{written}: {back} is not {value}"
                );
            }
        }
    }
    #[test]
    fn changed_numbers_follow_their_literals_through_edits() {
        let before = model("sphere(1.5).translate(x: -2)\nbox(3)\n");
        let mut values = ParamValues::default();
        for (number, value) in before.numbers.iter().zip([1.25, 4.0, 3.5]) {
            values.set_number(number, value);
        }
        // The first number is edited, the others move.
        let text = "let a = 0\nsphere(1.75).translate(x: -2)\nbox(3)\n";
        let after = model(text);
        let lost = values.rebase(&after, &rebase_numbers(&before.source, text));
        assert_eq!(lost, ["1.5 -> 1.25"]);
        let expected = "let a = 0\nsphere(1.75).translate(x: 4)\nbox(3.5)\n";
        assert_eq!(values.source_with_values(text), expected);
        assert!(values.frame(&after, 0.0, 0.0).params.iter().any(|lanes| lanes[0] == -4.0));
        // Once they are in the file, no number is changed.
        let saved = model(expected);
        let lost = values.rebase(&saved, &pair_numbers(text, expected));
        assert_eq!((lost.len(), values.changed_numbers()), (0, 0));
    }
}
