//! Parses primary expressions: literals, names, brackets, blocks, conditions, lambdas.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::group::Opener;
use super::{Failed, Parsed, Parser};
use crate::ast::{Comprehension, DeclKind, Element, Expr, ExprKind, Field, Let, Name};
use crate::literal;
use crate::token::TokenKind;

impl Parser<'_> {
    /// Parses an operand without its postfixes.
    pub(super) fn primary(&mut self) -> Parsed<Expr> {
        let begin = self.span();
        if self.kind() == TokenKind::Unknown {
            while self.eat(TokenKind::Unknown) {}
            if self.next().first || !self.kind().starts_primary() {
                return Ok(Expr { kind: ExprKind::Error, span: self.since(begin) });
            }
        }
        let start = self.span();
        let kind = match self.kind() {
            TokenKind::Number => self.literal(literal::number, |kind| kind),
            TokenKind::PointNumber => {
                let diagnostic = literal::bare_point(self.slice(start), start);
                self.report(diagnostic);
                self.bump();
                ExprKind::Error
            }
            TokenKind::Color => self.literal(literal::color, ExprKind::Color),
            TokenKind::Text => self.literal(literal::text, ExprKind::Text),
            TokenKind::True => self.word(ExprKind::Bool(true)),
            TokenKind::False => self.word(ExprKind::Bool(false)),
            TokenKind::Name => self.word(ExprKind::Name(self.slice(start).to_owned())),
            TokenKind::OpenParen => self.parenthesized()?,
            TokenKind::OpenBracket => self.list()?,
            TokenKind::OpenBrace => return self.block(),
            TokenKind::If => return self.condition(),
            TokenKind::Fn => self.lambda()?,
            _ => return self.expected_expression(),
        };
        Ok(Expr { kind, span: self.since(start) })
    }

    fn word(&mut self, kind: ExprKind) -> ExprKind {
        self.bump();
        kind
    }

    fn literal<T>(
        &mut self,
        read: impl Fn(&str, Span) -> literal::Checked<T>,
        make: impl Fn(T) -> ExprKind,
    ) -> ExprKind {
        let span = self.span();
        let (value, problem) = read(self.slice(span), span);
        self.bump();
        match problem {
            Some(problem) => {
                self.report(problem);
                ExprKind::Error
            }
            None => make(value),
        }
    }

    fn expected_expression(&mut self) -> Parsed<Expr> {
        let before = match self.previous() {
            Some(token) if token.kind.wants_operand() => self.slice(token.span(self.file)),
            Some(_) | None => "",
        };
        let context = if before.is_empty() { String::new() } else { format!(" after `{before}`") };
        let help: &[&str] = match self.kind() {
            TokenKind::For => &[
                "`for` stands in a list or among arguments: [for i in 0..3: i]",
                "of shapes: union(for i in 0..3: sphere(0.2).translate(x: i))",
            ],
            TokenKind::Let if !self.next().first => {
                &["`let` stands at top level, or in a block: { let a = 1; a + 1 }"]
            }
            TokenKind::Solid | TokenKind::Region | TokenKind::Shape | TokenKind::Param
                if !self.next().first =>
            {
                &["declarations stand at top level, each on a line of its own"]
            }
            TokenKind::Import if !self.next().first => &[
                "an import stands on a line of its own: import gear from \"gear.sdf\"",
                "it reads scenes; meshes cannot be imported",
            ],
            TokenKind::Eq if before == ".." => {
                &["a range is written without `=`. A loop leaves out its end: 1..13 counts to 12; \
                 the range of a param includes it"]
            }
            TokenKind::Else => &["`else` follows the `}` of an `if`"],
            TokenKind::Star if before == "*" => &["powers are written `pow(x, 2)`"],
            TokenKind::Greater if before == "=" => {
                &["a function without a name is written fn(x) = x"]
            }
            TokenKind::Greater if matches!(before, ">" | "|") => {
                &["an operator is called with a dot: a.translate(x: 1)"]
            }
            TokenKind::Eq if matches!(before, "+" | "-" | "*" | "/" | "%" | "|" | "&") => {
                &["values do not change; give the new one a name of its own: let b = a + 1"]
            }
            _ => &[],
        };
        self.expected_with(&format!("an expression{context}"), help)
    }

    /// Parses `(e)` or `(name: a, ...)`.
    fn parenthesized(&mut self) -> Parsed<ExprKind> {
        if self.at_record() {
            return Ok(ExprKind::Record(self.bracketed("field", Self::record_field, |_| None)?));
        }
        let opener = self.open();
        let depth = self.open.len();
        let inner = self.nested(opener.span, |parser| parser.expr_or_skip(&[]));
        self.open.truncate(depth);
        if self.kind() == TokenKind::Comma {
            self.unnamed_fields(opener)?;
        } else {
            self.close(opener, "an operator")?;
        }
        Ok(ExprKind::Paren(Box::new(inner?)))
    }

    /// Reports a bracket with several values without names, and skips the others.
    fn unnamed_fields(&mut self, opener: Opener) -> Parsed<()> {
        let message = "several values in `(...)` are the fields of a record, which need names";
        self.report(
            Diagnostic::error(Code::EXPECTED, self.span(), message)
                .help("write (first: ..., second: ...)")
                .help("a vector or a list is written [...]"),
        );
        let start = self.span();
        self.skip_to(start, &[])?;
        self.close(opener, "`,`")
    }

    /// Returns true if the bracket that comes next opens a record.
    fn at_record(&self) -> bool {
        let name = self.peek(1).kind;
        (name == TokenKind::Name || name.is_reserved()) && self.peek(2).kind == TokenKind::Colon
    }

    /// `name: value`
    fn record_field(&mut self) -> Parsed<Field> {
        let name = self.field_name()?;
        let value = self.expr_or_skip(&[TokenKind::Comma])?;
        Ok(Field { name, value })
    }

    /// Parses the name of a field and the colon behind it.
    pub(super) fn field_name(&mut self) -> Parsed<Name> {
        let name = self.name("a field's name")?;
        if self.eat(TokenKind::Colon) {
            return Ok(name);
        }
        let help = format!("each field of a record has a name: {}: ...", name.text);
        self.expected_with("`:`", &[&help])
    }

    /// `[a, b, for ...]`
    fn list(&mut self) -> Parsed<ExprKind> {
        let elements = self.bracketed("element", Self::element, |span| {
            Some(Element::Expr(Expr { kind: ExprKind::Error, span }))
        })?;
        Ok(ExprKind::List(elements))
    }

    /// Parses one value, or `for name in over [if condition]: element`.
    pub(super) fn element(&mut self) -> Parsed<Element> {
        if self.kind() != TokenKind::For {
            return Ok(Element::Expr(self.expr()?));
        }
        let start = self.span();
        self.nested(start, |parser| {
            parser.bump();
            let name = parser.declared_name("a name after `for`")?;
            if !parser.eat(TokenKind::In) {
                return parser.expected_with(
                    "`in` and a sequence",
                    &["for i in 0..3: ...", "for x in list: ..."],
                );
            }
            let over = parser.expr()?;
            let condition = if parser.eat(TokenKind::If) { Some(parser.expr()?) } else { None };
            if !parser.eat(TokenKind::Colon) {
                return parser.expected("`:` and what each one gives");
            }
            let body = parser.element()?;
            let span = parser.since(start);
            let comprehension = Comprehension { name, over, condition, body, span };
            Ok(Element::For(Box::new(comprehension)))
        })
    }

    /// `{ let a = 1; a }`
    fn block(&mut self) -> Parsed<Expr> {
        let opener = self.open();
        let depth = self.open.len();
        let contents = self.nested(opener.span, |parser| parser.block_contents());
        self.open.truncate(depth);
        let closed = self.close(opener, "the end of the line");
        let (lets, result) = contents?;
        closed?;
        let span = self.since(opener.span);
        Ok(Expr { kind: ExprKind::Block(lets, Box::new(result)), span })
    }

    fn block_contents(&mut self) -> Parsed<(Vec<Let>, Expr)> {
        let mut lets = Vec::new();
        let mut result: Option<Expr> = None;
        let reported = self.reported();
        let mut indented = false;
        loop {
            let at = self.at;
            if self.block_ends(indented) {
                break;
            }
            indented |= self.next().first && !self.in_first_column();
            if let Some(earlier) = &result
                && !matches!(earlier.kind, ExprKind::Error)
            {
                let span = earlier.span;
                self.report_second_value(span);
            }
            if self.kind() == TokenKind::Let {
                lets.extend(self.binding()?);
                result = result.filter(|value| matches!(value.kind, ExprKind::Error));
            } else if self.at_new_declaration() {
                self.misplaced_declaration()?;
            } else {
                result = Some(self.expr_or_skip(&[TokenKind::Semicolon])?);
            }
            self.end_of_line_in_block()?;
            if self.at == at {
                self.bump();
            }
        }
        match result {
            Some(result) => Ok((lets, result)),
            None => {
                let span = self.span();
                if self.kind() == TokenKind::CloseBrace && self.reported() == reported {
                    self.report_no_value();
                }
                Ok((lets, Expr { kind: ExprKind::Error, span }))
            }
        }
    }

    /// Returns true if the block's closing bracket comes next, or a declaration at the top level:
    /// one in the first column that cannot be in a block, or a `let` there after lines that were
    /// `indented`.
    fn block_ends(&self, indented: bool) -> bool {
        let at_top = self.at_new_declaration() && self.in_first_column();
        self.kind().is_closer()
            || self.kind() == TokenKind::Eof
            || (at_top && (indented || self.kind() != TokenKind::Let))
    }

    /// Reports a declaration in a block and parses it, to continue behind it.
    fn misplaced_declaration(&mut self) -> Parsed<()> {
        let word = self.slice(self.span());
        let diagnostic = Diagnostic::error(
            Code::EXPECTED,
            self.span(),
            format!("a `{word}` is declared at top level, not in a block"),
        );
        self.report(match self.kind() {
            TokenKind::Fn => diagnostic.help("in a block, write: let name = fn(...) = ..."),
            _ => {
                diagnostic.help("move it out of the block; what it needs it can take as parameters")
            }
        });
        let (start, in_shape) = (self.span(), self.in_shape);
        let read = self.declaration();
        self.in_shape = in_shape;
        if read.is_err() {
            self.skip_to(start, &[TokenKind::Semicolon])?;
        }
        Ok(())
    }

    fn end_of_line_in_block(&mut self) -> Parsed<()> {
        if self.eat(TokenKind::Semicolon) || self.at_end() {
            return Ok(());
        }
        let start = self.span();
        self.report_no_end();
        self.skip_to(start, &[TokenKind::Semicolon])?;
        self.eat(TokenKind::Semicolon);
        Ok(())
    }

    fn report_second_value(&mut self, first: Span) {
        let diagnostic =
            Diagnostic::error(Code::EXPECTED, first, "a block has one value, in its last line")
                .label("not the last line")
                .help("name this with `let`, or join it to the next line with an operator");
        self.report(diagnostic);
    }

    fn report_no_value(&mut self) {
        let diagnostic = Diagnostic::error(
            Code::EXPECTED,
            self.span(),
            "expected the block's value before `}`",
        )
        .help("a block ends with an expression: { let a = 1; a + 1 }")
        .help("a line that starts with an operator, `-` included, continues the line before it");
        self.report(diagnostic);
    }

    /// Parses `let name = value`. A value that cannot be parsed is `Error`. Returns `None` if the
    /// name is missing.
    pub(super) fn binding(&mut self) -> Parsed<Option<Let>> {
        let stops = &[TokenKind::Semicolon];
        let start = self.span();
        self.bump();
        let Ok(name) = self.declared_name("a name after `let`") else {
            self.skip_to(start, stops)?;
            return Ok(None);
        };
        let value = match self.equals(&name.text) {
            Ok(()) => self.expr_or_skip(stops)?,
            Err(Failed) => {
                let at = self.span();
                self.skip_to(at, stops)?
            }
        };
        Ok(Some(Let { name, value, span: self.since(start) }))
    }

    /// Takes the `=` after a `let` and a name, or suggests how to fix what is there instead.
    fn equals(&mut self, name: &str) -> Parsed<()> {
        let what = &format!("`=` and a value for `{name}`");
        match self.kind() {
            TokenKind::Eq => {
                self.bump();
                Ok(())
            }
            TokenKind::Colon => {
                self.expected_with(what, &["a `let` takes its type from its value"])
            }
            TokenKind::EqEq => self.expected_with(what, &["`==` compares; `=` gives a value"]),
            TokenKind::OpenParen => {
                let declared = format!(
                    "what takes arguments is declared by `fn`: fn {name}(size: length) = ..."
                );
                let formula = "a formula in the point `p` by `solid`, `region` or `shape`";
                self.expected_with(what, &[&declared, formula])
            }
            _ => self.expected(what),
        }
    }

    /// `if c { a } else if d { b } else { e }`
    fn condition(&mut self) -> Parsed<Expr> {
        let start = self.span();
        let mut branches = Vec::new();
        let mut last = loop {
            let if_span = self.span();
            self.bump();
            let condition = self.expr()?;
            let then = self.branch()?;
            branches.push((if_span, condition, then));
            if !self.eat(TokenKind::Else) {
                return self.expected_with(
                    "`else`",
                    &["an `if` gives a value, so it has both branches: if c { a } else { b }"],
                );
            }
            if self.kind() != TokenKind::If {
                break self.branch()?;
            }
        };
        let end = self.since(start);
        for (if_span, condition, then) in branches.into_iter().rev() {
            self.link(if_span)?;
            let kind = ExprKind::If(Box::new(condition), Box::new(then), Box::new(last));
            last = Expr { kind, span: if_span.to(end) };
        }
        Ok(last)
    }

    fn branch(&mut self) -> Parsed<Expr> {
        if self.kind() == TokenKind::OpenBrace {
            return self.block();
        }
        if let Some(hint) = self.operator_hint() {
            return self.expected_with("an operator or `{`", &[hint]);
        }
        self.expected_with("`{`", &["branches stand in braces: if c { a } else { b }"])
    }

    /// `fn(parameters) = body`
    fn lambda(&mut self) -> Parsed<ExprKind> {
        let start = self.span();
        self.nested(start, |parser| {
            parser.bump();
            if parser.kind() == TokenKind::Name {
                parser.report_named_lambda();
                parser.bump();
                if parser.kind() != TokenKind::OpenParen {
                    return Err(Failed);
                }
            }
            let signature = parser.signature(DeclKind::Fn)?;
            parser.body_follows()?;
            let body = parser.expr()?;
            Ok(ExprKind::Lambda(Box::new(signature), Box::new(body)))
        })
    }

    /// Reports a name behind a `fn` inside of an expression.
    fn report_named_lambda(&mut self) {
        let name = self.slice(self.span());
        let diagnostic = if self.peek(1).kind == TokenKind::OpenParen {
            let message = "a `fn` in an expression has no name";
            Diagnostic::error(Code::EXPECTED, self.span(), message)
                .help(format!("write: let {name} = fn(...) = ..."))
        } else {
            let message = "the parameters of a `fn` stand in brackets";
            Diagnostic::error(Code::EXPECTED, self.span(), message)
                .help(format!("write: fn({name}) = ..."))
        };
        self.report(diagnostic);
    }
}
