//! The parts of shaders that can be written, and programs that validate them.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use rayon::prelude::*;
use sdfc::{Code, Emit, Scene, ShaderOptions, Stage, Target};
use tempfile::NamedTempFile;

const SHADERTOY: &str = include_str!("../targets/shadertoy.glsl");

/// The most files that are passed to one process.
const MOST_FILES: usize = 32;

/// A part of a shader, with the options that select it.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The name in messages and in the table.
    pub name: &'static str,
    /// The part.
    pub emit: Emit,
    /// The stage of the part, if it has one.
    pub stage: Stage,
}

/// All parts.
pub const PARTS: [Part; 4] = [
    Part { name: "field", emit: Emit::Field, stage: Stage::Compute },
    Part { name: "march", emit: Emit::March, stage: Stage::Compute },
    Part { name: "compute", emit: Emit::Render, stage: Stage::Compute },
    Part { name: "fragment", emit: Emit::Render, stage: Stage::Fragment },
];

/// Returns true if a target supports a part.
pub fn is_supported(target: Target, part: Part) -> bool {
    let has_stage = part.emit != Emit::Render || target.has_stage(part.stage);
    has_stage && (target != Target::Shadertoy || part.emit == Emit::Render)
}

/// Returns true if a part of a scene's shader can be written. Regions have no rays to march.
pub fn is_written(scene: &Scene, target: Target, part: Part) -> bool {
    is_supported(target, part) && (part.emit != Emit::March || !scene.is_planar())
}

/// Writes a part of a scene's shader.
///
/// # Errors
///
/// As [`Scene::write_shader`].
pub fn write(scene: &Scene, target: Target, part: Part) -> Result<Code, sdfc::Error> {
    let Part { emit, stage, .. } = part;
    let options = ShaderOptions::new().target(target).emit(emit).stage(stage);
    Ok(scene.write_shader(&options)?.code)
}

/// A validator and its target.
pub struct Tool {
    /// The program that is run.
    pub program: &'static str,
    /// The language that it validates.
    pub target: Target,
    /// The argument that prints its version; empty for a library.
    version: &'static str,
    /// The arguments for a part, before the file.
    arguments: fn(Part) -> &'static [&'static str],
}

/// All validators.
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

    /// Returns true if the validator can be run.
    pub fn is_installed(&self) -> bool {
        let mut command = Command::new(self.program);
        command.arg(self.version).stdout(Stdio::null()).stderr(Stdio::null());
        self.is_library() || command.status().is_ok()
    }

    /// Returns the installed tool for a target, if there is one.
    pub fn of(target: Target) -> Option<&'static Self> {
        TOOLS.iter().find(|tool| tool.target == target && tool.is_installed())
    }

    /// Validates the code.
    ///
    /// # Errors
    ///
    /// The output of the tool.
    pub fn check(&self, part: Part, code: &Code) -> Result<(), String> {
        if self.is_library() {
            return check_with_naga(code);
        }
        let file = self.file(code).map_err(|e| e.to_string())?;
        self.run(part, [file.path()])
    }

    /// Validates many parts, each with a name for messages. If the tool validates many files in one
    /// process, it gets many: glslangValidator takes 75 ms to start, and 15 ms for a shader. Others
    /// run on all threads.
    ///
    /// # Errors
    ///
    /// The name of a part and the output of the tool.
    pub fn check_all<'c>(
        &self,
        codes: impl IntoIterator<Item = (String, Part, &'c Code)>,
    ) -> Result<(), String> {
        let failed = |name: &str, error: String| format!("{name}: {error}");
        if !self.takes_many_files() {
            let codes: Vec<_> = codes.into_iter().collect();
            return codes.par_iter().try_for_each(|(name, part, code)| {
                self.check(*part, code).map_err(|error| failed(name, error))
            });
        }
        let mut groups: BTreeMap<&[&str], Vec<(String, Part, NamedTempFile)>> = BTreeMap::new();
        for (name, part, code) in codes {
            let file = self.file(code).map_err(|e| e.to_string())?;
            groups.entry((self.arguments)(part)).or_default().push((name, part, file));
        }
        for group in groups.values().flat_map(|group| group.chunks(MOST_FILES)) {
            if self.run(group[0].1, group.iter().map(|(_, _, file)| file.path())).is_err() {
                for (name, part, file) in group {
                    self.run(*part, [file.path()]).map_err(|error| failed(name, error))?;
                }
                return Err(format!("{} refuses files that it accepts alone", self.program));
            }
        }
        Ok(())
    }

    /// Returns true if the tool validates each of its files by itself. glslangValidator does,
    /// unless it links them.
    fn takes_many_files(&self) -> bool {
        matches!(self.target, Target::Glsl | Target::GlslEs)
    }

    /// Writes the code into a file.
    fn file(&self, code: &Code) -> std::io::Result<NamedTempFile> {
        let before = if self.target == Target::Shadertoy { SHADERTOY } else { "" };
        // Some tools tell the language by the end of the name.
        let ending = format!(".{}", self.target.name());
        let mut file = tempfile::Builder::new().suffix(&ending).tempfile()?;
        file.write_all(before.as_bytes())?;
        file.write_all(&code.clone().into_bytes())?;
        Ok(file)
    }

    fn run<'p>(&self, part: Part, files: impl IntoIterator<Item = &'p Path>) -> Result<(), String> {
        let mut command = Command::new(self.program);
        command.args((self.arguments)(part)).args(files).stdin(Stdio::null());
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
