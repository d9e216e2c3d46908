//! The numbers of a source that can be changed in the window, with the sign that belongs to each.
//!
//! The compiler makes a param of a literal, and a literal has no sign: in `translate(x: -2.1)` it
//! is `2.1`. A person reads and types -2.1, so a [`SourceNumber`] is the literal with its sign.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_graph::{Param, ParamKind};
use sdfc_lang::live_literals::LiveLiteral;
use sdfc_syntax::{Class, classes};

use crate::scene::number_text::{Unit, angle_text, number_text};

/// A number of a source, with its sign.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceNumber {
    /// The literal without its sign. It identifies the number in its source.
    pub span: Span,
    /// The bytes that another value replaces: the literal with its sign.
    pub written: Range<usize>,
    /// Its value in the source, with its sign; radians for an angle.
    pub value: f64,
    /// Lowest and highest value, if it has a range.
    pub range: Option<[f64; 2]>,
    /// True for an angle.
    pub is_angle: bool,
    /// The number as the source writes it.
    pub text: String,
    /// The name in a line `let name = number`.
    pub name: Option<String>,
    /// The index of the param that the literal became.
    param: usize,
    is_signed: bool,
    /// True if a negative number needs parentheses at this position.
    wants_parentheses: bool,
}

impl SourceNumber {
    /// The index of the literal's param, and the value that the param has for this number.
    pub fn param_value(&self, number: f64) -> (usize, f64) {
        (self.param, if self.is_signed { -number } else { number })
    }

    /// The same number in a source in which its literal starts elsewhere.
    pub fn moved_to(&self, start: usize) -> Self {
        let sign = self.span.start as usize - self.written.start;
        let length = self.span.end - self.span.start;
        let from = u32::try_from(start).unwrap_or(u32::MAX);
        let span = Span::new(self.span.file, from, from.saturating_add(length));
        let written = start.saturating_sub(sign)..span.end as usize;
        Self { span, written, ..self.clone() }
    }

    /// The text that replaces [`written`](Self::written), in the unit of the literal.
    pub fn text_of(&self, number: f64) -> String {
        let suffix = self.suffix();
        let text = if suffix.is_empty() { number_text(number) } else { angle_text(number, suffix) };
        if text.starts_with('-') && self.wants_parentheses { format!("({text})") } else { text }
    }

    /// The unit of the literal.
    pub fn unit(&self) -> Unit {
        Unit::of(self.suffix())
    }

    fn suffix(&self) -> &str {
        self.text.trim_start_matches(|c: char| c.is_ascii_digit() || ".eE_+- ".contains(c))
    }
}

/// A number in a text, with its sign.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenNumber {
    /// The bytes that another value replaces: the literal with its sign.
    pub range: Range<usize>,
    /// The literal without its sign.
    pub literal: String,
    /// Its value with its sign, in the unit of the literal.
    pub value: f64,
    /// The number of digits behind the point.
    pub decimals: usize,
    unit: String,
    wants_parentheses: bool,
}

impl WrittenNumber {
    /// The text with another value in it.
    pub fn with_value(&self, number: &str) -> String {
        let text = format!("{number}{}", self.unit);
        if text.starts_with('-') && self.wants_parentheses { format!("({text})") } else { text }
    }
}

/// The number that an offset of a text is in or beside.
pub fn number_around(text: &str, offset: usize) -> Option<WrittenNumber> {
    let tokens = tokens(text);
    let is_under = |(class, range): &Token| {
        *class == Class::Number && (range.start..=range.end).contains(&offset)
    };
    let at = tokens.iter().position(is_under)?;
    let (_, own) = tokens.get(at)?;
    let literal = text.get(own.clone())?;
    let number_end = (1..=literal.len())
        .rev()
        .find(|end| literal.get(..*end).is_some_and(|part| part.parse::<f64>().is_ok()))?;
    let (digits, unit) = literal.split_at(number_end);
    let value: f64 = digits.parse().ok()?;
    let sign = sign_of(text, &tokens, at);
    Some(WrittenNumber {
        range: sign.unwrap_or(own.start)..own.end,
        literal: literal.to_owned(),
        value: if sign.is_some() { -value } else { value },
        decimals: digits.split_once('.').map_or(0, |(_, decimals)| decimals.len()),
        unit: unit.to_owned(),
        wants_parentheses: sign.is_none() && is_operand(text, &tokens, at),
    })
}

/// The numbers of a source, in the order of their positions.
pub fn source_numbers<'a>(
    source: &str,
    literals: impl Iterator<Item = (&'a LiveLiteral, &'a Param)>,
) -> Vec<SourceNumber> {
    let tokens = tokens(source);
    let number = |(literal, param): (&LiveLiteral, &Param)| {
        let at = tokens.partition_point(|(_, range)| range.start < literal.span.start as usize);
        let (_, own) = tokens.get(at).filter(|(class, _)| *class == Class::Number)?;
        let sign = sign_of(source, &tokens, at);
        let written = sign.unwrap_or(own.start)..own.end;
        let flip = |[low, high]: [f64; 2]| if sign.is_some() { [-high, -low] } else { [low, high] };
        Some(SourceNumber {
            span: literal.span,
            value: if sign.is_some() { -literal.value } else { literal.value },
            range: param.range.map(flip),
            is_angle: param.kind == ParamKind::Angle,
            text: source.get(written.clone())?.to_owned(),
            name: let_name(source, written.clone()).map(str::to_owned),
            param: literal.param,
            is_signed: sign.is_some(),
            wants_parentheses: sign.is_none() && is_operand(source, &tokens, at),
            written,
        })
    };
    let mut numbers: Vec<SourceNumber> = literals.filter_map(number).collect();
    numbers.sort_by_key(|number| number.span.start);
    numbers
}

pub(super) type Token = (Class, Range<usize>);

/// The tokens of a source without its comments.
pub(super) fn tokens(source: &str) -> Vec<Token> {
    let mut tokens = classes(source);
    tokens.retain(|(class, _)| !matches!(class, Class::Comment | Class::Docs));
    tokens
}

/// Where the minus sign of a number token stands; `None` if it has none. The minus of `-2.abs()` is
/// that of the call, and the minus of `a - 2` is an operator between two values.
fn sign_of(source: &str, tokens: &[Token], number: usize) -> Option<usize> {
    let minus = number.checked_sub(1)?;
    let (_, range) = tokens.get(minus).filter(|(_, range)| &source[range.clone()] == "-")?;
    let before = minus.checked_sub(1).and_then(|before| tokens.get(before));
    let is_prefix = before.is_some_and(|(class, range)| match class {
        Class::Operator | Class::Open | Class::Keyword => true,
        Class::Punctuation => &source[range.clone()] != ".",
        Class::Name | Class::Number | Class::Color | Class::Text | Class::Close => false,
        Class::Comment | Class::Docs | Class::Unknown => false,
    });
    (is_prefix && !is_receiver(source, tokens, number)).then_some(range.start)
}

/// True if a field or a method of the token's value follows.
fn is_receiver(source: &str, tokens: &[Token], at: usize) -> bool {
    tokens.get(at + 1).is_some_and(|(_, range)| &source[range.clone()] == ".")
}

/// True if the token is an operand of an operator other than `=`, or has a method.
fn is_operand(source: &str, tokens: &[Token], at: usize) -> bool {
    let before = at.checked_sub(1).and_then(|before| tokens.get(before));
    let follows_operator = before
        .is_some_and(|(class, range)| *class == Class::Operator && &source[range.clone()] != "=");
    follows_operator || is_receiver(source, tokens, at)
}

/// The name in a line `let name = value`, which may end with a comment; `None` for other lines.
/// `value` is the byte range of the value in the source.
fn let_name(source: &str, value: Range<usize>) -> Option<&str> {
    let (before, after) = (source.get(..value.start)?, source.get(value.end..)?);
    let (line, rest) = (before.rsplit('\n').next()?, after.lines().next().unwrap_or_default());
    let name = line.trim_start_matches('\u{feff}').strip_prefix("let ")?.trim_end();
    let ends = rest.trim().is_empty() || rest.trim_start().starts_with("//");
    name.strip_suffix('=').map(str::trim).filter(|_| ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::model;

    /// What the window shows for each number, and the source with all of them replaced.
    fn shown_and_written(source: &str, value: f64) -> (Vec<String>, String) {
        let model = model(source);
        let shown = model.numbers.iter().map(|number| number.text.clone()).collect();
        let mut written = source.to_owned();
        for number in model.numbers.iter().rev() {
            written.replace_range(number.written.clone(), &number.text_of(value));
        }
        (shown, written)
    }

    #[test]
    fn a_sign_is_part_of_its_number() {
        let source = "let k = -0.4\nsphere(1).translate([-2.1, - 3, 1 - 0.5 + k])\n";
        let (shown, written) = shown_and_written(source, -0.25);
        assert_eq!(shown, ["-0.4", "1", "-2.1", "- 3", "1", "0.5"]);
        let expected =
            "let k = -0.25\nsphere(-0.25).translate([-0.25, -0.25, -0.25 - (-0.25) + k])\n";
        assert_eq!(written, expected);
        let (_, written) = shown_and_written(source, 7.0);
        assert_eq!(written, "let k = 7\nsphere(7).translate([7, 7, 7 - 7 + k])\n");
        assert_eq!(model(source).numbers[0].name.as_deref(), Some("k"));
    }

    #[test]
    fn a_minus_in_front_of_a_call_is_not_that_of_the_number() {
        let (shown, written) = shown_and_written("sphere(1).translate(x: -2.1.abs())\n", -3.0);
        assert_eq!(shown, ["1", "2.1"]);
        assert_eq!(written, "sphere(-3).translate(x: -(-3).abs())\n");
    }

    #[test]
    fn a_literal_has_a_name_if_it_is_the_whole_value_of_a_let() {
        let name = |text: &str| {
            let at = text.find("0.4").unwrap();
            let_name(text, at..at + 3).map(str::to_owned)
        };
        let named = ["let k = 0.4", "\u{feff}let k = 0.4\r\nsphere(k)\n", "a()\nlet  k=0.4 // k"];
        named.iter().for_each(|text| assert_eq!(name(text).as_deref(), Some("k"), "{text}"));
        let unnamed = ["let k = 0.4 + 1", "sphere(0.4)", "  let k = 0.4", "outlet = 0.4"];
        unnamed.iter().for_each(|text| assert_eq!(name(text), None, "{text}"));
    }
}
