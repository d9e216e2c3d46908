//! Names of the parameters of the call around the cursor.

use sdfc_syntax::ast::ExprKind;

use super::item::{CURSOR, Completion, CompletionKind};
use crate::analysis::Analysis;
use crate::calls::open_call;
use crate::signature::{parameter_name, signature_help};
use crate::tree::{Node, path};

/// Returns the parameters that have no argument yet.
pub fn arguments(analysis: &Analysis, offset: usize) -> Vec<Completion> {
    let inside = offset + CURSOR.len();
    let Some(call) = open_call(analysis.text(), inside) else { return Vec::new() };
    let given = given(analysis, inside);
    let mut found: Vec<Completion> = Vec::new();
    for signature in signature_help(analysis, inside) {
        // Positional arguments come first, so the parameters before the cursor have theirs.
        let first = if call.argument_name.is_some() { 0 } else { call.argument };
        let first = first.saturating_sub(given.len()) + usize::from(call.is_method);
        for (written, about) in signature.parameters.into_iter().skip(first) {
            let name = parameter_name(&written).to_owned();
            let is_known = found.iter().any(|it| it.label == format!("{name}:"));
            if is_known || given.contains(&name) || name.is_empty() {
                continue;
            }
            let insert = format!("{name}: $0");
            let it = Completion::new(CompletionKind::Argument, format!("{name}:"), 1);
            found.push(it.detail(written).docs(about).insert(insert));
        }
    }
    found
}

/// The names that arguments of the call have already.
fn given(analysis: &Analysis, offset: usize) -> Vec<String> {
    let around = path(&analysis.tree, offset).into_iter().rev().filter_map(Node::expr);
    let call = around.filter_map(|e| {
        let ExprKind::Call(_, args) = &e.kind else { return None };
        Some(args)
    });
    let names = call.take(1).flatten().filter_map(|arg| arg.name.as_ref());
    names.map(|name| name.text.clone()).filter(|name| name != CURSOR).collect()
}
