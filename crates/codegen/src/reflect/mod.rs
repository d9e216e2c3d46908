//! Reads what a shader offers to a host off its module and its written source.

mod text;

use naga::proc::NameKey;
use naga::{
    AddressSpace, ArraySize, GlobalVariable, Handle, Module, Scalar, StorageAccess, TypeInner,
};

use crate::names::{Names, final_names};
use crate::reflection::{
    Buffer, BufferRole, Entry, EntryStage, FunctionInfo, ModuleParts, Reflection, Structure,
    StructureMember, Uniform,
};
use crate::target::Code;
use crate::write::WrittenModule;

/// Describes a module with its names in WGSL.
pub(crate) fn reflect(module: &Module, parts: &ModuleParts) -> Reflection {
    describe(module, parts, &final_names(module))
}

/// Describes a module with the names that a writer gave.
pub(crate) fn reflect_written(
    module: &Module,
    parts: &ModuleParts,
    written: &WrittenModule,
) -> Reflection {
    let mut reflection = describe(module, parts, &text::written_names(module, &written.code));
    if let Code::Text(text) = &written.code {
        for function in &mut reflection.functions {
            if let Some((name, signature)) = text::declaration(text, &function.name) {
                *function = FunctionInfo { role: function.role, name, signature };
            }
        }
    }
    let block = |handle: Option<Handle<GlobalVariable>>| {
        let block = written.blocks.iter().find(|(known, _)| Some(*known) == handle);
        block.map(|(_, name)| name.clone())
    };
    if let Some(uniform) = &mut reflection.uniform {
        uniform.block = block(parts.uniform);
    }
    for (buffer, (handle, _)) in reflection.buffers.iter_mut().zip(buffers(module, parts)) {
        buffer.block = block(Some(handle));
    }
    if let Some(entries) = &written.entries {
        reflection.entries.clone_from(entries);
    }
    reflection
}

fn describe(module: &Module, parts: &ModuleParts, names: &Names) -> Reflection {
    let name = |key: NameKey| names.get(&key).cloned().unwrap_or_default();
    let mut reflection = Reflection { members: parts.members.clone(), ..Default::default() };
    let mut structures = Vec::new();
    for &(role, handle) in &parts.functions {
        let function = &module.functions[handle];
        let function_name = name(NameKey::Function(handle));
        let mut arguments = Vec::new();
        for (argument, index) in function.arguments.iter().zip(0..) {
            add_structures(module, argument.ty, &mut structures);
            let argument_name = name(NameKey::FunctionArgument(handle, index));
            arguments.push(format!("{argument_name}: {}", type_name(module, names, argument.ty)));
        }
        let result = function.result.as_ref().map_or_else(String::new, |result| {
            add_structures(module, result.ty, &mut structures);
            type_name(module, names, result.ty)
        });
        let signature = format!("fn {function_name}({}) -> {result}", arguments.join(", "));
        reflection.functions.push(FunctionInfo { role, name: function_name, signature });
    }
    if let Some(handle) = parts.uniform {
        let variable = &module.global_variables[handle];
        for (member, index) in reflection.members.iter_mut().zip(0..) {
            member.name = name(NameKey::StructMember(variable.ty, index));
        }
        let binding = variable.binding.unwrap_or(naga::ResourceBinding { group: 0, binding: 0 });
        reflection.uniform = Some(Uniform {
            structure: parts.members.first().map(|_| name(NameKey::Type(variable.ty))),
            variable: name(NameKey::GlobalVariable(handle)),
            group: binding.group,
            binding: binding.binding,
            size: buffer_size(module, variable.space, variable.ty),
            block: None,
        });
    }
    for (handle, role) in buffers(module, parts) {
        add_structures(module, module.global_variables[handle].ty, &mut structures);
        reflection.buffers.push(buffer(module, names, handle, role));
    }
    reflection.lists = parts.lists.as_ref().map_or_else(Vec::new, |(_, lists)| lists.clone());
    reflection.structures =
        structures.into_iter().filter_map(|ty| structure(module, names, ty)).collect();
    reflection.entries = module
        .entry_points
        .iter()
        .zip(0..)
        .map(|(entry, index)| Entry {
            stage: EntryStage::of(entry.stage),
            name: name(NameKey::EntryPoint(index)),
        })
        .collect();
    reflection
}

/// The buffers that a host binds, and their roles.
fn buffers<'a>(
    module: &'a Module,
    parts: &'a ModuleParts,
) -> impl Iterator<Item = (Handle<GlobalVariable>, BufferRole)> + 'a {
    module.global_variables.iter().filter_map(|(handle, variable)| {
        variable.binding?;
        let is_written = variable.space
            == AddressSpace::Storage { access: StorageAccess::LOAD | StorageAccess::STORE };
        let role = if Some(handle) == parts.uniform {
            BufferRole::Params
        } else if parts.lists.as_ref().is_some_and(|(lists, _)| *lists == handle) {
            BufferRole::Lists
        } else if variable.space == AddressSpace::Uniform {
            BufferRole::View
        } else if is_written {
            BufferRole::Pixels
        } else {
            return None;
        };
        Some((handle, role))
    })
}

fn buffer(
    module: &Module,
    names: &Names,
    handle: Handle<GlobalVariable>,
    role: BufferRole,
) -> Buffer {
    let variable = &module.global_variables[handle];
    let binding = variable.binding.unwrap_or(naga::ResourceBinding { group: 0, binding: 0 });
    let (mut ty, mut is_array) = (variable.ty, false);
    if let TypeInner::Array { base, size: ArraySize::Dynamic, .. } = module.types[ty].inner {
        (ty, is_array) = (base, true);
    }
    Buffer {
        role,
        variable: names.get(&NameKey::GlobalVariable(handle)).cloned().unwrap_or_default(),
        ty: type_name(module, names, ty),
        is_array,
        group: binding.group,
        binding: binding.binding,
        size: buffer_size(module, variable.space, ty),
        block: None,
    }
}

/// Bytes of a buffer that holds a value. A uniform block of GLSL, or a constant buffer of HLSL,
/// ends at a multiple of 16 bytes, and the bound buffer may not be shorter.
fn buffer_size(module: &Module, space: AddressSpace, ty: Handle<naga::Type>) -> u32 {
    let size = module.types[ty].inner.size(module.to_ctx());
    if space == AddressSpace::Uniform { size.next_multiple_of(16) } else { size }
}

/// Adds the structures in a type, each once; a structure follows those that it contains. Types nest
/// only as deep as `sdfc-march` declares them.
fn add_structures(module: &Module, ty: Handle<naga::Type>, found: &mut Vec<Handle<naga::Type>>) {
    if let TypeInner::Array { base, .. } = module.types[ty].inner {
        add_structures(module, base, found);
    }
    if let TypeInner::Struct { members, .. } = &module.types[ty].inner
        && !found.contains(&ty)
    {
        members.iter().for_each(|member| add_structures(module, member.ty, found));
        found.push(ty);
    }
}

fn structure(module: &Module, names: &Names, ty: Handle<naga::Type>) -> Option<Structure> {
    let TypeInner::Struct { members, span } = &module.types[ty].inner else { return None };
    let name = |key: NameKey| names.get(&key).cloned().unwrap_or_default();
    let members = members.iter().zip(0..).map(|(member, index)| StructureMember {
        name: name(NameKey::StructMember(ty, index)),
        ty: type_name(module, names, member.ty),
        offset: member.offset,
    });
    Some(Structure { name: name(NameKey::Type(ty)), size: *span, members: members.collect() })
}

/// The name of a type in WGSL. Neither the structures of `sdfc-march` nor params contain other
/// types than these.
fn type_name(module: &Module, names: &Names, ty: Handle<naga::Type>) -> String {
    let inner = &module.types[ty].inner;
    if let TypeInner::Scalar(scalar) = inner {
        scalar_name(*scalar).to_owned()
    } else if let TypeInner::Vector { size, scalar } = inner {
        format!("vec{}<{}>", *size as u8, scalar_name(*scalar))
    } else if let TypeInner::Array { base, size: ArraySize::Constant(count), .. } = inner {
        format!("array<{}, {count}>", type_name(module, names, *base))
    } else {
        names.get(&NameKey::Type(ty)).cloned().unwrap_or_default()
    }
}

fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::U32 => "u32",
        Scalar::I32 => "i32",
        Scalar::BOOL => "bool",
        _ => "f32",
    }
}
