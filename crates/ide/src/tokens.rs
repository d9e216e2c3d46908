//! The roles of the words of a scene, for colouring.

use std::ops::Range;

use rustc_hash::FxHashMap;
use sdfc_lang::hir::Type;
use sdfc_syntax::ast::DeclKind;
use sdfc_syntax::{Class, classes};

use crate::analysis::{Analysis, Referent};
use crate::declaration::{Declared, declared};

/// The role of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TokenRole {
    /// A comment.
    Comment,
    /// Documentation.
    Docs,
    /// A reserved word, or the word of a clause.
    Keyword,
    /// A number or a colour.
    Number,
    /// A string.
    Text,
    /// An operator.
    Operator,
    /// A function.
    Function,
    /// A solid, a region or a shape.
    Shape,
    /// A setting.
    Setting,
    /// A type.
    Type,
    /// A `param`.
    Param,
    /// A parameter.
    Parameter,
    /// A variable.
    Variable,
    /// A component or an end, such as `.xy`.
    Property,
}

/// A word with its role.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TokenSpan {
    /// The word.
    pub range: Range<usize>,
    /// Its role.
    pub role: TokenRole,
    /// True if it declares a name.
    pub declares: bool,
    /// True if the library, the kernel or the language declares it.
    pub built_in: bool,
}

/// Words that are keywords only in clauses and imports.
const WORDS: [&str; 13] = [
    "exact",
    "bound",
    "outside",
    "inside",
    "lipschitz",
    "everywhere",
    "bounds",
    "material",
    "intersect",
    "copies",
    "require",
    "from",
    "as",
];

/// Returns the words of the scene with their roles, in the order of the text.
pub fn tokens(analysis: &Analysis) -> Vec<TokenSpan> {
    let text = analysis.text();
    let names = Names::new(analysis);
    let mut spans = Vec::new();
    for (class, range) in classes(text) {
        let role = match class {
            Class::Comment => Some((TokenRole::Comment, false, false)),
            Class::Docs => Some((TokenRole::Docs, false, false)),
            Class::Keyword => Some((TokenRole::Keyword, false, false)),
            Class::Number | Class::Color => Some((TokenRole::Number, false, false)),
            Class::Text => Some((TokenRole::Text, false, false)),
            Class::Operator => Some((TokenRole::Operator, false, false)),
            Class::Name => names.role(analysis, &range),
            Class::Open | Class::Close | Class::Punctuation | Class::Unknown => None,
        };
        if let Some((role, declares, built_in)) = role {
            spans.push(TokenSpan { range, role, declares, built_in });
        }
    }
    spans
}

/// The names of the scene by position.
struct Names {
    by_start: FxHashMap<usize, (TokenRole, bool, bool)>,
}

impl Names {
    fn new(analysis: &Analysis) -> Self {
        let mut roles = FxHashMap::default();
        let mut by_start = FxHashMap::default();
        for it in analysis.occurrences().iter().filter(|it| it.span.file == analysis.file) {
            let role = match &it.referent {
                Referent::Declared(name) => {
                    let role = *roles.entry(*name).or_insert_with(|| role_of(analysis, *name));
                    let of_files = analysis.file == name.file
                        || analysis.imports.iter().any(|import| import.file == name.file);
                    (role, it.declares, !of_files)
                }
                Referent::Implicit => (TokenRole::Variable, false, true),
                Referent::Kernel(_) => (TokenRole::Function, false, true),
                Referent::Setting(_) => (TokenRole::Setting, false, true),
                Referent::Type(_) => (TokenRole::Type, false, true),
                Referent::Parameter(..) => (TokenRole::Parameter, false, true),
            };
            by_start.insert(it.span.start as usize, role);
        }
        Self { by_start }
    }

    fn role(&self, analysis: &Analysis, at: &Range<usize>) -> Option<(TokenRole, bool, bool)> {
        if let Some(role) = self.by_start.get(&at.start) {
            return Some(*role);
        }
        let text = analysis.text();
        if WORDS.contains(&&text[at.clone()]) {
            return Some((TokenRole::Keyword, false, false));
        }
        // Components of vectors are left, and fields of records and of their types.
        let is_field = text[..at.start].trim_end().ends_with('.')
            || text[at.end..].trim_start().starts_with(':');
        is_field.then_some((TokenRole::Property, false, false))
    }
}

fn role_of(analysis: &Analysis, name: sdfc_diagnostics::Span) -> TokenRole {
    match declared(analysis, name) {
        Some(Declared::Decl(decl)) => match decl.kind {
            DeclKind::Fn => TokenRole::Function,
            DeclKind::Solid | DeclKind::Region | DeclKind::Shape => TokenRole::Shape,
        },
        Some(Declared::Param(_)) => TokenRole::Param,
        Some(Declared::Parm(..)) => TokenRole::Parameter,
        Some(Declared::Let(_)) => match analysis.uses.variables.get(&name) {
            Some(Type::Fn(..)) => TokenRole::Function,
            Some(_) | None => TokenRole::Variable,
        },
        Some(Declared::For(_)) | None => TokenRole::Variable,
    }
}
