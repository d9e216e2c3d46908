//! Lists of constants that a program looks up.

use std::collections::hash_map::Entry;
use std::num::NonZeroU32;

use naga::{
    AddressSpace, ArraySize, Expression, GlobalVariable, Handle, Literal, MemoryDecorations,
    Module, Span, TypeInner,
};
use rustc_hash::FxHashMap;
use sdfc_graph::{Const, Node, NodeId, Program, Table, TableId, Type, reachable};

use crate::{Error, types};

/// The global variables that hold a program's lists.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    of: FxHashMap<TableId, (Handle<GlobalVariable>, u32)>,
}

impl Tables {
    /// Declares those that the roots look up, unless that was done.
    pub(crate) fn declare(
        &mut self,
        module: &mut Module,
        program: &Program,
        roots: &[NodeId],
    ) -> Result<(), Error> {
        for node in reachable(&program.graph, roots) {
            let Node::Element(id, ..) = program.graph.node(node) else { continue };
            if let Entry::Vacant(place) = self.of.entry(id) {
                let table = program.graph.table(id);
                let variable = declare(module, table, node)?;
                place.insert((variable, table.elements.len().saturating_sub(1) as u32));
            }
        }
        Ok(())
    }

    /// The variable and the position of its last element.
    pub(crate) fn get(&self, id: TableId) -> Option<(Handle<GlobalVariable>, u32)> {
        self.of.get(&id).copied()
    }
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

fn constant(
    module: &mut Module,
    element: &Const,
    node: NodeId,
) -> Result<Handle<Expression>, Error> {
    let mut components = Vec::new();
    for &value in &element.lanes()[..element.ty().width()] {
        let rounded = value as f32;
        if !rounded.is_finite() {
            return Err(Error::NotFinite { node, value });
        }
        let literal = Expression::Literal(Literal::F32(rounded));
        components.push(module.global_expressions.append(literal, Span::UNDEFINED));
    }
    if let [number] = components[..] {
        return Ok(number);
    }
    let ty = types::value(&mut module.types, element.ty());
    let vector = Expression::Compose { ty, components };
    Ok(module.global_expressions.append(vector, Span::UNDEFINED))
}
