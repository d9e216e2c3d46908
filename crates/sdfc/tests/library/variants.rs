//! Scenes like an entry's example with other numbers, for which formulas degenerate and conditions
//! change.

use crate::geometry::Random;

/// Numbers are multiplied or divided by up to this factor.
const LARGEST: f64 = 5.0;

/// Returns the text with random changes: each number is kept, scaled or set to 0, and sometimes
/// negated. The entry's own ranges refuse many of these scenes; the caller drops those.
pub fn changed(text: &str, random: &mut Random) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, number, after)) = next_number(rest) {
        out.push_str(before);
        out.push_str(&other(number, random));
        rest = after;
    }
    out + rest
}

/// Returns the first number of a text, with the text before and after it.
fn next_number(text: &str) -> Option<(&str, &str, &str)> {
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let byte = bytes[at];
        if byte == b'"' {
            at += 1 + text[at + 1..].find('"')? + 1;
        } else if byte.is_ascii_alphabetic() || byte == b'_' || byte == b'#' {
            // The digits of a name, a colour or a unit are no number.
            at += 1;
            while at < bytes.len() && (bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_') {
                at += 1;
            }
        } else if byte.is_ascii_digit() {
            let digit = |c: char| c.is_ascii_digit();
            let whole = text[at..].find(|c| !digit(c)).map_or(text.len(), |end| at + end);
            let fraction = text[whole..].starts_with('.') && text[whole + 1..].starts_with(digit);
            let end = if fraction {
                text[whole + 1..].find(|c| !digit(c)).map_or(text.len(), |end| whole + 1 + end)
            } else {
                whole
            };
            return Some((&text[..at], &text[at..end], &text[end..]));
        } else {
            at += 1;
        }
    }
    None
}

fn other(number: &str, random: &mut Random) -> String {
    let Ok(value) = number.parse::<f64>() else { return number.to_owned() };
    let whole = !number.contains('.');
    let changed = match random.below(16) {
        0..=3 => value,
        4 => 0.0,
        _ => value * LARGEST.powf(random.signed()),
    };
    let changed = if random.below(6) == 0 { -changed } else { changed };
    // Half of the whole numbers stay whole, because they may be counts.
    let changed = if whole && random.below(2) == 0 { changed.round() } else { changed };
    let digits = format!("{changed:.3}");
    let short = digits.trim_end_matches('0').trim_end_matches('.');
    if changed < 0.0 { format!("({short})") } else { short.to_owned() }
}

/// Returns the call of `name` in an example, with its arguments.
pub fn call_of<'t>(name: &str, text: &'t str) -> Option<&'t str> {
    let starts = text.match_indices(name).map(|(at, _)| at);
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let start = starts
        .into_iter()
        .find(|&at| text[at + name.len()..].starts_with('(') && !text[..at].ends_with(is_word))?;
    let mut depth = 0;
    for (at, c) in text[start..].char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return Some(&text[start..=start + at]);
        }
    }
    None
}
