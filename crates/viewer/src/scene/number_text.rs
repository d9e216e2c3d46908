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

/// The shortest text in `unit` that parses to this angle.
pub fn angle_text(radians: f64, unit: &str) -> String {
    let [half, turns] = match unit {
        "deg" => [180.0, 1.0],
        "turn" => [1.0, 2.0],
        _ => return format!("{}{unit}", number_text(radians)),
    };
    // The compiler computes it in this order, which decides the last digit.
    let parsed = |number: f64| number * (PI * turns) / half;
    let near = radians * half / (PI * turns);
    let rounded = |digits: usize| format!("{near:.digits$e}").parse::<f64>().ok();
    let exact = (0..17).filter_map(rounded).find(|number| parsed(*number) == radians);
    format!("{}{unit}", number_text(exact.unwrap_or(near)))
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
