//! The values of number, colour and string literals.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use crate::ast::{ExprKind, Unit};
use crate::token::is_quote;

/// The value of a literal and an error in it, if there is one. Then the value is a placeholder.
pub(crate) type Checked<T> = (T, Option<Diagnostic>);

/// Reads a number with an optional unit: `12`, `0.5e-3`, `90deg`.
pub(crate) fn number(text: &str, span: Span) -> Checked<ExprKind> {
    let digits_end = digits_end(text);
    let (digits, suffix) = text.split_at(digits_end);
    let value = digits.parse::<f64>().unwrap_or(f64::NAN);
    let wrong = |message: String| Diagnostic::error(Code::BAD_NUMBER, span, message);
    let (unit, problem) = match suffix {
        "" => (None, None),
        "deg" => (Some(Unit::Deg), None),
        "turn" => (Some(Unit::Turn), None),
        "rad" => (Some(Unit::Rad), None),
        "e" | "E" => (None, Some(wrong(format!("the exponent of `{text}` has no digits")))),
        _ if is_upper_exponent(suffix) => {
            let fixed = text.replace('E', "e");
            let help = format!("write {fixed}");
            let problem = wrong("exponents are written with a small `e`".to_owned());
            (None, Some(problem.help(&help).fix(help, span, fixed)))
        }
        "mm" | "cm" | "m" | "inch" | "in" | "px" | "em" => {
            let help = format!("lengths have no unit: {digits} may be millimetres or metres");
            let fix = format!("write {digits}");
            let problem = wrong(format!("`{suffix}` is not a unit"));
            (None, Some(problem.help(help).fix(fix, span, digits.to_owned())))
        }
        _ => {
            let problem = wrong(format!("`{suffix}` is not a unit"))
                .help("the units are deg, turn and rad; lengths have none")
                .help(format!("a product needs its operator: {digits} * {suffix}"))
                .fix("write a product", span, format!("{digits} * {suffix}"));
            (None, Some(problem))
        }
    };
    let problem = problem.or_else(|| {
        let problem = wrong("this number is too large".to_owned());
        (!value.is_finite()).then(|| problem.help("the largest is about 1.8e308; for no end: inf"))
    });
    let whole = unit.is_none() && digits.bytes().all(|b| b.is_ascii_digit());
    (ExprKind::Number { value, unit, whole }, problem)
}

fn is_upper_exponent(suffix: &str) -> bool {
    suffix.strip_prefix('E').is_some_and(|rest| rest.bytes().all(|b| b.is_ascii_digit()))
}

/// Returns the offset where the unit of a number begins, behind digits, point and exponent.
fn digits_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits =
        |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if bytes.get(end) == Some(&b'e') {
        let signed = matches!(bytes.get(end + 1), Some(b'+' | b'-'));
        let start = end + 1 + usize::from(signed);
        let exponent_end = digits(start.min(bytes.len()));
        if exponent_end > start {
            end = exponent_end;
        }
    }
    end
}

/// Returns the error for a number without a digit on one side of its point.
pub(crate) fn bare_point(written: &str, span: Span) -> Diagnostic {
    let fixed = match written.strip_suffix('.') {
        Some(digits) => format!("{digits}.0"),
        None => format!("0{written}"),
    };
    Diagnostic::error(Code::BAD_NUMBER, span, "a number needs a digit on both sides of the point")
        .help(format!("write {fixed}"))
        .fix(format!("write {fixed}"), span, fixed)
}

/// Reads a colour: `#rgb`, `#rgba`, `#rrggbb`, `#rrggbbaa`.
pub(crate) fn color(text: &str, span: Span) -> Checked<[u8; 4]> {
    let digits: Vec<u8> =
        text.chars().skip(1).filter_map(|c| c.to_digit(16)).map(|digit| digit as u8).collect();
    let written = text.len().saturating_sub(1);
    let wrong = |message: String| Diagnostic::error(Code::BAD_COLOUR, span, message);
    if digits.len() != written {
        let problem = wrong(format!("`{text}` is not a colour")).help(match text {
            "#include" => "write import name from \"file.sdf\"",
            "#define" => "write let name = ..., or fn name(x) = ...",
            _ => "after `#` come hexadecimal digits: 0 to 9 and a to f",
        });
        return ([0; 4], Some(problem));
    }
    match digits[..] {
        [r, g, b] => ([r * 17, g * 17, b * 17, 255], None),
        [r, g, b, a] => ([r * 17, g * 17, b * 17, a * 17], None),
        [r, r2, g, g2, b, b2] => ([r * 16 + r2, g * 16 + g2, b * 16 + b2, 255], None),
        [r, r2, g, g2, b, b2, a, a2] => {
            ([r * 16 + r2, g * 16 + g2, b * 16 + b2, a * 16 + a2], None)
        }
        _ => {
            let found = digits.len();
            let problem = wrong(format!("a colour has 3, 4, 6 or 8 digits, this has {found}"))
                .help("write #rgb, #rgba, #rrggbb or #rrggbbaa");
            ([0; 4], Some(problem))
        }
    }
}

/// Reads a string and returns it without quotes and escapes.
pub(crate) fn text(written: &str, span: Span) -> Checked<String> {
    if !written.starts_with('"') {
        let inner = written.trim_matches(is_quote);
        let problem = Diagnostic::error(
            Code::UNKNOWN_CHARACTER,
            span,
            "strings stand between plain double quotes",
        )
        .help(format!("write \"{inner}\""))
        .fix("use plain double quotes", span, format!("\"{inner}\""));
        return (inner.to_owned(), Some(problem));
    }
    let mut value = String::new();
    let mut problem = None;
    let mut at = 1;
    while let Some(c) = written[at..].chars().next() {
        at += c.len_utf8();
        match c {
            '"' => return (value, problem),
            '\\' => {
                let (escaped, length) = escape(&written[at..]);
                if escaped.is_none() && problem.is_none() {
                    problem = Some(bad_escape(written, at, length, span));
                }
                value.push(escaped.unwrap_or('\u{fffd}'));
                at += length;
            }
            _ => value.push(c),
        }
    }
    let unclosed = Diagnostic::error(Code::BAD_STRING, span, "this string does not end").help(
        "close it with `\"` on the line where it starts; a line break in it is written `\\n`",
    );
    (value, problem.or(Some(unclosed)))
}

/// Returns the character that an escape stands for, and the length of the escape behind the
/// backslash in bytes.
fn escape(rest: &str) -> (Option<char>, usize) {
    let Some(c) = rest.chars().next() else {
        return (None, 0);
    };
    match c {
        '"' | '\\' => (Some(c), 1),
        'n' => (Some('\n'), 1),
        'u' => match rest.strip_prefix("u{").and_then(|inner| inner.split_once('}')) {
            Some((digits, _)) => {
                let code =
                    u32::from_str_radix(digits, 16).ok().filter(|_| !digits.starts_with('+'));
                (code.and_then(char::from_u32), digits.len() + 3)
            }
            None => (None, 1),
        },
        _ => (None, c.len_utf8()),
    }
}

fn bad_escape(written: &str, at: usize, length: usize, span: Span) -> Diagnostic {
    let escape =
        Span::new(span.file, span.start + at as u32 - 1, span.start + (at + length) as u32);
    let shown = &written[at - 1..at + length];
    Diagnostic::error(Code::BAD_STRING, escape, format!("`{shown}` is not an escape"))
        .help("the escapes are `\\\"`, `\\\\`, `\\n` and `\\u{20ac}`; a path is written with `/`")
}

#[cfg(test)]
mod tests {
    use sdfc_diagnostics::FileId;

    use super::*;

    fn span(text: &str) -> Span {
        Span::new(FileId(0), 0, text.len() as u32)
    }

    fn numbers(text: &str) -> (f64, Option<Unit>, bool, bool) {
        match number(text, span(text)) {
            (ExprKind::Number { value, unit, whole }, problem) => {
                (value, unit, whole, problem.is_none())
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn numbers_have_values_and_units() {
        assert_eq!(numbers("12"), (12.0, None, true, true));
        assert_eq!(numbers("0.5e-3"), (0.5e-3, None, false, true));
        assert_eq!(numbers("1e2"), (100.0, None, false, true));
        assert_eq!(numbers("90deg"), (90.0, Some(Unit::Deg), false, true));
        assert_eq!(numbers("0.25turn"), (0.25, Some(Unit::Turn), false, true));
        for wrong in ["3mm", "2e", "1E5", "1e999", "2_000"] {
            assert!(!numbers(wrong).3, "{wrong}");
        }
    }

    #[test]
    fn short_colours_repeat_their_digits() {
        assert_eq!(color("#f80", span("#f80")).0, [255, 136, 0, 255]);
        assert_eq!(color("#F807", span("#f807")).0, [255, 136, 0, 119]);
        assert_eq!(color("#d94f30", span("#d94f30")).0, [0xd9, 0x4f, 0x30, 255]);
        assert_eq!(color("#d94f3080", span("#d94f3080")).0, [0xd9, 0x4f, 0x30, 128]);
        assert!(color("#ff", span("#ff")).1.is_some());
        assert!(color("#ggg", span("#ggg")).1.is_some());
    }

    #[test]
    fn strings_lose_quotes_and_escapes() {
        let value = |written: &str| text(written, span(written));
        assert_eq!(value(r#""a\"b\\c\nd\u{20ac}""#), ("a\"b\\c\nd€".to_owned(), None));
        assert!(value(r#""a\qb""#).1.is_some_and(|found| found.span.start == 2));
        assert!(value(r#""open"#).1.is_some());
        assert!(value(r#""open\"#).1.is_some());
        assert!(value(r#""\u{d800}""#).1.is_some());
        assert_eq!(value("“a”").0, "a");
    }
}
