//! Validated modules.

use std::time::Duration;

use naga::Module;
use naga::valid::ModuleInfo;
use sdfc_march::Features;

use crate::error::Error;
use crate::reflect::{reflect, reflect_written};
use crate::reflection::{ModuleParts, Reflection};
use crate::stopwatch::Stopwatch;
use crate::target::{Code, Target};
use crate::write::instructions::{FunctionCost, count};
use crate::write::{self, glsl_select, validate};

/// Prefixes of the functions that writers add: conversions, in HLSL constructors of arrays, and in
/// GLSL ES selections. Two sources in one file would both declare them.
const WRITERS_OWN: [&str; 3] = ["naga_", "Constructarray", glsl_select::NAME];

/// A shader in a target's language, and its reflection with the names of that source.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// Source or words.
    pub code: Code,
    /// Functions, buffers and their names.
    pub reflection: Reflection,
}

/// A validated module.
#[derive(Debug)]
pub struct Shader {
    module: Module,
    info: ModuleInfo,
    parts: ModuleParts,
    features: Features,
    validation: Duration,
    culling: Option<Box<Culling>>,
}

impl Shader {
    pub(crate) fn new(
        module: Module,
        parts: ModuleParts,
        features: Features,
    ) -> Result<Self, Error> {
        let start = Stopwatch::start();
        let info = validate(&module)?;
        Ok(Self { module, info, parts, features, validation: start.elapsed(), culling: None })
    }

    /// Returns the same shader with a culling shader that must run before it.
    pub(crate) fn culled_by(self, culling: Option<Culling>) -> Self {
        Self { culling: culling.map(Box::new), ..self }
    }

    /// Takes the shader that must run before this one on each tile, if [`Features::culled`] is set.
    pub fn take_culling(&mut self) -> Option<Culling> {
        self.culling.take().map(|culling| *culling)
    }

    /// Returns the shader that [`Self::take_culling`] takes.
    pub fn culling(&self) -> Option<&Culling> {
        self.culling.as_deref()
    }

    /// Replaces a constant of the culling shader. Tests break the shader by this; `None` if it has
    /// no such constant.
    #[doc(hidden)]
    pub fn with_broken_culling(mut self, name: &str, number: u32) -> Option<Self> {
        let module = &mut self.culling.as_mut()?.shader.module;
        let known = |constant: &naga::Constant| constant.name.as_deref() == Some(name);
        let init = module.constants.iter().find(|(_, constant)| known(constant))?.1.init;
        *module.global_expressions.get_mut(init) =
            naga::Expression::Literal(naga::Literal::U32(number));
        Some(self)
    }

    /// The time that validation took, that of the culling shader included.
    pub fn validation_time(&self) -> Duration {
        let before = self.culling.as_ref().map(|culling| culling.shader.validation);
        self.validation + before.unwrap_or_default()
    }

    /// Returns the module, for `wgpu::ShaderSource::Naga`.
    pub fn into_module(self) -> Module {
        self.module
    }

    /// Returns the module.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// The contents of the buffer of long lists; empty if there is none.
    pub fn lists(&self) -> &[[f32; 4]] {
        self.parts.lists.as_ref().map_or(&[], |(_, contents)| contents)
    }

    /// The optional parts that were linked.
    pub fn features(&self) -> Features {
        self.features
    }

    /// Functions, uniforms and their names.
    pub fn reflection(&self) -> Reflection {
        reflect(&self.module, &self.parts)
    }

    /// Writes the shader in a target's language. A source begins with `comment`, which is one line
    /// (in GLSL the second line, after the version).
    ///
    /// GLSL holds one stage per source. For a module without entry points, GLSL has all functions
    /// and an empty fragment stage; for one with several, the last. GLSL and Metal drop the groups
    /// of bindings; ES 3.00 drops the bindings too, and its buffers go by
    /// [`crate::Uniform::block`].
    ///
    /// # Errors
    ///
    /// [`Error::Unsupported`] if the language cannot express the module,
    /// [`Error::BindingTooLarge`], and [`Error::Naga`] if naga's writer refuses it.
    pub fn write(&self, target: Target, comment: &str) -> Result<Written, Error> {
        let mut written = write::write(target, &self.module, &self.info, comment)?;
        if let Code::Text(text) = &mut written.code {
            for added in WRITERS_OWN {
                *text = text.replace(added, &format!("{}{added}", self.parts.prefix));
            }
        }
        let reflection = reflect_written(&self.module, &self.parts, &written);
        Ok(Written { code: written.code, reflection })
    }

    /// Returns the source in WGSL, without a comment.
    ///
    /// # Errors
    ///
    /// [`Error::Naga`] if naga's writer refuses the module.
    pub fn wgsl(&self) -> Result<String, Error> {
        write::wgsl(&self.module, &self.info)
    }

    /// Returns the words of the module in SPIR-V 1.3 for Vulkan, with names. A module without an
    /// entry point has the capability `Linkage`.
    ///
    /// # Errors
    ///
    /// [`Error::Naga`] if naga's writer refuses the module.
    pub fn spirv(&self) -> Result<Vec<u32>, Error> {
        write::spirv(&self.module, &self.info)
    }

    /// Counts the instructions of each function for hosts, in SPIR-V as naga writes it, before any
    /// optimiser.
    ///
    /// # Errors
    ///
    /// [`Error::Naga`] if naga's writer refuses the module.
    pub fn instructions(&self) -> Result<Vec<FunctionCost>, Error> {
        let words = self.spirv()?;
        let functions = self.parts.functions.iter().map(|&(role, handle)| {
            (role, self.module.functions[handle].name.clone().unwrap_or_default())
        });
        Ok(count(&words, functions))
    }
}

/// A shader that runs before a picture's, on the tiles that the picture draws next.
///
/// Its entry points for tiles are `mark`, one invocation for each 32 iterations (x), tile of the
/// level (y) and loop (z), to be run for each level from the highest down; and `list`, one for each
/// tile (x). Both have workgroups of 64 by 1. Those for cells are `mark_groups`, one for each group
/// of cells (x), 32 iterations (y) and loop (z), to be run at level 0 and then at level 1; and
/// `list_cells`, one for each cell (x).
///
/// Its bindings are those of the picture; in place of the pixels it has storage arrays of words, at
/// 4 `active_lists`, which the picture reads, at 5 `masks`, and at 7 `counters`, and at 6 the
/// uniform `level`.
#[derive(Debug)]
pub struct Culling {
    /// The shader.
    pub shader: Shader,
    /// The number of iterations of each loop.
    pub iterations: Vec<u32>,
    /// For each loop, true if no iteration need be run outside all cells; `None` if rays do not use
    /// cells.
    pub cells: Option<Vec<bool>>,
    /// True if rays need exact distances outside the surfaces' box, too: those to a light with a
    /// soft shadow do.
    pub soft_shadows: bool,
}
