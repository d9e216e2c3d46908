//! Formulas of `p` at the top level, where a shape is expected: what shaders and other tools start
//! with.

use sdfc_syntax::ast::{BinaryOp, Element, Expr, ExprKind as Ast, UnaryOp};

use super::Checker;
use super::names::Found;

impl Checker<'_> {
    /// True if an expression computes a number from `p` by operators and functions of the language
    /// alone.
    pub(super) fn is_formula_of_point(&mut self, e: &Expr) -> bool {
        self.look_up("p").is_none() && self.uses_point(e) == Some(true)
    }

    /// Whether such an expression mentions `p`; `None` for any other expression.
    fn uses_point(&mut self, e: &Expr) -> Option<bool> {
        match &e.kind {
            Ast::Number { .. } => Some(false),
            Ast::Name(name) => Some(name == "p"),
            Ast::Paren(inner) | Ast::Field(inner, _) | Ast::Unary(UnaryOp::Neg, inner) => {
                self.uses_point(inner)
            }
            Ast::Binary(
                BinaryOp::Mul | BinaryOp::Div | BinaryOp::Rem | BinaryOp::Add | BinaryOp::Sub,
                _,
                a,
                b,
            ) => Some(self.uses_point(a)? | self.uses_point(b)?),
            Ast::List(elements) => self.any_uses_point(elements.iter()),
            Ast::Call(callee, args) => {
                let Ast::Name(name) = &callee.kind else { return None };
                let is_function = matches!(self.look_up(name), Some(Found::Builtin(_)));
                if !is_function {
                    return None;
                }
                self.any_uses_point(args.iter().map(|arg| &arg.value))
            }
            Ast::Color(_)
            | Ast::Text(_)
            | Ast::Bool(_)
            | Ast::Block(..)
            | Ast::If(..)
            | Ast::Lambda(..)
            | Ast::Record(_)
            | Ast::Index(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Error => None,
        }
    }

    fn any_uses_point<'e>(
        &mut self,
        mut elements: impl Iterator<Item = &'e Element>,
    ) -> Option<bool> {
        elements.try_fold(false, |uses, element| match element {
            Element::Expr(e) => Some(self.uses_point(e)? | uses),
            Element::For(_) => None,
        })
    }
}
