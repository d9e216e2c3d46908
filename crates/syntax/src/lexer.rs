//! Splits source text into tokens. Comments are kept separately.

use logos::Logos;
use sdfc_diagnostics::{Code, Diagnostic, FileId, Span};

use crate::token::{Token, TokenKind};

/// The position of a comment, including its slashes, without the line break.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Comment {
    /// Offset of its first slash.
    pub start: u32,
    /// Offset after its last character that is not white space.
    pub end: u32,
    /// The number of tokens before it.
    pub tokens_before: usize,
}

impl Comment {
    /// Returns the text of the comment, including its slashes.
    pub fn text(self, text: &str) -> &str {
        &text[self.start as usize..self.end as usize]
    }

    /// Returns the text of a documentation comment, or `None` for `//` and for four and more
    /// slashes.
    pub fn doc(self, text: &str) -> Option<&str> {
        let line = self.text(text).strip_prefix("///")?;
        (!line.starts_with('/')).then(|| line.strip_prefix(' ').unwrap_or(line))
    }
}

/// The tokens and comments of a file.
#[derive(Debug)]
pub(crate) struct Lexed {
    /// The tokens; the last one is `Eof`.
    pub tokens: Vec<Token>,
    /// The comments in order.
    pub comments: Vec<Comment>,
    /// Errors about characters that start no token.
    pub diagnostics: Vec<Diagnostic>,
}

/// Splits `text` into tokens, starting at byte `from`. The length of `text` must fit `u32`.
pub(crate) fn lex(text: &str, file: FileId, from: usize) -> Lexed {
    let mut lexed = Lexed { tokens: Vec::new(), comments: Vec::new(), diagnostics: Vec::new() };
    let mark = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let start = if text.is_char_boundary(from) { from.max(mark) } else { text.len() };
    let mut lexer = TokenKind::lexer(text);
    lexer.bump(start);
    let mut previous_end = start;
    let mut first = true;
    while let Some(found) = lexer.next() {
        let range = lexer.span();
        first |= text[previous_end..range.start].contains('\n');
        previous_end = range.end;
        let mut token = Token {
            kind: found.unwrap_or(TokenKind::Unknown),
            first,
            start: range.start as u32,
            end: range.end as u32,
        };
        if token.kind == TokenKind::Comment {
            let end = range.start + text[range].trim_end().len();
            let tokens_before = lexed.tokens.len();
            lexed.comments.push(Comment { start: token.start, end: end as u32, tokens_before });
            continue;
        }
        if token.kind == TokenKind::BlockComment {
            lexed.block_comment(token.span(file));
            continue;
        }
        if token.kind == TokenKind::Unknown {
            let letters = lexer.slice().chars().chain(lexer.remainder().chars());
            let word: usize = letters.take_while(|&c| is_letter(c)).map(char::len_utf8).sum();
            if word > 0 {
                lexer.bump(word - lexer.slice().len());
                previous_end = lexer.span().end;
                token.end = previous_end as u32;
                token = lexed.foreign_word(text, token, file);
            } else if let Some(kind) = lexed.unknown(text, token, file) {
                token.kind = kind;
            } else {
                continue;
            }
        }
        first = false;
        if let Some(token) = lexed.joined(token) {
            lexed.tokens.push(token);
        }
    }
    let end = text.len() as u32;
    lexed.tokens.push(Token { kind: TokenKind::Eof, first: true, start: end, end });
    lexed
}

impl Lexed {
    /// Returns the token, or `None` if it extends a run of unknown characters, which is one token.
    fn joined(&mut self, token: Token) -> Option<Token> {
        match self.tokens.last_mut() {
            Some(last)
                if last.kind == TokenKind::Unknown
                    && token.kind == TokenKind::Unknown
                    && last.end == token.start =>
            {
                last.end = token.end;
                None
            }
            Some(_) | None => Some(token),
        }
    }

    /// Reports a block comment, which is otherwise ignored.
    fn block_comment(&mut self, span: Span) {
        let opening = Span { end: span.start + 2, ..span };
        let message = "comments in `/* */` are not part of the language";
        self.diagnostics.push(
            Diagnostic::error(Code::UNKNOWN_CHARACTER, opening, message)
                .help("write `//` before each line; such a comment ends with its line"),
        );
    }

    /// Reports a word with letters outside ASCII. It counts as a name, together with a name right
    /// before it.
    fn foreign_word(&mut self, text: &str, mut token: Token, file: FileId) -> Token {
        if let Some(last) = self.tokens.last()
            && last.kind == TokenKind::Name
            && last.end == token.start
        {
            token = Token { end: token.end, ..*last };
            self.tokens.pop();
        }
        let word = &text[token.start as usize..token.end as usize];
        let message = format!("`{word}` has letters that names cannot have");
        self.diagnostics.push(
            Diagnostic::error(Code::UNKNOWN_CHARACTER, token.span(file), message)
                .help("names are written with the letters a to z, digits and `_`"),
        );
        Token { kind: TokenKind::Name, ..token }
    }

    /// Reports a character that starts no token. Returns the kind that was probably meant,
    /// `Unknown`, or `None` if the parser can ignore the character.
    fn unknown(&mut self, text: &str, token: Token, file: FileId) -> Option<TokenKind> {
        let span = token.span(file);
        let c = text[token.start as usize..].chars().next()?;
        let (meant, help) = meaning(c);
        if meant == Some(TokenKind::Unknown) && self.extends_last(span) {
            return meant;
        }
        let shown = if c.is_control() || c.is_whitespace() {
            format!("U+{:04X}", c as u32)
        } else {
            c.to_string()
        };
        let found = Diagnostic::error(
            Code::UNKNOWN_CHARACTER,
            span,
            format!("the character `{shown}` is not part of the language"),
        );
        self.diagnostics.push(if help.is_empty() { found } else { found.help(help) });
        meant
    }

    /// Returns true if the previous character was unknown too; then its diagnostic covers both.
    fn extends_last(&mut self, span: Span) -> bool {
        let joins = self
            .tokens
            .last()
            .is_some_and(|last| last.kind == TokenKind::Unknown && last.end == span.start);
        if let (true, Some(last)) = (joins, self.diagnostics.last_mut()) {
            last.span.end = span.end;
        }
        joins
    }
}

/// Returns true if the character may be part of a word in another language.
fn is_letter(c: char) -> bool {
    let meant = matches!(meaning(c).0, Some(kind) if kind != TokenKind::Unknown);
    c == '_' || (c.is_alphanumeric() && !meant)
}

/// Returns the token that a character was probably meant to be, and what to write instead.
fn meaning(c: char) -> (Option<TokenKind>, &'static str) {
    match c {
        '\u{2010}'..='\u{2015}' | '\u{2212}' => (Some(TokenKind::Minus), "write `-`"),
        '\u{d7}' | '\u{b7}' | '\u{22c5}' => (Some(TokenKind::Star), "write `*`"),
        '\u{f7}' => (Some(TokenKind::Slash), "write `/`"),
        '\u{2026}' => (Some(TokenKind::DotDot), "a range is written with two dots: `0..1`"),
        '\u{2264}' => (Some(TokenKind::LessEq), "write `<=`"),
        '\u{2265}' => (Some(TokenKind::GreaterEq), "write `>=`"),
        '\u{2260}' => (Some(TokenKind::NotEq), "write `!=`"),
        '\u{3c0}' => (Some(TokenKind::Name), "write `pi`"),
        '\u{221e}' => (Some(TokenKind::Name), "write `inf`"),
        '\u{b0}' => (None, "angles are written `90deg`"),
        '^' => (Some(TokenKind::Unknown), "powers are written `pow(x, 2)`"),
        '?' => (Some(TokenKind::Unknown), "choices are written `if c { a } else { b }`"),
        c if c.is_whitespace() => (None, "replace it by a plain space"),
        _ => (Some(TokenKind::Unknown), ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind> {
        lex(text, FileId(0), 0).tokens.iter().map(|token| token.kind).collect()
    }

    #[test]
    fn ranges_numbers_and_points_are_distinguished() {
        use TokenKind::{Dot, DotDot, Ellipsis, Eof, Name, Number, PointNumber};
        assert_eq!(kinds("0..8"), [Number, DotDot, Number, Eof]);
        assert_eq!(kinds("0.5..1.5e-3deg"), [Number, DotDot, Number, Eof]);
        assert_eq!(kinds("0.._n"), [Number, DotDot, Name, Eof]);
        assert_eq!(kinds(".5 a.x 1.x"), [PointNumber, Name, Dot, Name, Number, Dot, Name, Eof]);
        assert_eq!(kinds("shapes..."), [Name, Ellipsis, Eof]);
    }

    #[test]
    fn lines_begin_after_line_feeds_only() {
        let firsts = |text: &str| -> Vec<bool> {
            lex(text, FileId(0), 0).tokens.iter().map(|token| token.first).collect()
        };
        assert_eq!(firsts("a b\r\nc // d\ne"), [true, false, true, true, true]);
        assert_eq!(firsts("\u{feff}a // b"), [true, true]);
    }

    #[test]
    fn a_string_ends_at_its_quote_or_its_line() {
        let texts = |text: &str| -> Vec<String> {
            let lexed = lex(text, FileId(0), 0);
            let tokens = lexed.tokens.iter();
            tokens.map(|t| text[t.start as usize..t.end as usize].to_owned()).collect()
        };
        assert_eq!(texts("\"a\\\"b\" c"), ["\"a\\\"b\"", "c", ""]);
        assert_eq!(texts("\"ab\r\nc"), ["\"ab", "c", ""]);
        assert_eq!(texts("\"a\\\\\" b"), ["\"a\\\\\"", "b", ""]);
        assert_eq!(texts("“a” b"), ["“a”", "b", ""]);
    }
}
