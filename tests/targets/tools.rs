//! External validators.

use std::path::Path;
use std::process::{Command, Stdio};

use sdfc::{Code, Emit, Stage, Target};

use crate::Part;

const SHADERTOY: &str = include_str!("shadertoy.glsl");

/// A validator and its target.
pub struct Tool {
    pub program: &'static str,
    pub target: Target,
    /// The argument that prints its version; empty for a library.
    version: &'static str,
    /// The arguments for a part, before the file.
    arguments: fn(Part) -> &'static [&'static str],
}

pub const TOOLS: &[Tool] = &[
    Tool { program: "naga", target: Target::Wgsl, version: "", arguments: |_| &[] },
    Tool {
        program: "tint",
        target: Target::Wgsl,
        version: "--help",
        arguments: |_| &["--format", "wgsl", "-o", "/dev/null"],
    },
    Tool {
        program: "glslangValidator",
        target: Target::Glsl,
        version: "--version",
        arguments: |part| match (part.emit, part.stage) {
            (Emit::Render, Stage::Compute) => &["-S", "comp"],
            (Emit::Render, Stage::Fragment) | (Emit::Field | Emit::March, _) => &["-S", "frag"],
        },
    },
    Tool {
        program: "glslangValidator",
        target: Target::GlslEs,
        version: "--version",
        arguments: |_| &["-S", "frag"],
    },
    Tool {
        program: "glslangValidator",
        target: Target::Shadertoy,
        version: "--version",
        // Linked, so that missing functions are found.
        arguments: |_| &["-l", "-S", "frag"],
    },
    Tool {
        program: "glslangValidator",
        target: Target::Hlsl,
        version: "--version",
        // Parsed only: a field has no entry point for linking.
        arguments: |part| match (part.emit, part.stage) {
            (Emit::Render, Stage::Compute) => {
                &["-D", "-V", "-o", "/dev/null", "-S", "comp", "-e", "sdf_main"]
            }
            (Emit::Render, Stage::Fragment) => {
                &["-D", "-V", "-o", "/dev/null", "-S", "frag", "-e", "sdf_fragment"]
            }
            (Emit::Field | Emit::March, _) => &["-D", "-V", "-o", "/dev/null", "-S", "frag"],
        },
    },
    Tool {
        program: "spirv-val",
        target: Target::Spirv,
        version: "--version",
        // A field is a module for linking, which Vulkan does not allow.
        arguments: |part| match part.emit {
            Emit::Field | Emit::March => &["--target-env", "spv1.3"],
            Emit::Render => &["--target-env", "vulkan1.1"],
        },
    },
];

impl Tool {
    /// Returns true for naga, which is a library.
    fn is_library(&self) -> bool {
        self.version.is_empty()
    }

    pub fn is_installed(&self) -> bool {
        let mut command = Command::new(self.program);
        command.arg(self.version).stdout(Stdio::null()).stderr(Stdio::null());
        self.is_library() || command.status().is_ok()
    }

    /// Returns the installed tool for a target, if there is one.
    pub fn of(target: Target) -> Option<&'static Self> {
        TOOLS.iter().find(|tool| tool.target == target && tool.is_installed())
    }

    /// Validates the code. The error is the output of the tool.
    pub fn check(&self, part: Part, code: &Code) -> Result<(), String> {
        if self.is_library() {
            return check_with_naga(code);
        }
        let name = format!("{}.{}.{}", self.program, part.name, self.target.name());
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let before = if self.target == Target::Shadertoy { SHADERTOY } else { "" };
        let bytes = [before.as_bytes(), &code.clone().into_bytes()].concat();
        std::fs::write(&file, bytes).map_err(|e| e.to_string())?;
        let mut command = Command::new(self.program);
        command.args((self.arguments)(part)).arg(&file).stdin(Stdio::null());
        let output = command.output().map_err(|e| e.to_string())?;
        if output.status.success() {
            return Ok(());
        }
        let message = [output.stdout, output.stderr].concat();
        Err(String::from_utf8_lossy(&message).into_owned())
    }
}

/// Parses and validates WGSL.
fn check_with_naga(code: &Code) -> Result<(), String> {
    let Code::Text(text) = code else { return Err("no text".to_owned()) };
    let module = naga::front::wgsl::parse_str(text).map_err(|e| e.emit_to_string(text))?;
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::default())
        .validate(&module)
        .map_err(|e| e.emit_to_string(text))?;
    Ok(())
}
