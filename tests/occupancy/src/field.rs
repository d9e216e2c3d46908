//! A compute shader around the functions that `--emit field` writes.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// The entry point. Half of the threads ask for the distance and half for the gradient, so the
/// shader takes the registers of the function that needs more, and the cost is that of both.
const ENTRY: &str = "
@group(0) @binding(7) var<storage, read_write> test_points: array<vec4<f32>>;

@compute @workgroup_size(64)
fn test_main(@builtin(global_invocation_id) id: vec3<u32>) {
    let point = test_points[id.x];
    if point.w > 0.0 {
        test_points[id.x].w = sdf_distance(point.DIMENSIONS);
    } else {
        test_points[id.x] = vec4<f32>(sdf_gradient(point.DIMENSIONS)FILL);
    }
}
";

/// Compiles the WGSL of a field, with an entry point, to SPIR-V.
///
/// # Errors
///
/// The source is not valid.
pub fn spirv(field: &str) -> Result<Vec<u8>, String> {
    let is_planar = field.contains("fn sdf_distance(p: vec2<f32>)");
    let [dimensions, fill] = if is_planar { ["xy", ", 0.0"] } else { ["xyz", ""] };
    let entry = ENTRY.replace("DIMENSIONS", dimensions).replace("FILL", fill);
    let source = format!("{field}{entry}");
    let module = naga::front::wgsl::parse_str(&source).map_err(|e| e.emit_to_string(&source))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).map_err(|e| e.emit_to_string(&source))?;
    let options = spv::Options { flags: spv::WriterFlags::empty(), ..spv::Options::default() };
    let words = spv::write_vec(&module, &info, &options, None).map_err(|e| e.to_string())?;
    Ok(words.into_iter().flat_map(u32::to_le_bytes).collect())
}
