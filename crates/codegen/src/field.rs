//! A scene's functions by themselves, for those who embed them.

use naga::{Function, Module, ResourceBinding, Span, StructMember, TypeInner};
use sdfc_graph::{FrameInput, MaterialField, Node, NodeId, Program, Type, reachable};
use sdfc_march::Features;

use crate::inputs::declare_members;
use crate::lower::{struct_function, value_function};
use crate::reflect::{Parts, Role};
use crate::{Error, Shader, types};

/// What a field module holds and how it is named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldOptions {
    /// Start of every name.
    pub prefix: String,
    /// Whether to write the gradient.
    pub gradient: bool,
    /// Whether to write the material, if the program has one.
    pub material: bool,
    /// Bind group of the uniform structure.
    pub group: u32,
    /// Its binding in the group.
    pub binding: u32,
}

impl Default for FieldOptions {
    fn default() -> Self {
        let prefix = "sdf_".to_owned();
        Self { prefix, gradient: true, material: true, group: 0, binding: 0 }
    }
}

/// The functions `<prefix>distance`, `<prefix>gradient` and `<prefix>material` of a program, without
/// an entry point.
///
/// Params, `time` and `frame`, as far as the functions use them, are members of one uniform
/// structure ([`crate::Reflection::members`]); what follows from them is computed in the functions.
///
/// # Errors
///
/// [`Error::BadPrefix`]; [`Error::NothingDrawn`] and [`Error::MissingRoot`] where the program has no
/// distance or lacks the gradient that the options ask for; others where its nodes cannot be lowered.
pub fn field_module(program: &Program, options: &FieldOptions) -> Result<Shader, Error> {
    check_prefix(&options.prefix)?;
    let distance = program.distance.ok_or(Error::NothingDrawn)?;
    let mut roots = vec![(Role::Distance, "distance", distance)];
    if options.gradient {
        let gradient = program.gradient.ok_or(Error::MissingRoot("gradient"))?;
        roots.push((Role::Gradient, "gradient", gradient));
    }
    let material = program.material.filter(|_| options.material);

    let mut module = Module::default();
    let mut nodes: Vec<_> = roots.iter().map(|&(.., root)| root).collect();
    nodes.extend(material.into_iter().flatten());
    let used = used_inputs(program, &nodes);
    let binding = ResourceBinding { group: options.group, binding: options.binding };
    let prefix = options.prefix.as_str();
    let (inputs, members) = declare_members(&mut module, program, &used, prefix, binding);

    let mut parts = Parts { members, uniform: inputs.buffer(), ..Default::default() };
    let mut add = |module: &mut Module, role, function: Function| {
        let handle = module.functions.append(function, Span::UNDEFINED);
        parts.functions.push((role, handle));
    };
    for (role, name, root) in roots {
        let name = format!("{prefix}{name}");
        let function = value_function(program, &inputs, &mut module.types, &name, root)?;
        add(&mut module, role, function);
    }
    if let Some(fields) = material {
        let structure = material_type(&mut module, prefix);
        let (name, types) = (format!("{prefix}material"), &mut module.types);
        let function = struct_function(program, &inputs, types, &name, &fields, structure)?;
        add(&mut module, Role::Material, function);
    }
    Shader::new(module, parts, Features { materials: material.is_some(), ..Features::default() })
}

/// Letters, digits and `_`, no digit first, no `__`: what naga and WGSL both leave as it is.
fn check_prefix(prefix: &str) -> Result<(), Error> {
    let plain = prefix.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let digit_first = prefix.starts_with(|c: char| c.is_ascii_digit());
    if plain && !digit_first && !prefix.contains("__") {
        Ok(())
    } else {
        Err(Error::BadPrefix(prefix.to_owned()))
    }
}

/// The per-frame inputs that the roots need: params by position, then `time`, then `frame`.
fn used_inputs(program: &Program, roots: &[NodeId]) -> Vec<(FrameInput, Type)> {
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

/// A structure with the fields of `MaterialField::ALL` in that order.
fn material_type(module: &mut Module, prefix: &str) -> naga::Handle<naga::Type> {
    let mut offset = 0u32;
    let mut members = Vec::new();
    for field in MaterialField::ALL {
        let (size, alignment) = if field.ty() == Type::Vec3 { (12, 16) } else { (4, 4) };
        offset = offset.next_multiple_of(alignment);
        let ty = types::value(&mut module.types, field.ty());
        let name = Some(material_field_name(field).to_owned());
        members.push(StructMember { name, ty, binding: None, offset });
        offset += size;
    }
    let inner = TypeInner::Struct { members, span: offset.next_multiple_of(16) };
    let name = Some(format!("{prefix}Material"));
    module.types.insert(naga::Type { name, inner }, Span::UNDEFINED)
}

fn material_field_name(field: MaterialField) -> &'static str {
    match field {
        MaterialField::Color => "color",
        MaterialField::Coverage => "coverage",
        MaterialField::Roughness => "roughness",
        MaterialField::Metallic => "metallic",
        MaterialField::Emission => "emission",
        MaterialField::Occlusion => "occlusion",
    }
}
