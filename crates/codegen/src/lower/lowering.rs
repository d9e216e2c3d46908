//! Lowers nodes to the body of one naga function.
//!
//! Nodes are visited in the order of [`sdfc_graph::schedule`], arguments first, so nothing recurses
//! over the graph. A value that is used more than once gets a name in the written source, as do
//! those that the program names; a value used once is written where it is used, to a bounded depth.

use naga::{BinaryOperator, Literal, Statement, SwizzleComponent, UniqueArena};
use naga::{Expression, Function, FunctionArgument, FunctionResult, GlobalVariable, Handle};
use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Const, IdMap, LoopId, Node, NodeId, Program, Type};

use super::body::{Body, Value};
use super::inputs::{Inputs, frame_name, input_name};
use super::iteration::Iteration;
use super::types;
use super::uses::{Uses, is_component, scheduled};
use crate::error::Error;

/// The name of the point that a function is evaluated at.
pub(crate) const POINT: &str = "p";

/// The literal for infinity: 2^127. The shortest decimal text of the largest number is above that
/// number, and some shader compilers refuse it.
const FARTHEST: f32 = f32::from_bits(0x7f00_0000);

/// Makes a function of several points, by level, that returns one node's value.
pub(crate) fn function_of(
    program: &Program,
    inputs: &Inputs,
    types: &mut UniqueArena<naga::Type>,
    name: &str,
    root: NodeId,
    arguments: &'static [&'static str],
) -> Result<Function, Error> {
    let lowering = Lowering::new(program, inputs, types, &[root]);
    let mut lowering = Lowering { arguments, ..lowering };
    lowering.visit_all(&[root])?;
    let mut value = lowering.value(root)?;
    if program.graph.ty(root) == Type::Scalar {
        value = lowering.with_inactive_distance(value);
    }
    let result = types::value(lowering.types, program.graph.ty(root));
    Ok(lowering.finish(name, value, result))
}

/// Makes a function of an iteration's number and the point, for a node over the variables of an
/// iteration.
pub(crate) fn function_of_iteration(
    program: &Program,
    inputs: &Inputs,
    types: &mut UniqueArena<naga::Type>,
    name: &str,
    root: NodeId,
) -> Result<Function, Error> {
    let mut lowering = Lowering::new(program, inputs, types, &[root]);
    lowering.first_point = 1;
    let number = lowering.body.declare(Expression::FunctionArgument(0));
    lowering.iterations = vec![Some(Iteration::of_number(number))];
    let order = lowering.uses.take_order();
    lowering.visit(&[root], &order)?;
    let value = lowering.value(root)?;
    let result = types::value(lowering.types, program.graph.ty(root));
    Ok(lowering.finish(name, value, result))
}

/// Makes a function of points that returns several nodes' values in a structure.
pub(crate) fn struct_function(
    program: &Program,
    inputs: &Inputs,
    types: &mut UniqueArena<naga::Type>,
    name: &str,
    (roots, structure): (&[NodeId], Handle<naga::Type>),
    arguments: &'static [&'static str],
) -> Result<Function, Error> {
    let lowering = Lowering::new(program, inputs, types, roots);
    let mut lowering = Lowering { arguments, ..lowering };
    lowering.visit_all(roots)?;
    let components: Vec<_> =
        roots.iter().map(|&root| lowering.value(root)).collect::<Result<_, _>>()?;
    let compose = Expression::Compose { ty: structure, components: components.clone() };
    let value = lowering.body.compute(compose, &components);
    Ok(lowering.finish(name, value, structure))
}

/// Makes a function without arguments that computes nodes and stores each in a private variable.
pub(crate) fn store_function(
    program: &Program,
    inputs: &Inputs,
    types: &mut UniqueArena<naga::Type>,
    stored: &[(NodeId, Handle<GlobalVariable>)],
) -> Result<Function, Error> {
    let roots: Vec<_> = stored.iter().map(|&(node, _)| node).collect();
    let mut lowering = Lowering::new(program, inputs, types, &roots);
    lowering.visit_all(&roots)?;
    for &(node, variable) in stored {
        let value = lowering.value(node)?;
        let pointer = lowering.body.declare(Expression::GlobalVariable(variable));
        lowering.body.push(Statement::Store { pointer, value });
    }
    Ok(lowering.body.finish(None))
}

/// The nodes that are computed in the branch of each guarded value.
pub(super) type Branches = FxHashMap<NodeId, Vec<NodeId>>;

/// A function while its nodes are lowered.
pub(super) struct Lowering<'a> {
    pub(super) program: &'a Program,
    pub(super) inputs: &'a Inputs,
    pub(super) types: &'a mut UniqueArena<naga::Type>,
    pub(super) uses: Uses,
    pub(super) body: Body,
    /// Names of the points that the function takes, by level.
    pub(super) arguments: &'static [&'static str],
    /// The number of other arguments before them.
    pub(super) first_point: u32,
    /// Values of the nodes visited so far, except constants.
    pub(super) values: IdMap<Value>,
    pub(super) matrices: FxHashMap<[NodeId; 3], Value>,
    /// The words of hashes.
    pub(super) words: FxHashMap<NodeId, Value>,
    /// The final states of the loops visited so far.
    pub(super) loops: FxHashMap<LoopId, Vec<Value>>,
    /// The variables of the current iterations, by the depth of their loops.
    pub(super) iterations: Vec<Option<Iteration>>,
    /// True if a loop was written that runs only listed iterations.
    pub(super) uses_lists: bool,
}

impl<'a> Lowering<'a> {
    fn new(
        program: &'a Program,
        inputs: &'a Inputs,
        types: &'a mut UniqueArena<naga::Type>,
        roots: &[NodeId],
    ) -> Self {
        let uses = Uses::count(&program.graph, roots, inputs);
        let (body, values, matrices, words, loops, iterations, uses_lists) = Default::default();
        let arguments = &[POINT];
        Self {
            program,
            inputs,
            types,
            uses,
            body,
            arguments,
            first_point: 0,
            values,
            matrices,
            words,
            loops,
            iterations,
            uses_lists,
        }
    }

    /// Computes all nodes that the roots need.
    fn visit_all(&mut self, roots: &[NodeId]) -> Result<(), Error> {
        let graph = &self.program.graph;
        let outside = self.uses.take_order().into_iter().filter(|&id| graph.loops_around(id) == 0);
        let outside: Vec<NodeId> = outside.collect();
        self.visit(roots, &outside)
    }

    /// Computes ascending nodes, each near its first use and after its arguments.
    pub(super) fn visit(&mut self, roots: &[NodeId], nodes: &[NodeId]) -> Result<(), Error> {
        let (guarded, nodes) = self.without_guarded(roots, nodes);
        self.visit_with(&guarded, roots, &nodes)
    }

    /// The same, with these branches.
    pub(super) fn visit_with(
        &mut self,
        guarded: &Branches,
        roots: &[NodeId],
        nodes: &[NodeId],
    ) -> Result<(), Error> {
        for id in scheduled(&self.program.graph, roots, nodes, self.inputs) {
            let node = self.program.graph.node(id);
            if matches!(node, Node::Const(_)) {
                continue;
            }
            let value = match (self.inputs.read_slot(&mut self.body, id), guarded.get(&id)) {
                (Some(value), _) => value,
                (None, Some(within)) => self.guarded(id, within)?,
                (None, None) => self.node(id, node)?,
            };
            self.values.insert(id, value);
            self.name(id, node, value);
        }
        Ok(())
    }

    /// Names a value as the program does, or if it is used more than once; but no value that is as
    /// short as a name.
    pub(super) fn name(&mut self, id: NodeId, node: Node, value: Value) {
        if self.inputs.is_slot(id) {
            return self.body.name(value, &frame_name(self.program, id));
        }
        if matches!(node, Node::Point(..) | Node::Frame(..) | Node::Variable(..)) {
            return;
        }
        if let Some(name) = self.program.names.get(&id) {
            self.body.name(value, name);
        } else if (self.uses.of(id) > 1 || self.uses.is_named(id)) && !is_component(&node) {
            self.body.name(value, hint(self.program.graph.ty(id)));
        }
    }

    /// The value of an argument. Constants are written where they are used.
    pub(super) fn value(&mut self, id: NodeId) -> Result<Value, Error> {
        if let Node::Const(constant) = self.program.graph.node(id) {
            return self.constant(id, constant);
        }
        self.values.get(id).ok_or(Error::NotFlat(id))
    }

    fn node(&mut self, id: NodeId, node: Node) -> Result<Value, Error> {
        match node {
            Node::Const(constant) => self.constant(id, constant),
            Node::Point(level, dim)
                if dim == self.program.dim() && usize::from(level) < self.arguments.len() =>
            {
                let argument = self.first_point + u32::from(level);
                Ok(self.body.declare(Expression::FunctionArgument(argument)))
            }
            Node::Point(..) | Node::Sample(..) | Node::MaterialAt(..) => Err(Error::NotFlat(id)),
            Node::Frame(input, _) => {
                let name = input_name(self.program, input);
                let value = self.inputs.read_raw(&mut self.body, input, &name);
                value.ok_or(Error::UnboundInput(id))
            }
            Node::Unary(op, a) => {
                self.refuse_constants(id, &[a])?;
                self.unary(id, op, a)
            }
            Node::Binary(Binary::Hash, state, x) => {
                self.refuse_constants(id, &[state, x])?;
                self.hash(id, state, x)
            }
            Node::Binary(op, a, b) => {
                self.refuse_constants(id, &[a, b])?;
                self.binary(id, op, a, b)
            }
            Node::Ternary(op, arguments) => {
                self.refuse_constants(id, &arguments)?;
                self.ternary(id, op, arguments)
            }
            Node::Splat(ty, a) => {
                let size = types::vector_size(ty).ok_or(Error::IllTyped(id))?;
                let value = self.value(a)?;
                Ok(self.body.compute(Expression::Splat { size, value }, &[value]))
            }
            Node::Compose(ty, parts) => {
                let mut components = Vec::with_capacity(ty.width());
                for &part in &parts[..ty.width()] {
                    components.push(self.value(part)?);
                }
                Ok(self.compose(ty, components))
            }
            Node::Swizzle(ty, a, lanes) => self.swizzle(id, ty, a, lanes),
            Node::Transform(columns, v) => self.transform(id, columns, v),
            Node::Variable(depth, variable, _) => self.variable(id, depth, variable),
            Node::Loop(repeated, position, _) => self.after_loop(repeated, position),
            Node::Element(table, at, ty) => self.element(table, at, ty),
        }
    }

    /// Refuses operations on constants alone, which the graph folds: validators of WGSL evaluate
    /// them and refuse those without a finite result.
    fn refuse_constants(&self, id: NodeId, arguments: &[NodeId]) -> Result<(), Error> {
        let constant = |&a: &NodeId| matches!(self.program.graph.node(a), Node::Const(_));
        if arguments.iter().all(constant) { Err(Error::NotFolded(id)) } else { Ok(()) }
    }

    fn constant(&mut self, id: NodeId, constant: Const) -> Result<Value, Error> {
        let ty = constant.ty();
        if ty == Type::Bool {
            let literal = Literal::Bool(constant.lanes()[0] != 0.0);
            return Ok(self.body.declare(Expression::Literal(literal)));
        }
        let lanes = &constant.lanes()[..ty.width()];
        let mut literals = Vec::with_capacity(lanes.len());
        for &lane in lanes {
            literals.push(self.number(id, lane)?);
        }
        let first = literals[0];
        Ok(match types::vector_size(ty) {
            None => first,
            Some(size) if literals.iter().all(|&literal| literal == first) => {
                self.body.compute(Expression::Splat { size, value: first }, &[])
            }
            Some(_) => self.compose(ty, literals),
        })
    }

    /// A number, rounded to 32 bits. Shader languages have no infinite literals, so the bounds of a
    /// shape without an end become [`FARTHEST`].
    pub(super) fn number(&mut self, node: NodeId, value: f64) -> Result<Value, Error> {
        let rounded = value as f32;
        let rounded = if value.is_infinite() { FARTHEST.copysign(rounded) } else { rounded };
        if !rounded.is_finite() {
            return Err(Error::NotFinite { node, value });
        }
        Ok(self.body.literal(rounded))
    }

    pub(super) fn compose(&mut self, ty: Type, components: Vec<Value>) -> Value {
        let ty = types::value(self.types, ty);
        let operands = components.clone();
        self.body.compute(Expression::Compose { ty, components }, &operands)
    }

    fn swizzle(&mut self, id: NodeId, ty: Type, a: NodeId, lanes: [u8; 4]) -> Result<Value, Error> {
        let width = self.program.graph.ty(a).width();
        if lanes[..ty.width()].iter().any(|&lane| usize::from(lane) >= width) {
            return Err(Error::BadLane(id));
        }
        let vector = self.value(a)?;
        let Some(size) = types::vector_size(ty) else {
            if width == 1 {
                return Ok(vector);
            }
            let index = u32::from(lanes[0]);
            return Ok(self
                .body
                .compute(Expression::AccessIndex { base: vector, index }, &[vector]));
        };
        if width == 1 {
            return Ok(self.body.compute(Expression::Splat { size, value: vector }, &[vector]));
        }
        let pattern = lanes.map(|lane| SwizzleComponent::XYZW[usize::from(lane) % 4]);
        Ok(self.body.compute(Expression::Swizzle { size, vector, pattern }, &[vector]))
    }

    fn transform(&mut self, id: NodeId, columns: [NodeId; 3], v: NodeId) -> Result<Value, Error> {
        if columns.iter().chain([&v]).any(|&part| self.program.graph.ty(part) != Type::Vec3) {
            return Err(Error::IllTyped(id));
        }
        let matrix = match self.matrices.get(&columns) {
            Some(&matrix) => matrix,
            None => {
                let [a, b, c] = columns;
                let components = vec![self.value(a)?, self.value(b)?, self.value(c)?];
                let ty = types::matrix(self.types);
                let operands = components.clone();
                let matrix = self.body.compute(Expression::Compose { ty, components }, &operands);
                self.body.name(matrix, "m");
                self.matrices.insert(columns, matrix);
                matrix
            }
        };
        let v = self.value(v)?;
        Ok(self.body.binary(BinaryOperator::Multiply, matrix, v))
    }

    fn finish(self, name: &str, value: Value, result: Handle<naga::Type>) -> Function {
        let point = types::value(self.types, self.program.dim().point_type());
        let arguments = self.arguments;
        let mut function = self.body.finish(Some(value));
        function.name = Some(name.to_owned());
        let argument = |&name: &&str| {
            let name = Some(name.to_owned());
            FunctionArgument { name, ty: point, binding: None }
        };
        function.arguments = arguments.iter().map(argument).collect();
        function.result = Some(FunctionResult { ty: result, binding: None });
        function
    }
}

/// The name of a value that the program does not name.
pub(super) fn hint(ty: Type) -> &'static str {
    match ty {
        Type::Bool => "b",
        Type::Scalar => "s",
        Type::Vec2 | Type::Vec3 | Type::Vec4 => "v",
    }
}
