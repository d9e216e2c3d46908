//! Names and declarations in a written source.
//!
//! Only naga's WGSL writer reports its names. Those of the other writers are read off their source,
//! in which top-level declarations start a line.

use naga::Module;
use naga::TypeInner;
use naga::proc::NameKey;

use crate::names::{Names, final_names};
use crate::target::Code;

/// Returns the written names of functions, structures, members and variables.
pub(super) fn written_names(module: &Module, code: &Code) -> Names {
    let mut names = final_names(module);
    match code {
        Code::Words(_) => take_raw_names(module, &mut names),
        Code::Text(text) => take_structures(module, text, &mut names),
    }
    names
}

/// SPIR-V has names for debugging only, which are those of the module.
fn take_raw_names(module: &Module, names: &mut Names) {
    let mut take = |key: NameKey, name: &Option<String>| {
        if let Some(name) = name {
            names.insert(key, name.clone());
        }
    };
    for (handle, function) in module.functions.iter() {
        take(NameKey::Function(handle), &function.name);
        for (argument, index) in function.arguments.iter().zip(0..) {
            take(NameKey::FunctionArgument(handle, index), &argument.name);
        }
    }
    for (handle, variable) in module.global_variables.iter() {
        take(NameKey::GlobalVariable(handle), &variable.name);
    }
    for (handle, ty) in module.types.iter() {
        take(NameKey::Type(handle), &ty.name);
        if let TypeInner::Struct { members, .. } = &ty.inner {
            for (member, index) in members.iter().zip(0..) {
                take(NameKey::StructMember(handle, index), &member.name);
            }
        }
    }
    for (entry, index) in module.entry_points.iter().zip(0..) {
        take(NameKey::EntryPoint(index), &Some(entry.name.clone()));
    }
}

fn take_structures(module: &Module, text: &str, names: &mut Names) {
    for (handle, ty) in module.types.iter() {
        let TypeInner::Struct { members, .. } = &ty.inner else { continue };
        let known = names.get(&NameKey::Type(handle)).cloned().unwrap_or_default();
        let Some((name, found)) = structure(text, &known) else { continue };
        names.insert(NameKey::Type(handle), name);
        if found.len() == members.len() {
            for (member, index) in found.into_iter().zip(0..) {
                names.insert(NameKey::StructMember(handle, index), member);
            }
        }
    }
}

/// A name as it is, and as naga writes it if it is a keyword of the language.
fn spellings(name: &str) -> [String; 2] {
    [name.to_owned(), format!("{name}_")]
}

/// Name and members of the structure of that name, without padding members.
fn structure(text: &str, name: &str) -> Option<(String, Vec<String>)> {
    spellings(name).into_iter().find_map(|name| {
        let declaration = format!("struct {name} {{\n");
        let start = text.find(&declaration)? + declaration.len();
        let lines = text[start..].lines().take_while(|line| !line.starts_with('}'));
        let members = lines.filter_map(member).map(str::to_owned).collect();
        Some((name, members))
    })
}

/// The name in `name: type,` or in `type name;`, `type name[8];`.
fn member(line: &str) -> Option<&str> {
    let line = line.trim();
    let name = match line.strip_suffix(',') {
        Some(line) => line.split(':').next()?,
        None => line.split([';', '[']).next()?.rsplit(' ').next()?,
    };
    let is_gap = ["_pad", "_end_pad"].iter().any(|gap| name.starts_with(gap));
    (!is_gap && !name.is_empty()).then_some(name)
}

/// Name and declaration, on one line, of the function of that name. Declarations stand at the start
/// of a line, calls do not.
pub(super) fn declaration(text: &str, name: &str) -> Option<(String, String)> {
    spellings(name).into_iter().find_map(|name| {
        let call = format!(" {name}(");
        let mut starts = text.match_indices(&call).map(|(position, _)| position);
        starts.find_map(|position| {
            let start = text[..position].rfind('\n').map_or(0, |end| end + 1);
            let rest = &text[start..];
            let declaration = &rest[..rest.find('{')?];
            let is_declaration =
                !declaration.starts_with(char::is_whitespace) && !declaration.contains([';', '=']);
            let words: Vec<_> = declaration.split_whitespace().collect();
            let signature = words.join(" ").replace("( ", "(").replace(" )", ")");
            is_declaration.then(|| (name.clone(), signature))
        })
    })
}
