//! Literals that move without a recompile.
//!
//! A number written in the scene becomes a param of its own, with the number as its default, unless it
//! decides what is built: a branch, a length, a count, a promise, a requirement, an exponent. Which do
//! is found out by elaborating: what a decision asked about is put back, and the scene elaborated again,
//! until nothing is asked. Everything after that treats such a param as any other.

use std::collections::{BTreeMap, BTreeSet};

use sdfc_diagnostics::{Diagnostic, FileId, Sources, Span};

use crate::elab::{self, Elaborated};
use crate::font::Fonts;
use crate::hir::{self, Element, Expr, ExprKind, ParamId, Program};

/// How often a scene is elaborated before its literals are left as they are.
const MAX_ROUNDS: usize = 64;
/// Most literals of a scene that move: what a uniform buffer of 16 KiB holds, with room for params.
pub const MAX_SLOTS: usize = 512;

/// A literal that moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Slot {
    /// Where it is written.
    pub span: Span,
    /// Its value there.
    pub value: f64,
    /// The param that it has become, by position.
    pub param: usize,
}

/// What is known of the literals so far.
#[derive(Clone, Debug, Default, PartialEq)]
struct Known {
    decisive: BTreeSet<Span>,
    ranges: BTreeMap<Span, [f64; 2]>,
}

/// Elaborates a checked scene with as many of its literals as possible as params.
pub(crate) fn elaborate(
    program: &Program,
    fonts: &Fonts<'_>,
    sources: &Sources,
    file: FileId,
    near: Option<u32>,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    let plain = elab::elaborate(program, fonts);
    if plain.0.is_none() {
        return plain;
    }
    let mut known = Known::default();
    for _ in 0..MAX_ROUNDS {
        let mut moving = program.clone();
        let chosen = near.and_then(|near| around(near, program, sources, file, &known));
        let slots = Offering { chosen, ..Offering::new(sources, file, &known) }.make(&mut moving);
        if slots.is_empty() {
            return plain;
        }
        let (elaborated, _, offer) = elab::elaborate_with(&moving, fonts, program.params.len());
        let span = |param: &usize| slots.iter().find(|s| s.param == *param).map(|s| s.span);
        let mut learned = known.clone();
        learned.decisive.extend(offer.decisive.iter().filter_map(span));
        if learned == known {
            learned.decisive.extend(offer.bound.iter().filter_map(span));
            let ranges = offer.ranges.iter();
            learned.ranges.extend(ranges.filter_map(|(param, range)| Some((span(param)?, *range))));
        }
        if learned != known {
            known = learned;
            continue;
        }
        return match elaborated {
            Some(elaborated) => (Some(Elaborated { slots, ..elaborated }), plain.1),
            None => plain,
        };
    }
    plain
}

/// Of the literals in the order of the text as many as can move, with the one nearest to a byte in their middle; `None` where
/// all can.
fn around(
    near: u32,
    program: &Program,
    sources: &Sources,
    file: FileId,
    known: &Known,
) -> Option<BTreeSet<Span>> {
    let all = Offering { most: usize::MAX, ..Offering::new(sources, file, known) };
    let mut all: Vec<Span> = all.make(&mut program.clone()).iter().map(|slot| slot.span).collect();
    if all.len() <= MAX_SLOTS {
        return None;
    }
    all.sort_unstable();
    let middle = all.partition_point(|span| span.end < near);
    let first = middle.saturating_sub(MAX_SLOTS / 2).min(all.len() - MAX_SLOTS);
    Some(all[first..first + MAX_SLOTS].iter().copied().collect())
}

/// Puts params in the places of literals.
struct Offering<'a> {
    sources: &'a Sources,
    file: FileId,
    known: &'a Known,
    /// The literals to choose from; all, if nothing is said.
    chosen: Option<BTreeSet<Span>>,
    most: usize,
    params: Vec<hir::Param>,
    slots: Vec<Slot>,
    /// The param of each literal so far.
    places: BTreeMap<Span, ParamId>,
    first: usize,
}

impl<'a> Offering<'a> {
    fn new(sources: &'a Sources, file: FileId, known: &'a Known) -> Self {
        Self {
            sources,
            file,
            known,
            chosen: None,
            most: MAX_SLOTS,
            params: Vec::new(),
            slots: Vec::new(),
            places: BTreeMap::new(),
            first: 0,
        }
    }

    fn make(mut self, program: &mut Program) -> Vec<Slot> {
        self.first = program.params.len();
        for global in &mut program.globals {
            self.expr(&mut global.value);
        }
        for function in &mut program.functions {
            self.expr(&mut function.body);
        }
        for shape in &mut program.shapes {
            self.expr(&mut shape.body);
            shape.material.iter_mut().for_each(|material| self.expr(material));
        }
        program.drawn.iter_mut().for_each(|drawn| self.expr(drawn));
        for setting in &mut program.settings {
            setting.args.iter_mut().flatten().for_each(|arg| self.expr(arg));
        }
        program.params.append(&mut self.params);
        self.slots
    }

    fn expr(&mut self, expr: &mut Expr) {
        stacker::maybe_grow(128 << 10, 2 << 20, || self.expr_kind(expr));
    }

    fn expr_kind(&mut self, expr: &mut Expr) {
        if expr.span.file != self.file {
            return;
        }
        match &mut expr.kind {
            ExprKind::Number(value) => {
                let value = *value;
                if let Some(id) = self.offer(expr.span, value, &expr.ty) {
                    expr.kind = ExprKind::Param(id);
                }
            }
            ExprKind::Color(_)
            | ExprKind::Text(_)
            | ExprKind::Bool(_)
            | ExprKind::Local(_)
            | ExprKind::Param(_)
            | ExprKind::Global(_)
            | ExprKind::Time
            | ExprKind::Frame
            | ExprKind::FnValue(_)
            | ExprKind::Error => {}
            ExprKind::List(elements) => elements.iter_mut().for_each(|e| self.element(e)),
            ExprKind::Range(a, b)
            | ExprKind::Index(a, b)
            | ExprKind::Slice(a, b)
            | ExprKind::Sample(a, b) => {
                self.expr(a);
                self.expr(b);
            }
            ExprKind::Vector(parts) | ExprKind::Kernel(_, parts) => {
                parts.iter_mut().for_each(|part| self.expr(part));
            }
            ExprKind::Swizzle(a, _)
            | ExprKind::RangeEnd(a, _)
            | ExprKind::Splat(a)
            | ExprKind::Constant(a) => self.expr(a),
            ExprKind::Block(lets, result) => {
                lets.iter_mut().for_each(|(_, _, value)| self.expr(value));
                self.expr(result);
            }
            ExprKind::If(condition, yes, no) => {
                for part in [condition, yes, no] {
                    self.expr(part);
                }
            }
            ExprKind::Lambda(lambda) => self.expr(&mut lambda.body),
            ExprKind::Call(_, args) | ExprKind::Build(_, args) => {
                args.iter_mut().flatten().for_each(|arg| self.expr(arg));
            }
            ExprKind::Apply(function, args) => {
                self.expr(function);
                args.iter_mut().for_each(|arg| self.expr(arg));
            }
            ExprKind::With(base, fields) => {
                self.expr(base);
                fields.iter_mut().for_each(|(_, value)| self.expr(value));
            }
        }
    }

    fn element(&mut self, element: &mut Element) {
        match element {
            Element::One(value) | Element::Spread(value) => self.expr(value),
            Element::For(comprehension) => {
                self.expr(&mut comprehension.over);
                comprehension.condition.iter_mut().for_each(|condition| self.expr(condition));
                self.element(&mut comprehension.body);
            }
        }
    }

    /// The param for a literal; `None` if it must stay. `pi` and its like are names, not literals.
    fn offer(&mut self, span: Span, value: f64, ty: &hir::Type) -> Option<ParamId> {
        let written = self.sources.slice(span).starts_with(|c: char| c.is_ascii_digit());
        if !written || self.known.decisive.contains(&span) {
            return None;
        }
        if let Some(again) = self.places.get(&span) {
            return Some(*again);
        }
        if self.slots.len() == self.most
            || self.chosen.as_ref().is_some_and(|it| !it.contains(&span))
        {
            return None;
        }
        let param = self.first + self.slots.len();
        let number = |value| Expr { kind: ExprKind::Number(value), ty: hir::Type::Number, span };
        let ty = if *ty == hir::Type::Angle { hir::Type::Angle } else { hir::Type::Number };
        let place = self.sources.line_column(span.file, span.start);
        let range = self.known.ranges.get(&span).map(|[lo, hi]| Expr {
            kind: ExprKind::Range(Box::new(number(*lo)), Box::new(number(*hi))),
            ty: hir::Type::Range(Box::new(ty.clone())),
            span,
        });
        self.params.push(hir::Param {
            name: format!("at_{}_{}", place.line, place.column),
            default: Expr { ty: ty.clone(), ..number(value) },
            ty,
            range,
            choices: Vec::new(),
            span,
            docs: vec![self.sources.slice(span).to_owned()],
        });
        self.slots.push(Slot { span, value, param });
        self.places.insert(span, ParamId(param as u32));
        Some(ParamId(param as u32))
    }
}
