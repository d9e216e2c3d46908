//! Splits Rust source into words and marks, without comments and literals.

/// A token of Rust source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Token<'a> {
    /// A keyword, a name or a number.
    Word(&'a str),
    /// A single character of punctuation.
    Mark(char),
}

/// Returns the tokens of a Rust source. Strings, characters and lifetimes are left out.
pub fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let skipped = skipped_length(rest);
        if skipped > 0 {
            rest = &rest[skipped..];
        } else if is_word(first) {
            let end = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
            tokens.push(Token::Word(&rest[..end]));
            rest = &rest[end..];
        } else {
            if !first.is_whitespace() {
                tokens.push(Token::Mark(first));
            }
            rest = &rest[first.len_utf8()..];
        }
    }
    tokens
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// Returns the length of the comment, string, character or lifetime that `rest` begins with, or 0.
fn skipped_length(rest: &str) -> usize {
    if rest.starts_with("//") {
        return rest.find('\n').unwrap_or(rest.len());
    }
    if rest.starts_with("/*") {
        return rest.find("*/").map_or(rest.len(), |end| end + 2);
    }
    if let Some(length) = raw_string_length(rest) {
        return length;
    }
    let unprefixed = rest.strip_prefix('b').unwrap_or(rest);
    let prefix = rest.len() - unprefixed.len();
    if unprefixed.starts_with('"') {
        return prefix + quoted_length(unprefixed, '"');
    }
    if !unprefixed.starts_with('\'') {
        return 0;
    }
    // A quote begins a character, such as 'a' or '\n', or a lifetime, such as 'a.
    let mut letters = unprefixed.char_indices().skip(1);
    match (letters.next(), letters.next()) {
        (Some((_, '\\')), _) | (_, Some((_, '\''))) => prefix + quoted_length(unprefixed, '\''),
        (_, _) => 1 + unprefixed[1..].find(|letter| !is_word(letter)).unwrap_or(0),
    }
}

/// Returns the length of a raw string such as `r#"..."#`, if `rest` begins with one.
fn raw_string_length(rest: &str) -> Option<usize> {
    let behind = rest.strip_prefix("br").or_else(|| rest.strip_prefix('r'))?;
    let hashes = behind.len() - behind.trim_start_matches('#').len();
    let content = behind[hashes..].strip_prefix('"')?;
    let close = format!("\"{}", "#".repeat(hashes));
    let end = content.find(&close).map_or(content.len(), |end| end + close.len());
    Some(rest.len() - content.len() + end)
}

/// Returns the length of a literal that begins and ends with `quote`.
fn quoted_length(rest: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, letter) in rest.char_indices().skip(1) {
        if letter == quote && !is_escaped {
            return at + 1;
        }
        is_escaped = letter == '\\' && !is_escaped;
    }
    rest.len()
}

/// Removes the items that have the attribute `#[cfg(test)]`.
pub fn without_tests(tokens: Vec<Token<'_>>) -> Vec<Token<'_>> {
    use Token::{Mark, Word};
    const ATTRIBUTE: [Token<'_>; 7] =
        [Mark('#'), Mark('['), Word("cfg"), Mark('('), Word("test"), Mark(')'), Mark(']')];
    let mut kept = Vec::new();
    let mut rest = tokens.as_slice();
    while let Some(first) = rest.first() {
        if let Some(item) = rest.strip_prefix(&ATTRIBUTE) {
            rest = &item[item_length(item)..];
        } else {
            kept.push(*first);
            rest = &rest[1..];
        }
    }
    kept
}

/// Returns how many tokens belong to the item at the beginning: up to a `;` or a closing brace.
fn item_length(tokens: &[Token<'_>]) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        match token {
            Token::Mark('{' | '(' | '[') => depth += 1,
            Token::Mark(')' | ']') => depth -= 1,
            Token::Mark('}') => {
                depth -= 1;
                if depth == 0 {
                    return at + 1;
                }
            }
            Token::Mark(';') if depth == 0 => return at + 1,
            Token::Mark(_) | Token::Word(_) => {}
        }
    }
    tokens.len()
}

#[cfg(test)]
mod tests {
    use super::Token::{Mark, Word};
    use super::*;

    #[test]
    fn comments_strings_characters_and_lifetimes_are_left_out() {
        let source = "a // b\n/* c */ \"d \\\" e\" r#\"f \" g\"# 'h' '\\'' b\"i\" &'j k";
        assert_eq!(tokens(source), [Word("a"), Mark('&'), Word("k")]);
    }

    #[test]
    fn items_of_tests_are_removed() {
        let source = "a #[cfg(test)] mod t { x { y } } b #[cfg(test)] use c::{d}; e";
        // The braces of a `use` end the item, and the `;` behind them stays.
        let kept = [Word("a"), Word("b"), Mark(';'), Word("e")];
        assert_eq!(without_tests(tokens(source)), kept);
    }
}
