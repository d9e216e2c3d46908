//! Compiles WGSL to optimised SPIR-V and counts its arithmetic instructions.

use std::io::Write;
use std::process::{Command, Stdio};

/// The words of a SPIR-V module.
pub type Words = Vec<u32>;

/// An instruction. The operands include the result type and the result.
pub struct Instruction<'a> {
    pub opcode: u16,
    pub operands: &'a [u32],
}

/// Compiles WGSL with naga.
pub fn compile(wgsl: &str) -> Result<Words, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| e.emit_to_string(wgsl))?;
    let flags = naga::valid::ValidationFlags::all();
    let info = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
        .validate(&module)
        .map_err(|e| e.emit_to_string(wgsl))?;
    let options = naga::back::spv::Options {
        flags: naga::back::spv::WriterFlags::empty(),
        ..naga::back::spv::Options::default()
    };
    naga::back::spv::write_vec(&module, &info, &options, None).map_err(|e| e.to_string())
}

/// Returns true if `spirv-opt` is installed.
pub fn has_optimizer() -> bool {
    let status = Command::new("spirv-opt").arg("--version").stdout(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// Validates a module with `spirv-val` and optimises it with `spirv-opt -O`.
pub fn optimize(words: &[u32]) -> Result<Words, String> {
    pipe("spirv-val", &["--target-env", "vulkan1.1", "-"], words)?;
    let bytes = pipe("spirv-opt", &["-O", "-", "-o", "-"], words)?;
    Ok(bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
}

fn pipe(tool: &str, args: &[&str], words: &[u32]) -> Result<Vec<u8>, String> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut child = Command::new(tool)
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| format!("{tool}: {e}"))?;
    // Both tools read all of their input before they write.
    child.stdin.take().ok_or("no stdin")?.write_all(&bytes).map_err(|e| e.to_string())?;
    let output = child.wait_with_output().map_err(|e| e.to_string())?;
    if output.status.success() {
        Ok(output.stdout)
    } else {
        Err(format!("{tool}: {}", String::from_utf8_lossy(&output.stderr)))
    }
}

/// Returns the instructions, which follow the five words of the header.
pub fn instructions(words: &[u32]) -> Vec<Instruction<'_>> {
    let mut rest = words.get(5..).unwrap_or(&[]);
    let mut found = Vec::new();
    while let [head, ..] = rest {
        let length = ((head >> 16) as usize).clamp(1, rest.len());
        found.push(Instruction { opcode: (head & 0xffff) as u16, operands: &rest[1..length] });
        rest = &rest[length..];
    }
    found
}

/// Returns the number of arithmetic instructions. README.md explains the ranges of opcodes.
pub fn arithmetic(words: &[u32]) -> usize {
    let counts = |opcode| matches!(opcode, 12 | 109..=115 | 126..=152 | 154..=191 | 194..=205);
    instructions(words).iter().filter(|found| counts(found.opcode)).count()
}
