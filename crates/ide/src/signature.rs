//! The signature of the call around the cursor.

use sdfc_lang::library::Entry;
use sdfc_syntax::ast::Item;

use crate::analysis::{Analysis, Referent};
use crate::calls::open_call;
use crate::declaration::describe;
use crate::library::library;

/// The signature of a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SignatureHelp {
    /// Name and parameters.
    pub label: String,
    /// The summary of what is called.
    pub docs: String,
    /// Each parameter as it is written in the label, with its description.
    pub parameters: Vec<(String, String)>,
    /// The index of the parameter at the cursor, if there is one.
    pub active: Option<usize>,
}

/// Returns the signatures of what is called around a byte offset. A shape that is declared for
/// solids and for regions has two.
pub fn signature_help(analysis: &Analysis, offset: usize) -> Vec<SignatureHelp> {
    let text = analysis.text();
    if !text.is_char_boundary(offset) {
        return Vec::new();
    }
    let Some(call) = open_call(text, offset) else { return Vec::new() };
    let name = &text[call.name.clone()];
    let entries = called(analysis, call.name.start, name);
    let shift = usize::from(call.is_method);
    let help = entries.into_iter().map(|entry| {
        let parameters = parameters(&entry);
        let active = match &call.argument_name {
            Some(wanted) => parameters.iter().position(|(it, _)| parameter_name(it) == wanted),
            None if parameters.is_empty() => None,
            None => Some(call.argument + shift),
        };
        let last = parameters.len().saturating_sub(1);
        let variadic = parameters.last().is_some_and(|(it, _)| it.contains("..."));
        let active = active.map(|at| if variadic { at.min(last) } else { at });
        let active = active.filter(|at| *at < parameters.len());
        SignatureHelp { label: entry.signature, docs: entry.summary, parameters, active }
    });
    help.collect()
}

/// The entries that the name at an offset may refer to: what the checker found, or else all with
/// that name.
fn called(analysis: &Analysis, at: usize, name: &str) -> Vec<Entry> {
    let known = analysis.occurrence(at).filter(|it| analysis.slice(it.span) == name);
    match known.map(|it| &it.referent) {
        Some(Referent::Declared(span)) => {
            let decl = analysis.declaration(*span);
            decl.map(|decl| describe(analysis, decl)).into_iter().collect()
        }
        Some(Referent::Kernel(name)) => {
            library().entry("kernel", name).cloned().into_iter().collect()
        }
        Some(Referent::Setting(name)) => {
            library().entry("setting", name).cloned().into_iter().collect()
        }
        Some(Referent::Parameter(..) | Referent::Type(_) | Referent::Implicit) | None => {
            let own = analysis.tree.items.iter().filter_map(Item::as_decl);
            let own = own.filter(|decl| decl.name.text == name);
            let own: Vec<Entry> = own.map(|decl| describe(analysis, decl)).collect();
            if !own.is_empty() {
                return own;
            }
            let entries = library().entries.iter().filter(|entry| entry.name == name);
            entries.filter(|entry| !matches!(entry.kind, "type" | "syntax")).cloned().collect()
        }
    }
}

/// The parameters of a signature as they are written, with their descriptions.
fn parameters(entry: &Entry) -> Vec<(String, String)> {
    let about = |written: &str| {
        let name = parameter_name(written);
        let found = entry.parameters.iter().find(|(parameter, _)| parameter == name);
        found.map(|(_, about)| about.clone()).unwrap_or_default()
    };
    let list = written_parameters(&entry.signature);
    list.into_iter().map(|it| (it.to_owned(), about(it))).collect()
}

/// Splits `name(a, b: [vec2] = [0, 1])` at the commas between its parameters.
pub fn written_parameters(signature: &str) -> Vec<&str> {
    let Some(open) = signature.find('(') else { return Vec::new() };
    let (mut depth, mut start, mut list) = (0_usize, open + 1, Vec::new());
    for (at, c) in signature.char_indices().skip_while(|(at, _)| *at < open) {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            ',' if depth == 1 => {
                list.push(signature[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
        if depth == 0 {
            list.push(signature[start..at].trim());
            break;
        }
    }
    list.retain(|it| !it.is_empty());
    list
}

/// The name of a parameter as it is written: `r` of `r: length = 1`.
pub fn parameter_name(written: &str) -> &str {
    let end = written.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    &written[..end.unwrap_or(written.len())]
}
