//! A validated module and what can be written of it.

use std::time::{Duration, Instant};

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, back};
use sdfc_march::Features;

use crate::Error;
use crate::instructions::{FunctionCost, count};
use crate::reflect::{Parts, Reflection, reflect};

/// A validated module.
#[derive(Debug)]
pub struct Shader {
    module: Module,
    info: ModuleInfo,
    parts: Parts,
    features: Features,
    validation: Duration,
}

impl Shader {
    pub(crate) fn new(module: Module, parts: Parts, features: Features) -> Result<Self, Error> {
        let start = Instant::now();
        let info = Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .map_err(|error| Error::Naga(error.emit_to_string("")))?;
        Ok(Self { module, info, parts, features, validation: start.elapsed() })
    }

    /// How long validation took.
    pub fn validation_time(&self) -> Duration {
        self.validation
    }

    /// The module, for `wgpu::ShaderSource::Naga`.
    pub fn into_module(self) -> Module {
        self.module
    }

    /// The module.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// What of `march` was linked.
    pub fn features(&self) -> Features {
        self.features
    }

    /// Functions, uniforms and their names.
    pub fn reflection(&self) -> Reflection {
        reflect(&self.module, &self.parts)
    }

    /// The text in WGSL, without a comment.
    ///
    /// # Errors
    ///
    /// [`Error::Naga`] where naga's writer refuses the module.
    pub fn wgsl(&self) -> Result<String, Error> {
        let flags = back::wgsl::WriterFlags::empty();
        back::wgsl::write_string(&self.module, &self.info, flags)
            .map_err(|error| Error::Naga(error.to_string()))
    }

    /// The words of the module in SPIR-V 1.3 for Vulkan, with names. A module without an entry point
    /// has the capability `Linkage`.
    ///
    /// # Errors
    ///
    /// [`Error::Naga`] where naga's writer refuses the module.
    pub fn spirv(&self) -> Result<Vec<u32>, Error> {
        let options = back::spv::Options {
            lang_version: (1, 3),
            flags: back::spv::WriterFlags::DEBUG | back::spv::WriterFlags::LABEL_VARYINGS,
            ..Default::default()
        };
        back::spv::write_vec(&self.module, &self.info, &options, None)
            .map_err(|error| Error::Naga(error.to_string()))
    }

    /// What each function of the point costs in SPIR-V as naga writes it, before any optimiser.
    ///
    /// # Errors
    ///
    /// [`Error::Naga`] where naga's writer refuses the module.
    pub fn instructions(&self) -> Result<Vec<FunctionCost>, Error> {
        let words = self.spirv()?;
        let functions = self.parts.functions.iter().map(|&(role, handle)| {
            (role, self.module.functions[handle].name.clone().unwrap_or_default())
        });
        Ok(count(&words, functions))
    }
}
