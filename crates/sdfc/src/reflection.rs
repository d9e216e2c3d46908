//! The interface of a written shader and the properties of its field, as data.

use sdfc_analyze::{Promise, Sides as ShapeSides};
use sdfc_codegen::{Buffer, BufferRole, EntryStage, Member, Structure, Written};
use sdfc_graph::{FrameInput, Param, ParamKind, Type};
use serde::{Serialize, Serializer};

use crate::explanation::{Bounds, QualityRow};
use crate::scene::Scene;
use crate::shader::ShaderOptions;

/// The interface of a written shader.
///
/// Other tools rely on the keys of its JSON: new ones may be added, none is renamed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ShaderReflection {
    /// Version of sdfc.
    pub sdfc: &'static str,
    /// The hash of [`Scene::source_hash`].
    pub source_hash: String,
    /// Prefix of every name.
    pub prefix: String,
    /// Shader language.
    pub target: &'static str,
    /// Functions that a host may call.
    pub functions: Vec<FunctionRow>,
    /// Members of the uniform structure, in order.
    pub params: Vec<ParamRow>,
    /// Params that are constants of the shader, because they decide what the scene consists of.
    /// Another value takes another shader.
    pub fixed_params: Vec<FixedParamRow>,
    /// The uniform buffer; null if the shader reads no params.
    pub uniform: Option<UniformRow>,
    /// All buffers that a host binds, including the uniform buffer.
    pub buffers: Vec<BufferRow>,
    /// Contents of the buffer with the role `lists`: 32-bit floats, four per element. Empty without
    /// such a buffer.
    pub lists: Vec<f32>,
    /// Contents of the buffer with the role `view`, for a picture of
    /// [`VIEW_SIZE`](crate::VIEW_SIZE) at the params' defaults and time 0: 32-bit words, floats as
    /// their bits. Empty without such a buffer.
    pub view: Vec<u32>,
    /// Structures of function signatures and buffers. A structure follows those it contains.
    pub structs: Vec<StructRow>,
    /// The entry points.
    pub entry_points: Vec<EntryRow>,
    /// Properties of the field.
    pub certificate: Certificate,
}

/// A function of the point, or of a ray.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct FunctionRow {
    /// `distance`, `gradient`, `material` or `trace`.
    pub role: &'static str,
    /// Name in the shader.
    pub name: String,
    /// Declaration in the shader; in WGSL syntax for SPIR-V.
    pub signature: String,
}

/// A member of the uniform structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ParamRow {
    /// Name in the shader.
    pub name: String,
    /// Name in the scene, or `time` or `frame`.
    pub param: String,
    /// `number`, `int`, `angle` (radians), `bool` (0 or 1, of 32 bits), `color` (linear red, green,
    /// blue, alpha) or `choice` (its index, as a float).
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Offset in the structure, in bytes.
    pub offset: u32,
    /// Size in bytes.
    pub size: u32,
    /// Default value, one number per lane.
    pub default: Vec<f64>,
    /// Lowest value; null without a range.
    pub min: Option<f64>,
    /// Highest value; null without a range.
    pub max: Option<f64>,
    /// Names of the choices, in order of their indices.
    pub choices: Vec<String>,
}

/// A param that is a constant of the shader.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FixedParamRow {
    /// Name in the scene.
    pub param: String,
    /// As in [`ParamRow`].
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The value that the shader was written with, one number per lane.
    pub value: Vec<f64>,
    /// Lowest value; null without a range.
    pub min: Option<f64>,
    /// Highest value; null without a range.
    pub max: Option<f64>,
    /// Names of the choices, in order of their indices.
    pub choices: Vec<String>,
}

/// The uniform buffer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct UniformRow {
    /// Name of its structure; null for an array of values computed per frame.
    #[serde(rename = "struct")]
    pub structure: Option<String>,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Size in bytes, a multiple of 16.
    pub size: u32,
    /// Name of its block in GLSL; otherwise null.
    pub block: Option<String>,
}

/// A buffer that a host binds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct BufferRow {
    /// `view` (camera, limits and lights), `params`, `pixels` (written by the shader), or `lists`
    /// (filled once by the host with [`ShaderReflection::lists`]).
    pub role: &'static str,
    /// Name of the variable.
    pub name: String,
    /// WGSL type of the buffer, or of its elements.
    #[serde(rename = "type")]
    pub ty: String,
    /// True if the host chooses the number of elements.
    pub array: bool,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Size in bytes: of one element for an array, a multiple of 16 for a uniform buffer.
    pub size: u32,
    /// Name of its block in GLSL; otherwise null.
    pub block: Option<String>,
}

/// A structure.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct StructRow {
    /// Name in the shader.
    pub name: String,
    /// Size in a buffer, in bytes.
    pub size: u32,
    /// The members.
    pub members: Vec<MemberRow>,
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct MemberRow {
    /// Name in the shader.
    pub name: String,
    /// WGSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// Offset in a buffer, in bytes.
    pub offset: u32,
}

/// An entry point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct EntryRow {
    /// The stage that it is for.
    #[serde(serialize_with = "stage_name")]
    pub stage: EntryStage,
    /// Name in the shader.
    pub name: String,
}

fn stage_name<S: Serializer>(stage: &EntryStage, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(stage.name())
}

/// Properties of the emitted field, at the params' defaults.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Certificate {
    /// True if every part has a Lipschitz constant: then the field never exceeds the distance.
    pub certified: bool,
    /// Bounds of the scene; null is infinite.
    pub bounds: Bounds,
    /// Lipschitz constant of the emitted field: 1, since the field is divided by its constant, or
    /// null if unknown.
    pub lipschitz: Sides<Option<f64>>,
    /// Promise: `exact`, `bound` or `none`.
    pub promise: Sides<String>,
    /// Factor that turns a distance into a safe step.
    pub step_scale: f64,
    /// The shapes that calls in the scene made, in source order.
    pub parts: Vec<QualityRow>,
}

/// A property outside and inside the surface.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Sides<T> {
    /// Outside, where the field is positive.
    pub outside: T,
    /// Inside, where the field is negative.
    pub inside: T,
}

impl Scene {
    /// Returns the interface of a shader that was written with these options.
    pub fn reflect(&self, options: &ShaderOptions, written: &Written) -> ShaderReflection {
        let found = &written.reflection;
        let functions = found.functions.iter().map(|function| FunctionRow {
            role: function.role.name(),
            name: function.name.clone(),
            signature: function.signature.clone(),
        });
        let uniform = found.uniform.as_ref().map(|uniform| UniformRow {
            structure: uniform.structure.clone(),
            group: uniform.group,
            binding: uniform.binding,
            size: uniform.size,
            block: uniform.block.clone(),
        });
        let entries = found.entries.iter();
        let entries = entries.map(|e| EntryRow { stage: e.stage, name: e.name.clone() });
        ShaderReflection {
            sdfc: env!("CARGO_PKG_VERSION"),
            source_hash: self.source_hash(),
            prefix: options.prefix.clone(),
            target: options.target.name(),
            functions: functions.collect(),
            params: found.members.iter().map(|member| self.param_row(member)).collect(),
            fixed_params: self.fixed_params(),
            uniform,
            buffers: found.buffers.iter().map(buffer_row).collect(),
            lists: found.lists.as_flattened().to_vec(),
            view: self.reflected_view(found),
            structs: found.structures.iter().map(struct_row).collect(),
            entry_points: entries.collect(),
            certificate: self.certificate(),
        }
    }

    /// Returns the view's words. Empty if the settings give no valid view: the host has its own.
    fn reflected_view(&self, found: &sdfc_codegen::Reflection) -> Vec<u32> {
        if !found.buffers.iter().any(|buffer| buffer.role == BufferRole::View) {
            return Vec::new();
        }
        let bytes = self.default_view().unwrap_or_default();
        let words = bytes.as_chunks::<4>().0;
        words.iter().map(|word| u32::from_ne_bytes(*word)).collect()
    }

    fn fixed_params(&self) -> Vec<FixedParamRow> {
        let row = |param: &Param| {
            let [min, max] = finite_ends(param.range);
            Some(FixedParamRow {
                param: param.name.clone(),
                kind: kind_name(param.kind),
                value: param.fixed?[..lanes(param.ty)].to_vec(),
                min,
                max,
                choices: param.choices.clone(),
            })
        };
        self.params().iter().filter_map(row).collect()
    }

    fn param_row(&self, member: &Member) -> ParamRow {
        let row = |param: &str, kind| ParamRow {
            name: member.name.clone(),
            param: param.to_owned(),
            kind,
            offset: member.offset,
            size: member.size,
            default: vec![0.0; lanes(member.ty)],
            min: None,
            max: None,
            choices: Vec::new(),
        };
        let param = match member.input {
            FrameInput::Param(index) => self.params().get(index as usize),
            FrameInput::Time => return row("time", "number"),
            FrameInput::Frame => return row("frame", "int"),
        };
        let Some(Param { name, kind, default, range, choices, .. }) = param else {
            return row(&member.name, "number");
        };
        let [min, max] = finite_ends(*range);
        ParamRow {
            default: default[..lanes(member.ty)].to_vec(),
            min,
            max,
            choices: choices.clone(),
            ..row(name, kind_name(*kind))
        }
    }

    fn certificate(&self) -> Certificate {
        let certified = self.report.uncertified.is_empty();
        let root = self.graph().root;
        let root = self.report.shapes.iter().find(|shape| Some(shape.shape) == root);
        // A 1-Lipschitz field that is 0 on the surface never exceeds the distance to it.
        let least = if certified { Promise::Bound } else { Promise::None };
        let promise = |side: fn(&ShapeSides) -> Promise| {
            root.map_or(Promise::None, |shape| side(&shape.sides)).max(least).to_string()
        };
        let constant = certified.then_some(1.0);
        Certificate {
            certified,
            bounds: self.finite_bounds(),
            lipschitz: Sides { outside: constant, inside: constant },
            promise: Sides { outside: promise(|s| s.outside), inside: promise(|s| s.inside) },
            step_scale: 1.0,
            parts: self.quality_rows(),
        }
    }
}

fn finite_ends(range: Option<[f64; 2]>) -> [Option<f64>; 2] {
    [0, 1].map(|end| range.map(|ends| ends[end]).filter(|end| end.is_finite()))
}

fn buffer_row(buffer: &Buffer) -> BufferRow {
    BufferRow {
        role: buffer_name(buffer.role),
        name: buffer.variable.clone(),
        ty: buffer.ty.clone(),
        array: buffer.is_array,
        group: buffer.group,
        binding: buffer.binding,
        size: buffer.size,
        block: buffer.block.clone(),
    }
}

fn struct_row(structure: &Structure) -> StructRow {
    let members = structure.members.iter().map(|member| MemberRow {
        name: member.name.clone(),
        ty: member.ty.clone(),
        offset: member.offset,
    });
    StructRow { name: structure.name.clone(), size: structure.size, members: members.collect() }
}

fn buffer_name(role: BufferRole) -> &'static str {
    match role {
        BufferRole::View => "view",
        BufferRole::Params => "params",
        BufferRole::Pixels => "pixels",
        BufferRole::Lists => "lists",
    }
}

fn kind_name(kind: ParamKind) -> &'static str {
    match kind {
        ParamKind::Number => "number",
        ParamKind::Int => "int",
        ParamKind::Angle => "angle",
        ParamKind::Bool => "bool",
        ParamKind::Color => "color",
        ParamKind::Choice => "choice",
    }
}

fn lanes(ty: Type) -> usize {
    match ty {
        Type::Bool | Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compiler::Compiler;
    use crate::shader::{Emit, VIEW_SIZE};
    use sdfc_codegen::Target;

    fn reflection(text: &str, target: Target) -> serde_json::Value {
        let scene = Compiler::new().compile("a.sdf", text).unwrap();
        let options = ShaderOptions { target, group: 1, binding: 2, ..Default::default() };
        let written = scene.write_shader(&options).unwrap();
        serde_json::to_value(scene.reflect(&options, &written)).unwrap()
    }

    const SCENE: &str = "param r = 0.5 in 0.1..1\nparam tint = #ff0000\n\
                         (sphere(r) | plane(y: -1)).color(tint)\nsphere(0.2).translate(x: time)";

    #[test]
    fn the_keys_of_the_reflection_are_stable() {
        let found = reflection(SCENE, Target::Wgsl);
        assert_eq!(found["sdfc"], env!("CARGO_PKG_VERSION"));
        assert_eq!(found["source_hash"].as_str().unwrap().len(), 16);
        assert_eq!((&found["prefix"], &found["target"]), (&"sdf_".into(), &"wgsl".into()));
        assert_eq!(found["functions"][0]["role"], "distance");
        assert_eq!(found["functions"][0]["signature"], "fn sdf_distance(p: vec3<f32>) -> f32");
        assert_eq!(found["functions"][2]["name"], "sdf_material");
        let [r, tint, time] = [0, 1, 2].map(|index| &found["params"][index]);
        assert_eq!(
            (&r["name"], &r["type"], &r["offset"]),
            (&"r".into(), &"number".into(), &0.into())
        );
        assert_eq!((r["default"][0].as_f64(), r["min"].as_f64()), (Some(0.5), Some(0.1)));
        assert_eq!((&tint["type"], &tint["offset"]), (&"color".into(), &16.into()));
        assert_eq!((&tint["size"], &tint["max"]), (&16.into(), &serde_json::Value::Null));
        assert_eq!((&time["name"], &time["offset"]), (&"time".into(), &32.into()));
        let uniform = &found["uniform"];
        assert_eq!((&uniform["struct"], &uniform["size"]), (&"sdf_Params".into(), &48.into()));
        assert_eq!((&uniform["group"], &uniform["binding"]), (&1.into(), &2.into()));
    }

    #[test]
    fn a_uniform_buffer_of_one_number_has_sixteen_bytes() {
        let found = reflection("param r = 0.5 in 0.1..1\nsphere(r)", Target::GlslEs);
        assert_eq!(
            (&found["uniform"]["size"], &found["params"][0]["size"]),
            (&16.into(), &4.into())
        );
        assert_eq!(found["buffers"][0]["size"], 16);
    }

    #[test]
    fn the_view_has_a_word_for_every_lane_of_its_structure() {
        let text = "sphere(1)\ncamera(eye: [0, 0, 5], fov: 90deg)";
        let scene = Compiler::new().compile("a.sdf", text).unwrap();
        let options = ShaderOptions { emit: Emit::Render, ..Default::default() };
        let written = scene.write_shader(&options).unwrap();
        let found = scene.reflect(&options, &written);
        let buffer = found.buffers.iter().find(|buffer| buffer.role == "view").unwrap();
        assert_eq!(found.view.len() * 4, buffer.size as usize);
        let structure = found.structs.iter().find(|row| row.name == buffer.ty).unwrap();
        let words = |name: &str| {
            let member = structure.members.iter().find(|member| member.name == name).unwrap();
            &found.view[member.offset as usize / 4..]
        };
        assert_eq!(words("eye")[..3], [0.0, 0.0, 5.0_f32].map(f32::to_bits));
        assert_eq!(words("up")[..3], [0.0, 1.0, 0.0_f32].map(f32::to_bits));
        assert_eq!(words("size")[..2], VIEW_SIZE);
        assert!(reflection("sphere(1)", Target::Wgsl)["view"].as_array().unwrap().is_empty());
    }

    #[test]
    fn the_certificate_holds_the_results_of_the_analysis() {
        let found = reflection(SCENE, Target::Msl);
        let certificate = &found["certificate"];
        assert_eq!(
            (&certificate["certified"], &certificate["step_scale"]),
            (&true.into(), &1.0.into())
        );
        assert!(certificate["bounds"]["max"][0].is_null(), "the plane is infinite");
        assert!((certificate["bounds"]["max"][1].as_f64().unwrap() - 0.5).abs() < 1e-6);
        assert_eq!(certificate["lipschitz"]["outside"], 1.0);
        assert_eq!(certificate["promise"]["outside"], "exact");
        assert_eq!(certificate["promise"]["inside"], "bound");
        assert!(certificate["parts"][0]["line"].as_u64().is_some());
    }

    #[test]
    fn parts_have_jumps_blend_margins_and_bounds() {
        let text = "solid stairs() = p.y - 0.2 * floor(p.x)\n\
                    union(sphere(0.5), box(1), blend: smooth(0.4))\n\
                    sphere(1).round(0.1) - circle(0.2).extrude(3)\nstairs()";
        let found = reflection(text, Target::Wgsl);
        let parts = found["certificate"]["parts"].as_array().unwrap();
        let part = |name: &str| parts.iter().find(|part| part["name"] == name).unwrap();
        let margin = |name| part(name)["blend_margin"].as_f64().unwrap();
        assert!((margin("union") - 0.1).abs() < 1e-3, "{}", margin("union"));
        assert!((margin("round") - 0.1).abs() < 1e-3);
        assert!(margin("difference") < 1e-6, "a hard operator moves no surface");
        assert!(part("sphere")["blend_margin"].is_null());
        assert_eq!(part("stairs")["jump"], "floor");
        assert!(part("union")["jump"].is_null());
        assert_eq!(part("circle")["bounds"]["max"], serde_json::json!([0.2, 0.2, null]));
        assert_eq!(part("sphere")["bounds"]["max"], serde_json::json!([0.5, 0.5, 0.5]));
    }

    #[test]
    fn a_field_without_a_constant_is_not_certified() {
        let found = reflection("solid s() = p.x * p.x + p.y * p.y - 1\ns()", Target::Glsl);
        let certificate = &found["certificate"];
        assert_eq!(certificate["certified"], false);
        assert!(certificate["lipschitz"]["outside"].is_null());
        assert_eq!(certificate["promise"]["outside"], "none");
        assert!(found["uniform"].is_null());
    }
}
