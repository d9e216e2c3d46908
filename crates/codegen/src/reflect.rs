//! What a shader offers to those who embed it.

use naga::proc::{CaseInsensitiveKeywordSet, NameKey, Namer};
use naga::{FastHashMap, GlobalVariable, Handle, Module};
use sdfc_graph::{FrameInput, Type};

use crate::target::{Code, Written};

/// What a function computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Signed distance.
    Distance,
    /// Spatial gradient of the distance.
    Gradient,
    /// Material.
    Material,
}

/// A function of the point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionInfo {
    /// What it computes.
    pub role: Role,
    /// Its name in the written text.
    pub name: String,
    /// How the text declares it, such as `fn sdf_distance(p: vec3<f32>) -> f32`; as WGSL would for
    /// SPIR-V.
    pub signature: String,
}

/// A member of the uniform structure of a field module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// What it sets.
    pub input: FrameInput,
    /// Its name in the written text.
    pub name: String,
    /// Its type in the scene; a truth value is a `u32`, 0 or 1, in the buffer.
    pub ty: Type,
    /// Bytes from the start of the structure.
    pub offset: u32,
    /// Bytes.
    pub size: u32,
}

/// The uniform buffer that the scene's functions read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Uniform {
    /// Name of its structure; `None` for an array of slots.
    pub structure: Option<String>,
    /// Name of the variable.
    pub variable: String,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Size in bytes.
    pub size: u32,
    /// In GLSL, the name of its block.
    pub block: Option<String>,
}

/// What a shader offers. Names are those of the written text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reflection {
    /// Functions of the point.
    pub functions: Vec<FunctionInfo>,
    /// Members of the uniform structure; empty for an array of slots.
    pub members: Vec<Member>,
    /// The uniform buffer; `None` where nothing that the functions need is known per frame.
    pub uniform: Option<Uniform>,
}

/// What is known of a module before names are final.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    pub(crate) functions: Vec<(Role, Handle<naga::Function>)>,
    pub(crate) members: Vec<Member>,
    pub(crate) uniform: Option<Handle<GlobalVariable>>,
}

/// Reads the final names off the module.
pub(crate) fn reflect(module: &Module, parts: &Parts) -> Reflection {
    let names = final_names(module);
    let name = |key: NameKey| names.get(&key).cloned().unwrap_or_default();
    let mut reflection = Reflection { members: parts.members.clone(), ..Default::default() };
    for &(role, handle) in &parts.functions {
        let function = &module.functions[handle];
        let function_name = name(NameKey::Function(handle));
        let argument = name(NameKey::FunctionArgument(handle, 0));
        let result = match role {
            Role::Distance => "f32".to_owned(),
            Role::Gradient => "vec3<f32>".to_owned(),
            Role::Material => {
                function.result.as_ref().map_or_else(String::new, |r| name(NameKey::Type(r.ty)))
            }
        };
        let signature = format!("fn {function_name}({argument}: vec3<f32>) -> {result}");
        reflection.functions.push(FunctionInfo { role, name: function_name, signature });
    }
    if let Some(handle) = parts.uniform {
        let variable = &module.global_variables[handle];
        for (member, index) in reflection.members.iter_mut().zip(0..) {
            member.name = name(NameKey::StructMember(variable.ty, index));
        }
        let binding = variable.binding.unwrap_or(naga::ResourceBinding { group: 0, binding: 0 });
        reflection.uniform = Some(Uniform {
            structure: parts.members.first().map(|_| name(NameKey::Type(variable.ty))),
            variable: name(NameKey::GlobalVariable(handle)),
            group: binding.group,
            binding: binding.binding,
            size: module.types[variable.ty].inner.size(module.to_ctx()),
            block: None,
        });
    }
    reflection
}

/// Reads the names off what a writer gave.
pub(crate) fn reflect_written(module: &Module, parts: &Parts, written: &Written) -> Reflection {
    let mut reflection = reflect(module, parts);
    if let Code::Text(text) = &written.code {
        for function in &mut reflection.functions {
            if let Some((name, signature)) = declaration(text, &function.name) {
                *function = FunctionInfo { role: function.role, name, signature };
            }
        }
    }
    if let Some(uniform) = &mut reflection.uniform {
        let mut blocks = written.blocks.iter();
        let block = blocks.find(|(handle, _)| Some(*handle) == parts.uniform);
        uniform.block = block.map(|(_, name)| name.clone());
    }
    reflection
}

/// Name and head of the function of that name in the text, on one line. naga adds `_` to names that the
/// language has itself. Heads stand at the start of a line, calls do not.
fn declaration(text: &str, name: &str) -> Option<(String, String)> {
    [name.to_owned(), format!("{name}_")].into_iter().find_map(|name| {
        let call = format!(" {name}(");
        let mut places = text.match_indices(&call).map(|(place, _)| place);
        places.find_map(|place| {
            let start = text[..place].rfind('\n').map_or(0, |end| end + 1);
            let rest = &text[start..];
            let head = &rest[..rest.find('{')?];
            let is_head = !head.starts_with(char::is_whitespace) && !head.contains([';', '=']);
            let words: Vec<_> = head.split_whitespace().collect();
            let signature = words.join(" ").replace("( ", "(").replace(" )", ")");
            is_head.then(|| (name.clone(), signature))
        })
    })
}

/// Names as naga's WGSL writer gives them: sanitised, off WGSL's words, all different.
fn final_names(module: &Module) -> FastHashMap<NameKey, String> {
    let mut names = FastHashMap::default();
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
