//! Diagnostics for arguments that match no parameter.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{self, DeclKind};

use super::call::{Callee, Given, Value, count};
use super::decl::ParameterSignature;
use super::kernel::Builtin;
use super::names::{Entry, Found, is_private};
use super::types::show;
use super::written::written;
use super::{Checker, DeclIndex};
use crate::hir::Type;

impl<'a> Checker<'a> {
    /// Adds a suggestion for an unknown parameter name: an operator of this name, which is called
    /// on the shape, or a shape with a longer name that has this parameter.
    pub(super) fn elsewhere(&mut self, callee: &str, name: &str, found: Diagnostic) -> Diagnostic {
        let makes_shape = match self.look_up(callee) {
            Some(Found::Decls(decls)) => {
                decls.iter().any(|decl| self.decls[decl.0].ast.kind != DeclKind::Fn)
            }
            _ => false,
        };
        if !makes_shape {
            return found;
        }
        match (callee, name) {
            ("extrude", "twist") => {
                return found.help(
                    "`extrude` runs along z, and `twist` turns about y by an angle for each unit: \
                     extrude(...).rotate(x: -90deg).twist(2deg).rotate(x: 90deg)",
                );
            }
            ("extrude", "scale" | "taper") => {
                return found.help("a loft joins two sections: loft(a, a.scale(0.6), h: ...)");
            }
            ("cylinder", "r1" | "r2") => return found.help("`capped_cone` has two radii"),
            _ => {}
        }
        if self.library_decls(name).iter().any(|decl| self.takes_shape(*decl)) {
            return found.help(format!("call `{name}` on the shape: {callee}(...).{name}(...)"));
        }
        let mut kin: Vec<&str> = Vec::new();
        for other in self.library.keys().filter(|other| *other != &callee && other.contains(callee))
        {
            let has = |decl: &DeclIndex| {
                self.decls[decl.0].ast.signature.parms.iter().any(|parm| parm.name.text == name)
            };
            if !is_private(other) && self.library_decls(other).iter().any(has) {
                kin.push(other);
            }
        }
        kin.sort_unstable();
        match &kin[..] {
            [] => found,
            [one] => found.help(format!("`{one}` has this parameter")),
            [one, other, ..] => found.help(format!("`{one}` and `{other}` have this parameter")),
        }
    }

    /// The diagnostic for a call on a shape, as in `box(1).fillet(0.1)`, of something that makes
    /// no shape: a blend or a material.
    pub(super) fn no_operator(
        &mut self,
        callee: Callee,
        base: &mut Given<'a>,
    ) -> Option<Diagnostic> {
        let name = callee.name;
        let (what, help) = match self.look_up(name)? {
            Found::Builtin(Builtin::Material) => (
                "a material",
                ["to give a shape a material, write a.paint(material(...))"].as_slice(),
            ),
            Found::Decls(decls) if decls.iter().any(|decl| self.is_blend(*decl)) => (
                "a blend",
                [
                    "between two shapes, write union(a, b, blend: ...)",
                    "`rounded_box` has round edges; a.round(0.1) rounds the edges of any shape, and \
                     makes it 0.1 larger on each side",
                ]
                .as_slice(),
            ),
            _ => return None,
        };
        if !matches!(self.look_at(base), Type::Shape(_)) {
            return None;
        }
        let message = format!("`{name}` makes {what}; it is not called on a shape");
        let found = Diagnostic::error(Code::TYPE_MISMATCH, callee.at, message);
        Some(help.iter().fold(found, |found, help| found.help(*help)))
    }

    fn is_blend(&self, decl: DeclIndex) -> bool {
        let result = self.decls[decl.0].ast.signature.result.as_ref();
        matches!(
            result.map(|ty| &ty.kind),
            Some(ast::TypeExprKind::Named(word)) if word == "blend"
        )
    }

    fn library_decls(&self, name: &str) -> &[DeclIndex] {
        match self.library.get(name) {
            Some(Entry::Decls(decls)) => decls,
            Some(Entry::Let(_) | Entry::Param(_)) | None => &[],
        }
    }

    /// True if the first parameter is a shape, so that the declaration is called on one.
    fn takes_shape(&self, decl: DeclIndex) -> bool {
        let first = self.decls[decl.0].ast.signature.parms.first();
        matches!(
            first.and_then(|parm| parm.ty.as_ref()).map(|ty| &ty.kind),
            Some(ast::TypeExprKind::Named(word)) if matches!(&word[..], "solid" | "region" | "shape")
        )
    }

    /// The diagnostic for a parameter's name instead of its value, as in `mirror(x)`, if
    /// nothing else is called `x`.
    pub(super) fn parameter_for_value(
        &mut self,
        callee: Callee,
        parameters: &[ParameterSignature],
        given: &Given<'a>,
    ) -> Option<Diagnostic> {
        let Value::Expr(ast::Expr { kind: ast::ExprKind::Name(name), span }) = given.value else {
            return None;
        };
        let parameter = parameters.iter().find(|parameter| parameter.name == name)?;
        if name == "p" || self.look_up(name).is_some() {
            return None;
        }
        let value = if parameter.ty == Type::Bool { "true" } else { "..." };
        let message = format!("`{name}` has no value here; it is a parameter of `{}`", callee.name);
        let found = Diagnostic::error(Code::UNKNOWN_NAME, *span, message);
        let found = found.help(format!("give the parameter a value: {name}: {value}"));
        Some(found.help(format!("or define it above this line: let {name} = ...")))
    }

    /// The diagnostic for a word for a string, as in `align: center`.
    pub(super) fn word_without_quotes(
        &mut self,
        parameter: &ParameterSignature,
        given: &Given<'a>,
    ) -> Option<Diagnostic> {
        let Value::Expr(ast::Expr { kind: ast::ExprKind::Name(word), span }) = given.value else {
            return None;
        };
        if parameter.ty != Type::Text || self.look_up(word).is_some() {
            return None;
        }
        let message = format!("`{}` is a string, and `{word}` is an unknown name", parameter.name);
        let found = Diagnostic::error(Code::UNKNOWN_NAME, *span, message);
        Some(found.help(format!("write the string in quotes: {}: \"{word}\"", parameter.name)))
    }
}

/// The diagnostic for too many arguments, of which at most `unnamed` have no name.
pub(super) fn too_many(
    callee: Callee,
    parameters: &[ParameterSignature],
    unnamed: usize,
    span: Span,
) -> Diagnostic {
    let name = callee.name;
    let message = match unnamed {
        0 => format!("`{name}` takes no arguments"),
        n if n < parameters.len() => {
            format!("`{name}` takes at most {} without a name", count(n, "argument"))
        }
        n => format!("`{name}` takes at most {}", count(n, "argument")),
    };
    let found = Diagnostic::error(Code::ARGUMENTS, span, message);
    let found = found.help(signature(callee.name, parameters));
    match name {
        "emission" => found.help("stronger light is a brighter colour: emission(5 * #ffcc80)"),
        _ => found,
    }
}

/// The signature of a call, as in `capsule(a: vec3, b: vec3, r: number = 0.5)`.
pub(super) fn signature(name: &str, parameters: &[ParameterSignature]) -> String {
    let parameters: Vec<String> = parameters
        .iter()
        .map(|parameter| {
            let ty = match &parameter.ty {
                Type::List(of) if parameter.variadic => format!("{}...", show(of)),
                ty => show(ty),
            };
            let default = match parameter.default {
                Some(default) => format!(" = {}", written(default)),
                None if parameter.optional => " = ...".to_owned(),
                None => String::new(),
            };
            format!("{}: {ty}{default}", parameter.name)
        })
        .collect();
    format!("{name}({})", parameters.join(", "))
}
