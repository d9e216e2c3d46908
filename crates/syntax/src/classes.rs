//! The tokens of a text by their role, for editors.

use std::ops::Range;

use sdfc_diagnostics::FileId;

use crate::lexer::lex;
use crate::token::TokenKind;

/// The role of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// `// comment`
    Comment,
    /// `/// documentation`
    Docs,
    /// A reserved word.
    Keyword,
    /// A name.
    Name,
    /// A number with its unit.
    Number,
    /// `#rrggbb`
    Color,
    /// A string with its quotes.
    Text,
    /// An operator, such as `|` or `->`.
    Operator,
    /// An opening bracket.
    Open,
    /// A closing bracket.
    Close,
    /// `,`, `:`, `;` or `.`
    Punctuation,
    /// Characters that start no token.
    Unknown,
}

/// Returns the byte ranges of all tokens and comments of a text, in order. A text that is too large
/// for a file has none.
pub fn classes(text: &str) -> Vec<(Class, Range<usize>)> {
    if text.len() > crate::MAX_BYTES {
        return Vec::new();
    }
    let lexed = lex(text, FileId(0), 0);
    let mut classes = Vec::with_capacity(lexed.tokens.len() + lexed.comments.len());
    for comment in &lexed.comments {
        let class = if comment.doc(text).is_some() { Class::Docs } else { Class::Comment };
        classes.push((class, comment.start as usize..comment.end as usize));
    }
    let tokens = lexed.tokens.iter().filter(|token| token.kind != TokenKind::Eof);
    classes.extend(tokens.map(|it| (class(it.kind), it.start as usize..it.end as usize)));
    classes.sort_by_key(|(_, range)| range.start);
    classes
}

/// Returns true if a word is reserved, so that it cannot be a name.
pub fn is_reserved(word: &str) -> bool {
    let lexed = lex(word, FileId(0), 0);
    lexed.tokens.first().is_some_and(|token| token.kind.is_reserved())
}

fn class(kind: TokenKind) -> Class {
    use TokenKind as Kind;
    match kind {
        Kind::Comment | Kind::BlockComment => Class::Comment,
        Kind::Name => Class::Name,
        Kind::Number | Kind::PointNumber => Class::Number,
        Kind::Color => Class::Color,
        Kind::Text => Class::Text,
        Kind::Let
        | Kind::Param
        | Kind::Fn
        | Kind::Solid
        | Kind::Region
        | Kind::Shape
        | Kind::Import
        | Kind::If
        | Kind::Else
        | Kind::For
        | Kind::In
        | Kind::True
        | Kind::False => Class::Keyword,
        Kind::Ellipsis
        | Kind::DotDot
        | Kind::Arrow
        | Kind::EqEq
        | Kind::NotEq
        | Kind::LessEq
        | Kind::GreaterEq
        | Kind::Less
        | Kind::Greater
        | Kind::AndAnd
        | Kind::OrOr
        | Kind::And
        | Kind::Or
        | Kind::Not
        | Kind::Eq
        | Kind::Plus
        | Kind::Minus
        | Kind::Star
        | Kind::Slash
        | Kind::Percent => Class::Operator,
        Kind::Dot | Kind::Comma | Kind::Colon | Kind::Semicolon => Class::Punctuation,
        Kind::OpenParen | Kind::OpenBracket | Kind::OpenBrace => Class::Open,
        Kind::CloseParen | Kind::CloseBracket | Kind::CloseBrace => Class::Close,
        Kind::Unknown | Kind::Eof => Class::Unknown,
    }
}
