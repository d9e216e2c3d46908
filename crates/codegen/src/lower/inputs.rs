//! The inputs of functions besides the point: uniforms, raw or computed per frame, and lists.

use std::num::NonZeroU32;

use naga::{
    AddressSpace, ArraySize, BinaryOperator, Constant, Expression, GlobalVariable, Handle, Literal,
    Module, ResourceBinding, Scalar, Span, Statement, StructMember, SwizzleComponent, TypeInner,
    VectorSize,
};
use rustc_hash::FxHashMap;
use sdfc_graph::{FrameInput, Node, NodeId, Program, Type, reachable};

use super::active_lists::ActiveLists;
use super::body::Body;
use super::tables::Tables;
use super::types;
use crate::reflection::Member;

/// The locations of the per-frame values that a function reads.
#[derive(Debug, Default)]
pub(crate) struct Inputs {
    /// The uniform buffer that holds them.
    pub(crate) buffer: Option<Handle<GlobalVariable>>,
    /// The location of each raw input.
    raw: FxHashMap<FrameInput, Raw>,
    /// The private variable of each uniform slot's node.
    slots: FxHashMap<NodeId, Handle<GlobalVariable>>,
    /// Lists of constants.
    pub(crate) tables: Tables,
    /// The lists of iterations that loops run; `None` runs all.
    pub(crate) active_lists: Option<ActiveLists>,
    /// A variable that is greater than the number of iterations of any loop, so that drivers do not
    /// know that number; `None` if loops have constant limits.
    pub(crate) loop_limit: Option<Handle<GlobalVariable>>,
}

/// The location of a raw input.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Raw {
    /// A member of a uniform structure.
    Member {
        /// The structure.
        structure: Handle<GlobalVariable>,
        /// Which member.
        index: u32,
        /// Its type in the scene.
        ty: Type,
    },
    /// A constant of the module.
    Constant(Handle<Constant>),
    /// A private variable that the shader sets itself.
    Variable(Handle<GlobalVariable>),
}

impl Inputs {
    /// Inputs with raw inputs alone.
    pub(crate) fn of_raw(raw: FxHashMap<FrameInput, Raw>) -> Self {
        Self { raw, ..Self::default() }
    }

    /// The same inputs, with these nodes read from private variables.
    pub(crate) fn with_slots(self, slots: FxHashMap<NodeId, Handle<GlobalVariable>>) -> Self {
        Self { slots, ..self }
    }

    /// Reads the input into a named value; `None` if it is not among these.
    pub(crate) fn read_raw(
        &self,
        body: &mut Body,
        input: FrameInput,
        name: &str,
    ) -> Option<Handle<Expression>> {
        match *self.raw.get(&input)? {
            Raw::Member { structure, index, ty } => {
                let base = body.declare(Expression::GlobalVariable(structure));
                let pointer = body.compute(Expression::AccessIndex { base, index }, &[base]);
                let load = body.compute(Expression::Load { pointer }, &[pointer]);
                let value = if ty == Type::Bool {
                    let zero = body.declare(Expression::Literal(Literal::U32(0)));
                    body.binary(BinaryOperator::NotEqual, load, zero)
                } else {
                    load
                };
                body.name(value, name);
                Some(value)
            }
            Raw::Constant(constant) => Some(body.declare(Expression::Constant(constant))),
            Raw::Variable(variable) => {
                let pointer = body.declare(Expression::GlobalVariable(variable));
                let load = body.compute(Expression::Load { pointer }, &[]);
                body.name(load, name);
                Some(load)
            }
        }
    }

    /// Reads a node's private variable; `None` if it has none.
    pub(crate) fn read_slot(&self, body: &mut Body, node: NodeId) -> Option<Handle<Expression>> {
        let pointer = body.declare(Expression::GlobalVariable(*self.slots.get(&node)?));
        Some(body.compute(Expression::Load { pointer }, &[]))
    }

    /// Returns true if the node is an input that is a constant of the module.
    pub(crate) fn is_constant(&self, node: Node) -> bool {
        let Node::Frame(input, _) = node else { return false };
        matches!(self.raw.get(&input), Some(Raw::Constant(_)))
    }

    /// Returns true if the node is computed outside the function.
    pub(crate) fn is_slot(&self, node: NodeId) -> bool {
        self.slots.contains_key(&node)
    }
}

/// The raw inputs that nodes need: params by position, then `time`, then `frame`.
pub(crate) fn raw_inputs(program: &Program, roots: &[NodeId]) -> Vec<(FrameInput, Type)> {
    let nodes = reachable(&program.graph, roots);
    let mut inputs: Vec<_> = nodes
        .into_iter()
        .filter_map(|id| {
            let Node::Frame(input, ty) = program.graph.node(id) else { return None };
            Some((input, ty))
        })
        .collect();
    inputs.sort_unstable();
    inputs.dedup_by_key(|(input, _)| *input);
    inputs
}

/// The name of an input in shaders: its name in the scene, with `_` for what is not a letter, digit
/// or `_`, as in `storey_width` for `storey.width`. naga makes equal names different, by a number.
pub(crate) fn input_name(program: &Program, input: FrameInput) -> String {
    let name = match input {
        FrameInput::Param(index) => {
            program.params.get(index as usize).map_or("param", |param| param.name.as_str())
        }
        FrameInput::Time => "time",
        FrameInput::Frame => "frame",
    };
    name.replace(|c: char| !c.is_ascii_alphanumeric() && c != '_', "_")
}

/// Declares the uniform structure `Params` of these inputs, in this order.
pub(crate) fn declare_members(
    module: &mut Module,
    program: &Program,
    inputs: &[(FrameInput, Type)],
    binding: ResourceBinding,
) -> (Inputs, Vec<Member>) {
    if inputs.is_empty() {
        return (Inputs::default(), Vec::new());
    }
    let mut offset = 0u32;
    let mut structure_alignment = 4;
    let (mut members, mut described) = (Vec::new(), Vec::new());
    for &(input, ty) in inputs {
        let (size, alignment) = layout(ty);
        offset = offset.next_multiple_of(alignment);
        structure_alignment = structure_alignment.max(alignment);
        let member_type = match ty {
            // Booleans have no layout in buffers.
            Type::Bool => types::add(&mut module.types, TypeInner::Scalar(Scalar::U32)),
            Type::Scalar | Type::Vec2 | Type::Vec3 | Type::Vec4 => {
                types::value(&mut module.types, ty)
            }
        };
        let name = input_name(program, input);
        described.push(Member { input, name: name.clone(), ty, offset, size });
        members.push(StructMember { name: Some(name), ty: member_type, binding: None, offset });
        offset += size;
    }
    let span = offset.next_multiple_of(structure_alignment);
    let structure =
        naga::Type { name: Some("Params".to_owned()), inner: TypeInner::Struct { members, span } };
    let ty = module.types.insert(structure, Span::UNDEFINED);
    let structure = declare(module, "params", AddressSpace::Uniform, ty, Some(binding));
    let raw = inputs.iter().zip(0..);
    let raw = raw.map(|(&(input, ty), index)| (input, Raw::Member { structure, index, ty }));
    (Inputs { buffer: Some(structure), ..Inputs::of_raw(raw.collect()) }, described)
}

/// Size and alignment in a uniform structure, in bytes.
fn layout(ty: Type) -> (u32, u32) {
    match ty {
        Type::Bool | Type::Scalar => (4, 4),
        Type::Vec2 => (8, 8),
        Type::Vec3 => (12, 16),
        Type::Vec4 => (16, 16),
    }
}

/// Declares the buffer of uniform slots and a private variable for each slot in use, and makes the
/// function body that copies one to the other. `used` are indices in `Program::uniforms`.
pub(crate) fn declare_slots(
    module: &mut Module,
    program: &Program,
    used: &[usize],
    binding: ResourceBinding,
) -> (Inputs, Option<naga::Function>) {
    let count = u32::try_from(program.uniforms.len()).ok().and_then(NonZeroU32::new);
    let Some(count) = count.filter(|_| !used.is_empty()) else {
        return (Inputs::default(), None);
    };
    let base = types::value(&mut module.types, Type::Vec4);
    let size = ArraySize::Constant(count);
    let array = types::add(&mut module.types, TypeInner::Array { base, size, stride: 16 });
    let buffer = declare(module, "frame_slots", AddressSpace::Uniform, array, Some(binding));

    let mut body = Body::default();
    let mut variables = FxHashMap::default();
    for &slot in used {
        let node = program.uniforms[slot];
        let variable = declare_variable(module, program, node);
        copy_slot(&mut body, buffer, slot, program.graph.ty(node), variable);
        variables.insert(node, variable);
    }
    let inputs = Inputs { buffer: Some(buffer), ..Inputs::default() };
    (inputs.with_slots(variables), Some(body.finish(None)))
}

/// Declares the private variable of a per-frame node.
pub(crate) fn declare_variable(
    module: &mut Module,
    program: &Program,
    node: NodeId,
) -> Handle<GlobalVariable> {
    let ty = types::value(&mut module.types, program.graph.ty(node));
    let name = format!("frame_{}", frame_name(program, node));
    declare(module, &name, AddressSpace::Private, ty, None)
}

/// The name of a per-frame value in the scene.
pub(crate) fn frame_name(program: &Program, node: NodeId) -> String {
    match (program.names.get(&node), program.graph.node(node)) {
        (Some(name), _) => name.clone(),
        (None, Node::Frame(input, _)) => input_name(program, input),
        (None, _) => "value".to_owned(),
    }
}

/// `variable = buffer[slot]`, cut to the type's width.
fn copy_slot(
    body: &mut Body,
    buffer: Handle<GlobalVariable>,
    slot: usize,
    ty: Type,
    variable: Handle<GlobalVariable>,
) {
    let base = body.declare(Expression::GlobalVariable(buffer));
    let index = slot as u32;
    let element = body.compute(Expression::AccessIndex { base, index }, &[base]);
    let first = |body: &mut Body| {
        let pointer = Expression::AccessIndex { base: element, index: 0 };
        let pointer = body.compute(pointer, &[element]);
        body.compute(Expression::Load { pointer }, &[pointer])
    };
    let cut = |body: &mut Body, size: VectorSize| {
        let vector = body.compute(Expression::Load { pointer: element }, &[element]);
        body.compute(
            Expression::Swizzle { size, vector, pattern: SwizzleComponent::XYZW },
            &[vector],
        )
    };
    let value = match ty {
        Type::Bool => {
            let number = first(body);
            let zero = body.literal(0.0);
            body.binary(BinaryOperator::NotEqual, number, zero)
        }
        Type::Scalar => first(body),
        Type::Vec2 => cut(body, VectorSize::Bi),
        Type::Vec3 => cut(body, VectorSize::Tri),
        Type::Vec4 => body.compute(Expression::Load { pointer: element }, &[element]),
    };
    let pointer = body.declare(Expression::GlobalVariable(variable));
    body.push(Statement::Store { pointer, value });
}

fn declare(
    module: &mut Module,
    name: &str,
    space: AddressSpace,
    ty: Handle<naga::Type>,
    binding: Option<ResourceBinding>,
) -> Handle<GlobalVariable> {
    let variable = GlobalVariable {
        name: Some(name.to_owned()),
        space,
        binding,
        ty,
        init: None,
        memory_decorations: naga::MemoryDecorations::empty(),
    };
    module.global_variables.append(variable, Span::UNDEFINED)
}
