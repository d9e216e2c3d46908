//! Fills the tables of [`Uses`] while the checker runs.

use sdfc_diagnostics::Span;

use super::Checker;
use super::call::Given;
use super::decl::ParameterSignature;
use super::kernel;
use super::names::Found;
use crate::hir::Type;
use crate::uses::{ArgumentUse, CallUse, Scope, Target, Uses};

impl<'a> Checker<'a> {
    /// The tables, if they are filled and the current body is not of the library.
    fn tables(&mut self) -> Option<&mut Uses> {
        let is_library = self.modules.get(self.body.module).is_none_or(|it| it.path.is_none());
        self.uses.as_mut().filter(|_| !is_library)
    }

    /// Notes the type of an expression.
    pub(super) fn note_type(&mut self, span: Span, ty: &Type) {
        if let Some(uses) = self.tables()
            && *ty != Type::Error
        {
            uses.types.insert(span, ty.clone());
        }
    }

    /// Notes the type of a variable, by the span of its declared name.
    pub(super) fn note_variable(&mut self, span: Span, ty: &Type) {
        if let Some(uses) = self.tables() {
            uses.variables.insert(span, ty.clone());
        }
    }

    /// Notes that the name at `span` refers to the declaration of the name at `declared`.
    pub(super) fn note_declared(&mut self, span: Span, declared: Span) {
        if let Some(uses) = self.tables() {
            uses.targets.insert(span, Target::Declared(declared));
        }
    }

    /// Notes what the name at `span` refers to.
    pub(super) fn note_use(&mut self, span: Span, name: &str, found: &Found) {
        if self.tables().is_none() {
            return;
        }
        let target = match found {
            Found::Local(index) => self.body.variable(*index).map(|it| match it.implicit {
                true => Target::Implicit,
                false => Target::Declared(it.span),
            }),
            Found::Let(index) => Some(Target::Declared(self.lets[index.0].ast.name.span)),
            Found::Param(index) => Some(Target::Declared(self.params[index.0].ast.name.span)),
            Found::Decls(decls) => {
                let first = decls.first();
                first.map(|decl| Target::Declared(self.decls[decl.0].ast.name.span))
            }
            Found::Builtin(_) => {
                kernel::ROWS.iter().find(|row| row.name == name).map(|row| Target::Kernel(row.name))
            }
            Found::Setting(row) => self.settings.get(*row).map(|row| Target::Setting(row.name)),
            Found::Poisoned => None,
        };
        if let (Some(uses), Some(target)) = (&mut self.uses, target) {
            uses.targets.insert(span, target);
        }
    }

    /// Notes the arguments of a call, by parameter.
    pub(super) fn note_call(
        &mut self,
        at: Span,
        parameters: &[ParameterSignature],
        bound: &[Vec<Given<'a>>],
    ) {
        let Some(uses) = self.tables() else { return };
        let arguments = bound.iter().enumerate().flat_map(|(parameter, given)| {
            let argument = move |given: &Given| ArgumentUse {
                value: given.span,
                name: given.name.map(|name| name.span),
                parameter,
            };
            given.iter().map(argument)
        });
        let mut arguments: Vec<ArgumentUse> = arguments.collect();
        arguments.sort_by_key(|argument| argument.value.start);
        let parameters = parameters.iter().map(|it| it.name.to_owned()).collect();
        uses.calls.insert(at, CallUse { parameters, arguments });
    }

    /// Notes the scope, if the name marks the cursor.
    pub(super) fn note_scope(&mut self, name: &str) {
        if !self.is_cursor(name) {
            return;
        }
        let module = &self.modules[self.body.module];
        let own = module.names.iter().filter(|(_, entry)| self.is_visible(entry));
        let own = own.map(|(name, entry)| (*name, entry));
        let imported =
            module.imports.iter().filter_map(|(name, it)| Some((*name, it.entry.as_ref()?)));
        let named = own.chain(imported);
        let mut items: Vec<(String, Span)> =
            named.map(|(name, entry)| (name.to_owned(), self.entry_span(entry))).collect();
        items.sort();
        let variables = self.body.variables().map(|it| (it.name.to_owned(), it.ty.clone()));
        let variables = variables.collect();
        let Some(uses) = self.tables() else { return };
        let expected = uses.scope.take().and_then(|scope| scope.expected);
        uses.scope = Some(Scope { variables, items, expected });
    }

    /// Notes the type that is expected, if the name marks the cursor.
    pub(super) fn note_expected(&mut self, name: &str, want: &Type) {
        if !self.is_cursor(name) {
            return;
        }
        if let Some(uses) = self.tables() {
            uses.scope.get_or_insert_default().expected = Some(want.clone());
        }
    }

    fn is_cursor(&mut self, name: &str) -> bool {
        self.tables().is_some_and(|uses| uses.cursor.as_deref() == Some(name))
    }
}
