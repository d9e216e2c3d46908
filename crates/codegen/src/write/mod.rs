//! Writes validated modules in the languages of the targets.

mod common;
mod glsl;
pub(crate) mod glsl_select;
mod hlsl;
mod hlsl_lists;
pub(crate) mod instructions;
mod msl;

use naga::valid::ModuleInfo;
use naga::{Module, back};

pub(crate) use common::{WrittenModule, validate};

use crate::error::Error;
use crate::reflection::{Entry, EntryStage};
use crate::target::{Code, Target};
use common::{one_line, refused};
use glsl::{glsl, shadertoy};
use hlsl::hlsl;
use msl::msl;

/// Writes a validated module; `comment` is one line for the start of a source.
pub(crate) fn write(
    target: Target,
    module: &Module,
    info: &ModuleInfo,
    comment: &str,
) -> Result<WrittenModule, Error> {
    let head = |text: String| Code::Text(format!("// {}\n\n{text}", one_line(comment)));
    let written = |code, entries| WrittenModule { code, blocks: Vec::new(), entries };
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

/// The module's entry points with other names.
fn renamed(module: &Module, names: Vec<String>) -> Vec<Entry> {
    let entries = module.entry_points.iter().zip(names);
    entries.map(|(entry, name)| Entry { stage: EntryStage::of(entry.stage), name }).collect()
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
