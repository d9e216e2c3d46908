//! The functions of a scene by themselves, for those who embed them.

use naga::{Function, Handle, Module, ResourceBinding, Span, StructMember, TypeInner};
use sdfc_graph::{FormulaChoice, Graph, MaterialField, NodeId, Program, Type};
use sdfc_march::{Features, Method, MethodDefinition, ray_source, stubs};

use super::bindings::{StubBinding, analytic_bindings, segment_bindings};
use super::template::ray_features;
use crate::error::Error;
use crate::link::template::{bind, find_function, parse_template};
use crate::lower::inputs::{declare_members, raw_inputs};
use crate::lower::tables::Tables;
use crate::lower::{POINT, struct_function, types};
use crate::names::{check_prefix, make_public};
use crate::options::FieldOptions;
use crate::reflection::{ModuleParts, Role};
use crate::shader::Shader;

/// Makes a module of the functions `<prefix>distance`, `<prefix>gradient` and `<prefix>material` of
/// a program, without an entry point. The gradient has the distance in its last lane. In a planar
/// program they are functions of a point in the plane.
///
/// Params, `time` and `frame`, if the functions use them, are members of one uniform structure
/// ([`crate::Reflection::members`]); values that follow from them are computed in the functions.
///
/// # Errors
///
/// [`Error::BadPrefix`]; [`Error::NothingDrawn`] and [`Error::MissingRoot`] if the program has no
/// distance, or lacks the gradient that the options ask for; others if its nodes cannot be lowered.
pub fn field_module(program: &Program, options: &FieldOptions) -> Result<Shader, Error> {
    functions(program, None, options)
}

/// Makes the module of [`field_module`] with `<prefix>trace` and `<prefix>intersect` beside the
/// functions: a ray method that returns where a ray hits the surface, whether it does, and how
/// often it evaluated the distance. The structures are those of `ray.wgsl` in `sdfc-march`.
///
/// # Errors
///
/// As [`field_module`].
pub fn march_module(
    program: &Program,
    method: Method,
    options: &FieldOptions,
) -> Result<Shader, Error> {
    functions(program, Some(method.definition()), options)
}

fn functions(
    program: &Program,
    method: Option<&MethodDefinition>,
    options: &FieldOptions,
) -> Result<Shader, Error> {
    check_prefix(&options.prefix)?;
    if program.is_planar() && method.is_some() {
        return Err(Error::Planar("a function of a ray"));
    }
    let program = program.by_formulas(FormulaChoice::Portable);
    let distance = program.distance.ok_or(Error::NothingDrawn)?;
    let mut program = program.guarded();
    let field = program.distance.unwrap_or(distance);
    let features = ray_features(&program, method);
    let mut bindings = vec![StubBinding::of_point(Some(Role::Distance), stubs::FIELD, field)];
    if options.gradient {
        let gradient = program.gradient.ok_or(Error::MissingRoot("gradient"))?;
        let gradient = with_value(&mut program.graph, gradient, distance);
        bindings.push(StubBinding::of_point(Some(Role::Gradient), stubs::GRADIENT, gradient));
    }
    let program = &program;
    bindings.extend(analytic_bindings(program, features));
    if let Some(method) = method {
        bindings.extend(segment_bindings(program, method, features)?);
    }
    let material = program.material.filter(|_| options.material);
    let mut nodes: Vec<_> = bindings.iter().map(|binding| binding.root).collect();
    nodes.extend(material.into_iter().flatten());

    let mut module = match method {
        Some(method) => {
            let unused = [stubs::RECORD_SAMPLE, stubs::RECORD_GAP];
            parse_template(&ray_source(method), &features.overrides(), &unused)?
        }
        None => Module::default(),
    };
    module.entry_points.clear();
    let binding = ResourceBinding { group: options.group, binding: options.binding };
    let used = raw_inputs(program, &nodes);
    let (mut inputs, members) = declare_members(&mut module, program, &used, binding);
    let after = ResourceBinding { binding: binding.binding.saturating_add(1), ..binding };
    inputs.tables = Tables::new(options.lists, after);
    inputs.tables.declare(&mut module, program, &nodes)?;

    let (uniform, prefix) = (inputs.buffer, options.prefix.clone());
    let mut parts = ModuleParts { members, uniform, prefix, ..Default::default() };
    for binding in bindings {
        let function = binding.function(program, &inputs, &mut module.types)?;
        let handle = bind_or_add(&mut module, binding.stub, function)?;
        parts.functions.extend(binding.role.map(|role| (role, handle)));
    }
    if let Some(fields) = material {
        let structure = material_type(&mut module);
        let (stub, types) = (stubs::MATERIAL, &mut module.types);
        let function =
            struct_function(program, &inputs, types, stub, (&fields, structure), &[POINT])?;
        parts.functions.push((Role::Material, bind_or_add(&mut module, stub, function)?));
    }
    for (role, name) in [(Role::Trace, stubs::TRACE), (Role::Intersect, stubs::INTERSECT)] {
        parts.functions.extend(find_function(&module, name).map(|f| (role, f)));
    }
    parts.lists = inputs.tables.into_buffer();
    make_public(&mut module, &parts, &options.prefix);
    Shader::new(module, parts, Features { materials: material.is_some(), ..features })
}

/// A derivative with its value in one more lane: callers often need both, and they share most of
/// their work.
fn with_value(graph: &mut Graph, derivative: NodeId, value: NodeId) -> NodeId {
    let width = graph.ty(derivative).width() as u8;
    let mut lanes: Vec<NodeId> = (0..width).map(|lane| graph.component(derivative, lane)).collect();
    lanes.push(value);
    graph.compose(&lanes)
}

/// Binds the function to the stub of that name if a ray method has it, else adds the function.
fn bind_or_add(
    module: &mut Module,
    stub: &str,
    function: Function,
) -> Result<Handle<Function>, Error> {
    if let Some(handle) = find_function(module, stub) {
        bind(module, stub, function)?;
        return Ok(handle);
    }
    Ok(module.functions.append(function, Span::UNDEFINED))
}

/// A structure with the fields of `MaterialField::ALL` in that order.
fn material_type(module: &mut Module) -> naga::Handle<naga::Type> {
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
    let name = Some("Material".to_owned());
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
