//! Gives a part of the code a name: a number becomes a param, an expression a `let`.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_lang::hir::Type;
use sdfc_lang::uses::Target;
use sdfc_syntax::ast::{BinaryOp, Expr, ExprKind, Item, Parm, TypeExprKind, UnaryOp, Unit};

use super::change::{Change, declare_before, free_name};
use crate::analysis::{Analysis, Referent};
use crate::edit::range;
use crate::tree::{Node, path};

/// Returns the change that makes the selected number a param, with a range around its value.
/// Numbers of signatures, settings, sequences and indices are left out, because many of them have
/// to be known when the scene compiles. The range is a guess.
pub fn to_param(analysis: &Analysis, selected: &Range<usize>) -> Option<Change> {
    let nodes = path(&analysis.tree, selected.start);
    let number = nodes.last().copied().and_then(Node::expr)?;
    let ExprKind::Number { value, unit, .. } = number.kind else { return None };
    let is_fixed = nodes.iter().any(|it| fixes(*it, number) || is_setting(analysis, *it));
    if selected.end > number.span.end as usize || is_fixed {
        return None;
    }
    let (wanted, parm) = parameter(analysis, number.span).unwrap_or(("value", None));
    let name = free_name(analysis, wanted);
    let ty = match parm.and_then(|parm| parm.ty.as_ref()).map(|ty| &ty.kind) {
        Some(TypeExprKind::Named(word)) if word == "int" || word == "length" => format!(": {word}"),
        Some(
            TypeExprKind::Named(_)
            | TypeExprKind::List(_)
            | TypeExprKind::Fn(..)
            | TypeExprKind::Record(_),
        )
        | None => String::new(),
    };
    let allowed = parm.and_then(|parm| limits(parm.range.as_ref()?)).unwrap_or(UNLIMITED);
    let around = values_around(value, unit, allowed, ty == ": int");
    let declaration = format!("param {name}{ty} = {} in {around}", analysis.slice(number.span));
    let declared = declare_before(analysis, nodes.first()?.span(), &declaration);
    Some((format!("make it the param `{name}`"), vec![declared, (number.span, name)]))
}

/// True if a node is the call of a setting.
fn is_setting(analysis: &Analysis, node: Node<'_>) -> bool {
    node.expr().is_some_and(|e| {
        let ExprKind::Call(callee, _) = &e.kind else { return false };
        matches!(analysis.uses.targets.get(&callee.span), Some(Target::Setting(_)))
    })
}

/// True if a node around a number needs it when the scene compiles, or is a param.
fn fixes(node: Node<'_>, number: &Expr) -> bool {
    match node {
        Node::Item(Item::Import(_) | Item::Param(_)) | Node::Signature(_) => true,
        Node::For(it) => it.over.span.contains(number.span),
        Node::Expr(e) => match &e.kind {
            ExprKind::Index(_, index) => index.span.contains(number.span),
            ExprKind::Number { .. }
            | ExprKind::Color(_)
            | ExprKind::Text(_)
            | ExprKind::Bool(_)
            | ExprKind::Name(_)
            | ExprKind::Paren(_)
            | ExprKind::Block(..)
            | ExprKind::If(..)
            | ExprKind::Lambda(..)
            | ExprKind::List(_)
            | ExprKind::Record(_)
            | ExprKind::Call(..)
            | ExprKind::Field(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Error => false,
        },
        Node::Item(Item::Decl(_) | Item::Let(_) | Item::Expr(_))
        | Node::Parm(_)
        | Node::Clause(_)
        | Node::Type(_)
        | Node::Let(_)
        | Node::Arg(_) => false,
    }
}

/// The name of the parameter that an argument is for, and its declaration unless it is one of the
/// kernel.
fn parameter(analysis: &Analysis, argument: Span) -> Option<(&str, Option<&Parm>)> {
    let mut found = analysis.uses.calls.iter().filter_map(|(callee, call)| {
        let given = call.arguments.iter().find(|it| it.value == argument)?;
        Some((callee, call.parameters.get(given.parameter)?, given.parameter))
    });
    let (callee, name, at) = found.next()?;
    let Some(Target::Declared(declared)) = analysis.uses.targets.get(callee) else {
        return Some((name, None));
    };
    let decl = analysis.declaration(*declared);
    Some((name, decl.and_then(|decl| decl.signature.parms.get(at))))
}

const UNLIMITED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// The ends of a range that is written with plain numbers and `inf`.
fn limits(range: &Expr) -> Option<[f64; 2]> {
    let ExprKind::Binary(BinaryOp::Range, _, lo, hi) = &range.kind else { return None };
    Some([limit(lo)?, limit(hi)?])
}

fn limit(e: &Expr) -> Option<f64> {
    if let ExprKind::Unary(UnaryOp::Neg, of) = &e.kind {
        return limit(of).map(|value| -value);
    }
    if let ExprKind::Number { value, unit: None, .. } = &e.kind {
        return Some(*value);
    }
    matches!(&e.kind, ExprKind::Name(name) if name == "inf").then_some(f64::INFINITY)
}

/// A range of values for a slider, with the value in it. Around a number other than 0 it leaves out
/// 0, which few parameters can be.
fn values_around(value: f64, unit: Option<Unit>, [lo, hi]: [f64; 2], is_int: bool) -> String {
    let (suffix, turn) = match unit {
        None if value > 0.0 => {
            let half = if is_int { (value / 2.0).floor().max(1.0) } else { value / 2.0 };
            return format!("{}..{}", half.max(lo), (2.0 * value).min(hi));
        }
        None => return format!("{}..{}", lo.max(-1.0), hi.min(1.0)),
        Some(Unit::Deg) => ("deg", 180.0),
        Some(Unit::Turn) => ("turn", 0.5),
        Some(Unit::Rad) => ("rad", 3.2),
    };
    let end = if value > turn { 2.0 * value } else { turn };
    format!("-{end}{suffix}..{end}{suffix}")
}

/// Returns the change that gives the selected expression a name, before the innermost statement
/// where all that it uses is known.
pub fn to_let(analysis: &Analysis, selected: &Range<usize>) -> Option<Change> {
    let text = analysis.text().get(selected.clone())?;
    let start = selected.start + text.len() - text.trim_start().len();
    let wanted = start..start + text.trim().len();
    let nodes = path(&analysis.tree, start);
    let is_wanted = |node: &Node| node.expr().is_some_and(|e| range(e.span) == wanted);
    let at = nodes.iter().position(is_wanted)?;
    let (around, e) = (&nodes[..at], nodes[at].expr()?);
    let is_callee = around.last().and_then(|it| it.expr()).is_some_and(
        |outer| matches!(&outer.kind, ExprKind::Call(callee, _) if callee.span == e.span),
    );
    let has_name = matches!(e.kind, ExprKind::Name(_) | ExprKind::Block(..) | ExprKind::Lambda(..));
    // A setting has no type.
    let ty = analysis.uses.types.get(&e.span)?;
    if is_callee || has_name {
        return None;
    }
    let statements = around.iter().enumerate().rev();
    let statements = statements.filter_map(|(at, node)| statement(*node, nodes.get(at + 1)));
    let mut known = statements.filter(|it| knows(analysis, *it, e.span));
    let (statement, _) = known.next()?;
    let is_shape = matches!(ty, Type::Shape(_));
    let name = free_name(analysis, if is_shape { "part" } else { "value" });
    let declaration = format!("let {name} = {}", analysis.slice(e.span));
    let declared = declare_before(analysis, statement, &declaration);
    Some((format!("give it the name `{name}`"), vec![declared, (e.span, name)]))
}

/// The span of the statement that a node begins or that its child is, and true if it is an item. A
/// `let` can stand before a statement.
fn statement(node: Node<'_>, child: Option<&Node<'_>>) -> Option<(Span, bool)> {
    match node {
        Node::Item(Item::Decl(_) | Item::Let(_) | Item::Expr(_)) => Some((node.span(), true)),
        Node::Let(it) => Some((it.span, false)),
        Node::Expr(e) => {
            let ExprKind::Block(_, result) = &e.kind else { return None };
            let is_result = child.is_some_and(|child| child.span() == result.span);
            is_result.then_some((result.span, false))
        }
        Node::Item(Item::Import(_) | Item::Param(_))
        | Node::Signature(_)
        | Node::Parm(_)
        | Node::Clause(_)
        | Node::Type(_)
        | Node::Arg(_)
        | Node::For(_) => None,
    }
}

/// True if all names of an expression are known before the statement around it.
fn knows(analysis: &Analysis, (statement, is_item): (Span, bool), e: Span) -> bool {
    let mut names = analysis.occurrences().iter().filter(|it| e.contains(it.span));
    names.all(|it| match &it.referent {
        Referent::Declared(name) => !statement.contains(*name) || e.contains(*name),
        Referent::Implicit => !is_item,
        Referent::Kernel(_)
        | Referent::Setting(_)
        | Referent::Parameter(..)
        | Referent::Type(_) => true,
    })
}
