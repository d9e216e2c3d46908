//! Parses bracketed lists, and recovers from missing brackets.

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

    /// Takes the closing bracket, or reports that it is missing. `what` is the alternative to the
    /// bracket that the message names.
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
        let mut diagnostic = self.expectation(&format!("{what} or `{shown}`"));
        diagnostic.help.extend(self.operator_hint().map(str::to_owned));
        self.report(diagnostic);
        let start = self.span();
        self.skip_to(start, &[])?;
        if !self.eat(closer) {
            self.missing[slot(closer)] += 1;
        }
        Ok(())
    }

    /// Reports an unclosed bracket. Brackets that should close at the same position share one
    /// diagnostic.
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
        let mut diagnostic = Diagnostic::error(
            Code::UNCLOSED,
            opener.span,
            format!("this `{shown}` is never closed"),
        );
        if behind != opener.span {
            diagnostic =
                diagnostic.note_at(behind.after(), format!("a `{missing}` is missing up to here"));
        }
        let diagnostic = diagnostic.help(format!("write `{missing}` there, or before"));
        self.report(diagnostic.fix(format!("write `{missing}`"), behind.after(), missing));
    }

    /// Handles a closing bracket of another kind. It closes an outer bracket, or is a mistake.
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

    /// Parses bracketed elements separated by commas, with an optional comma behind the last.
    /// `failed` returns the stand-in for an element that cannot be parsed.
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

    /// Returns true if the file ends or a new declaration begins inside of a list.
    fn ends_early(&self) -> bool {
        self.kind() == TokenKind::Eof || self.at_new_declaration()
    }

    /// Returns true if another element follows, behind an element without a comma.
    fn at_next_element(&self) -> bool {
        let element = self.kind().starts_primary() || self.kind() == TokenKind::For;
        element && !self.at_new_item() && self.operator_hint().is_none()
    }

    fn report_missing_comma(&mut self, one: &str) {
        let closer = self.open.last().and_then(|open| open.closer()).map_or("", name_of);
        let diagnostic = self
            .expectation(&format!("`,` or `{closer}`"))
            .help(format!("separate one {one} from the next with a comma"));
        let behind = self.previous().map(|token| token.span(self.file).after());
        let diagnostic = match behind {
            Some(behind) => diagnostic.fix("write `,`", behind, ","),
            None => diagnostic,
        };
        self.report(diagnostic);
    }

    /// Returns true if a late closing bracket matches one that was reported as missing.
    pub(super) fn was_missing(&mut self, closer: TokenKind) -> bool {
        let missing = &mut self.missing[slot(closer)];
        let late = *missing > 0;
        *missing = missing.saturating_sub(1);
        late
    }
}

/// Returns the index of a closing bracket in [`Parser::missing`].
fn slot(closer: TokenKind) -> usize {
    if closer == TokenKind::CloseParen {
        0
    } else if closer == TokenKind::CloseBracket {
        1
    } else {
        2
    }
}

/// Returns the text of a closing bracket.
fn name_of(closer: TokenKind) -> &'static str {
    if closer == TokenKind::CloseParen {
        ")"
    } else if closer == TokenKind::CloseBracket {
        "]"
    } else {
        "}"
    }
}
