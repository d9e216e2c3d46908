//! What functions read besides the point: uniforms, raw or computed per frame.

use std::num::NonZeroU32;

use naga::{
    AddressSpace, ArraySize, BinaryOperator, Expression, GlobalVariable, Handle, Literal, Module,
    ResourceBinding, Scalar, Span, Statement, StructMember, SwizzleComponent, TypeInner,
    VectorSize,
};
use rustc_hash::FxHashMap;
use sdfc_graph::{FrameInput, NodeId, Program, Type};

use crate::lower::Body;
use crate::reflect::Member;
use crate::types;

/// Where a function finds what is known per frame.
#[derive(Debug, Default)]
pub(crate) enum Inputs {
    /// Nothing is known per frame.
    #[default]
    None,
    /// Raw inputs are members of one uniform structure.
    Members {
        /// The structure.
        global: Handle<GlobalVariable>,
        /// Index and type of each input's member.
        members: FxHashMap<FrameInput, (u32, Type)>,
    },
    /// Values computed per frame wait in private variables, copied from a buffer.
    Slots {
        /// The buffer.
        buffer: Handle<GlobalVariable>,
        /// Each node's private variable.
        variables: FxHashMap<NodeId, Handle<GlobalVariable>>,
    },
}

impl Inputs {
    /// Reads the input into a named value; `None` where it is not among these.
    pub(crate) fn read_member(
        &self,
        body: &mut Body,
        input: FrameInput,
        name: &str,
    ) -> Option<Handle<Expression>> {
        let Self::Members { global, members } = self else { return None };
        let &(index, ty) = members.get(&input)?;
        let base = body.declare(Expression::GlobalVariable(*global));
        let pointer = body.compute(Expression::AccessIndex { base, index }, &[base]);
        let load = body.compute(Expression::Load { pointer }, &[pointer]);
        if ty != Type::Bool {
            body.name(load, name);
            return Some(load);
        }
        let zero = body.declare(Expression::Literal(Literal::U32(0)));
        let truth = body.binary(BinaryOperator::NotEqual, load, zero);
        body.name(truth, name);
        Some(truth)
    }

    /// Reads a node's private variable; `None` where it has none.
    pub(crate) fn read_slot(&self, body: &mut Body, node: NodeId) -> Option<Handle<Expression>> {
        let Self::Slots { variables, .. } = self else { return None };
        let pointer = body.declare(Expression::GlobalVariable(*variables.get(&node)?));
        Some(body.compute(Expression::Load { pointer }, &[]))
    }

    /// The uniform buffer behind the inputs.
    pub(crate) fn buffer(&self) -> Option<Handle<GlobalVariable>> {
        match self {
            Self::None => None,
            Self::Members { global, .. } => Some(*global),
            Self::Slots { buffer, .. } => Some(*buffer),
        }
    }

    /// Whether the node is computed outside the shader.
    pub(crate) fn is_slot(&self, node: NodeId) -> bool {
        matches!(self, Self::Slots { variables, .. } if variables.contains_key(&node))
    }
}

/// What a scene calls an input.
pub(crate) fn input_name(program: &Program, input: FrameInput) -> &str {
    match input {
        FrameInput::Param(index) => {
            program.params.get(index as usize).map_or("param", |param| param.name.as_str())
        }
        FrameInput::Time => "time",
        FrameInput::Frame => "frame",
    }
}

/// Declares the uniform structure of these inputs, in this order.
pub(crate) fn declare_members(
    module: &mut Module,
    program: &Program,
    inputs: &[(FrameInput, Type)],
    prefix: &str,
    binding: ResourceBinding,
) -> (Inputs, Vec<Member>) {
    if inputs.is_empty() {
        return (Inputs::None, Vec::new());
    }
    let mut offset = 0u32;
    let mut structure_alignment = 4;
    let (mut members, mut described) = (Vec::new(), Vec::new());
    for &(input, ty) in inputs {
        let (size, alignment) = layout(ty);
        offset = offset.next_multiple_of(alignment);
        structure_alignment = structure_alignment.max(alignment);
        let member_type = match ty {
            // Truth values have no layout in buffers.
            Type::Bool => types::add(&mut module.types, TypeInner::Scalar(Scalar::U32)),
            Type::Scalar | Type::Vec2 | Type::Vec3 | Type::Vec4 => {
                types::value(&mut module.types, ty)
            }
        };
        let name = input_name(program, input).to_owned();
        described.push(Member { input, name: name.clone(), ty, offset, size });
        members.push(StructMember { name: Some(name), ty: member_type, binding: None, offset });
        offset += size;
    }
    let span = offset.next_multiple_of(structure_alignment);
    let structure = naga::Type {
        name: Some(format!("{prefix}Params")),
        inner: TypeInner::Struct { members, span },
    };
    let ty = module.types.insert(structure, Span::UNDEFINED);
    let global = declare(module, &format!("{prefix}params"), AddressSpace::Uniform, ty, binding);
    let places = inputs.iter().zip(0..).map(|(&(input, ty), index)| (input, (index, ty))).collect();
    (Inputs::Members { global, members: places }, described)
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

/// Declares the slot buffer and a private variable for each slot in use, and the function body that
/// copies one to the other. `used` are positions in `Program::uniforms`.
pub(crate) fn declare_slots(
    module: &mut Module,
    program: &Program,
    used: &[usize],
    binding: ResourceBinding,
) -> (Inputs, Option<naga::Function>) {
    let count = u32::try_from(program.uniforms.len()).ok().and_then(NonZeroU32::new);
    let Some(count) = count.filter(|_| !used.is_empty()) else {
        return (Inputs::None, None);
    };
    let base = types::value(&mut module.types, Type::Vec4);
    let size = ArraySize::Constant(count);
    let array = types::add(&mut module.types, TypeInner::Array { base, size, stride: 16 });
    let buffer = declare(module, "frame_slots", AddressSpace::Uniform, array, binding);

    let mut body = Body::default();
    let mut variables = FxHashMap::default();
    for &slot in used {
        let node = program.uniforms[slot];
        let ty = program.graph.ty(node);
        let ty_handle = types::value(&mut module.types, ty);
        let variable = GlobalVariable {
            name: Some(format!("frame_{}", frame_name(program, node))),
            space: AddressSpace::Private,
            binding: None,
            ty: ty_handle,
            init: None,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        let variable = module.global_variables.append(variable, Span::UNDEFINED);
        copy_slot(&mut body, buffer, slot, ty, variable);
        variables.insert(node, variable);
    }
    (Inputs::Slots { buffer, variables }, Some(body.finish(None)))
}

/// What a scene calls a value that is known per frame.
pub(crate) fn frame_name(program: &Program, node: NodeId) -> &str {
    match (program.names.get(&node), program.graph.node(node)) {
        (Some(name), _) => name,
        (None, sdfc_graph::Node::Frame(input, _)) => input_name(program, input),
        (None, _) => "value",
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
    binding: ResourceBinding,
) -> Handle<GlobalVariable> {
    let variable = GlobalVariable {
        name: Some(name.to_owned()),
        space,
        binding: Some(binding),
        ty,
        init: None,
        memory_decorations: naga::MemoryDecorations::empty(),
    };
    module.global_variables.append(variable, Span::UNDEFINED)
}
