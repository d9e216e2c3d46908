//! Shape instances: arguments, clauses, formula and material.

use rustc_hash::FxHashSet;
use sdfc_diagnostics::{Code as ErrorCode, Diagnostic, Span};
use sdfc_graph::{
    Binary, Contract, Graph, MaterialRule, Node, NodeId, Range, Shape, ShapeId, SidePromise, Stage,
};

use super::elaborator::{CallFrame, Elaborator, Env, Outcome, Poison, Within};
use super::limits::MAX_DEPTH;
use super::output::Site;
use super::report::show_lanes;
use super::value::{Value, highest};
use crate::hir::{Expr, Promise, ShapeDef, ShapeDefId};

impl<'p> Elaborator<'p> {
    /// Builds an instance from a call of a shape's declaration.
    pub(super) fn build(
        &mut self,
        env: &mut Env<'p>,
        id: ShapeDefId,
        args: &'p [Option<Expr>],
        span: Span,
    ) -> Outcome<Value<'p>> {
        let given = self.given(env, args)?;
        self.instance(id, given, span)
    }

    /// Like [`Self::build`], from values.
    pub(super) fn instance(
        &mut self,
        id: ShapeDefId,
        given: Vec<super::call::Given<'p>>,
        span: Span,
    ) -> Outcome<Value<'p>> {
        let program = self.program;
        let definition = program.shapes.get(id.0 as usize).ok_or(Poison)?;
        self.frames.push(CallFrame { name: &definition.name, span });
        let within = std::mem::replace(&mut self.within, Within::Formula);
        let result = self.instance_inside(definition, id, given, span);
        self.within = within;
        self.frames.pop();
        result
    }

    fn instance_inside(
        &mut self,
        definition: &'p ShapeDef,
        id: ShapeDefId,
        given: Vec<super::call::Given<'p>>,
        span: Span,
    ) -> Outcome<Value<'p>> {
        let mut env = Env::new(definition.locals);
        self.bind(&mut env, &definition.parameters, given, span)?;
        let values: Vec<Value<'p>> =
            env.locals[..definition.parameters.len()].iter().flatten().cloned().collect();
        let level = highest(values.iter().map(|value| value.levels(&self.graph)));
        let args: Vec<_> = values.iter().map(Value::to_arg).collect();
        let name = self.definitions[id.0 as usize].clone();
        if let Some(known) = self.graph.find_shape(&name, definition.dim, level, &args) {
            self.add_site(known, span);
            return Ok(Value::Shape(known));
        }
        self.requirements(&mut env, &definition.requires)?;
        let point = self.graph.point(level, definition.dim);
        env.set(definition.parameters.len(), Value::Node(point));
        let contract = self.contract(&mut env, definition)?;
        let continuation = self.continuation(&contract);
        let nearest = match continuation {
            Some((bounds, _)) => self.graph.nearest_within(point, bounds),
            None => point,
        };
        env.set(definition.parameters.len(), Value::Node(nearest));
        let mut formula = self.number(&mut env, &definition.body)?;
        let material = self.material(&mut env, definition, formula)?;
        if let Some((_, constant)) = continuation {
            formula = self.graph.lipschitz_extension(point, nearest, formula, constant);
        }
        let shape = Shape {
            definition: name,
            dim: definition.dim,
            level,
            args,
            formula,
            contract,
            intersect: Vec::new(),
            material,
            children: Vec::new(),
            depth: 1,
            name: None,
        };
        let built = self.add_shape(shape, span)?;
        if let Value::Shape(shape) = built {
            self.queue_intersection(id, shape, env);
        }
        Ok(built)
    }

    /// The bounds outside which the field is extended, and the slope of the extension.
    fn continuation(&mut self, contract: &Contract) -> Option<([NodeId; 2], NodeId)> {
        let constant = contract.lipschitz.filter(|_| contract.is_extended)?;
        let bounds = contract.bounds.filter(|_| self.graph.is_finite(constant))?;
        // A field that never exceeds the distance is extended with slope 1.
        let is_bound = contract.outside != SidePromise::default();
        Some((bounds, if is_bound { self.graph.number(1.0) } else { constant }))
    }

    /// Adds an instance; finds its children first.
    pub(super) fn add_shape(&mut self, mut shape: Shape, span: Span) -> Outcome<Value<'p>> {
        let formula = survey(&self.graph, shape.formula);
        if formula.infinite {
            let message = format!("`{}` computes with an infinite value here", shape.definition);
            let help = "shaders need finite numbers: use a large number instead";
            let error = Diagnostic::error(ErrorCode::NOT_FINITE, span, message).help(help);
            return Err(self.report(error));
        }
        let of_contract = shape.contract.lipschitz.into_iter();
        let of_contract: Vec<NodeId> =
            of_contract.chain(shape.contract.bounds.into_iter().flatten()).collect();
        self.refuse_surface_vectors(&[&[shape.formula], &of_contract[..]].concat(), span)?;
        shape.children = formula.children;
        let deepest = shape.children.iter().map(|&child| self.graph.shape(child).depth).max();
        shape.depth = 1 + deepest.unwrap_or(0);
        if shape.depth > MAX_DEPTH {
            let message = format!("shapes are nested more than {MAX_DEPTH} levels deep");
            let help = "join many shapes with one `union(...)` instead of one by one";
            let error = Diagnostic::error(ErrorCode::SHAPE_NESTING, span, message).help(help);
            return Err(self.stop(error));
        }
        let id = self.graph.add_shape(shape);
        self.add_site(id, span);
        Ok(Value::Shape(id))
    }

    /// Records a call in the scene's files. Shapes that the library builds are not recorded.
    fn add_site(&mut self, shape: ShapeId, span: Span) {
        if !self.is_library(span) && self.seen_sites.insert((shape, span)) {
            let name = self.graph.shape(shape).definition.clone();
            self.sites.push(Site { shape, span, name });
        }
    }

    fn material(
        &mut self,
        env: &mut Env<'p>,
        definition: &'p ShapeDef,
        formula: NodeId,
    ) -> Outcome<MaterialRule> {
        let Some(stated) = definition.material.as_ref().filter(|_| self.has_materials) else {
            return Ok(MaterialRule::Weighted(formula));
        };
        let outer = std::mem::replace(&mut self.within, Within::Material);
        let value = self.eval(env, stated);
        self.within = outer;
        match value? {
            Value::Material(fields) => Ok(MaterialRule::Explicit(fields)),
            Value::Node(shares) => Ok(MaterialRule::Weighted(shares)),
            other => Err(self.unexpected(stated.span, "a material or a number", &other)),
        }
    }

    /// Evaluates the clauses to constants and per-frame values. A clause that depends on an outer
    /// formula's point is ignored.
    fn contract(&mut self, env: &mut Env<'p>, definition: &'p ShapeDef) -> Outcome<Contract> {
        let outer = std::mem::replace(&mut self.within, Within::Clause);
        let contract = self.clauses(env, definition);
        self.within = outer;
        contract
    }

    fn clauses(&mut self, env: &mut Env<'p>, definition: &'p ShapeDef) -> Outcome<Contract> {
        let mut contract = Contract::default();
        for promise in &definition.promises {
            self.promise(env, promise, &mut contract)?;
        }
        if let Some(stated) = &definition.lipschitz {
            let (constant, bounds) = self.with_bounds(|it| it.stated_constant(env, stated))?;
            contract.lipschitz = Some(constant).filter(|&node| self.is_early(node));
            contract.everywhere = definition.everywhere;
            let steep = self.graph.as_number(constant).is_none_or(|constant| constant > 1.0);
            contract.is_local = bounds.is_some() && !definition.everywhere;
            contract.is_extended = contract.is_local && steep;
        }
        contract.copies = definition.copies.is_some();
        if let Some(stated) = &definition.bounds {
            let Value::Range(lo, hi) = self.eval(env, stated)? else {
                return Err(Poison);
            };
            let lo = self.known(lo, f64::NEG_INFINITY);
            let hi = self.known(hi, f64::INFINITY);
            if self.is_early(lo) && self.is_early(hi) {
                contract.bounds = Some([lo, hi]);
            } else {
                let lo = self.for_all_points(lo, |range| range.lo);
                let hi = self.for_all_points(hi, |range| range.hi);
                contract.outer_bounds = Some([lo, hi]);
            }
        }
        Ok(contract)
    }

    /// A corner of bounds for all outer points: components that depend on one are replaced by an
    /// end of their range.
    fn for_all_points(&mut self, corner: NodeId, end: fn(Range) -> f64) -> NodeId {
        let width = self.graph.ty(corner).width();
        let mut components = Vec::with_capacity(width);
        for lane in 0..width {
            let component = self.graph.component(corner, lane as u8);
            components.push(if self.is_early(component) {
                component
            } else {
                let limit = end(self.graph.range(component));
                self.graph.number(limit)
            });
        }
        self.graph.compose(&components)
    }

    fn promise(
        &mut self,
        env: &mut Env<'p>,
        promise: &'p Promise,
        contract: &mut Contract,
    ) -> Outcome<()> {
        let condition = match &promise.condition {
            Some(condition) => self.number(env, condition)?,
            None => self.graph.boolean(true),
        };
        self.constrains(condition);
        if !self.is_early(condition) || self.as_bool(condition) == Some(false) {
            return Ok(());
        }
        let sides =
            [(promise.outside, &mut contract.outside), (promise.inside, &mut contract.inside)];
        for (_, side) in sides.into_iter().filter(|(stated, _)| *stated) {
            let SidePromise { exact, bound } = side;
            let side_condition = if promise.exact { exact } else { bound };
            *side_condition = Some(match *side_condition {
                Some(other) => self.graph.binary(Binary::Or, other, condition),
                None => condition,
            });
        }
        Ok(())
    }

    /// A stated Lipschitz constant; infinite if it is not a number. A negative one is an error.
    pub(super) fn stated_constant(
        &mut self,
        env: &mut Env<'p>,
        stated: &'p Expr,
    ) -> Outcome<NodeId> {
        let constant = self.number(env, stated)?;
        let constant = self.known(constant, f64::INFINITY);
        let nought = self.graph.number(0.0);
        let holds = self.graph.le(nought, constant);
        let Some(found) = self.refute(holds) else { return Ok(constant) };
        let value = self.value_at(constant, &found).map_or("…".to_owned(), |v| show_lanes(&v));
        let can_be = if found.causes.is_empty() { "is" } else { "can be" };
        let message = format!("this Lipschitz constant {can_be} {value}, but must be at least 0");
        let help = "it is the largest change of the value when its argument changes by 1";
        Err(self
            .report(Diagnostic::error(ErrorCode::OUT_OF_RANGE, stated.span, message).help(help)))
    }

    fn is_early(&self, node: NodeId) -> bool {
        self.graph.stage(node) != Stage::Point
    }

    /// Replaces components of a constant that are not a number by `otherwise`. An example is 0
    /// times infinity, if a shape without bounds is twisted by 0.
    fn known(&mut self, node: NodeId, otherwise: f64) -> NodeId {
        let node = self.settled(node);
        let Some((lanes, width)) = self.as_lanes(node) else { return node };
        let lanes = lanes.map(|lane| if lane.is_nan() { otherwise } else { lane });
        self.graph.constant(self.graph.ty(node), &lanes[..width])
    }
}

/// The result of a walk over a formula.
#[derive(Default)]
struct Formula {
    /// The shapes that it samples, in order of first use.
    children: Vec<ShapeId>,
    /// True if it computes with a constant that is not finite.
    infinite: bool,
}

fn survey(graph: &Graph, root: NodeId) -> Formula {
    let mut found = Formula::default();
    let mut seen: FxHashSet<NodeId> = FxHashSet::default();
    let mut known: FxHashSet<ShapeId> = FxHashSet::default();
    let mut stack = vec![root];
    while let Some(id) = stack.pop() {
        if let Some(value) = graph.as_const(id) {
            found.infinite |= value.lanes().iter().any(|lane| !lane.is_finite());
        }
        // Only nodes that depend on a point can contain a sample.
        if graph.stage(id) != Stage::Point || !seen.insert(id) {
            continue;
        }
        let node = graph.node(id);
        if let Node::Sample(child, _) | Node::MaterialAt(child, ..) = node
            && known.insert(child)
        {
            found.children.push(child);
        }
        let arguments: Vec<NodeId> = graph.arguments(id).collect();
        stack.extend(arguments.into_iter().rev());
    }
    found
}
