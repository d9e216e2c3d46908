//! Names of the parts of a module.

use naga::proc::{CaseInsensitiveKeywordSet, NameKey, Namer};
use naga::{FastHashMap, Module, TypeInner};

use crate::error::Error;
use crate::reflection::ModuleParts;

/// Checks a prefix: letters, digits and `_`, no digit first, no `__`. Both naga and WGSL leave such
/// names unchanged.
pub(crate) fn check_prefix(prefix: &str) -> Result<(), Error> {
    let plain = prefix.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let digit_first = prefix.starts_with(|c: char| c.is_ascii_digit());
    if plain && !digit_first && !prefix.contains("__") {
        Ok(())
    } else {
        Err(Error::BadPrefix(prefix.to_owned()))
    }
}

/// Names functions after their roles, and puts the prefix before all names that the module
/// declares.
pub(crate) fn make_public(module: &mut Module, parts: &ModuleParts, prefix: &str) {
    for &(role, handle) in &parts.functions {
        module.functions.get_mut(handle).name = Some(role.name().to_owned());
    }
    if prefix.is_empty() {
        return;
    }
    let add = |name: &mut Option<String>| {
        if let Some(name) = name {
            name.insert_str(0, prefix);
        }
    };
    let types: Vec<_> = module.types.iter().map(|(handle, ty)| (handle, ty.clone())).collect();
    for (handle, mut ty) in types {
        // MSL declares arrays by name.
        if ty.name.is_none() && matches!(ty.inner, TypeInner::Array { .. }) {
            ty.name = Some("array".to_owned());
        }
        if ty.name.is_some() {
            add(&mut ty.name);
            module.types.replace(handle, ty);
        }
    }
    module.constants.iter_mut().for_each(|(_, constant)| add(&mut constant.name));
    module.global_variables.iter_mut().for_each(|(_, variable)| add(&mut variable.name));
    module.functions.iter_mut().for_each(|(_, function)| add(&mut function.name));
    for entry in &mut module.entry_points {
        entry.name.insert_str(0, prefix);
    }
}

/// Names as naga's WGSL writer gives them: valid identifiers, no keywords, all different.
pub(crate) type Names = FastHashMap<NameKey, String>;

/// Returns the names that naga's WGSL writer gives.
pub(crate) fn final_names(module: &Module) -> Names {
    let mut names = Names::default();
    Namer::default().reset(
        module,
        &naga::keywords::wgsl::RESERVED_SET,
        &naga::keywords::wgsl::BUILTIN_IDENTIFIER_SET,
        CaseInsensitiveKeywordSet::empty(),
        &["__", "_naga"],
        &mut names,
    );
    names
}
