//! Lists of constants that a program looks up.
//!
//! A shader may hold a list itself, as a constant, or read it from a buffer that holds all its long
//! lists one after the other. Drivers take long over constants; `docs/benchmarks.md` has
//! measurements.

use std::num::NonZeroU32;

use naga::{
    AddressSpace, ArraySize, Expression, GlobalVariable, Handle, Literal, MemoryDecorations,
    Module, ResourceBinding, Span, StorageAccess, TypeInner,
};
use rustc_hash::FxHashMap;
use sdfc_graph::{Const, Node, NodeId, Program, Table, TableId, Type, reachable};

use super::types;
use crate::error::Error;
use crate::options::{Lists, MAX_CONSTANT_LIST};

/// The storage of a program's lists.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    of: FxHashMap<TableId, List>,
    /// The binding of the buffer, and the minimum length of a list that is stored in it.
    binding: Option<(ResourceBinding, usize)>,
    buffer: Option<Handle<GlobalVariable>>,
    contents: Vec<[f32; 4]>,
}

/// The storage of a list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct List {
    /// An array of the elements' type, or the buffer.
    pub(crate) variable: Handle<GlobalVariable>,
    /// The index of its first element in the buffer, which has four lanes per element; `None` if
    /// the list is a variable of its own.
    pub(crate) first: Option<u32>,
    /// The index of its last element.
    pub(crate) last: u32,
}

impl Tables {
    /// Stores all lists in a storage buffer at this binding.
    pub(crate) fn in_buffer(binding: ResourceBinding) -> Self {
        Self { binding: Some((binding, 0)), ..Self::default() }
    }

    /// Stores long lists in a storage buffer at this binding, or none.
    pub(crate) fn new(lists: Lists, binding: ResourceBinding) -> Self {
        match lists {
            Lists::Buffer => {
                Self { binding: Some((binding, MAX_CONSTANT_LIST + 1)), ..Self::default() }
            }
            Lists::Constants => Self::default(),
        }
    }

    /// Declares the lists that the roots look up, unless they are declared already.
    pub(crate) fn declare(
        &mut self,
        module: &mut Module,
        program: &Program,
        roots: &[NodeId],
    ) -> Result<(), Error> {
        let graph = &program.graph;
        let mut looked_up = Vec::new();
        for node in reachable(graph, roots) {
            let Node::Element(id, ..) = graph.node(node) else { continue };
            if !self.of.contains_key(&id) && !looked_up.iter().any(|&(known, _)| known == id) {
                looked_up.push((id, node));
            }
        }
        // If there is a buffer anyway, short lists are stored in it too.
        let length = |id| graph.table(id).elements.len();
        let is_long = |least| looked_up.iter().any(|&(id, _)| length(id) >= least);
        let binding = self.binding.filter(|&(_, least)| self.buffer.is_some() || is_long(least));
        for (id, node) in looked_up {
            let table = graph.table(id);
            let last = table.elements.len().saturating_sub(1) as u32;
            let list = match binding {
                Some((binding, _)) => {
                    let variable =
                        *self.buffer.get_or_insert_with(|| declare_buffer(module, binding));
                    let first = Some(self.contents.len() as u32);
                    for element in &table.elements {
                        self.contents.push(rounded(element, node)?);
                    }
                    List { variable, first, last }
                }
                None => List { variable: declare(module, table, node)?, first: None, last },
            };
            self.of.insert(id, list);
        }
        self.resize_buffer(module);
        Ok(())
    }

    /// Sets the length of the buffer's type to that of its contents.
    fn resize_buffer(&self, module: &mut Module) {
        let size = u32::try_from(self.contents.len()).ok().and_then(NonZeroU32::new);
        let (Some(buffer), Some(size)) = (self.buffer, size) else { return };
        let base = types::value(&mut module.types, Type::Vec4);
        let array = TypeInner::Array { base, size: ArraySize::Constant(size), stride: 16 };
        module.global_variables[buffer].ty = types::add(&mut module.types, array);
    }

    /// The storage of a list.
    pub(crate) fn get(&self, id: TableId) -> Option<List> {
        self.of.get(&id).copied()
    }

    /// The buffer and its contents.
    pub(crate) fn into_buffer(self) -> Option<(Handle<GlobalVariable>, Vec<[f32; 4]>)> {
        Some((self.buffer?, self.contents))
    }
}

fn declare_buffer(module: &mut Module, binding: ResourceBinding) -> Handle<GlobalVariable> {
    let variable = GlobalVariable {
        name: Some("lists".to_owned()),
        space: AddressSpace::Storage { access: StorageAccess::LOAD },
        binding: Some(binding),
        // The type of one element, until their number is known.
        ty: types::value(&mut module.types, Type::Vec4),
        init: None,
        memory_decorations: MemoryDecorations::empty(),
    };
    module.global_variables.append(variable, Span::UNDEFINED)
}

fn declare(
    module: &mut Module,
    table: &Table,
    node: NodeId,
) -> Result<Handle<GlobalVariable>, Error> {
    let elements = table.elements.iter().map(|element| constant(module, element, node));
    let components: Vec<Handle<Expression>> = elements.collect::<Result<_, _>>()?;
    let base = types::value(&mut module.types, table.ty);
    let size = u32::try_from(components.len()).ok().and_then(NonZeroU32::new);
    let size = ArraySize::Constant(size.ok_or(Error::IllTyped(node))?);
    let stride = match table.ty {
        Type::Bool | Type::Scalar => 4,
        Type::Vec2 => 8,
        Type::Vec3 | Type::Vec4 => 16,
    };
    let ty = types::add(&mut module.types, TypeInner::Array { base, size, stride });
    let init = Expression::Compose { ty, components };
    let variable = GlobalVariable {
        name: Some("list".to_owned()),
        space: AddressSpace::Private,
        binding: None,
        ty,
        init: Some(module.global_expressions.append(init, Span::UNDEFINED)),
        memory_decorations: MemoryDecorations::empty(),
    };
    Ok(module.global_variables.append(variable, Span::UNDEFINED))
}

/// The lanes in 32 bits; those beyond the width are 0.
fn rounded(element: &Const, node: NodeId) -> Result<[f32; 4], Error> {
    let mut lanes = [0.0; 4];
    for (lane, &value) in lanes.iter_mut().zip(&element.lanes()[..element.ty().width()]) {
        *lane = value as f32;
        if !lane.is_finite() {
            return Err(Error::NotFinite { node, value });
        }
    }
    Ok(lanes)
}

fn constant(
    module: &mut Module,
    element: &Const,
    node: NodeId,
) -> Result<Handle<Expression>, Error> {
    let ty = element.ty();
    let literal = |value: &f32| match ty {
        Type::Bool => Literal::Bool(*value != 0.0),
        Type::Scalar | Type::Vec2 | Type::Vec3 | Type::Vec4 => Literal::F32(*value),
    };
    let literals: Vec<_> = rounded(element, node)?[..ty.width()].iter().map(literal).collect();
    let append =
        |literal| module.global_expressions.append(Expression::Literal(literal), Span::UNDEFINED);
    let components: Vec<_> = literals.into_iter().map(append).collect();
    if let [number] = components[..] {
        return Ok(number);
    }
    let ty = types::value(&mut module.types, ty);
    let vector = Expression::Compose { ty, components };
    Ok(module.global_expressions.append(vector, Span::UNDEFINED))
}
