//! HLSL.

use naga::valid::ModuleInfo;
use naga::{Module, back};

use super::common::{bindings, checked_u8, refused};
use super::hlsl_lists::with_plain_lists;
use crate::error::Error;
use crate::target::Target;

/// Returns the source and the names of its entry points.
pub(super) fn hlsl(module: &Module, info: &ModuleInfo) -> Result<(String, Vec<String>), Error> {
    let mut binding_map = back::hlsl::BindingMap::new();
    for binding in bindings(module) {
        let space = checked_u8(Target::Hlsl, binding.group)?;
        let target =
            back::hlsl::BindTarget { space, register: binding.binding, ..Default::default() };
        binding_map.insert(binding, target);
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
    Ok((with_plain_lists(&text), names.map_err(refused)?))
}
