//! The state of the parser: a cursor over the tokens, the open brackets, the diagnostics.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "each rule of a grammar looks for a few kinds of token and refuses the rest"
)]

mod expr;
mod group;
mod items;
mod primary;
mod report;
mod signature;

use std::ops::Range;

use sdfc_diagnostics::{Code, Diagnostic, FileId, Sources, Span};

use crate::ast::File;
use crate::lexer::{Comment, lex};
use crate::token::{Token, TokenKind};
use crate::{MAX_BYTES, MAX_HEIGHT, MAX_NESTING};

/// The free stack in bytes below which a nested construct gets a new stack segment.
const RED_ZONE: usize = 128 << 10;
/// The size of a stack segment in bytes.
const SEGMENT: usize = 1 << 20;

/// Signals that a construct could not be parsed and that this was reported.
#[derive(Debug)]
struct Failed;

type Parsed<T> = Result<T, Failed>;

/// Parses a file. Returns the tree, and the diagnostics in the order of the text.
///
/// Without errors the tree is complete. With errors it has everything that could be parsed: a value
/// that could not is [`crate::ast::ExprKind::Error`], and an item without a name is absent. An
/// unknown `file` parses as an empty one.
pub fn parse(sources: &Sources, file: FileId) -> (File, Vec<Diagnostic>) {
    parse_part(sources, file, 0..sources.text(file).len())
}

/// Parses a byte range of a file as [`parse`] parses all of it. Spans refer to the file.
///
/// The range must begin where an item or its documentation begins, and end where an item ends. A
/// range outside of the file parses as an empty file.
pub fn parse_part(sources: &Sources, file: FileId, part: Range<usize>) -> (File, Vec<Diagnostic>) {
    let text = sources.text(file);
    if text.len() > MAX_BYTES {
        return (File::default(), vec![too_large(file, text.len())]);
    }
    let text = text.get(..part.end).unwrap_or("");
    let lexed = lex(text, file, part.start);
    let mut parser = Parser::new(text, file, &lexed.tokens, &lexed.comments);
    for diagnostic in lexed.diagnostics {
        parser.report(diagnostic);
    }
    let tree = parser.file();
    (tree, parser.diagnostics())
}

fn too_large(file: FileId, length: usize) -> Diagnostic {
    let message = format!("this file has {length} bytes; a scene file has at most {MAX_BYTES}");
    Diagnostic::error(Code::TOO_LARGE, Span::new(file, 0, 0), message)
        .help("write repeated parts with `for` or a function, or import them")
}

struct Parser<'a> {
    text: &'a str,
    file: FileId,
    tokens: &'a [Token],
    comments: &'a [Comment],
    /// Index of the next token; never past `Eof`.
    at: usize,
    /// The number of constructs that are open around the next token.
    depth: u32,
    /// The height of the highest expression parsed since this was last set to 0.
    height: u32,
    /// True inside a `solid`, `region` or `shape`, where `p` is the point.
    in_shape: bool,
    /// The brackets that are open, outermost first.
    open: Vec<TokenKind>,
    /// Index of the token where a closing bracket was last found missing.
    missing_at: Option<usize>,
    /// The numbers of missing `)`, `]` and `}`, so that a late one is not reported as well.
    missing: [u32; 3],
    /// True after a limit was exceeded: the rest of the item is skipped without a diagnostic.
    abandoned: bool,
    reports: report::Reports,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str, file: FileId, tokens: &'a [Token], comments: &'a [Comment]) -> Self {
        Parser {
            text,
            file,
            tokens,
            comments,
            at: 0,
            depth: 0,
            height: 0,
            in_shape: false,
            open: Vec::new(),
            missing_at: None,
            missing: [0; 3],
            abandoned: false,
            reports: report::Reports::default(),
        }
    }

    /// Returns the token `ahead` positions behind the next one, or `Eof` past the end.
    fn peek(&self, ahead: usize) -> Token {
        let eof = Token { kind: TokenKind::Eof, first: true, start: 0, end: 0 };
        let last = self.tokens.last().copied().unwrap_or(eof);
        self.tokens.get(self.at + ahead).copied().unwrap_or(last)
    }

    fn next(&self) -> Token {
        self.peek(0)
    }

    fn kind(&self) -> TokenKind {
        self.next().kind
    }

    fn span(&self) -> Span {
        self.next().span(self.file)
    }

    /// The token before the next one.
    fn previous(&self) -> Option<Token> {
        self.tokens.get(self.at.checked_sub(1)?).copied()
    }

    /// Returns the span from the start of `start` to the end of the previous token.
    fn since(&self, start: Span) -> Span {
        match self.previous() {
            Some(token) if token.start >= start.start => start.to(token.span(self.file)),
            Some(_) | None => Span::new(self.file, start.start, start.start),
        }
    }

    /// Returns the text of a span of this file.
    fn slice(&self, span: Span) -> &'a str {
        self.text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// Takes the next token.
    fn bump(&mut self) -> Token {
        let token = self.next();
        if token.kind != TokenKind::Eof {
            self.at += 1;
        }
        token
    }

    /// Takes the next token if it is of this kind.
    fn eat(&mut self, kind: TokenKind) -> bool {
        let found = self.kind() == kind;
        if found {
            self.bump();
        }
        found
    }

    /// Returns true if the next token is this name. For words that are reserved in some positions
    /// only.
    fn at_word(&self, word: &str) -> bool {
        self.kind() == TokenKind::Name && self.slice(self.span()) == word
    }

    /// Returns true if an item, a `let` or a block's value may end here.
    fn at_end(&self) -> bool {
        let next = self.next();
        next.first || matches!(next.kind, TokenKind::Semicolon | TokenKind::CloseBrace)
    }

    /// Returns true if the next token begins a line in the first column.
    fn in_first_column(&self) -> bool {
        let start = self.next().start as usize;
        let before = &self.text[..start];
        self.next().first && (before.is_empty() || before.ends_with(['\n', '\u{feff}']))
    }

    /// Returns true if the next token begins a declaration on a new line.
    fn at_new_declaration(&self) -> bool {
        use TokenKind::{CloseBracket, CloseParen, Comma, Ellipsis, Fn, OpenParen};
        let (next, after) = (self.next(), self.peek(1).kind);
        let lambda = next.kind == Fn && after == OpenParen;
        let ty = matches!(after, Comma | CloseParen | CloseBracket | Ellipsis);
        next.first && next.kind.declares() && !lambda && !ty
    }

    /// Returns true if the next token seems to begin an item, judged by its line.
    fn at_new_item(&self) -> bool {
        self.at_new_declaration() || (self.in_first_column() && self.kind().starts_primary())
    }

    /// Returns true if the next token begins a line with the `=` before a body.
    fn at_new_body(&self) -> bool {
        self.next().first && self.kind() == TokenKind::Eq
    }

    /// Parses a construct that may contain itself, one level deeper. Its height is one more than
    /// the height of the highest expression in it.
    fn nested<T>(&mut self, start: Span, parse: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == MAX_NESTING {
            return self.too_deep(start);
        }
        self.depth += 1;
        let parsed = self.measured(|parser| {
            let parsed = stacker::maybe_grow(RED_ZONE, SEGMENT, || parse(parser));
            parser.height += 1;
            parsed
        });
        self.depth -= 1;
        parsed
    }

    /// Parses with `height` counted from 0. Afterwards `height` is the maximum of both values.
    fn measured<T>(&mut self, parse: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::take(&mut self.height);
        let parsed = parse(self);
        self.height = self.height.max(outer);
        parsed
    }

    /// Counts one more node on top of the expressions parsed so far.
    fn link(&mut self, at: Span) -> Parsed<()> {
        self.height += 1;
        if self.height <= MAX_HEIGHT {
            return Ok(());
        }
        self.abandon(
            Diagnostic::error(
                Code::NESTING,
                at,
                format!("this expression is a chain of more than {MAX_HEIGHT} links"),
            )
            .help("name parts of it with `let`, or give the operands to one call as a list"),
        )
    }

    fn too_deep<T>(&mut self, at: Span) -> Parsed<T> {
        self.abandon(
            Diagnostic::error(
                Code::NESTING,
                at,
                format!("this is nested more than {MAX_NESTING} levels deep"),
            )
            .help("name inner parts with `let`"),
        )
    }
}
