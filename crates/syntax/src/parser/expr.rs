//! Parses operators: infix by precedence, prefix and postfix.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::{Parsed, Parser};
use crate::ast::{Arg, BinaryOp, Element, Expr, ExprKind, Name, UnaryOp};
use crate::literal;
use crate::token::TokenKind;

/// The precedence levels of infix operators, lowest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Or,
    And,
    Compare,
    Range,
    Sum,
    Product,
    Prefix,
}

impl Level {
    /// Returns the level of the right operand. All operators associate to the left.
    fn tighter(self) -> Level {
        match self {
            Level::Or => Level::And,
            Level::And => Level::Compare,
            Level::Compare => Level::Range,
            Level::Range => Level::Sum,
            Level::Sum => Level::Product,
            Level::Product | Level::Prefix => Level::Prefix,
        }
    }

    /// Returns why operators of this level cannot be chained, or `None` if they can.
    fn does_not_chain(self) -> Option<&'static str> {
        match self {
            Level::Compare => Some("comparisons do not chain"),
            Level::Range => Some("a range has two ends"),
            Level::Or | Level::And | Level::Sum | Level::Product | Level::Prefix => None,
        }
    }
}

/// The infix operators.
const INFIX: &[(TokenKind, BinaryOp, Level)] = &[
    (TokenKind::OrOr, BinaryOp::Or, Level::Or),
    (TokenKind::AndAnd, BinaryOp::And, Level::And),
    (TokenKind::EqEq, BinaryOp::Eq, Level::Compare),
    (TokenKind::NotEq, BinaryOp::Ne, Level::Compare),
    (TokenKind::Less, BinaryOp::Lt, Level::Compare),
    (TokenKind::LessEq, BinaryOp::Le, Level::Compare),
    (TokenKind::Greater, BinaryOp::Gt, Level::Compare),
    (TokenKind::GreaterEq, BinaryOp::Ge, Level::Compare),
    (TokenKind::DotDot, BinaryOp::Range, Level::Range),
    (TokenKind::Plus, BinaryOp::Add, Level::Sum),
    (TokenKind::Minus, BinaryOp::Sub, Level::Sum),
    (TokenKind::Or, BinaryOp::Union, Level::Sum),
    (TokenKind::And, BinaryOp::Intersect, Level::Sum),
    (TokenKind::Star, BinaryOp::Mul, Level::Product),
    (TokenKind::Slash, BinaryOp::Div, Level::Product),
    (TokenKind::Percent, BinaryOp::Rem, Level::Product),
];

impl Parser<'_> {
    /// Parses an expression.
    pub(super) fn expr(&mut self) -> Parsed<Expr> {
        self.binary(Level::Or)
    }

    /// Returns the infix operator that comes next, with its level.
    fn infix(&self) -> Option<(BinaryOp, Level)> {
        let kind = self.kind();
        INFIX.iter().find(|row| row.0 == kind).map(|&(_, op, level)| (op, level))
    }

    /// Parses operands joined by operators of this level or a higher one.
    fn binary(&mut self, loosest: Level) -> Parsed<Expr> {
        self.measured(|parser| {
            let mut left = parser.prefix()?;
            let mut unchained = None;
            while let Some((op, level)) = parser.infix().filter(|&(_, level)| level >= loosest) {
                let op_span = parser.span();
                parser.bump();
                let right = parser.binary(level.tighter())?;
                parser.link(op_span)?;
                let span = left.span.to(right.span);
                if op == BinaryOp::Intersect {
                    parser.refuse_mixture(op_span, &left, &right);
                }
                let kind = match level.does_not_chain() {
                    Some(why) if unchained == Some(level) => {
                        parser.report_chain(why, op_span, &left, &right);
                        ExprKind::Error
                    }
                    Some(_) | None => {
                        ExprKind::Binary(op, op_span, Box::new(left), Box::new(right))
                    }
                };
                left = Expr { kind, span };
                unchained = Some(level);
            }
            Ok(left)
        })
    }

    /// Reports `a | b & c`: operators go from left to right here, but most languages bind `&`
    /// tighter.
    fn refuse_mixture(&mut self, op_span: Span, left: &Expr, right: &Expr) {
        let ExprKind::Binary(BinaryOp::Union, _, first, middle) = &left.kind else { return };
        let message = "`|` and then `&` need brackets";
        let mut diagnostic = Diagnostic::error(Code::DOES_NOT_CHAIN, op_span, message);
        let [a, b, c] = [first.span, middle.span, right.span].map(|span| self.slice(span));
        if a.len() + b.len() + c.len() < 60 {
            diagnostic = diagnostic.help(format!("write {a} | ({b} & {c}), or ({a} | {b}) & {c}"));
        } else {
            diagnostic = diagnostic.help("write a | (b & c), or (a | b) & c");
        }
        self.report(diagnostic);
    }

    /// Reports the second of two operators that do not chain.
    fn report_chain(&mut self, why: &str, op_span: Span, left: &Expr, right: &Expr) {
        let mut diagnostic = Diagnostic::error(Code::DOES_NOT_CHAIN, op_span, why);
        if let ExprKind::Binary(op, _, _, middle) = &left.kind
            && *op != BinaryOp::Range
        {
            let [left, middle, operator, right] =
                [left.span, middle.span, op_span, right.span].map(|span| self.slice(span));
            let is_import = |word| left.strip_prefix(word).is_some_and(|at| at.starts_with(" <"));
            if is_import("include") || is_import("use") {
                // An import of OpenSCAD: `include <file.scad>`.
                diagnostic = diagnostic.help("write `import name from \"file.sdf\"`");
            } else if left.len() + middle.len() + right.len() < 60 {
                diagnostic =
                    diagnostic.help(format!("write {left} && {middle} {operator} {right}"));
            }
        }
        self.report(diagnostic);
    }

    /// Parses an operand with its prefixes `-` and `!`.
    fn prefix(&mut self) -> Parsed<Expr> {
        let mut operators = Vec::new();
        loop {
            let op = match self.kind() {
                TokenKind::Minus => UnaryOp::Neg,
                TokenKind::Not => UnaryOp::Not,
                _ => break,
            };
            operators.push((op, self.span()));
            self.bump();
        }
        let mut operand = self.postfix()?;
        for (op, op_span) in operators.into_iter().rev() {
            self.link(op_span)?;
            let span = op_span.to(operand.span);
            operand = Expr { kind: ExprKind::Unary(op, Box::new(operand)), span };
        }
        Ok(operand)
    }

    /// Parses an operand with its calls, fields and indices.
    fn postfix(&mut self) -> Parsed<Expr> {
        let start = self.span();
        let mut base = self.primary()?;
        loop {
            let next = self.next();
            let op_span = self.span();
            let kind = match next.kind {
                TokenKind::Dot => {
                    let name = self.field(&base)?;
                    ExprKind::Field(Box::new(base), name)
                }
                TokenKind::OpenParen if !next.first => {
                    let args = self.arguments()?;
                    ExprKind::Call(Box::new(base), args)
                }
                TokenKind::OpenBracket if !next.first => {
                    let index = self.index(&base)?;
                    ExprKind::Index(Box::new(base), Box::new(index))
                }
                TokenKind::PointNumber if !next.first => return self.glued_number(&base),
                _ => return Ok(base),
            };
            self.link(op_span)?;
            base = Expr { kind, span: self.since(start) };
        }
    }

    /// Parses `.name`.
    fn field(&mut self, base: &Expr) -> Parsed<Name> {
        let point = self.span();
        self.bump();
        let number = matches!(base.kind, ExprKind::Number { .. });
        let next = self.next();
        if number && base.span.end == point.start && (next.kind != TokenKind::Name || next.first) {
            let written = format!("{}.", self.slice(base.span));
            return self.fail(literal::bare_point(&written, base.span.to(point)));
        }
        self.name("a name after `.`")
    }

    /// Reports `a.5`, which is neither a field nor a number.
    fn glued_number(&mut self, base: &Expr) -> Parsed<Expr> {
        let number = matches!(base.kind, ExprKind::Number { .. });
        let written = self.slice(self.span());
        if number || base.span.end != self.next().start {
            return self.fail(literal::bare_point(written, self.span()));
        }
        let diagnostic =
            Diagnostic::error(Code::EXPECTED, self.span(), "expected a name after `.`")
                .help(format!("parts of a list or vector are written [{}]", &written[1..]));
        self.fail(diagnostic)
    }

    /// Parses `[index]`.
    fn index(&mut self, base: &Expr) -> Parsed<Expr> {
        let opener = self.open();
        let depth = self.open.len();
        let index = self.nested(opener.span, |parser| parser.expr_or_skip(&[]));
        self.open.truncate(depth);
        if self.kind() == TokenKind::Comma {
            let base = self.slice(base.span);
            let call = format!("the arguments of a call stand in round brackets: {base}(...)");
            let nested = format!("an element of a list of lists is {base}[i][j]");
            return self.expected_with("an operator or `]`", &[&call, &nested]);
        }
        self.close(opener, "an operator")?;
        index
    }

    /// Parses `(arguments)`.
    fn arguments(&mut self) -> Parsed<Vec<Arg>> {
        self.bracketed("argument", Self::argument, |span| {
            let value = Element::Expr(Expr { kind: ExprKind::Error, span });
            Some(Arg { name: None, value })
        })
    }

    fn argument(&mut self) -> Parsed<Arg> {
        let named = self.peek(1).kind == TokenKind::Colon
            && (self.kind() == TokenKind::Name || self.kind().is_reserved());
        if !named {
            let arg = Arg { name: None, value: self.element()? };
            self.refuse_equals(&arg)?;
            return Ok(arg);
        }
        let name = self.name("an argument")?;
        self.bump();
        if self.kind() == TokenKind::For {
            return self.expected_with(
                "one value for a named argument",
                &["put a sequence in brackets: [for ...]"],
            );
        }
        let value = Element::Expr(self.expr_or_skip(&[TokenKind::Comma])?);
        Ok(Arg { name: Some(name), value })
    }

    /// Reports an argument written with `=`, as in `f(x = 1)`.
    fn refuse_equals(&mut self, arg: &Arg) -> Parsed<()> {
        let Element::Expr(Expr { kind: ExprKind::Name(name), .. }) = &arg.value else {
            return Ok(());
        };
        if self.kind() != TokenKind::Eq {
            return Ok(());
        }
        let equals = self.span();
        let diagnostic =
            Diagnostic::error(Code::EXPECTED, equals, "expected `,` or `)`, found `=`")
                .help(format!("a named argument is written with a colon: {name}: ..."))
                .help("equality is written `==`")
                .fix("name the argument with a colon", equals, ":")
                .fix("compare with `==`", equals, "==");
        self.fail(diagnostic)
    }
}
