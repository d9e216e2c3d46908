//! Parses parameters, types and clauses.

use sdfc_diagnostics::{Code, Diagnostic};

use super::{Failed, Parsed, Parser};
use crate::ast::{
    Clause, ClauseKind, DeclKind, Expr, FieldType, Parm, Side, Signature, TypeExpr, TypeExprKind,
};
use crate::token::TokenKind;

/// The words that clauses start with.
const CLAUSES: [&str; 8] =
    ["exact", "bound", "lipschitz", "bounds", "material", "require", "intersect", "copies"];

/// The former name of the clause `intersect`.
const FORMER_INTERSECT: &str = "hits";

impl Parser<'_> {
    /// `(parameters) [-> type] clauses`
    pub(super) fn signature(&mut self, kind: DeclKind) -> Parsed<Signature> {
        let start = self.span();
        if self.kind() != TokenKind::OpenParen {
            let help: &[&str] = match kind {
                DeclKind::Fn => &["a function without parameters is written fn name() = ..."],
                DeclKind::Solid => &["a solid without parameters is written solid name() = ..."],
                DeclKind::Region => &["a region without parameters is written region name() = ..."],
                DeclKind::Shape => &["a shape without parameters is written shape name() = ..."],
            };
            return self.expected_with("`(` and the parameters", help);
        }
        let parms = self.bracketed("parameter", Self::parm, |_| None)?;
        let result = match self.eat(TokenKind::Arrow) {
            true => self.type_or_skip(&[TokenKind::Eq])?,
            false => None,
        };
        let mut clauses = Vec::new();
        while let Some(word) = self.clause_word() {
            let start = self.span();
            match self.clause(word, kind) {
                Ok(clause) => clauses.push(clause),
                Err(Failed) => drop(self.skip_to(start, &[TokenKind::Eq])?),
            }
        }
        Ok(Signature { parms, result, clauses, span: self.since(start) })
    }

    /// Takes the `=` before a body, or reports that it is missing.
    pub(super) fn body_follows(&mut self) -> Parsed<()> {
        if self.eat(TokenKind::Eq) {
            return Ok(());
        }
        if self.kind() == TokenKind::OpenBrace {
            let diagnostic =
                self.expectation("`=` before the body").help("write fn f(x) = { ... }");
            self.report(diagnostic);
            return Ok(());
        }
        if self.kind() == TokenKind::Colon {
            return self
                .expected_with("`=`", &["a result type is written with an arrow: -> number"]);
        }
        let help = "the clauses are exact, bound, lipschitz, bounds, material, intersect, copies and \
                    require";
        if self.kind() == TokenKind::Name && !self.at_new_item() {
            let word = self.slice(self.span());
            let message = format!("expected `=` or a clause, found `{word}`");
            return self.fail(Diagnostic::error(Code::EXPECTED, self.span(), message).help(help));
        }
        self.expected_with("`=` or a clause", &[help])
    }

    /// `NAME [: type [...]] [= default] [in range]`
    fn parm(&mut self) -> Parsed<Parm> {
        let start = self.span();
        let name = self.declared_name("a parameter's name")?;
        let ty = match self.eat(TokenKind::Colon) {
            true => self.type_or_skip(&[TokenKind::Comma, TokenKind::Eq, TokenKind::In])?,
            false => None,
        };
        let variadic = ty.is_some() && self.eat(TokenKind::Ellipsis);
        if self.kind() == TokenKind::Ellipsis {
            let message = "a parameter that takes any number of values needs a type";
            let diagnostic = Diagnostic::error(Code::EXPECTED, self.span(), message);
            return self.fail(diagnostic.help(format!("write {}: shape...", name.text)));
        }
        let default = if self.eat(TokenKind::Eq) {
            Some(self.expr_or_skip(&[TokenKind::Comma, TokenKind::In])?)
        } else {
            None
        };
        let range = if self.eat(TokenKind::In) {
            Some(self.expr_or_skip(&[TokenKind::Comma])?)
        } else {
            None
        };
        Ok(Parm { name, ty, variadic, default, range, span: self.since(start) })
    }

    /// Returns the first word of the clause that comes next, if there is one.
    fn clause_word(&mut self) -> Option<&'static str> {
        if self.at_word(FORMER_INTERSECT) {
            let message = format!("the clause `{FORMER_INTERSECT}` is called `intersect` now");
            let diagnostic = Diagnostic::error(Code::EXPECTED, self.span(), message);
            let span = self.span();
            let help = "write `intersect` and keep the rest of the clause";
            self.report(diagnostic.help(help).fix("write `intersect`", span, "intersect"));
            return Some("intersect");
        }
        CLAUSES.into_iter().find(|word| self.at_word(word))
    }

    fn clause(&mut self, word: &str, of: DeclKind) -> Parsed<Clause> {
        let start = self.span();
        if of == DeclKind::Fn && !matches!(word, "lipschitz" | "require") {
            let diagnostic = Diagnostic::error(
                Code::EXPECTED,
                start,
                format!("`{word}` is a clause of shapes, and this is a `fn`"),
            )
            .help("a `fn` may state `lipschitz` and `require`");
            self.report(diagnostic);
        }
        self.bump();
        let kind = match word {
            "exact" => {
                let side = self.side();
                ClauseKind::Exact(side, self.clause_condition()?)
            }
            "bound" => {
                let side = self.side();
                ClauseKind::Bound(side, self.clause_condition()?)
            }
            "lipschitz" => {
                let constant = self.expr()?;
                let everywhere = self.at_word("everywhere");
                if everywhere {
                    self.bump();
                }
                ClauseKind::Lipschitz(constant, everywhere)
            }
            "bounds" => ClauseKind::Bounds(self.expr()?),
            "material" => ClauseKind::Material(self.expr()?),
            "intersect" => ClauseKind::Intersect(self.expr()?),
            "copies" => ClauseKind::Copies,
            _ => self.requirement()?,
        };
        Ok(Clause { kind, span: self.since(start) })
    }

    fn side(&mut self) -> Option<Side> {
        let side = if self.at_word("outside") {
            Side::Outside
        } else if self.at_word("inside") {
            Side::Inside
        } else {
            return None;
        };
        self.bump();
        Some(side)
    }

    fn clause_condition(&mut self) -> Parsed<Option<Expr>> {
        if self.eat(TokenKind::If) { Ok(Some(self.expr()?)) } else { Ok(None) }
    }

    /// `condition, "message"`
    fn requirement(&mut self) -> Parsed<ClauseKind> {
        let condition = self.expr()?;
        if !self.eat(TokenKind::Comma) {
            return self.expected_with(
                "`,` and a message",
                &["a requirement says what is wrong: require r > 0, \"the radius is zero\""],
            );
        }
        Ok(ClauseKind::Require(condition, self.string("a message in quotes")?))
    }

    /// Parses a type. Returns `None` for an invalid one and skips it up to one of `stops`.
    pub(super) fn type_or_skip(&mut self, stops: &[TokenKind]) -> Parsed<Option<TypeExpr>> {
        let start = self.span();
        match self.type_expr() {
            Ok(ty) => Ok(Some(ty)),
            Err(Failed) => self.skip_to(start, stops).map(|_| None),
        }
    }

    /// Parses a type.
    pub(super) fn type_expr(&mut self) -> Parsed<TypeExpr> {
        let start = self.span();
        let kind = match self.kind() {
            TokenKind::Name | TokenKind::Solid | TokenKind::Region | TokenKind::Shape => {
                self.bump();
                TypeExprKind::Named(self.slice(start).to_owned())
            }
            TokenKind::OpenBracket => {
                let opener = self.open();
                let of = self.nested(start, Self::type_expr)?;
                self.close(opener, "the type of the elements")?;
                TypeExprKind::List(Box::new(of))
            }
            TokenKind::OpenParen => {
                TypeExprKind::Record(self.bracketed("field", Self::field_type, |_| None)?)
            }
            TokenKind::Fn => self.nested(start, Self::fn_type)?,
            _ => {
                return self
                    .expected_with("a type", &["types are words such as number, vec3 and solid"]);
            }
        };
        Ok(TypeExpr { kind, span: self.since(start) })
    }

    /// `name: type`
    fn field_type(&mut self) -> Parsed<FieldType> {
        let name = self.field_name()?;
        Ok(FieldType { name, ty: self.type_expr()? })
    }

    /// `fn(A, B) -> R`
    fn fn_type(&mut self) -> Parsed<TypeExprKind> {
        self.bump();
        if self.kind() != TokenKind::OpenParen {
            return self.expected("`(` and the types of the parameters");
        }
        let parameters = self.bracketed("type", Self::type_expr, |_| None)?;
        if !self.eat(TokenKind::Arrow) {
            return self.expected_with("`->` and the result's type", &["write fn(vec3) -> length"]);
        }
        let result = self.type_expr()?;
        Ok(TypeExprKind::Fn(parameters, Box::new(result)))
    }
}
