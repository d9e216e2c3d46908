//! Items that all writers share.

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{GlobalVariable, Handle, Module, ResourceBinding};

use crate::error::Error;
use crate::reflection::Entry;
use crate::target::{Code, Target};

/// The result of a writer.
pub(crate) struct WrittenModule {
    pub(crate) code: Code,
    /// The name of each buffer's block, if the language has blocks.
    pub(crate) blocks: Vec<(Handle<GlobalVariable>, String)>,
    /// The entry points, if they differ from the module's or have other names.
    pub(crate) entries: Option<Vec<Entry>>,
}

/// A comment that ends with its line in every language: `\` at the end of a line continues it.
pub(super) fn one_line(comment: &str) -> String {
    comment.chars().map(|c| if c.is_control() || c == '\\' { '?' } else { c }).collect()
}

/// The bindings of all buffers.
pub(super) fn bindings(module: &Module) -> impl Iterator<Item = ResourceBinding> {
    module.global_variables.iter().filter_map(|(_, variable)| variable.binding)
}

/// Converts a number of which a target has 256.
pub(super) fn checked_u8(target: Target, number: u32) -> Result<u8, Error> {
    u8::try_from(number).map_err(|_| Error::BindingTooLarge { target, number })
}

pub(crate) fn validate(module: &Module) -> Result<ModuleInfo, Error> {
    Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(module)
        .map_err(|error| Error::Naga(error.emit_to_string("")))
}

pub(super) fn refused(error: impl std::fmt::Display) -> Error {
    Error::Naga(error.to_string())
}
