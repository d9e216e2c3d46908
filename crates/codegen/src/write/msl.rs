//! Metal's shading language.

use naga::valid::ModuleInfo;
use naga::{Module, back};

use super::common::{bindings, checked_u8, refused};
use crate::error::Error;
use crate::target::Target;

/// Returns the source and the names of its entry points.
pub(super) fn msl(module: &Module, info: &ModuleInfo) -> Result<(String, Vec<String>), Error> {
    let mut resources = back::msl::EntryPointResources::default();
    for binding in bindings(module) {
        let buffer = Some(checked_u8(Target::Msl, binding.binding)?);
        let target = back::msl::BindTarget { buffer, mutable: true, ..Default::default() };
        resources.resources.insert(binding, target);
    }
    let last = bindings(module).map(|binding| binding.binding).max().unwrap_or(0);
    resources.sizes_buffer = Some(checked_u8(Target::Msl, last.saturating_add(1))?);
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
