//! The kinds of tokens, as in section 2 of the language reference.

use logos::Logos;
use sdfc_diagnostics::{FileId, Span};

/// The kind of a token. Its text is looked up by its span.
#[derive(Logos, Clone, Copy, Debug, PartialEq, Eq)]
#[logos(skip r"[ \t\r\n\x0C]+")]
pub(crate) enum TokenKind {
    /// `//` to the end of the line; never reaches the parser.
    #[regex(r"//[^\n]*", allow_greedy = true)]
    Comment,
    /// `/*` to `*/` or the end of the file, which is invalid; recognised for a better error.
    #[token("/*", scan_block)]
    BlockComment,
    #[regex(r"[A-Za-z_][A-Za-z0-9_]*")]
    Name,
    /// Digits with any letters behind them; `literal::number` checks the unit.
    #[regex(r"[0-9]+(\.[0-9]+)?(e[+-]?[0-9]+)?([A-Za-z_][A-Za-z0-9_]*)?")]
    Number,
    /// `.5`, which is invalid; recognised for a better error.
    #[regex(r"\.[0-9]+(e[+-]?[0-9]+)?([A-Za-z_][A-Za-z0-9_]*)?")]
    PointNumber,
    #[regex(r"#[A-Za-z0-9_]*")]
    Color,
    /// From its quote to the closing one or the end of the line; `literal::text` checks it.
    #[token("\"", scan_string)]
    #[token("'", scan_string)]
    #[regex("[\u{2018}-\u{201f}]", scan_string)]
    Text,

    #[token("let")]
    Let,
    #[token("param")]
    Param,
    #[token("fn")]
    Fn,
    #[token("solid")]
    Solid,
    #[token("region")]
    Region,
    #[token("shape")]
    Shape,
    #[token("import")]
    Import,
    #[token("if")]
    If,
    #[token("else")]
    Else,
    #[token("for")]
    For,
    #[token("in")]
    In,
    #[token("true")]
    True,
    #[token("false")]
    False,

    #[token("...")]
    Ellipsis,
    #[token("..")]
    DotDot,
    #[token(".")]
    Dot,
    #[token("->")]
    Arrow,
    #[token("==")]
    EqEq,
    #[token("!=")]
    NotEq,
    #[token("<=")]
    LessEq,
    #[token(">=")]
    GreaterEq,
    #[token("<")]
    Less,
    #[token(">")]
    Greater,
    #[token("&&")]
    AndAnd,
    #[token("||")]
    OrOr,
    #[token("&")]
    And,
    #[token("|")]
    Or,
    #[token("!")]
    Not,
    #[token("=")]
    Eq,
    #[token("+")]
    Plus,
    #[token("-")]
    Minus,
    #[token("*")]
    Star,
    #[token("/")]
    Slash,
    #[token("%")]
    Percent,
    #[token(",")]
    Comma,
    #[token(":")]
    Colon,
    #[token(";")]
    Semicolon,
    #[token("(")]
    OpenParen,
    #[token(")")]
    CloseParen,
    #[token("[")]
    OpenBracket,
    #[token("]")]
    CloseBracket,
    #[token("{")]
    OpenBrace,
    #[token("}")]
    CloseBrace,

    /// Characters that start no token; reported by the lexer.
    Unknown,
    /// Behind the last token.
    Eof,
}

/// Extends a string to its unescaped closing quote, or to the end of the line.
fn scan_string(lexer: &mut logos::Lexer<'_, TokenKind>) {
    let plain = lexer.slice() == "\"";
    let mut escaped = false;
    let mut length = 0;
    for c in lexer.remainder().chars() {
        if c == '\n' {
            break;
        }
        length += c.len_utf8();
        let closes = if plain { c == '"' } else { is_quote(c) };
        if closes && !escaped {
            break;
        }
        escaped = c == '\\' && !escaped;
    }
    let rest = &lexer.remainder()[..length];
    // A carriage return before the line feed belongs to the line's end, not to the string.
    lexer.bump(rest.strip_suffix('\r').unwrap_or(rest).len());
}

/// Extends a block comment to its end, or to the end of the file.
fn scan_block(lexer: &mut logos::Lexer<'_, TokenKind>) {
    let rest = lexer.remainder();
    let length = rest.find("*/").map_or(rest.len(), |end| end + 2);
    lexer.bump(length);
}

/// Returns true if strings in other languages or in pasted text begin or end with the character.
pub(crate) fn is_quote(c: char) -> bool {
    matches!(c, '"' | '\'' | '\u{2018}'..='\u{201f}')
}

/// A token.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token {
    /// The kind.
    pub kind: TokenKind,
    /// True if it is the first token of its line.
    pub first: bool,
    /// Offset of its first byte.
    pub start: u32,
    /// Offset after its last byte.
    pub end: u32,
}

impl Token {
    /// Returns the position in `file`.
    pub fn span(self, file: FileId) -> Span {
        Span::new(file, self.start, self.end)
    }
}

impl TokenKind {
    /// Returns true if it is one of the 13 reserved words.
    pub fn is_reserved(self) -> bool {
        use TokenKind::{
            Else, False, Fn, For, If, Import, In, Let, Param, Region, Shape, Solid, True,
        };
        matches!(
            self,
            Let | Param
                | Fn
                | Solid
                | Region
                | Shape
                | Import
                | If
                | Else
                | For
                | In
                | True
                | False
        )
    }

    /// Returns true if declarations start with it.
    pub fn declares(self) -> bool {
        use TokenKind::{Fn, Import, Let, Param, Region, Shape, Solid};
        matches!(self, Let | Param | Fn | Solid | Region | Shape | Import)
    }

    /// Returns true if an expression may start with it, apart from `-` and `!`.
    pub fn starts_primary(self) -> bool {
        use TokenKind::{
            Color, False, Fn, If, Name, Number, OpenBrace, OpenBracket, OpenParen, PointNumber,
            Text, True,
        };
        matches!(
            self,
            Name | Number
                | PointNumber
                | Color
                | Text
                | True
                | False
                | Fn
                | If
                | OpenParen
                | OpenBracket
                | OpenBrace
        )
    }

    /// Returns true if an expression must follow it.
    pub fn wants_operand(self) -> bool {
        use TokenKind::{
            CloseBrace, CloseBracket, CloseParen, Color, False, Name, Number, OpenBrace,
            OpenBracket, OpenParen, PointNumber, Semicolon, Text, True, Unknown,
        };
        !matches!(
            self,
            CloseBrace
                | CloseBracket
                | CloseParen
                | Color
                | False
                | Name
                | Number
                | OpenBrace
                | OpenBracket
                | OpenParen
                | PointNumber
                | Semicolon
                | Text
                | True
                | Unknown
        )
    }

    /// Returns the closing bracket that belongs to an opening one.
    pub fn closer(self) -> Option<TokenKind> {
        if self == TokenKind::OpenParen {
            Some(TokenKind::CloseParen)
        } else if self == TokenKind::OpenBracket {
            Some(TokenKind::CloseBracket)
        } else if self == TokenKind::OpenBrace {
            Some(TokenKind::CloseBrace)
        } else {
            None
        }
    }

    /// Returns true if it is a closing bracket.
    pub fn is_closer(self) -> bool {
        matches!(self, TokenKind::CloseParen | TokenKind::CloseBracket | TokenKind::CloseBrace)
    }
}
