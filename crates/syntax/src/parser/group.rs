//! Brackets: what stands between them, and what happens when one is missing.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::{Failed, Parsed, Parser};
use crate::token::{Token, TokenKind};

/// An opening bracket that was taken.
#[derive(Clone, Copy)]
pub(super) struct Opener {
    token: Token,
    pub(super) span: Span,
}

impl Parser<'_> {
    /// Takes the opening bracket that comes next.
    pub(super) fn open(&mut self) -> Opener {
        let span = self.span();
        let token = self.bump();
        self.open.push(token.kind);
        Opener { token, span }
    }

    /// Takes the closing bracket, or reports that it is missing. `what` says what could stand
    /// here instead, for the message.
    pub(super) fn close(&mut self, opener: Opener, what: &str) -> Parsed<()> {
        let closed = self.close_or_report(opener, what);
        self.open.pop();
        closed
    }

    fn close_or_report(&mut self, opener: Opener, what: &str) -> Parsed<()> {
        let Some(closer) = opener.token.kind.closer() else {
            return Ok(());
        };
        if self.eat(closer) {
            return Ok(());
        }
        if self.abandoned {
            return Err(Failed);
        }
        if self.kind() == TokenKind::Eof || self.at_new_item() || self.at_new_body() {
            self.unclosed(opener);
            return Ok(());
        }
        if self.kind().is_closer() {
            self.wrong_closer(opener);
            return Ok(());
        }
        let shown = name_of(closer);
        let mut found = self.expectation(&format!("{what} or `{shown}`"));
        found.help.extend(self.operator_hint().map(str::to_owned));
        self.report(found);
        let start = self.span();
        self.skip_to(start, &[])?;
        if !self.eat(closer) {
            self.missing[slot(closer)] += 1;
        }
        Ok(())
    }

    /// Reports an opener without its closer; those that end at one place are one report.
    pub(super) fn unclosed(&mut self, opener: Opener) {
        let Some(closer) = opener.token.kind.closer() else {
            return;
        };
        self.missing[slot(closer)] += 1;
        if self.missing_at.replace(self.at) == Some(self.at) {
            return self.amend(opener.span, "nor is this");
        }
        let shown = self.slice(opener.span);
        let missing = name_of(closer);
        let behind = self.previous().map_or(opener.span, |token| token.span(self.file));
        let mut found = Diagnostic::error(
            Code::UNCLOSED,
            opener.span,
            format!("this `{shown}` is never closed"),
        );
        if behind != opener.span {
            found = found.note_at(behind.after(), format!("a `{missing}` is missing up to here"));
        }
        self.report(found.help(format!("write `{missing}` there, or before")));
    }

    /// A closer of another kind: either it closes a bracket further out, or it is a slip.
    fn wrong_closer(&mut self, opener: Opener) {
        let found = self.kind();
        let outer = &self.open[..self.open.len().saturating_sub(1)];
        if outer.iter().any(|open| open.closer() == Some(found)) {
            return self.unclosed(opener);
        }
        let expected = opener.token.kind.closer().map_or("", name_of);
        let diagnostic = Diagnostic::error(
            Code::EXPECTED,
            self.span(),
            format!("expected `{expected}`, found `{}`", name_of(found)),
        )
        .note_at(opener.span, format!("`{}` was opened here", self.slice(opener.span)));
        self.report(diagnostic);
        self.bump();
    }

    /// What stands between brackets, separated by commas; a comma may follow the last. An element
    /// that cannot be read is what `failed` makes of the place.
    pub(super) fn bracketed<T>(
        &mut self,
        one: &str,
        parse: impl Fn(&mut Self) -> Parsed<T>,
        failed: impl Fn(Span) -> Option<T>,
    ) -> Parsed<Vec<T>> {
        let opener = self.open();
        let depth = self.open.len();
        let elements = self.nested(opener.span, |parser| {
            let mut elements = Vec::new();
            let mut comma_missing = false;
            while !parser.kind().is_closer() && !parser.ends_early() {
                let (start, at) = (parser.span(), parser.at);
                match parse(parser) {
                    Ok(element) => elements.push(element),
                    Err(Failed) => {
                        parser.open.truncate(depth);
                        let skipped = parser.skip_to(start, &[TokenKind::Comma])?;
                        elements.extend(failed(skipped.span));
                    }
                }
                if parser.eat(TokenKind::Comma) {
                    continue;
                }
                if !parser.at_next_element() || parser.at == at {
                    break;
                }
                if !comma_missing {
                    parser.report_missing_comma(one);
                }
                comma_missing = true;
            }
            Ok(elements)
        });
        let closed = self.close(opener, "`,`");
        let elements = elements?;
        closed?;
        Ok(elements)
    }

    /// Whether the file or a new declaration cuts a list short.
    fn ends_early(&self) -> bool {
        self.kind() == TokenKind::Eof || self.at_new_declaration()
    }

    /// Behind an element without a comma: whether another element follows.
    fn at_next_element(&self) -> bool {
        let element = self.kind().starts_primary() || self.kind() == TokenKind::For;
        element && !self.at_new_item() && self.operator_hint().is_none()
    }

    fn report_missing_comma(&mut self, one: &str) {
        let closer = self.open.last().and_then(|open| open.closer()).map_or("", name_of);
        let diagnostic = self
            .expectation(&format!("`,` or `{closer}`"))
            .help(format!("separate one {one} from the next with a comma"));
        self.report(diagnostic);
    }

    /// Whether a late closer makes up for one that was reported missing.
    pub(super) fn was_missing(&mut self, closer: TokenKind) -> bool {
        let missing = &mut self.missing[slot(closer)];
        let late = *missing > 0;
        *missing = missing.saturating_sub(1);
        late
    }
}

/// Where a closing bracket is counted.
fn slot(closer: TokenKind) -> usize {
    if closer == TokenKind::CloseParen {
        0
    } else if closer == TokenKind::CloseBracket {
        1
    } else {
        2
    }
}

/// How a closing bracket is written.
fn name_of(closer: TokenKind) -> &'static str {
    if closer == TokenKind::CloseParen {
        ")"
    } else if closer == TokenKind::CloseBracket {
        "]"
    } else {
        "}"
    }
}
