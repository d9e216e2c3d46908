//! Live literals: numbers written in the scene that can change without a recompile.
//!
//! Each literal becomes a param of its own, with the literal as its default. A literal stays
//! constant if it decides what is built (a branch, a length, a count, an exponent) or if a promise
//! or a requirement depends on it. Elaboration finds these: they are made constant again, and the
//! scene is elaborated again, until no more are found. Later phases treat a live literal as they
//! treat any other param.

use std::collections::{BTreeMap, BTreeSet};

use sdfc_diagnostics::{Diagnostic, FileId, Sources, Span};

use crate::assets::Assets;
pub use crate::elab::LiveLiteral;
use crate::elab::{self, CompileValues, Elaborated, ParamInputs};
use crate::hir::{self, Element, Expr, ExprKind, ParamId, Program};

/// Number of elaborations after which all literals of a scene stay constant.
const MAX_ELABORATIONS: usize = 64;
/// Most live literals of a scene: a uniform buffer of 16 KiB holds them, with room for params.
pub const MAX_LIVE_LITERALS: usize = 512;

/// The facts that earlier elaborations found about the literals.
#[derive(Clone, Debug, Default, PartialEq)]
struct LiteralFacts {
    /// Literals that must stay constant.
    fixed: BTreeSet<Span>,
    /// The range within which a literal may move.
    ranges: BTreeMap<Span, [f64; 2]>,
}

/// Elaborates a checked scene with as many of its literals as possible as params. If there are
/// more than [`MAX_LIVE_LITERALS`], those nearest to the byte offset `focus` become params.
pub(crate) fn elaborate(
    program: &Program,
    assets: &Assets<'_>,
    sources: &Sources,
    file: FileId,
    focus: Option<u32>,
    values: &CompileValues,
) -> (Option<Elaborated>, Vec<Diagnostic>) {
    let plain = elab::elaborate(program, assets, values, false);
    let Some(found) = &plain.0 else { return plain };
    let mut params = ParamInputs::new(program.params.len(), values);
    let declared = found.scene.params.iter().enumerate();
    params.fix(&declared.filter(|(_, param)| param.fixed.is_some()).map(|(i, _)| i).collect());
    let mut facts = LiteralFacts::default();
    for _ in 0..MAX_ELABORATIONS {
        let mut lifted = program.clone();
        let chosen = focus.and_then(|focus| around(focus, program, sources, file, &facts));
        let lifting = Lifting { chosen, ..Lifting::new(sources, file, &facts) };
        let literals = lifting.lift(&mut lifted);
        if literals.is_empty() {
            return plain;
        }
        let result = elab::elaborate_with(&lifted, assets, params.clone());
        let (elaborated, uses) = (result.elaborated, result.literals);
        let span = |param: &usize| literals.iter().find(|s| s.param == *param).map(|s| s.span);
        let mut learned = facts.clone();
        learned.fixed.extend(uses.fixed.iter().filter_map(span));
        if learned == facts {
            learned.fixed.extend(uses.constrained.iter().filter_map(span));
            let ranges = uses.ranges.iter();
            learned.ranges.extend(ranges.filter_map(|(param, range)| Some((span(param)?, *range))));
        }
        if learned != facts {
            facts = learned;
            continue;
        }
        let Some(elaborated) = elaborated else { return plain };
        let as_written = plain.0.map(|plain| Box::new(plain.scene));
        let live = Elaborated { live_literals: literals, as_written, ..elaborated };
        return (Some(live), plain.1);
    }
    plain
}

/// The [`MAX_LIVE_LITERALS`] literals around a byte offset; `None` if there are no more than that.
fn around(
    focus: u32,
    program: &Program,
    sources: &Sources,
    file: FileId,
    facts: &LiteralFacts,
) -> Option<BTreeSet<Span>> {
    let all = Lifting { most: usize::MAX, ..Lifting::new(sources, file, facts) };
    let literals = all.lift(&mut program.clone());
    let mut all: Vec<Span> = literals.iter().map(|literal| literal.span).collect();
    if all.len() <= MAX_LIVE_LITERALS {
        return None;
    }
    all.sort_unstable();
    let middle = all.partition_point(|span| span.end < focus);
    let first = middle.saturating_sub(MAX_LIVE_LITERALS / 2).min(all.len() - MAX_LIVE_LITERALS);
    Some(all[first..first + MAX_LIVE_LITERALS].iter().copied().collect())
}

/// Replaces literals of a program by params.
struct Lifting<'a> {
    sources: &'a Sources,
    file: FileId,
    facts: &'a LiteralFacts,
    /// The literals to choose from; `None` for all.
    chosen: Option<BTreeSet<Span>>,
    /// The largest number of literals to lift.
    most: usize,
    params: Vec<hir::Param>,
    literals: Vec<LiveLiteral>,
    /// The param of each literal lifted so far.
    lifted: BTreeMap<Span, ParamId>,
    /// Index of the first param that stands for a literal.
    first: usize,
}

impl<'a> Lifting<'a> {
    fn new(sources: &'a Sources, file: FileId, facts: &'a LiteralFacts) -> Self {
        Self {
            sources,
            file,
            facts,
            chosen: None,
            most: MAX_LIVE_LITERALS,
            params: Vec::new(),
            literals: Vec::new(),
            lifted: BTreeMap::new(),
            first: 0,
        }
    }

    /// Puts the params into the program and returns the literals that they stand for.
    fn lift(mut self, program: &mut Program) -> Vec<LiveLiteral> {
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
        self.literals
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
                if let Some(id) = self.lift_literal(expr.span, value, &expr.ty) {
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
            | ExprKind::SurfaceVector(_)
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
            ExprKind::Vector(parts) | ExprKind::Record(parts) | ExprKind::Kernel(_, parts) => {
                parts.iter_mut().for_each(|part| self.expr(part));
            }
            ExprKind::Swizzle(a, _)
            | ExprKind::Field(a, _)
            | ExprKind::MaterialField(a, _)
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

    /// The param for a literal; `None` if the literal must stay. Constants such as `pi` are names,
    /// not literals.
    fn lift_literal(&mut self, span: Span, value: f64, ty: &hir::Type) -> Option<ParamId> {
        let written = self.sources.slice(span).starts_with(|c: char| c.is_ascii_digit());
        if !written || self.facts.fixed.contains(&span) {
            return None;
        }
        if let Some(again) = self.lifted.get(&span) {
            return Some(*again);
        }
        if self.literals.len() == self.most
            || self.chosen.as_ref().is_some_and(|it| !it.contains(&span))
        {
            return None;
        }
        let param = self.first + self.literals.len();
        let number = |value| Expr { kind: ExprKind::Number(value), ty: hir::Type::Number, span };
        let ty = if *ty == hir::Type::Angle { hir::Type::Angle } else { hir::Type::Number };
        let at = self.sources.line_column(span.file, span.start);
        let range = self.facts.ranges.get(&span).map(|[lo, hi]| Expr {
            kind: ExprKind::Range(Box::new(number(*lo)), Box::new(number(*hi))),
            ty: hir::Type::Range(Box::new(ty.clone())),
            span,
        });
        self.params.push(hir::Param {
            name: format!("at_{}_{}", at.line, at.column),
            default: Expr { ty: ty.clone(), ..number(value) },
            ty,
            range,
            choices: Vec::new(),
            span,
            docs: vec![self.sources.slice(span).to_owned()],
        });
        self.literals.push(LiveLiteral { span, value, param });
        self.lifted.insert(span, ParamId(param as u32));
        Some(ParamId(param as u32))
    }
}
