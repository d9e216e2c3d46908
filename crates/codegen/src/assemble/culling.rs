//! The shader that runs before a picture and finds which iterations of loops can affect which rays.

use sdfc_graph::{CullableLoop, Program};
use sdfc_march::{Features, culling_source, stubs};

use super::bindings::{LISTS, SLOTS};
use super::template::{template, used_slots};
use crate::error::Error;
use crate::link::template::bind;
use crate::lower::function_of_iteration;
use crate::lower::inputs::declare_slots;
use crate::lower::tables::Tables;
use crate::reflection::ModuleParts;
use crate::shader::{Culling, Shader};

/// Makes the culling shader; `None` if the picture is not culled.
pub(crate) fn culling(program: &Program, features: Features) -> Result<Option<Culling>, Error> {
    if !features.culled {
        return Ok(None);
    }
    let loops: Vec<&CullableLoop> =
        program.cullable_loops.iter().take(stubs::CULLING_BOUNDS.len()).collect();
    let roots: Vec<_> = loops.iter().map(|looped| looped.culling_bounds).collect();
    let used = used_slots(program, roots.clone());
    let mut module = template(&culling_source(), features, &used, &[])?;
    let (mut inputs, load_frame) = declare_slots(&mut module, program, &used, SLOTS);
    if let Some(load_frame) = load_frame {
        bind(&mut module, stubs::LOAD_FRAME, load_frame)?;
    }
    inputs.tables = Tables::in_buffer(LISTS);
    inputs.tables.declare(&mut module, program, &roots)?;
    for (stub, root) in stubs::CULLING_BOUNDS.into_iter().zip(roots) {
        let function = function_of_iteration(program, &inputs, &mut module.types, stub, root)?;
        bind(&mut module, stub, function)?;
    }
    let parts = ModuleParts { lists: inputs.tables.into_buffer(), ..ModuleParts::default() };
    let shader = Shader::new(module, parts, features)?;
    let iterations = loops.iter().map(|looped| looped.iterations).collect();
    let is_joined = || loops.iter().map(|looped| looped.is_union_operand).collect();
    let cells = features.culls_by_cell().then(is_joined);
    Ok(Some(Culling { shader, iterations, cells, soft_shadows: features.soft_shadows }))
}
