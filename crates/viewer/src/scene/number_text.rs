//! Numbers and param values as text.

use std::f64::consts::PI;

use sdfc_graph::{Param, ParamKind};
use sdfc_render::linear_to_srgb8;

/// A param's value as a scene writes it. Parsing it gives the same value.
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

/// The shortest text that parses to this number.
pub fn number_text(value: f64) -> String {
    // Debug formatting uses an exponent instead of many zeros. -0 becomes 0.
    let text = format!("{:?}", if value == 0.0 { 0.0 } else { value });
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// A number rounded for display: to four significant digits below 1, else to four decimals.
pub fn display_text(value: f64) -> String {
    let text = if value.abs() < 1.0 { format!("{value:.3e}") } else { format!("{value:.4}") };
    number_text(text.parse().unwrap_or(value))
}

/// The unit in which a text writes a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// The number is the value.
    One,
    /// `deg` behind the number.
    Degrees,
    /// `turn` behind the number.
    Turns,
}

impl Unit {
    /// The unit that a text has behind its number.
    pub fn of(suffix: &str) -> Self {
        match suffix {
            "deg" => Self::Degrees,
            "turn" => Self::Turns,
            _ => Self::One,
        }
    }

    /// The value of a number in this unit.
    pub fn value(self, number: f64) -> f64 {
        // The compiler computes it in this order, which decides the last digit.
        self.in_half_turns()
            .map_or(number, |[number_of, half_turns]| number * (PI * half_turns) / number_of)
    }

    /// The number in this unit that is nearest to a value.
    pub fn number(self, value: f64) -> f64 {
        self.in_half_turns()
            .map_or(value, |[number_of, half_turns]| value * number_of / (PI * half_turns))
    }

    /// A number in this unit, and the half turns that it is.
    fn in_half_turns(self) -> Option<[f64; 2]> {
        match self {
            Self::One => None,
            Self::Degrees => Some([180.0, 1.0]),
            Self::Turns => Some([1.0, 2.0]),
        }
    }
}

/// The shortest text in a unit, such as `deg`, that parses to this angle.
pub fn angle_text(radians: f64, suffix: &str) -> String {
    let unit = Unit::of(suffix);
    if unit == Unit::One {
        return format!("{}{suffix}", number_text(radians));
    }
    let near = unit.number(radians);
    let rounded = |digits: usize| format!("{near:.digits$e}").parse::<f64>().ok();
    let exact = (0..17).filter_map(rounded).find(|number| unit.value(*number) == radians);
    format!("{}{suffix}", number_text(exact.unwrap_or(near)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displayed_numbers_are_short() {
        let texts = [0.5, -0.0, 2.0, 1.0 / 3.0, 0.000_123_46, 123_456.0, 1e-9].map(display_text);
        assert_eq!(texts, ["0.5", "0", "2", "0.3333", "0.0001235", "123456", "1e-9"]);
    }

    #[test]
    fn angles_keep_their_unit_and_are_short() {
        assert_eq!(angle_text(PI / 4.0, "deg"), "45deg");
        assert_eq!(angle_text(45.1 * PI / 180.0, "deg"), "45.1deg");
        assert_eq!(angle_text(0.1 * std::f64::consts::TAU, "turn"), "0.1turn");
    }
}
