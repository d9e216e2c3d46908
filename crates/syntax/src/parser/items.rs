//! An item at the top level.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::{Failed, Parsed, Parser};
use crate::ast::{
    Decl, DeclKind, Docs, Expr, ExprKind, File, Import, Item, Name, Param, Signature,
};
use crate::literal;
use crate::token::TokenKind;

impl Parser<'_> {
    /// Parses the whole file.
    pub(super) fn file(&mut self) -> File {
        let mut items = Vec::new();
        while self.kind() != TokenKind::Eof {
            let at = self.at;
            self.open.clear();
            self.height = 0;
            self.in_shape = false;
            match self.item() {
                Ok(item) => items.extend(item),
                Err(Failed) => self.skip_item(at),
            }
            self.abandoned = false;
            if self.at == at {
                self.bump();
            }
        }
        File { items }
    }

    /// Parses an item and its end. Returns `None` for an item that was skipped after an error.
    fn item(&mut self) -> Parsed<Option<Item>> {
        let item = match self.kind() {
            TokenKind::Let => self.binding()?.map(Item::Let),
            TokenKind::Fn if self.peek(1).kind == TokenKind::OpenParen => self.drawn()?,
            kind if kind.declares() => self.declaration()?,
            kind if kind.is_closer() => return Ok(self.stray_closer()),
            _ => self.drawn()?,
        };
        self.end_of_item();
        Ok(item)
    }

    /// A solid to draw, or a setting.
    fn drawn(&mut self) -> Parsed<Option<Item>> {
        Ok(Some(Item::Expr(self.expr()?)))
    }

    /// Parses an item that starts with a reserved word other than `let`.
    pub(super) fn declaration(&mut self) -> Parsed<Option<Item>> {
        match self.kind() {
            TokenKind::Import => self.import().map(Item::Import).map(Some),
            TokenKind::Param => self.param().map(Item::Param).map(Some),
            TokenKind::Solid => self.decl(DeclKind::Solid),
            TokenKind::Region => self.decl(DeclKind::Region),
            TokenKind::Shape => self.decl(DeclKind::Shape),
            _ => self.decl(DeclKind::Fn),
        }
    }

    /// Skips to the line that begins the next item.
    fn skip_item(&mut self, at: usize) {
        if self.at == at {
            self.bump();
        }
        while self.kind() != TokenKind::Eof && !self.at_new_item() {
            if self.eat(TokenKind::Semicolon) {
                return;
            }
            self.bump();
        }
    }

    /// Takes the end of an item, or reports and skips the rest of its line.
    fn end_of_item(&mut self) {
        if self.eat(TokenKind::Semicolon) || self.next().first {
            return;
        }
        if self.kind().is_closer() {
            return;
        }
        self.report_no_end();
        self.skip_item(self.at);
    }

    /// Reports a closing bracket without an opening one.
    fn stray_closer(&mut self) -> Option<Item> {
        let closer = self.kind();
        if !self.was_missing(closer) {
            let message = format!("this `{}` closes nothing", self.slice(self.span()));
            let diagnostic = Diagnostic::error(Code::EXPECTED, self.span(), message)
                .help("remove it, or open the bracket that it should close");
            self.report(diagnostic);
        }
        self.bump();
        self.end_after_stray();
        None
    }

    /// Skips the rest of the line behind a stray closing bracket, which belonged inside the
    /// brackets.
    fn end_after_stray(&mut self) {
        while !self.next().first && !self.kind().is_closer() {
            self.bump();
        }
    }

    /// `import a, b as c from "path"`
    fn import(&mut self) -> Parsed<Import> {
        let start = self.span();
        self.bump();
        let mut names = Vec::new();
        loop {
            if self.kind() == TokenKind::Text {
                return self.import_without_names();
            }
            let name = self.name("a name to import")?;
            let renamed = if self.at_word("as") {
                self.bump();
                Some(self.name("a new name after `as`")?)
            } else {
                None
            };
            names.push((name, renamed));
            if !self.eat(TokenKind::Comma) {
                break;
            }
        }
        if !self.at_word("from") {
            return self.expected_with(
                "`from` and a path",
                &["an import is written: import spur, rack as bar from \"parts/gear.sdf\""],
            );
        }
        self.bump();
        let path = self.string("a path in quotes")?;
        Ok(Import { names, path, span: self.since(start) })
    }

    /// Reports `import "path"`, which imports everything in other languages.
    fn import_without_names<T>(&mut self) -> Parsed<T> {
        let path = self.slice(self.span()).to_owned();
        let help = format!("name what you use of the file: import spur, rack as bar from {path}");
        self.expected_with("a name to import", &[&help])
    }

    /// A string, unescaped.
    pub(super) fn string(&mut self, what: &str) -> Parsed<Name> {
        let span = self.span();
        if self.kind() != TokenKind::Text {
            return self.expected(what);
        }
        let (text, problem) = literal::text(self.slice(span), span);
        if let Some(problem) = problem {
            self.report(problem);
        }
        self.bump();
        Ok(Name { text, span })
    }

    /// `param NAME [: type] = default [in range]`
    fn param(&mut self) -> Parsed<Param> {
        let docs = self.docs();
        let start = self.span();
        self.bump();
        let name = self.declared_name("a name after `param`")?;
        let ty = match self.eat(TokenKind::Colon) {
            true => self.type_or_skip(&[TokenKind::Eq])?,
            false => None,
        };
        let default = match self.eat(TokenKind::Eq) {
            true => self.expr_or_skip(&[TokenKind::In, TokenKind::Semicolon])?,
            false => {
                let what = format!("`=` and a default for `{}`", name.text);
                let _reported: Parsed<()> = self.expected_with(
                    &what,
                    &["param r = 1 in 0..2; without `in`, any value is allowed"],
                );
                let at = self.span();
                self.skip_to(at, &[TokenKind::In, TokenKind::Semicolon])?
            }
        };
        let range = match self.eat(TokenKind::In) {
            true => Some(self.expr_or_skip(&[TokenKind::Semicolon])?),
            false => None,
        };
        Ok(Param { docs, name, ty, default, range, span: self.since(start) })
    }

    /// Parses `fn`, `solid`, `region` or `shape` with a name, a signature and a body. An error
    /// behind the name leaves the name known.
    fn decl(&mut self, kind: DeclKind) -> Parsed<Option<Item>> {
        let docs = self.docs();
        let start = self.span();
        let word = self.slice(start);
        self.bump();
        let name = self.declared_name(&format!("a name after `{word}`"))?;
        self.in_shape = kind != DeclKind::Fn;
        let start_of_rest = self.span();
        let (signature, body) = match self.signature(kind) {
            Ok(signature) => (signature, self.body(&name)?),
            Err(Failed) => {
                let (parms, result, clauses) = (Vec::new(), None, Vec::new());
                let signature = Signature { parms, result, clauses, span: start_of_rest };
                (signature, self.late_body(start_of_rest)?)
            }
        };
        let span = self.since(start);
        Ok(Some(Item::Decl(Box::new(Decl { docs, kind, name, signature, body, span }))))
    }

    fn body(&mut self, name: &Name) -> Parsed<Expr> {
        let start = self.span();
        match self.body_follows() {
            Ok(()) if self.at_new_declaration() || self.kind() == TokenKind::Eof => {
                let what = format!("the formula of `{}` after `=`", name.text);
                let help = "put a formula of several lines in braces: = { ... }";
                let _reported: Parsed<()> = self.expected_with(&what, &[help]);
                Ok(Expr { kind: ExprKind::Error, span: self.since(start) })
            }
            Ok(()) => self.expr_or_skip(&[TokenKind::Semicolon]),
            Err(Failed) => self.late_body(start),
        }
    }

    /// Parses the body after an error in the signature, if the body begins a line with `=`.
    fn late_body(&mut self, start: Span) -> Parsed<Expr> {
        let skipped = self.skip_to(start, &[TokenKind::Semicolon])?;
        if !self.at_new_body() {
            return Ok(skipped);
        }
        self.bump();
        self.expr_or_skip(&[TokenKind::Semicolon])
    }

    /// Returns the `///` lines right above the next token, without plain comments among them.
    fn docs(&self) -> Docs {
        let mut below = self.next().start;
        let before = self.comments.partition_point(|comment| comment.tokens_before <= self.at);
        let mut lines = Vec::new();
        for comment in self.comments[..before].iter().rev() {
            let between = &self.text[comment.end as usize..below as usize];
            let own_line = self.text[..comment.start as usize]
                .rsplit('\n')
                .next()
                .is_some_and(|line| line.trim_matches(['\u{feff}', ' ', '\t']).is_empty());
            if comment.tokens_before < self.at || !own_line || between.matches('\n').count() != 1 {
                break;
            }
            lines.extend(comment.doc(self.text).map(str::to_owned));
            below = comment.start;
        }
        lines.reverse();
        Docs { lines }
    }

    /// Parses a name. A reserved word in its place is reported and taken.
    pub(super) fn name(&mut self, what: &str) -> Parsed<Name> {
        let span = self.span();
        let next = self.next();
        let text = self.slice(span).to_owned();
        if next.kind == TokenKind::Name {
            self.bump();
            return Ok(Name { text, span });
        }
        if !next.kind.is_reserved() || (next.first && next.kind.declares()) {
            return self.expected(what);
        }
        self.report(reserved(&text, span));
        self.bump();
        Ok(Name { text, span })
    }

    /// Parses the name of a declaration, which must not be `p` in a shape.
    pub(super) fn declared_name(&mut self, what: &str) -> Parsed<Name> {
        let name = self.name(what)?;
        if self.in_shape && name.text == "p" {
            let diagnostic = Diagnostic::error(
                Code::RESERVED,
                name.span,
                "`p` is the point here and cannot be declared",
            )
            .help("choose another name: `q` is usual for a moved point");
            self.report(diagnostic);
        }
        Ok(name)
    }
}

fn reserved(word: &str, span: Span) -> Diagnostic {
    Diagnostic::error(Code::RESERVED, span, format!("`{word}` is a reserved word, not a name"))
        .help(format!("choose another name, `{word}_` for example"))
        .fix(format!("rename to `{word}_`"), span, format!("{word}_"))
}
