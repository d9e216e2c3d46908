//! The shader of a picture: a scene's functions linked into a ray method and shading.

use naga::ResourceBinding;
use rustc_hash::FxHashSet;
use sdfc_graph::{NodeId, Program, Shadow, reachable_where};
use sdfc_march::{Features, FieldSource, Form, Method, method, source, source_over, stubs};

use crate::inputs::declare_slots;
use crate::lower::{struct_function, value_function};
use crate::reflect::{Parts, Role};
use crate::{Error, Shader, link};

/// Where the per-frame slots are bound.
const SLOTS: ResourceBinding = ResourceBinding { group: 0, binding: 1 };

/// The compute shader of a program's picture, entry point `main`, workgroups of 8x8 pixels.
///
/// Group 0 has three bindings. 0: uniform `sdfc_march::ViewBlock`. 1: uniform array with one
/// `vec4<f32>` for each of `Program::uniforms`, a value in its first lanes, a truth value as 0 or 1;
/// absent where the functions use none of them ([`crate::Reflection::uniform`] is `None`). 2: storage
/// array of `sdfc_march::PixelBlock`, one for each pixel of the tile, row by row.
///
/// Shadows are linked where a light of the settings casts one, soft ones as hard ones; materials where
/// the program has them; reflections where the settings want at least one.
///
/// # Errors
///
/// [`Error::UnknownMethod`]; [`Error::NothingDrawn`] and [`Error::MissingRoot`] where the program
/// has no distance or no gradient; others where its nodes cannot be lowered.
pub fn render_module(program: &Program, method_name: &str) -> Result<Shader, Error> {
    let method = method(method_name).ok_or_else(|| Error::UnknownMethod(method_name.to_owned()))?;
    link_picture(program, method)
}

/// As [`render_module`], with the gradient by differences of a field that is the scene's distance or an
/// interpreter, and without materials: what pictures have in common that are compared for speed.
///
/// An interpreter reads its program from storage buffers at the bindings that [`FieldSource`] tells, and
/// nothing at binding 1.
///
/// # Errors
///
/// As [`render_module`].
pub fn measured_module(
    program: &Program,
    method_name: &str,
    field: FieldSource,
) -> Result<Shader, Error> {
    let method = method(method_name).ok_or_else(|| Error::UnknownMethod(method_name.to_owned()))?;
    let distance = match field {
        FieldSource::Scene => return link_picture(program, method),
        FieldSource::Distance => Some(program.distance.ok_or(Error::NothingDrawn)?),
        FieldSource::Units | FieldSource::Tape => None,
    };
    let features = Features { materials: false, ..features(program) };
    let used = distance.map_or_else(Vec::new, |distance| used_slots(program, vec![distance]));
    let unused: &[&str] = if used.is_empty() { &[stubs::LOAD_FRAME] } else { &[] };
    let mut module = link::skeleton(&source_over(field, Form::Compute, method, features), unused)?;
    let (inputs, load_frame) = declare_slots(&mut module, program, &used, SLOTS);
    if let Some(load_frame) = load_frame {
        link::fill(&mut module, stubs::LOAD_FRAME, load_frame)?;
    }
    if let Some(distance) = distance {
        let types = &mut module.types;
        let function = value_function(program, &inputs, types, stubs::FIELD, distance)?;
        link::fill(&mut module, stubs::FIELD, function)?;
    }
    Shader::new(module, Parts::default(), features)
}

fn link_picture(program: &Program, method: &Method) -> Result<Shader, Error> {
    let distance = program.distance.ok_or(Error::NothingDrawn)?;
    let gradient = program.gradient.ok_or(Error::MissingRoot("gradient"))?;
    let features = features(program);
    let mut filled = vec![(Role::Distance, stubs::FIELD, distance)];
    if method.gradient.is_none() {
        filled.push((Role::Gradient, stubs::GRADIENT, gradient));
    }
    let mut roots: Vec<_> = filled.iter().map(|&(.., root)| root).collect();
    roots.extend(program.material.into_iter().flatten());
    let used = used_slots(program, roots);
    let unused: &[&str] = if used.is_empty() { &[stubs::LOAD_FRAME] } else { &[] };
    let mut module = link::skeleton(&source(method, features), unused)?;

    let (inputs, load_frame) = declare_slots(&mut module, program, &used, SLOTS);
    if let Some(load_frame) = load_frame {
        link::fill(&mut module, stubs::LOAD_FRAME, load_frame)?;
    }
    let mut parts = Parts { uniform: inputs.buffer(), ..Default::default() };
    for (role, stub, root) in filled {
        let function = value_function(program, &inputs, &mut module.types, stub, root)?;
        link::fill(&mut module, stub, function)?;
        parts.functions.extend(link::find_function(&module, stub).map(|f| (role, f)));
    }
    if let Some(fields) = program.material {
        let stub = stubs::MATERIAL;
        let handle = link::find_function(&module, stub);
        let structure = handle.and_then(|f| module.functions[f].result.as_ref());
        let structure = structure.ok_or(Error::MissingRoot("material"))?.ty;
        let types = &mut module.types;
        let function = struct_function(program, &inputs, types, stub, &fields, structure)?;
        link::fill(&mut module, stub, function)?;
        parts.functions.extend(handle.map(|f| (Role::Material, f)));
    }
    Shader::new(module, parts, features)
}

/// What a scene's picture needs beyond the least.
fn features(program: &Program) -> Features {
    let shadows = program.settings.lights.iter().any(|light| match light.shadow {
        Shadow::Off => false,
        Shadow::Hard | Shadow::Soft(_) => true,
    });
    let reflections = program.settings.reflections.is_some_and(|mirrors| mirrors.count > 0);
    Features { shadows, materials: program.material.is_some(), reflections }
}

/// Positions in `Program::uniforms` of those that the roots read.
fn used_slots(program: &Program, roots: Vec<NodeId>) -> Vec<usize> {
    let slots: FxHashSet<_> = program.uniforms.iter().copied().collect();
    let needed = reachable_where(&program.graph, &roots, |node| !slots.contains(&node));
    // In ascending order, so that a search finds them.
    let is_needed = |node: &NodeId| needed.binary_search(node).is_ok();
    let positions = program.uniforms.iter().enumerate();
    positions.filter(|(_, node)| is_needed(node)).map(|(slot, _)| slot).collect()
}
