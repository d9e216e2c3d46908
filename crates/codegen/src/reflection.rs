//! The description of a shader for hosts: functions, buffers, structures and their names.

use naga::{GlobalVariable, Handle, ShaderStage};
use sdfc_graph::{FrameInput, Type};

/// The role of a function of a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// The signed distance at a point.
    Distance,
    /// The spatial gradient of the distance; in a module of [`field_module`](crate::field_module)
    /// with the distance in the fourth lane.
    Gradient,
    /// The material at a point.
    Material,
    /// Bounds of the distance along a ray segment.
    Range,
    /// Bounds of the distance's slope along a ray segment.
    SlopeRange,
    /// The first hit of a ray that has a footprint.
    Trace,
    /// The first hit of a ray between two positions.
    Intersect,
}

impl Role {
    /// The function's name, without the prefix.
    pub fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Gradient => "gradient",
            Self::Material => "material",
            Self::Range => "range",
            Self::SlopeRange => "slope_range",
            Self::Trace => "trace",
            Self::Intersect => "intersect",
        }
    }
}

/// A function of a point or a ray that a host may call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionInfo {
    /// Its role.
    pub role: Role,
    /// Its name in the written source.
    pub name: String,
    /// Its declaration in the written source, such as `fn sdf_distance(p: vec3<f32>) -> f32`; for
    /// SPIR-V, as in WGSL.
    pub signature: String,
}

/// A member of the uniform structure of params.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// The input that it sets.
    pub input: FrameInput,
    /// Its name in the written source.
    pub name: String,
    /// Its type in the scene. A boolean is a `u32`, 0 or 1, in the buffer.
    pub ty: Type,
    /// Offset from the start of the structure, in bytes.
    pub offset: u32,
    /// Size in bytes.
    pub size: u32,
}

/// The uniform buffer that the scene's functions read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Uniform {
    /// Name of its structure; `None` for an array of uniform slots.
    pub structure: Option<String>,
    /// Name of the variable.
    pub variable: String,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Size in bytes, a multiple of 16.
    pub size: u32,
    /// Name of its block, in GLSL.
    pub block: Option<String>,
}

/// The contents of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BufferRole {
    /// Camera, limits and lights.
    View,
    /// The per-frame values that the scene's functions read.
    Params,
    /// The pixels of a tile, which the shader writes.
    Pixels,
    /// The long lists that the scene's functions look up.
    Lists,
}

/// A buffer that the host binds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffer {
    /// Its contents.
    pub role: BufferRole,
    /// Name of the variable.
    pub variable: String,
    /// Its type, or that of its elements.
    pub ty: String,
    /// True if it is an array of any length.
    pub is_array: bool,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Size in bytes, of one element for an array; that of a uniform is a multiple of 16.
    pub size: u32,
    /// Name of its block, in GLSL.
    pub block: Option<String>,
}

/// A structure that functions take or return, or that buffers hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Its name in the written source.
    pub name: String,
    /// Size in a buffer, in bytes.
    pub size: u32,
    /// Its members.
    pub members: Vec<StructureMember>,
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructureMember {
    /// Its name in the written source.
    pub name: String,
    /// Its type in WGSL.
    pub ty: String,
    /// Offset from the start of the structure in a buffer, in bytes.
    pub offset: u32,
}

/// The pipeline stage of an entry point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EntryStage {
    /// A vertex stage.
    Vertex,
    /// A fragment stage.
    Fragment,
    /// A compute stage.
    Compute,
}

impl EntryStage {
    /// Returns the stage of naga's name. The files of `sdfc-march` have no other stages.
    pub(crate) fn of(stage: ShaderStage) -> Self {
        if stage == ShaderStage::Vertex {
            Self::Vertex
        } else if stage == ShaderStage::Fragment {
            Self::Fragment
        } else {
            Self::Compute
        }
    }

    /// `vertex`, `fragment` or `compute`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Fragment => "fragment",
            Self::Compute => "compute",
        }
    }
}

/// An entry point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The stage that it is for.
    pub stage: EntryStage,
    /// Its name in the written source.
    pub name: String,
}

/// The interface of a shader for a host. Names are those of the written source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reflection {
    /// Functions that a host may call.
    pub functions: Vec<FunctionInfo>,
    /// Members of the uniform structure; empty for an array of uniform slots.
    pub members: Vec<Member>,
    /// The uniform buffer; `None` if the functions need no per-frame value.
    pub uniform: Option<Uniform>,
    /// All buffers.
    pub buffers: Vec<Buffer>,
    /// The contents of the buffer with the role [`BufferRole::Lists`].
    pub lists: Vec<[f32; 4]>,
    /// The structures of functions and buffers; a structure follows those that it contains.
    pub structures: Vec<Structure>,
    /// The entry points that are written.
    pub entries: Vec<Entry>,
}

/// The parts of a module that the reflection lists, before its names are final.
#[derive(Clone, Debug, Default)]
pub(crate) struct ModuleParts {
    /// The functions for hosts.
    pub(crate) functions: Vec<(Role, Handle<naga::Function>)>,
    /// Members of the uniform structure.
    pub(crate) members: Vec<Member>,
    /// The uniform buffer.
    pub(crate) uniform: Option<Handle<GlobalVariable>>,
    /// The buffer of long lists, and its contents.
    pub(crate) lists: Option<(Handle<GlobalVariable>, Vec<[f32; 4]>)>,
    /// Start of all names that the module declares.
    pub(crate) prefix: String,
}
