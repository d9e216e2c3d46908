//! The shaders of pictures.

use naga::ResourceBinding;
use sdfc_graph::{FormulaChoice, Program, Settings};
use sdfc_march::{Features, FieldSource, Form, Method, MethodDefinition, source_with, stubs};

use super::bindings::{LISTS, SLOTS, StubBinding};
use super::culling::culling;
use super::linker::PictureLinker;
use super::template::{features, is_culled, template, used_slots};
use crate::error::Error;
use crate::link::template::{bind, find_variable};
use crate::lower::active_lists::ActiveLists;
use crate::lower::inputs::{declare_members, declare_slots, raw_inputs};
use crate::lower::tables::Tables;
use crate::names::{check_prefix, make_public};
use crate::options::{PictureOptions, Stage};
use crate::reflection::ModuleParts;
use crate::shader::Shader;

/// Makes the compute shader of a program's picture: entry point `main`, workgroups of 8x8 pixels.
///
/// Group 0 has these bindings:
///
/// - 0: uniform `sdfc_march::ViewBlock`.
/// - 1: uniform array with one `vec4<f32>` for each of `Program::uniforms`: a value in its first
///   lanes, a boolean as 0 or 1. It is absent if the functions use none
///   ([`crate::Reflection::uniform`] is `None`).
/// - 2: storage array of `sdfc_march::PixelBlock`, one for each pixel of the tile, row by row.
/// - 3: storage array with the contents of [`Shader::lists`]; absent if that is empty.
///
/// Only the shading that the settings and the program need is linked; [`Shader::features`] returns
/// it.
///
/// # Errors
///
/// [`Error::NothingDrawn`] and [`Error::MissingRoot`] if the program has no distance or no
/// gradient; others if its nodes cannot be lowered.
pub fn render_module(program: &Program, method: Method) -> Result<Shader, Error> {
    link_picture(program, Form::Compute, method.definition(), None)
}

/// Makes the same shader as [`render_module`] for another camera than the scene's, whose rays are
/// parallel or not as the caller says.
///
/// # Errors
///
/// As [`render_module`].
pub fn render_module_with_camera(
    program: &Program,
    method: Method,
    parallel: bool,
) -> Result<Shader, Error> {
    link_picture(program, Form::Compute, method.definition(), Some(parallel))
}

/// Makes a shader whose pixels hold the position and unit normal of the hit in place of a colour,
/// for measurements. Only camera rays are traced. The method may be one that is not in the table.
///
/// # Errors
///
/// As [`render_module`].
pub fn normals_module(program: &Program, method: &MethodDefinition) -> Result<Shader, Error> {
    let Settings { camera, march, .. } = program.settings.clone();
    let settings = Settings { camera, march, ..Settings::default() };
    let unlit = Program { material: None, seen_material: None, settings, ..program.clone() };
    link_picture(&unlit, Form::Normals, method, None)
}

/// Makes a shader for benchmarks: without materials, with the gradient by differences of a field
/// that is either the scene's distance or an interpreter.
///
/// An interpreter reads its program from storage buffers at the bindings that [`FieldSource`]
/// states, and nothing at binding 1.
///
/// # Errors
///
/// As [`render_module`].
pub fn benchmark_module(
    program: &Program,
    method: Method,
    field: FieldSource,
) -> Result<Shader, Error> {
    link_benchmark(program, method, field, false)
}

/// Makes the same shader as [`benchmark_module`] for the scene's distance, instrumented: if
/// iterations of loops are culled, a pixel's `evaluations` counts the iterations that were run,
/// those for normals included.
///
/// # Errors
///
/// As [`render_module`].
pub fn instrumented_module(program: &Program, method: Method) -> Result<Shader, Error> {
    link_benchmark(program, method, FieldSource::Distance, true)
}

fn link_benchmark(
    program: &Program,
    method: Method,
    field: FieldSource,
    instrumented: bool,
) -> Result<Shader, Error> {
    if program.is_planar() {
        return Err(Error::Planar("a benchmark"));
    }
    let method = method.definition();
    let program = &program.by_formulas(FormulaChoice::Short).guarded();
    let distance = match field {
        FieldSource::Scene => return link_picture(program, Form::Compute, method, None),
        FieldSource::Distance => Some(program.distance.ok_or(Error::NothingDrawn)?),
        FieldSource::Units | FieldSource::Tape => None,
    };
    // The whole field is marched.
    let culled = field == FieldSource::Distance && is_culled(program, method);
    let instrumented = culled && instrumented;
    let environment = false; // its lists would be in the way
    let features =
        Features { materials: false, environment, culled, instrumented, ..features(program, None) };
    let used = distance.map_or_else(Vec::new, |distance| used_slots(program, vec![distance]));
    let source = source_with(field, Form::Compute, method, features);
    let mut module = template(&source, features, &used, &[])?;
    let (mut inputs, load_frame) = declare_slots(&mut module, program, &used, SLOTS);
    inputs.tables = Tables::in_buffer(LISTS);
    inputs.active_lists = ActiveLists::find(&module, program);
    inputs.loop_limit = find_variable(&module, stubs::LOOP_LIMIT);
    inputs.tables.declare(&mut module, program, distance.as_slice())?;
    if let Some(load_frame) = load_frame {
        bind(&mut module, stubs::LOAD_FRAME, load_frame)?;
    }
    if let Some(distance) = distance {
        let types = &mut module.types;
        let field = StubBinding::of_point(None, stubs::FIELD, distance);
        let function = field.function(program, &inputs, types)?;
        bind(&mut module, stubs::FIELD, function)?;
    }
    let parts = ModuleParts { lists: inputs.tables.into_buffer(), ..ModuleParts::default() };
    Ok(Shader::new(module, parts, features)?.culled_by(culling(program, features)?))
}

/// Makes the shader of a program's picture for another engine. It needs no values but params,
/// `time` and `frame`, in a structure as that of [`crate::field_module`]; per-frame values that
/// follow from them are computed once per pixel.
///
/// Uniform `view` is a `sdfc_march::ViewBlock`. With [`Stage::Compute`] the entry point is `main`,
/// and `pixels` is a storage array as in [`render_module`]. With [`Stage::Fragment`] there are
/// `vertex`, to be drawn as three vertices without buffers, and `fragment`, which returns a linear
/// colour.
///
/// # Errors
///
/// [`Error::BadPrefix`]; others as [`render_module`].
pub fn picture_module(program: &Program, options: &PictureOptions) -> Result<Shader, Error> {
    check_prefix(&options.prefix)?;
    let method = options.method.definition();
    let program = &program.by_formulas(FormulaChoice::Portable).guarded();
    let form = match options.stage {
        Stage::Compute => Form::Compute,
        Stage::Fragment if options.rows_up => Form::FragmentUp,
        Stage::Fragment => Form::Fragment,
    };
    let mut picture = PictureLinker::new(program, form, method, None, &[], false)?;
    let binding_at = |offset| ResourceBinding {
        group: options.group,
        binding: options.binding.saturating_add(offset),
    };
    for (_, variable) in picture.module.global_variables.iter_mut() {
        if let Some(binding) = &mut variable.binding {
            *binding = binding_at(binding.binding);
        }
    }
    let raw = raw_inputs(program, &picture.slot_nodes());
    let (mut inputs, members) =
        declare_members(&mut picture.module, program, &raw, binding_at(SLOTS.binding));
    inputs.tables = Tables::new(options.lists, binding_at(LISTS.binding));
    picture.parts.members = members;
    picture.parts.prefix.clone_from(&options.prefix);
    picture.compute_slots(inputs)?;
    picture.bind()?;
    make_public(&mut picture.module, &picture.parts, &options.prefix);
    picture.finish()
}

/// Links a picture. `parallel` overrides whether camera rays are parallel.
fn link_picture(
    program: &Program,
    form: Form,
    method: &MethodDefinition,
    parallel: Option<bool>,
) -> Result<Shader, Error> {
    let program = &program.by_formulas(FormulaChoice::Short).guarded();
    let mut picture = PictureLinker::new(program, form, method, parallel, &[], true)?;
    let (inputs, load_frame) = declare_slots(&mut picture.module, program, &picture.used, SLOTS);
    if let Some(load_frame) = load_frame {
        bind(&mut picture.module, stubs::LOAD_FRAME, load_frame)?;
    }
    picture.inputs = inputs;
    picture.inputs.tables = Tables::in_buffer(LISTS);
    picture.inputs.active_lists = ActiveLists::find(&picture.module, program);
    picture.bind()?;
    let features = picture.features;
    Ok(picture.finish()?.culled_by(culling(program, features)?))
}
