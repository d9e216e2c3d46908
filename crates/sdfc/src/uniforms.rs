//! The contents of a written shader's uniform buffer.

use sdfc_codegen::{Member, Reflection};
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{FrameInput, Type};

/// Returns the contents of the uniform buffer that a written field or ray method reads.
///
/// Numbers are little-endian. The size is a multiple of 16 bytes, and 0 if the shader reads no
/// params. Params that the frame lacks are 0.
///
/// ```
/// use sdfc::{Compiler, ShaderOptions, uniform_bytes};
///
/// let source = "param r = 1 in 0..2\nsphere(r).translate(x: time)";
/// let scene = Compiler::new().compile("a.sdf", source)?;
/// let written = scene.write_shader(&ShaderOptions::default())?;
/// let mut frame = scene.defaults();
/// frame.time = 0.25;
/// let words = [1f32, 0.25, 0.0, 0.0].map(f32::to_le_bytes).concat();
/// assert_eq!(uniform_bytes(&written.reflection, &frame), words);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn uniform_bytes(reflection: &Reflection, frame: &FrameValues) -> Vec<u8> {
    let size = reflection.uniform.as_ref().map_or(0, |uniform| uniform.size);
    let mut bytes = vec![0; size as usize];
    for member in &reflection.members {
        let words = words(member, frame);
        let slot = bytes.get_mut(member.offset as usize..).unwrap_or_default();
        for (to, from) in slot.chunks_exact_mut(4).zip(&words[..member.ty.width()]) {
            to.copy_from_slice(&from.to_le_bytes());
        }
    }
    bytes
}

fn words(member: &Member, frame: &FrameValues) -> [u32; 4] {
    let lanes = match member.input {
        FrameInput::Param(index) => frame.params.get(index as usize).copied().unwrap_or_default(),
        FrameInput::Time => [frame.time, 0.0, 0.0, 0.0],
        FrameInput::Frame => [frame.frame, 0.0, 0.0, 0.0],
    };
    lanes.map(|lane| match member.ty {
        Type::Bool => u32::from(lane != 0.0),
        Type::Scalar | Type::Vec2 | Type::Vec3 | Type::Vec4 => (lane as f32).to_bits(),
    })
}
