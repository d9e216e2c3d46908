//! Diagnostics, and the recovery after an error.

use sdfc_diagnostics::{Code, Diagnostic, Note, Span};

use super::{Failed, Parsed, Parser};
use crate::MAX_ERRORS;
use crate::ast::{Expr, ExprKind};
use crate::literal;
use crate::token::{Token, TokenKind};

/// The diagnostics so far.
#[derive(Default)]
pub(super) struct Reports {
    diagnostics: Vec<Diagnostic>,
    /// The number of diagnostics after the last one that is kept.
    dropped: usize,
}

impl Parser<'_> {
    /// Adds a diagnostic, unless there is one at the same position.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        let start = diagnostic.span.start;
        let reports = &mut self.reports;
        if reports.diagnostics.iter().rev().any(|earlier| earlier.span.start == start) {
            return;
        }
        if reports.diagnostics.len() < MAX_ERRORS {
            reports.diagnostics.push(diagnostic);
        } else {
            reports.dropped += 1;
        }
    }

    /// Returns all diagnostics in the order of the text.
    pub(super) fn diagnostics(self) -> Vec<Diagnostic> {
        let Reports { mut diagnostics, dropped } = self.reports;
        diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
        if dropped > 0
            && let Some(last) = diagnostics.pop()
        {
            diagnostics
                .push(last.note(format!("{dropped} more errors in this file are not shown")));
        }
        diagnostics
    }

    /// Reports and fails.
    pub(super) fn fail<T>(&mut self, diagnostic: Diagnostic) -> Parsed<T> {
        self.report(diagnostic);
        Err(Failed)
    }

    /// Reports that a limit was exceeded, and skips the rest of the item.
    pub(super) fn abandon<T>(&mut self, diagnostic: Diagnostic) -> Parsed<T> {
        self.report(diagnostic);
        self.abandoned = true;
        while self.kind() != TokenKind::Eof && !self.at_new_item() {
            self.bump();
        }
        Err(Failed)
    }

    /// Adds a note to the latest diagnostic, unless it has many already.
    pub(super) fn amend(&mut self, span: Span, note: &str) {
        if self.reports.dropped == 0
            && let Some(last) = self.reports.diagnostics.last_mut()
            && last.notes.len() < 4
        {
            last.notes.push(Note { span: Some(span), message: note.to_owned() });
        }
    }

    /// Reports that something else was expected and fails. `what` completes "expected ...".
    pub(super) fn expected<T>(&mut self, what: &str) -> Parsed<T> {
        self.expected_with(what, &[])
    }

    /// Does the same as [`Self::expected`], with suggestions.
    pub(super) fn expected_with<T>(&mut self, what: &str, help: &[&str]) -> Parsed<T> {
        let diagnostic = self.expectation(what);
        let diagnostic = help.iter().fold(diagnostic, |diagnostic, help| diagnostic.help(*help));
        self.fail(diagnostic)
    }

    /// Returns the number of diagnostics, including those past the limit.
    pub(super) fn reported(&self) -> usize {
        self.reports.diagnostics.len() + self.reports.dropped
    }

    /// Reports an unexpected token behind a complete expression.
    pub(super) fn report_no_end(&mut self) {
        if self.kind() == TokenKind::PointNumber {
            let diagnostic = literal::bare_point(self.slice(self.span()), self.span());
            return self.report(diagnostic);
        }
        let message = "expected an operator or the end of the line";
        let diagnostic = Diagnostic::error(Code::EXPECTED, self.span(), message);
        let help = match (self.kind(), self.operator_hint()) {
            (TokenKind::Comma, _) => {
                vec!["commas separate arguments and elements of lists".to_owned()]
            }
            (kind, _) if kind.declares() => {
                vec!["start a new line, or separate the two with `;`".to_owned()]
            }
            (_, Some(hint)) => vec![hint.to_owned()],
            (kind, None) => {
                let join = || "join solids with `|`, or start a new line".to_owned();
                self.brackets_hint().into_iter().chain(kind.starts_primary().then(join)).collect()
            }
        };
        self.report(help.into_iter().fold(diagnostic, Diagnostic::help));
    }

    /// Suggests how to write a call, for a name with an unexpected token behind it: `sphere 1`,
    /// `union() { ... }`.
    fn brackets_hint(&self) -> Option<String> {
        let previous = self.previous()?;
        let text = self.slice(previous.span(self.file));
        match (previous.kind, self.kind()) {
            (TokenKind::Name, TokenKind::Name) => {
                let word = self.slice(self.span());
                if text == "return" {
                    return Some("the last line is the value: leave out `return`".to_owned());
                }
                if matches!(text, "float" | "vec2" | "vec3" | "vec4" | "int" | "bool" | "void") {
                    return Some(format!(
                        "a type stands behind its name: `let {word} = ...`, `fn {word}(p: vec3) = \
                         ...`"
                    ));
                }
                if matches!(text, "module" | "function" | "def" | "func") {
                    return Some(format!(
                        "declare a function with `fn {word}(x) = ...`, and a shape with `solid \
                         {word}() = ...`"
                    ));
                }
                Some(format!(
                    "arguments stand in brackets, {text}({word}); `let {word} = ...` names a value"
                ))
            }
            (
                TokenKind::Name,
                TokenKind::Number | TokenKind::OpenBracket | TokenKind::OpenBrace,
            ) => Some(format!("arguments stand in brackets: {text}(...)")),
            (TokenKind::CloseParen, TokenKind::OpenBrace) => {
                Some("shapes are arguments, too: union(a, b)".to_owned())
            }
            _ => None,
        }
    }

    /// Suggests the equivalent of an operator from other languages.
    pub(super) fn operator_hint(&self) -> Option<&'static str> {
        match (self.kind(), self.slice(self.span())) {
            (TokenKind::Name, "and") => Some("write `&&`"),
            (TokenKind::Name, "or") => Some("write `||`"),
            (TokenKind::Name, "not") => Some("write `!`"),
            (TokenKind::Name, "to" | "until") | (TokenKind::Ellipsis, _) => {
                Some("a range is written with two dots: `0..1`")
            }
            (TokenKind::Name, "deg" | "turn" | "rad") if self.follows(TokenKind::Number) => {
                Some("a unit follows its number without a space: `30deg`")
            }
            (TokenKind::Eq, _) if self.peek(1).kind == TokenKind::Greater => {
                Some("a function without a name is written fn(x) = x")
            }
            (TokenKind::Eq, _) if self.follows_component() => Some(
                "values do not change; make a new vector of components: \
                 `let b = [c.x, a.y, c.y]`",
            ),
            (TokenKind::Eq, _) => Some("equality is written `==`; `let a = 1` names a value"),
            (TokenKind::Else, _) => Some("`else` follows the `}` of an `if`"),
            _ => None,
        }
    }

    fn follows(&self, kind: TokenKind) -> bool {
        self.previous().is_some_and(|previous| previous.kind == kind)
    }

    /// True behind a component, as in `a.x`.
    fn follows_component(&self) -> bool {
        let before = self.at.checked_sub(2).and_then(|at| self.tokens.get(at));
        self.follows(TokenKind::Name) && before.is_some_and(|token| token.kind == TokenKind::Dot)
    }

    /// Returns the diagnostic "expected ...", at the next token or, if the line ended too early,
    /// behind the previous one.
    pub(super) fn expectation(&mut self, what: &str) -> Diagnostic {
        let next = self.next();
        if next.kind == TokenKind::Unknown {
            // The lexer has already reported the character at this position.
            return Diagnostic::error(Code::EXPECTED, self.span(), format!("expected {what}"));
        }
        let found = self.description_of_next();
        let span = match self.previous() {
            Some(previous) if self.at_line_end() => previous.span(self.file).after(),
            Some(_) | None => self.span(),
        };
        Diagnostic::error(Code::EXPECTED, span, format!("expected {what}, found {found}"))
    }

    /// Returns true if the line ended too early: the next token begins something new on another
    /// line.
    fn at_line_end(&self) -> bool {
        let Token { kind, first, .. } = self.next();
        first && (kind == TokenKind::Eof || kind.starts_primary() || kind.declares())
    }

    /// Describes the next token for a message.
    pub(super) fn description_of_next(&self) -> String {
        let next = self.next();
        let text = self.slice(self.span());
        if next.kind == TokenKind::Eof {
            "the end of the file".to_owned()
        } else if self.at_line_end() {
            "the end of the line".to_owned()
        } else if next.kind == TokenKind::Text {
            "a string".to_owned()
        } else if next.kind.is_reserved() {
            format!("the reserved word `{text}`")
        } else if text.len() > 40 {
            format!("`{}...`", text.chars().take(32).collect::<String>())
        } else {
            format!("`{text}`")
        }
    }

    /// Parses an expression. For an invalid one it returns `Error` and skips to one of `stops` or
    /// to the closing bracket of the innermost list.
    ///
    /// # Errors
    ///
    /// Fails only if the item is abandoned.
    pub(super) fn expr_or_skip(&mut self, stops: &[TokenKind]) -> Parsed<Expr> {
        let start = self.span();
        match self.expr() {
            Ok(expr) => Ok(expr),
            Err(Failed) => self.skip_to(start, stops),
        }
    }

    /// Skips to one of `stops`, to the closing bracket of the innermost list, to the next item, to
    /// a line with the `=` of a body or, in a block, to the next line. Returns the skipped span as
    /// `Error`.
    pub(super) fn skip_to(&mut self, start: Span, stops: &[TokenKind]) -> Parsed<Expr> {
        if self.abandoned {
            return Err(Failed);
        }
        let mut inner = 0_usize;
        loop {
            let kind = self.kind();
            if kind == TokenKind::Eof || self.at_new_item() || self.at_new_body() {
                break;
            }
            let in_block = inner == 0 && self.open.last() == Some(&TokenKind::OpenBrace);
            if in_block && self.next().first && kind.starts_primary() && self.span() != start {
                break;
            }
            if inner == 0 && (kind.is_closer() || stops.contains(&kind)) {
                break;
            }
            if kind.closer().is_some() {
                inner += 1;
            } else if kind.is_closer() {
                inner -= 1;
            }
            self.bump();
        }
        Ok(Expr { kind: ExprKind::Error, span: self.since(start) })
    }
}
