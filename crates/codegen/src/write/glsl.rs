//! GLSL, one stage in a source; and the source of a shader on shadertoy.com.

use naga::proc::NameKey;
use naga::valid::ModuleInfo;
use naga::{
    EntryPoint, Expression, Function, GlobalVariable, Handle, Module, ResourceBinding, ShaderStage,
    Span, Statement, back,
};
use sdfc_march::{SHADERTOY_HEAD, SHADERTOY_TAIL, stubs};

use super::common::{WrittenModule, bindings, checked_u8, one_line, refused, validate};
use super::glsl_select::without_branches;
use crate::error::Error;
use crate::link::template::find_function;
use crate::names::final_names;
use crate::options::Stage;
use crate::reflection::{Entry, EntryStage};
use crate::target::{Code, Target};

/// Writes all functions and an empty fragment stage if there is no entry point, else the last entry
/// point.
pub(super) fn glsl(
    target: Target,
    version: back::glsl::Version,
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<WrittenModule, Error> {
    let Some(entry) = module.entry_points.last() else {
        let module = with_empty_stage(module);
        let info = validate(&module)?;
        let flags = back::glsl::WriterFlags::INCLUDE_UNUSED_ITEMS;
        return glsl_stage(target, version, flags, &module, &info, comment);
    };
    if target == Target::GlslEs && entry.stage == ShaderStage::Compute {
        return Err(Error::MissingStage { target, stage: Stage::Compute });
    }
    glsl_stage(target, version, back::glsl::WriterFlags::empty(), module, info, comment)
}

/// Writes the last entry point.
fn glsl_stage(
    target: Target,
    version: back::glsl::Version,
    writer_flags: back::glsl::WriterFlags,
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<WrittenModule, Error> {
    let entry = module.entry_points.last();
    let entry = entry.ok_or(Error::Unsupported { target, what: "text without a stage" })?;
    let options = back::glsl::Options {
        version,
        writer_flags,
        binding_map: bindings(module)
            .map(|binding| Ok((binding, checked_u8(target, binding.binding)?)))
            .collect::<Result<_, Error>>()?,
        zero_initialize_workgroup_memory: true,
    };
    let stage = back::glsl::PipelineOptions {
        shader_stage: entry.stage,
        entry_point: entry.name.clone(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = naga::proc::BoundsCheckPolicies::default();
    let reflected = back::glsl::Writer::new(&mut text, module, info, &options, &stage, policies)
        .and_then(|mut writer| writer.write())
        .map_err(refused)?;
    let mut blocks: Vec<_> = reflected.uniforms.into_iter().collect();
    blocks.sort_unstable();
    let blocks = rename_blocks(&mut text, module, entry.stage, blocks);
    if target == Target::GlslEs {
        text = without_branches(&text);
    }
    // The version must come first.
    let (version, rest) = text.split_once('\n').unwrap_or((&text, ""));
    let code = Code::Text(format!("{version}\n// {}\n{rest}", one_line(comment)));
    let entry = Entry { stage: EntryStage::of(entry.stage), name: "main".to_owned() };
    Ok(WrittenModule { code, blocks, entries: Some(vec![entry]) })
}

/// Writes a shader for shadertoy.com: between two whole files, the constants that naga writes,
/// which begin with the params, then structures, then functions, without the version, precisions
/// and the empty stage.
pub(super) fn shadertoy(
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<WrittenModule, Error> {
    let target = Target::Shadertoy;
    if find_function(module, stubs::IMAGE).is_none() {
        let what = "field or march: it takes whole pictures only, as `--emit render` writes them";
        return Err(Error::Unsupported { target, what });
    }
    let written = glsl(target, back::glsl::Version::new_gles(300), module, info, comment)?;
    let Code::Text(text) = &written.code else { return Ok(written) };
    let body = text.find("struct ").map_or("", |start| &text[start..]);
    let body = body.rfind("void main()").map_or(body, |end| &body[..end]);
    let (structures, rest) = body.split_at(body.find("\nconst ").map_or(0, |before| before + 1));
    let is_constant = |line: &&str| line.starts_with("const ");
    let constants: String = rest.split_inclusive('\n').take_while(is_constant).collect();
    let functions = without_zeros(&rest[constants.len()..], "View view");
    let head = format!("// {}\n{SHADERTOY_HEAD}", one_line(comment));
    let text = [&head, &constants, structures, functions.trim_matches('\n')].join("\n");
    let code = Code::Text(format!("{text}\n\n{SHADERTOY_TAIL}"));
    Ok(WrittenModule { code, blocks: Vec::new(), entries: Some(Vec::new()) })
}

/// Removes the initial value of a variable: `load_view` sets everything that is read of the view.
fn without_zeros(text: &str, variable: &str) -> String {
    let parts = text.split_once(&format!("{variable} = ")).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(";\n")?;
        Some(format!("{before}{variable};\n{after}"))
    });
    parts.unwrap_or_else(|| text.to_owned())
}

/// Names buffers after their variables, and blocks after the buffers. naga numbers both, so that
/// two sources in one file would clash.
fn rename_blocks(
    text: &mut String,
    module: &Module,
    stage: ShaderStage,
    blocks: Vec<(Handle<GlobalVariable>, String)>,
) -> Vec<(Handle<GlobalVariable>, String)> {
    let names = final_names(module);
    // naga's suffix of these names: `vs`, `fs`, `cs`.
    let suffix = format!("{}s", &EntryStage::of(stage).name()[..1]);
    let rename = |(handle, block): (Handle<GlobalVariable>, String)| {
        let binding = module.global_variables[handle].binding;
        let name = names.get(&NameKey::GlobalVariable(handle));
        let (Some(ResourceBinding { group, binding }), Some(name)) = (binding, name) else {
            return (handle, block);
        };
        let by_name = format!("{name}_block");
        let number = format!("_group_{group}_binding_{binding}_{suffix}");
        *text = text.replace(&block, &by_name).replace(&number, name);
        (handle, by_name)
    };
    blocks.into_iter().map(rename).collect()
}

/// Adds a fragment stage that only loads the buffers, so that they count as used: GLSL is written
/// one stage at a time.
fn with_empty_stage(module: &Module) -> Module {
    let mut module = module.clone();
    let mut function = Function::default();
    for (variable, _) in module.global_variables.iter().filter(|(_, v)| v.binding.is_some()) {
        let pointer = Expression::GlobalVariable(variable);
        let pointer = function.expressions.append(pointer, Span::UNDEFINED);
        let before = function.expressions.len();
        function.expressions.append(Expression::Load { pointer }, Span::UNDEFINED);
        let loaded = function.expressions.range_from(before);
        function.body.push(Statement::Emit(loaded), Span::UNDEFINED);
    }
    module.entry_points.push(EntryPoint {
        name: "main".to_owned(),
        stage: ShaderStage::Fragment,
        early_depth_test: None,
        workgroup_size: [0; 3],
        workgroup_size_overrides: None,
        function,
        mesh_info: None,
        task_payload: None,
        incoming_ray_payload: None,
    });
    module
}
