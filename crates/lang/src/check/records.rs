//! Records: `(name: value, ...)`, their fields, their conversion and `record.with(name: value)`.
//!
//! The type of a record is the names and types of its fields. Two records with the same names have
//! compatible types, whatever the order: a conversion reorders the fields.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{self, Name};

use super::builtins::parameter;
use super::call::{Callee, Given};
use super::coerce::{Role, bind, literal};
use super::types::{self, describe};
use super::{Checker, poison};
use crate::hir::{Expr, ExprKind, Type};
use crate::spelling::{ask, nearest};

/// The fields of a record's type.
type Fields = [(String, Type)];

impl<'a> Checker<'a> {
    /// Checks a record without an expected type.
    pub(super) fn infer_record(&mut self, fields: &'a [ast::Field], span: Span) -> Expr {
        self.refuse_repeated(fields.iter().map(|field| &field.name));
        let mut values: Vec<Expr> = fields.iter().map(|field| self.infer(&field.value)).collect();
        // A whole literal makes a number. An index or a count stays an int.
        for value in values.iter_mut().filter(|value| literal(value).is_some()) {
            if value.ty == Type::Int {
                value.ty = Type::Number;
            }
        }
        let names = fields.iter().map(|field| field.name.text.clone());
        let of = names.zip(values.iter().map(|value| value.ty.clone())).collect();
        self.record(values, of, span)
    }

    /// Checks a record against a type with these fields. The type of each field is passed into its
    /// value.
    pub(super) fn check_record(
        &mut self,
        fields: &'a [ast::Field],
        want: &Fields,
        span: Span,
        role: Role,
    ) -> Expr {
        self.refuse_repeated(fields.iter().map(|field| &field.name));
        let mut given: Vec<Option<Expr>> = vec![None; want.len()];
        let mut unknown = None;
        for field in fields {
            let name = field.name.text.as_str();
            match want.iter().position(|(other, _)| other == name) {
                Some(at) => {
                    let what = format!("the field `{name}`");
                    given[at] = Some(self.check_expr(&field.value, &want[at].1, Role::The(&what)));
                }
                None => {
                    self.infer(&field.value);
                    unknown = unknown.or(Some(&field.name));
                }
            }
        }
        let missing = want.iter().zip(&given).find(|(_, value)| value.is_none());
        let wanted = || format!("{} is {}", role.subject(), describe(&Type::Record(want.to_vec())));
        if let Some(name) = unknown {
            let message = format!("{}; it has no field `{}`", wanted(), name.text);
            let found = Diagnostic::error(Code::TYPE_MISMATCH, name.span, message);
            self.report(fields_of(names_of(want), name, found));
            return poison(span);
        }
        if let Some(((name, _), _)) = missing {
            let message = format!("{}; the field `{name}` is missing", wanted());
            let found = Diagnostic::error(Code::TYPE_MISMATCH, span, message);
            self.report(found.help(format!("add {name}: ...")));
            return poison(span);
        }
        self.record(given.into_iter().flatten().collect(), want.to_vec(), span)
    }

    fn record(&mut self, values: Vec<Expr>, of: Vec<(String, Type)>, span: Span) -> Expr {
        if values.iter().any(|value| types::poisoned(&value.ty)) {
            return poison(span);
        }
        self.limit_type(Expr { kind: ExprKind::Record(values), ty: Type::Record(of), span })
    }

    /// Reports a field that occurs twice.
    fn refuse_repeated<'n>(&mut self, names: impl Iterator<Item = &'n Name>) {
        let mut seen: FxHashMap<&str, Span> = FxHashMap::default();
        for name in names {
            if let Some(first) = seen.insert(&name.text, name.span) {
                let message = format!("two fields are called `{}`", name.text);
                let found = Diagnostic::error(Code::DECLARED_TWICE, name.span, message);
                self.report(found.note_at(first, "the first one"));
            }
        }
    }

    /// The type `(name: type, ...)`.
    pub(super) fn resolve_record(&mut self, fields: &[ast::FieldType]) -> Type {
        self.refuse_repeated(fields.iter().map(|field| &field.name));
        let field =
            |field: &ast::FieldType| (field.name.text.clone(), self.resolve_type(&field.ty));
        Type::Record(fields.iter().map(field).collect())
    }

    /// `base.name` of a record.
    pub(super) fn field(&mut self, base: Expr, of: &Fields, name: &Name, span: Span) -> Expr {
        match of.iter().position(|(other, _)| *other == name.text) {
            Some(at) => pick(base, of, at, span),
            None => {
                self.no_such_field(of, name);
                poison(span)
            }
        }
    }

    fn no_such_field(&mut self, of: &Fields, name: &Name) {
        let message = format!("this record has no field `{}`", name.text);
        let found = Diagnostic::error(Code::NO_FIELD, name.span, message);
        self.report(fields_of(names_of(of), name, found));
    }

    /// Converts a record to a type with the same fields, in that type's order.
    pub(super) fn coerce_record(
        &mut self,
        value: Expr,
        have: &Fields,
        want: &Fields,
    ) -> Result<Expr, Expr> {
        if have.len() != want.len() {
            return Err(value);
        }
        let (local, mention) = self.name_value(&value);
        let fields = want.iter().map(|(name, ty)| {
            let at = have.iter().position(|(other, _)| other == name)?;
            self.try_coerce(pick(mention.clone(), have, at, value.span), ty).ok()
        });
        let Some(fields) = fields.collect::<Option<Vec<Expr>>>() else { return Err(value) };
        let (kind, ty) = (ExprKind::Record(fields), Type::Record(want.to_vec()));
        let record = Expr { kind, ty, span: value.span };
        Ok(bind(local, "record", value, record))
    }

    /// `record.with(name: value, ...)`: the record with other values for these fields.
    pub(super) fn changed(
        &mut self,
        callee: Callee,
        of: &Fields,
        mut given: Vec<Given<'a>>,
    ) -> Expr {
        let is_field = |name: &Name| of.iter().any(|(field, _)| *field == name.text);
        let unknown = given.iter().filter_map(|given| given.name).find(|name| !is_field(name));
        if let Some(name) = unknown {
            self.no_such_field(of, name);
            given.retain(|given| given.name.is_none_or(is_field));
        }
        let whole = parameter("record", Type::Record(of.to_vec()), false);
        let fields = of.iter().map(|(name, ty)| parameter(name, ty.clone(), true));
        let parameters: Vec<_> = std::iter::once(whole).chain(fields).collect();
        let mut arguments = self.arguments(callee, &parameters, given).into_iter();
        let Some(base) = arguments.next().flatten() else { return poison(callee.span) };
        let (local, mention) = self.name_value(&base);
        let field = |(at, value): (usize, Option<Expr>)| {
            value.unwrap_or_else(|| pick(mention.clone(), of, at, callee.span))
        };
        let fields = arguments.enumerate().map(field).collect();
        let record = self.record(fields, of.to_vec(), callee.span);
        if types::poisoned(&record.ty) || types::poisoned(&base.ty) {
            return poison(callee.span);
        }
        Expr { span: callee.span, ..bind(local, "record", base, record) }
    }
}

/// Adds the field that the name was probably meant to be, or all fields.
pub(super) fn fields_of<'n>(
    names: impl Iterator<Item = &'n str> + Clone,
    name: &Name,
    found: Diagnostic,
) -> Diagnostic {
    match nearest(&name.text, names.clone()) {
        Some(near) => ask(near).add_to(found),
        None => found.help(format!("its fields are {}", names.collect::<Vec<_>>().join(", "))),
    }
}

fn names_of(of: &Fields) -> impl Iterator<Item = &str> + Clone {
    of.iter().map(|(name, _)| name.as_str())
}

/// The field of a record with an index.
fn pick(base: Expr, of: &Fields, at: usize, span: Span) -> Expr {
    Expr { kind: ExprKind::Field(Box::new(base), at), ty: of[at].1.clone(), span }
}
