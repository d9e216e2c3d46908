//! The languages that shaders are written in.

mod lists;

use naga::proc::NameKey;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{
    EntryPoint, Expression, Function, GlobalVariable, Handle, Module, ResourceBinding, ShaderStage,
    Span, Statement, back,
};
use sdfc_march::{SHADERTOY_HEAD, SHADERTOY_TAIL, stubs};

use crate::link::find_function;
use crate::picture::Stage;
use crate::reflect::{Entry, final_names, stage_name};
use crate::{Error, Lists};

/// A language that shaders are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// WebGPU's.
    Wgsl,
    /// GLSL 4.50, one stage in a text.
    Glsl,
    /// GLSL ES 3.00, WebGL 2's, one stage in a text; it has no compute stage.
    GlslEs,
    /// Shader model 5.1.
    Hlsl,
    /// Metal 2.1.
    Msl,
    /// SPIR-V 1.3 for Vulkan, with names.
    Spirv,
    /// The one text of a shader on shadertoy.com, GLSL ES 3.00: a whole picture, see
    /// [`crate::shadertoy_module`].
    Shadertoy,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Wgsl, Self::Glsl, Self::GlslEs, Self::Hlsl, Self::Msl, Self::Spirv, Self::Shadertoy];

    /// What the command line calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::GlslEs => "glsl-es",
            Self::Hlsl => "hlsl",
            Self::Msl => "msl",
            Self::Spirv => "spirv",
            Self::Shadertoy => "shadertoy",
        }
    }

    /// Whether buffers are in groups.
    pub fn has_groups(self) -> bool {
        match self {
            Self::Wgsl | Self::Hlsl | Self::Spirv => true,
            Self::Glsl | Self::GlslEs | Self::Msl | Self::Shadertoy => false,
        }
    }

    /// Whether buffers are bound by numbers, not by names.
    pub fn has_bindings(self) -> bool {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => true,
            Self::GlslEs | Self::Shadertoy => false,
        }
    }

    /// Where long lists are.
    pub fn lists(self) -> Lists {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => Lists::Buffer,
            Self::GlslEs | Self::Shadertoy => Lists::Constants,
        }
    }

    /// Whether there is a stage.
    pub fn has_stage(self, stage: Stage) -> bool {
        match self {
            Self::Wgsl | Self::Glsl | Self::Hlsl | Self::Msl | Self::Spirv => true,
            Self::GlslEs | Self::Shadertoy => stage == Stage::Fragment,
        }
    }

    /// Whether the first row of what a fragment stage draws is the lowest.
    pub fn counts_rows_upwards(self) -> bool {
        match self {
            Self::Glsl | Self::GlslEs | Self::Shadertoy => true,
            Self::Wgsl | Self::Hlsl | Self::Msl | Self::Spirv => false,
        }
    }
}

/// A shader in a target's language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Code {
    /// The text.
    Text(String),
    /// The words of SPIR-V.
    Words(Vec<u32>),
}

impl Code {
    /// As a file holds it: UTF-8, or words of four bytes, the lowest first.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.into_bytes(),
            Self::Words(words) => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
        }
    }
}

/// What a writer gives.
pub(crate) struct Written {
    pub(crate) code: Code,
    /// Name of the block of each buffer, where the language has such names.
    pub(crate) blocks: Vec<(Handle<GlobalVariable>, String)>,
    /// The entry points, where they are not those of the module or are not named as there.
    pub(crate) entries: Option<Vec<Entry>>,
}

/// Writes a validated module; `comment` is one line for the head of a text.
pub(crate) fn write(
    target: Target,
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<Written, Error> {
    let head = |text: String| Code::Text(format!("// {}\n\n{text}", one_line(comment)));
    let written = |code, entries| Written { code, blocks: Vec::new(), entries };
    match target {
        Target::Wgsl => wgsl(module, info).map(|text| written(head(text), None)),
        Target::Glsl => glsl(target, back::glsl::Version::Desktop(450), module, info, comment),
        Target::GlslEs => glsl(target, back::glsl::Version::new_gles(300), module, info, comment),
        Target::Hlsl => hlsl(module, info)
            .map(|(text, names)| written(head(text), Some(renamed(module, names)))),
        Target::Msl => {
            msl(module, info).map(|(text, names)| written(head(text), Some(renamed(module, names))))
        }
        Target::Spirv => spirv(module, info).map(|words| written(Code::Words(words), None)),
        Target::Shadertoy => shadertoy(module, info, comment),
    }
}

/// The module's entry points by other names.
fn renamed(module: &Module, names: Vec<String>) -> Vec<Entry> {
    let entries = module.entry_points.iter().zip(names);
    entries.map(|(entry, name)| Entry { stage: stage_name(entry.stage), name }).collect()
}

/// A comment that ends where its line does, in every language: `\` at the end of a line continues it.
fn one_line(comment: &str) -> String {
    comment.chars().map(|c| if c.is_control() || c == '\\' { '?' } else { c }).collect()
}

pub(crate) fn wgsl(module: &Module, info: &ModuleInfo) -> Result<String, Error> {
    let flags = back::wgsl::WriterFlags::empty();
    back::wgsl::write_string(module, info, flags).map_err(refused)
}

pub(crate) fn spirv(module: &Module, info: &ModuleInfo) -> Result<Vec<u32>, Error> {
    let options = back::spv::Options {
        lang_version: (1, 3),
        flags: back::spv::WriterFlags::DEBUG | back::spv::WriterFlags::LABEL_VARYINGS,
        ..Default::default()
    };
    back::spv::write_vec(module, info, &options, None).map_err(refused)
}

/// Without an entry point, all functions and an empty fragment stage; else the last entry point.
fn glsl(
    target: Target,
    version: back::glsl::Version,
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<Written, Error> {
    let Some(entry) = module.entry_points.last() else {
        let module = with_empty_stage(module);
        let info = validate(&module)?;
        let flags = back::glsl::WriterFlags::INCLUDE_UNUSED_ITEMS;
        return glsl_stage(target, version, flags, &module, &info, comment);
    };
    if target == Target::GlslEs && entry.stage == ShaderStage::Compute {
        return Err(Error::Unsupported { target, what: "compute stage" });
    }
    glsl_stage(target, version, back::glsl::WriterFlags::empty(), module, info, comment)
}

/// The last entry point.
fn glsl_stage(
    target: Target,
    version: back::glsl::Version,
    writer_flags: back::glsl::WriterFlags,
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<Written, Error> {
    let entry = module.entry_points.last();
    let entry = entry.ok_or(Error::Unsupported { target, what: "text without a stage" })?;
    let options = back::glsl::Options {
        version,
        writer_flags,
        binding_map: bindings(module)
            .map(|binding| Ok((binding, slot(target, binding.binding)?)))
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
    // Nothing may stand before the version.
    let (version, rest) = text.split_once('\n').unwrap_or((&text, ""));
    let code = Code::Text(format!("{version}\n// {}\n{rest}", one_line(comment)));
    let entry = Entry { stage: stage_name(entry.stage), name: "main".to_owned() };
    Ok(Written { code, blocks, entries: Some(vec![entry]) })
}

/// Between two whole files, what naga writes: constants, which the params begin, then structures, then functions,
/// without the version, precisions and the empty stage.
fn shadertoy(module: &Module, info: &ModuleInfo, comment: &str) -> Result<Written, Error> {
    let target = Target::Shadertoy;
    if find_function(module, stubs::IMAGE).is_none() {
        return Err(Error::Unsupported { target, what: "text but that of a whole picture" });
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
    Ok(Written { code, blocks: Vec::new(), entries: Some(Vec::new()) })
}

/// The text without what a variable begins with: `load_view` sets all that is read of the view.
fn without_zeros(text: &str, variable: &str) -> String {
    let parts = text.split_once(&format!("{variable} = ")).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(";\n")?;
        Some(format!("{before}{variable};\n{after}"))
    });
    parts.unwrap_or_else(|| text.to_owned())
}

/// Calls buffers by the names of their variables, and their blocks after them. naga calls both after
/// numbers, by which two texts in one file clash.
fn rename_blocks(
    text: &mut String,
    module: &Module,
    stage: ShaderStage,
    blocks: Vec<(Handle<GlobalVariable>, String)>,
) -> Vec<(Handle<GlobalVariable>, String)> {
    let names = final_names(module);
    // What naga ends the names with: `vs`, `fs`, `cs`.
    let suffix = format!("{}s", &stage_name(stage)[..1]);
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

/// The module and a fragment stage that does nothing but load the buffers, so that they count as used:
/// GLSL is written a stage at a time.
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

/// The text, and what entry points are called in it.
fn hlsl(module: &Module, info: &ModuleInfo) -> Result<(String, Vec<String>), Error> {
    let mut binding_map = back::hlsl::BindingMap::new();
    for binding in bindings(module) {
        let space = slot(Target::Hlsl, binding.group)?;
        let place =
            back::hlsl::BindTarget { space, register: binding.binding, ..Default::default() };
        binding_map.insert(binding, place);
    }
    let options = back::hlsl::Options {
        shader_model: back::hlsl::ShaderModel::V5_1,
        binding_map,
        // Every loop of a ray method ends by its own counter.
        force_loop_bounding: false,
        ..Default::default()
    };
    let mut text = String::new();
    let stages = back::hlsl::PipelineOptions::default();
    let mut writer = back::hlsl::Writer::new(&mut text, &options, &stages);
    let reflected = writer.write(module, info, None).map_err(refused)?;
    let names: Result<_, _> = reflected.entry_point_names.into_iter().collect();
    Ok((lists::with_plain_lists(&text), names.map_err(refused)?))
}

/// The text, and what entry points are called in it.
fn msl(module: &Module, info: &ModuleInfo) -> Result<(String, Vec<String>), Error> {
    let mut resources = back::msl::EntryPointResources::default();
    for binding in bindings(module) {
        let buffer = Some(slot(Target::Msl, binding.binding)?);
        let place = back::msl::BindTarget { buffer, mutable: true, ..Default::default() };
        resources.resources.insert(binding, place);
    }
    let last = bindings(module).map(|binding| binding.binding).max().unwrap_or(0);
    resources.sizes_buffer = Some(slot(Target::Msl, last.saturating_add(1))?);
    let entries = module.entry_points.iter().map(|entry| (entry.name.clone(), resources.clone()));
    let options = back::msl::Options {
        lang_version: (2, 1),
        per_entry_point_map: entries.collect(),
        force_loop_bounding: false,
        ..Default::default()
    };
    let stages = back::msl::PipelineOptions::default();
    let (text, reflected) =
        back::msl::write_string(module, info, &options, &stages).map_err(refused)?;
    let names: Result<_, _> = reflected.entry_point_names.into_iter().collect();
    Ok((text, names.map_err(refused)?))
}

/// Places of the buffers.
fn bindings(module: &Module) -> impl Iterator<Item = ResourceBinding> {
    module.global_variables.iter().filter_map(|(_, variable)| variable.binding)
}

/// Numbers that a target has 256 of.
fn slot(target: Target, number: u32) -> Result<u8, Error> {
    u8::try_from(number).map_err(|_| Error::BindingTooLarge { target, number })
}

pub(crate) fn validate(module: &Module) -> Result<ModuleInfo, Error> {
    Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(module)
        .map_err(|error| Error::Naga(error.emit_to_string("")))
}

fn refused(error: impl std::fmt::Display) -> Error {
    Error::Naga(error.to_string())
}
