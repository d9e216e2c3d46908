//! Short expressions as source, for messages.

use sdfc_syntax::ast::{Arg, Element, Expr, ExprKind, UnaryOp, Unit};

/// Length of the longest source that is shown.
const LONGEST: usize = 40;
/// Depth of the deepest expression that is shown.
const DEEPEST: usize = 3;

/// The expression on one line; `...` if it is long or does not consist of literals, names and
/// calls.
pub(super) fn written(expr: &Expr) -> String {
    let text = text(expr, DEEPEST).filter(|text| text.len() <= LONGEST);
    text.unwrap_or_else(|| "...".to_owned())
}

fn text(expr: &Expr, depth: usize) -> Option<String> {
    let within = depth.checked_sub(1)?;
    match &expr.kind {
        ExprKind::Number { value, unit, .. } => Some(format!("{value}{}", suffix(*unit))),
        ExprKind::Color([r, g, b, 255]) => Some(format!("#{r:02x}{g:02x}{b:02x}")),
        ExprKind::Color([r, g, b, a]) => Some(format!("#{r:02x}{g:02x}{b:02x}{a:02x}")),
        ExprKind::Text(text) => Some(format!("{text:?}")),
        ExprKind::Bool(value) => Some(value.to_string()),
        ExprKind::Name(name) => Some(name.clone()),
        ExprKind::Unary(UnaryOp::Neg, of) => Some(format!("-{}", text(of, within)?)),
        ExprKind::List(elements) => {
            let elements: Option<Vec<String>> =
                elements.iter().map(|element| element_text(element, within)).collect();
            Some(format!("[{}]", elements?.join(", ")))
        }
        ExprKind::Call(callee, arguments) => {
            let arguments: Option<Vec<String>> =
                arguments.iter().map(|argument| argument_text(argument, within)).collect();
            Some(format!("{}({})", text(callee, within)?, arguments?.join(", ")))
        }
        ExprKind::Paren(_)
        | ExprKind::Block(..)
        | ExprKind::If(..)
        | ExprKind::Lambda(..)
        | ExprKind::Record(_)
        | ExprKind::Field(..)
        | ExprKind::Index(..)
        | ExprKind::Unary(UnaryOp::Not, _)
        | ExprKind::Binary(..)
        | ExprKind::Error => None,
    }
}

fn suffix(unit: Option<Unit>) -> &'static str {
    match unit {
        None => "",
        Some(Unit::Deg) => "deg",
        Some(Unit::Turn) => "turn",
        Some(Unit::Rad) => "rad",
    }
}

fn argument_text(argument: &Arg, depth: usize) -> Option<String> {
    let value = element_text(&argument.value, depth)?;
    Some(match &argument.name {
        Some(name) => format!("{}: {value}", name.text),
        None => value,
    })
}

fn element_text(element: &Element, depth: usize) -> Option<String> {
    match element {
        Element::Expr(value) => text(value, depth),
        Element::For(_) => None,
    }
}
