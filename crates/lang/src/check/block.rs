//! Blocks: `{ let a = ...; result }`.

use sdfc_diagnostics::Span;
use sdfc_syntax::ast;

use super::Checker;
use crate::hir::{Expr, ExprKind};

impl<'a> Checker<'a> {
    /// Checks a block without an expected type.
    pub(super) fn infer_block(
        &mut self,
        lets: &'a [ast::Let],
        result: &'a ast::Expr,
        span: Span,
    ) -> Expr {
        self.block(lets, span, |checker| checker.infer(result))
    }

    /// Checks a block; `result` is called with the block's variables in scope.
    pub(super) fn block(
        &mut self,
        lets: &'a [ast::Let],
        span: Span,
        result: impl FnOnce(&mut Self) -> Expr,
    ) -> Expr {
        if lets.is_empty() {
            return result(self);
        }
        let mark = self.body.enter();
        let mut values = Vec::with_capacity(lets.len());
        for item in lets {
            let name = &item.name;
            let value = self.infer(&item.value);
            self.note_variable(name.span, &value.ty);
            let local = self.body.declare(&name.text, value.ty.clone(), name.span);
            values.push((local, name.text.clone(), value));
        }
        let result = result(self);
        self.leave_block(mark);
        let ty = result.ty.clone();
        Expr { kind: ExprKind::Block(values, Box::new(result)), ty, span }
    }
}
