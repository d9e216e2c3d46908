//! Values of params and of numbers in the text, as moved by hand, and the text that keeps them.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use sdfc::FrameValues;
use sdfc::diagnostics::Span;
use sdfc::graph::{Param, ParamKind};
use sdfc::lang::live_literals::LiveLiteral;
use sdfc::render::linear_to_srgb8;

use crate::document;
use crate::model::Model;

/// What has been moved; all else is as the scene says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Knobs {
    /// Params by name: they outlive edits of the text.
    pub params: BTreeMap<String, [f64; 4]>,
    /// Numbers by place, of one text only.
    literals: BTreeMap<Span, f64>,
}

impl Knobs {
    /// The values of a frame at a time.
    pub fn frame(&self, model: &Model, time: f64, frame: f64) -> FrameValues {
        let mut values = model.defaults();
        (values.time, values.frame) = (time, frame);
        for (param, lanes) in model.declared().iter().zip(&mut values.params) {
            if let Some(moved) =
                self.params.get(&param.name).and_then(|moved| fitted(param, *moved))
            {
                *lanes = moved;
            }
        }
        for (slot, param) in model.literals() {
            let moved = self.literals.get(&slot.span).map(|value| [*value, 0.0, 0.0, 0.0]);
            if let (Some(moved), Some(lanes)) =
                (moved.and_then(|moved| fitted(param, moved)), values.params.get_mut(slot.param))
            {
                *lanes = moved;
            }
        }
        values
    }

    /// Sets a number of the text; its own value takes the change back.
    pub fn set_literal(&mut self, slot: &LiveLiteral, value: f64) {
        if value == slot.value {
            self.literals.remove(&slot.span);
        } else if value.is_finite() {
            self.literals.insert(slot.span, value);
        }
    }

    /// The value of a number of the text.
    pub fn literal(&self, slot: &LiveLiteral) -> f64 {
        self.literals.get(&slot.span).copied().unwrap_or(slot.value)
    }

    /// How many numbers of the text have been moved.
    pub fn moved_literals(&self) -> usize {
        self.literals.len()
    }

    /// Numbers are where they were in one text only.
    pub fn forget_literals(&mut self) {
        self.literals.clear();
    }

    /// The text with moved numbers in it.
    pub fn rewritten(&self, model: &Model) -> String {
        let edit = |(slot, _): (&LiveLiteral, &Param)| {
            let value = *self.literals.get(&slot.span)?;
            Some((slot.span, literal_text(model, slot, value)))
        };
        let edits: Vec<(Span, String)> = model.literals().filter_map(edit).collect();
        document::replaced(&model.text, &edits)
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

/// A moved value where it still fits the param: the text may have changed since.
fn fitted(param: &Param, moved: [f64; 4]) -> Option<[f64; 4]> {
    if !moved.iter().all(|lane| lane.is_finite()) {
        return None;
    }
    let [number, ..] = moved;
    let in_range = param.range.is_none_or(|[lo, hi]| (lo..=hi).contains(&number));
    let fits = match param.kind {
        ParamKind::Number | ParamKind::Angle => in_range,
        ParamKind::Int => in_range && number.fract() == 0.0,
        ParamKind::Bool => number == 0.0 || number == 1.0,
        ParamKind::Color => true,
        ParamKind::Choice => number >= 0.0 && (number as usize) < param.choices.len(),
    };
    fits.then_some(moved)
}

/// A value as a scene writes it; read back, it is the same.
pub fn value_text(param: &Param, lanes: [f64; 4]) -> String {
    let [number, green, blue, _] = lanes;
    match param.kind {
        ParamKind::Number | ParamKind::Int => number_text(number),
        ParamKind::Angle => angle_text(number, "deg"),
        ParamKind::Bool => (number != 0.0).to_string(),
        ParamKind::Color => {
            let [r, g, b] = [number, green, blue].map(|lane| linear_to_srgb8(lane as f32));
            format!("#{r:02x}{g:02x}{b:02x}")
        }
        ParamKind::Choice => param.choices.get(number as usize).cloned().unwrap_or_default(),
    }
}

/// The shortest text that is read back as this number.
pub fn number_text(value: f64) -> String {
    // With an exponent where there would be many zeros.
    let text = format!("{:?}", if value == 0.0 { 0.0 } else { value });
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// A number to look at: four digits, or all before the point and four behind it.
pub fn display_text(value: f64) -> String {
    let text = if value.abs() < 1.0 { format!("{value:.3e}") } else { format!("{value:.4}") };
    number_text(text.parse().unwrap_or(value))
}

/// The shortest text that is read back as this angle.
fn angle_text(radians: f64, unit: &str) -> String {
    let [half, turns] = match unit {
        "deg" => [180.0, 1.0],
        "turn" => [1.0, 2.0],
        _ => return format!("{}{unit}", number_text(radians)),
    };
    // As the compiler reads it: the order of the operations decides the last digit.
    let read = |number: f64| number * (PI * turns) / half;
    let near = radians * half / (PI * turns);
    let rounded = |digits: usize| format!("{near:.digits$e}").parse::<f64>().ok();
    let exact = (0..17).filter_map(rounded).find(|number| read(*number) == radians);
    format!("{}{unit}", number_text(exact.unwrap_or(near)))
}

/// A number in the place of a literal, with the unit that stands there.
fn literal_text(model: &Model, slot: &LiveLiteral, value: f64) -> String {
    let span = slot.span.start as usize..slot.span.end as usize;
    let written = model.text.get(span).unwrap_or_default();
    let unit = written.trim_start_matches(|c: char| c.is_ascii_digit() || ".eE_+-".contains(c));
    if unit.is_empty() { number_text(value) } else { angle_text(value, unit) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worker::tests::model;

    const TEXT: &str = "param r = 0.5 in 0.1..2\nparam lid = true\nparam wood = #8a5a34\n\
                        param style = \"round\" in [\"round\", \"flat\"]\n\
                        sphere(r).translate(x: 1.5).rotate(y: 30deg)\n";

    #[test]
    fn moved_params_outlive_edits_while_they_fit() {
        let mut knobs = Knobs::default();
        knobs.params.insert("r".to_owned(), [1.5, 0.0, 0.0, 0.0]);
        knobs.params.insert("gone".to_owned(), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(knobs.frame(&model(TEXT), 2.0, 60.0).params[0][0], 1.5);
        let narrower = model("param r = 0.5 in 0.1..1\nsphere(r)\n");
        assert_eq!(knobs.frame(&narrower, 0.0, 0.0).params[0][0], 0.5);
    }

    #[test]
    fn moved_numbers_are_written_where_they_stand() {
        let model = model(TEXT);
        let mut knobs = Knobs::default();
        let slot = |at: &str| {
            let start = TEXT.find(at).unwrap() as u32;
            model.literals().find(|(slot, _)| slot.span.start == start).unwrap().0.clone()
        };
        knobs.set_literal(&slot("1.5"), -0.25);
        knobs.set_literal(&slot("30deg"), 45f64.to_radians());
        let frame = knobs.frame(&model, 0.0, 0.0);
        assert!(frame.params.iter().any(|lanes| lanes[0] == -0.25));
        let text = knobs.rewritten(&model);
        assert!(text.ends_with("translate(x: -0.25).rotate(y: 45deg)\n"), "{text}");
        knobs.set_literal(&slot("1.5"), 1.5);
        assert_eq!(knobs.moved_literals(), 1);
    }

    #[test]
    fn values_are_arguments_that_the_command_line_takes() {
        let model = model(TEXT);
        let mut knobs = Knobs::default();
        knobs.params.insert("style".to_owned(), [1.0, 0.0, 0.0, 0.0]);
        knobs.params.insert("lid".to_owned(), [0.0; 4]);
        let text = knobs.arguments(&model);
        assert_eq!(text, "--set r=0.5 --set lid=false --set 'wood=#8a5a34' --set style=flat");
        for argument in text.split("--set ").filter(|text| !text.is_empty()) {
            let (name, value) = argument.trim().trim_matches('\'').split_once('=').unwrap();
            let mut frame = model.defaults();
            model.scene.set_param(&mut frame, name, value).unwrap();
        }
    }

    #[test]
    fn numbers_to_look_at_are_short() {
        let texts = [0.5, -0.0, 2.0, 1.0 / 3.0, 0.000_123_46, 123_456.0, 1e-9].map(display_text);
        assert_eq!(texts, ["0.5", "0", "2", "0.3333", "0.0001235", "123456", "1e-9"]);
    }

    #[test]
    fn numbers_in_a_file_are_read_back_as_they_were() {
        let places =
            ["sphere(0.5)\n", "sphere(1).rotate(y: 0.5deg)\n", "sphere(1).rotate(y: 0.5turn)\n"];
        for text in places {
            let at = text.find("0.5").unwrap() as u32;
            let slot = |model: &Model| {
                model.literals().find(|(slot, _)| slot.span.start == at).unwrap().0.clone()
            };
            let model_before = model(text);
            for value in [0.1 + 0.2, 1e-7, 1.0 / 3.0, 12_345.678_9, 0.123_456_789_012_345_6] {
                let mut knobs = Knobs::default();
                knobs.set_literal(&slot(&model_before), value);
                let rewritten = knobs.rewritten(&model_before);
                let back = slot(&model(&rewritten)).value;
                let digits = f64::EPSILON * value;
                assert!((back - value).abs() <= digits, "{rewritten}: {back} is not {value}");
                assert!(
                    back == value || text.contains("rotate"),
                    "{rewritten}: {back} is not {value}"
                );
            }
        }
        assert_eq!(angle_text(PI / 4.0, "deg"), "45deg");
        assert_eq!(angle_text(45.1 * PI / 180.0, "deg"), "45.1deg");
        assert_eq!(angle_text(0.1 * std::f64::consts::TAU, "turn"), "0.1turn");
    }
}
