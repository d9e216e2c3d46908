//! What a written shader offers, and what is known of its field, for programs.

use sdfc_analyze::{Promise, Sides as ShapeSides};
use sdfc_codegen::{Buffer, BufferRole, Member, Structure, Written};
use sdfc_graph::{FrameInput, Param, ParamKind, Type};
use serde::Serialize;

use crate::{Bounds, QualityRow, Scene, ShaderOptions};

/// The reflection of a written shader. The keys are a promise to other tools: some may be added, none
/// renamed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShaderReflection {
    /// Version of sdfc.
    pub sdfc: &'static str,
    /// As [`Scene::source_hash`].
    pub source_hash: String,
    /// Start of every name.
    pub prefix: String,
    /// The language.
    pub target: &'static str,
    /// Functions that a host may call.
    pub functions: Vec<FunctionRow>,
    /// Members of the uniform structure, in its order.
    pub params: Vec<ParamRow>,
    /// The uniform buffer; null where nothing is known per frame only.
    pub uniform: Option<UniformRow>,
    /// All buffers that a host binds, that one included.
    pub buffers: Vec<BufferRow>,
    /// What the buffer of the role `lists` holds: numbers of 32 bits, four to an element. Empty without one.
    pub lists: Vec<f32>,
    /// What the buffer of the role `view` holds for a picture of [`VIEW_SIZE`](crate::VIEW_SIZE) at the params' defaults and time 0: words
    /// of 32 bits, floats by their bits. Empty without one.
    pub view: Vec<u32>,
    /// The structures that functions take or give and buffers hold, members before what holds them.
    pub structs: Vec<StructRow>,
    /// The entry points.
    pub entry_points: Vec<EntryRow>,
    /// What is known of the field.
    pub certificate: Certificate,
}

/// A function of the point, or of a ray.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FunctionRow {
    /// `distance`, `gradient`, `material` or `trace`.
    pub role: &'static str,
    /// Its name in the text.
    pub name: String,
    /// How the text declares it; as WGSL would for SPIR-V.
    pub signature: String,
}

/// A member of the uniform structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParamRow {
    /// Its name in the text.
    pub name: String,
    /// Its name in the scene, `time` or `frame`.
    pub param: String,
    /// `number`, `int`, `angle` (radians), `bool` (0 or 1, of 32 bits), `color` (linear red, green,
    /// blue, alpha) or `choice` (its index, as a float).
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Bytes from the start of the structure.
    pub offset: u32,
    /// Bytes.
    pub size: u32,
    /// Its default, one number for each lane.
    pub default: Vec<f64>,
    /// Least value; null without a range.
    pub min: Option<f64>,
    /// Greatest value; null without a range.
    pub max: Option<f64>,
    /// Names of the choices, in the order of their indices.
    pub choices: Vec<String>,
}

/// The uniform buffer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UniformRow {
    /// Name of its structure in the text; null for an array of values computed per frame.
    #[serde(rename = "struct")]
    pub structure: Option<String>,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Bytes, a multiple of 16.
    pub size: u32,
    /// In GLSL, the name of its block; else null.
    pub block: Option<String>,
}

/// A buffer that a host binds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BufferRow {
    /// `view`: camera, limits and lights; `params`; `pixels`, which the shader writes; or `lists`, which a
    /// host fills once with [`ShaderReflection::lists`].
    pub role: &'static str,
    /// Name of its variable.
    pub name: String,
    /// Its type as WGSL calls it, or that of its elements.
    #[serde(rename = "type")]
    pub ty: String,
    /// Whether it has as many elements as the host likes.
    pub array: bool,
    /// Bind group.
    pub group: u32,
    /// Binding in the group.
    pub binding: u32,
    /// Bytes, of one element where there may be many; of a uniform a multiple of 16.
    pub size: u32,
    /// In GLSL, the name of its block; else null.
    pub block: Option<String>,
}

/// A structure.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StructRow {
    /// Its name in the text.
    pub name: String,
    /// Bytes in a buffer.
    pub size: u32,
    /// Its members.
    pub members: Vec<MemberRow>,
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MemberRow {
    /// Its name in the text.
    pub name: String,
    /// Its type as WGSL calls it.
    #[serde(rename = "type")]
    pub ty: String,
    /// Bytes from the start of the structure in a buffer.
    pub offset: u32,
}

/// An entry point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct EntryRow {
    /// `vertex`, `fragment` or `compute`.
    pub stage: &'static str,
    /// Its name in the text.
    pub name: String,
}

/// What is known of the emitted field, at the params' defaults.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Certificate {
    /// Whether every part has a Lipschitz constant: then the field never exceeds the distance.
    pub certified: bool,
    /// Where the scene lies; null where infinite.
    pub bounds: Bounds,
    /// Constant of the emitted field, which is divided where it must be: 1, or null where not known.
    pub lipschitz: Sides<Option<f64>>,
    /// `exact`, `bound` or `none`.
    pub promise: Sides<String>,
    /// By what the distance is multiplied to be a safe step.
    pub step_scale: f64,
    /// The calls of the scene that made shapes, in order of place.
    pub parts: Vec<QualityRow>,
}

/// A property outside and inside the surface.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Sides<T> {
    /// Where the field is positive.
    pub outside: T,
    /// Where it is negative.
    pub inside: T,
}

impl Scene {
    /// What a shader that was written with these options offers.
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
            uniform,
            buffers: found.buffers.iter().map(buffer_row).collect(),
            lists: found.lists.as_flattened().to_vec(),
            view: self.reflected_view(found),
            structs: found.structures.iter().map(struct_row).collect(),
            entry_points: entries.collect(),
            certificate: self.certificate(),
        }
    }

    /// Empty too where the settings make no picture: a host may have others.
    fn reflected_view(&self, found: &sdfc_codegen::Reflection) -> Vec<u32> {
        if !found.buffers.iter().any(|buffer| buffer.role == BufferRole::View) {
            return Vec::new();
        }
        let bytes = self.default_view().unwrap_or_default();
        let words = bytes.as_chunks::<4>().0;
        words.iter().map(|word| u32::from_ne_bytes(*word)).collect()
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
        ParamRow {
            default: default[..lanes(member.ty)].to_vec(),
            min: range.map(|range| range[0]).filter(|end| end.is_finite()),
            max: range.map(|range| range[1]).filter(|end| end.is_finite()),
            choices: choices.clone(),
            ..row(name, kind_name(*kind))
        }
    }

    fn certificate(&self) -> Certificate {
        let certified = self.report.uncertified.is_empty();
        let root = self.graph().root;
        let root = self.report.shapes.iter().find(|shape| Some(shape.shape) == root);
        // What is 1-Lipschitz and 0 on the surface never exceeds the distance to it.
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
    use crate::{ShaderOptions, Target, compile};

    fn reflection(text: &str, target: Target) -> serde_json::Value {
        let compiled = compile("a.sdf", text);
        let scene = compiled.scene.unwrap();
        let options = ShaderOptions { target, group: 1, binding: 2, ..Default::default() };
        let written = scene.write_shader(&options).unwrap();
        serde_json::to_value(scene.reflect(&options, &written)).unwrap()
    }

    const SCENE: &str = "param r = 0.5 in 0.1..1\nparam tint = #ff0000\n\
                         (sphere(r) | plane(y: -1)).color(tint)\nsphere(0.2).translate(x: time)";

    #[test]
    fn the_keys_are_those_that_other_tools_rely_on() {
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
    fn a_uniform_of_one_number_takes_sixteen_bytes() {
        let found = reflection("param r = 0.5 in 0.1..1\nsphere(r)", Target::GlslEs);
        assert_eq!(
            (&found["uniform"]["size"], &found["params"][0]["size"]),
            (&16.into(), &4.into())
        );
        assert_eq!(found["buffers"][0]["size"], 16);
    }

    #[test]
    fn the_view_has_a_word_for_every_lane_of_its_structure() {
        let compiled = compile("a.sdf", "sphere(1)\ncamera(eye: [0, 0, 5], fov: 90deg)");
        let scene = compiled.scene.unwrap();
        let options = ShaderOptions { emit: crate::Emit::Render, ..Default::default() };
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
        assert_eq!(words("size")[..2], crate::VIEW_SIZE);
        assert!(reflection("sphere(1)", Target::Wgsl)["view"].as_array().unwrap().is_empty());
    }

    #[test]
    fn the_certificate_says_what_the_analysis_found() {
        let found = reflection(SCENE, Target::Msl);
        let certificate = &found["certificate"];
        assert_eq!(
            (&certificate["certified"], &certificate["step_scale"]),
            (&true.into(), &1.0.into())
        );
        assert!(certificate["bounds"]["max"][0].is_null(), "the plane is without end");
        assert!((certificate["bounds"]["max"][1].as_f64().unwrap() - 0.5).abs() < 1e-6);
        assert_eq!(certificate["lipschitz"]["outside"], 1.0);
        assert_eq!(certificate["promise"]["outside"], "exact");
        assert_eq!(certificate["promise"]["inside"], "bound");
        assert!(certificate["parts"][0]["line"].as_u64().is_some());
    }

    #[test]
    fn parts_tell_of_jumps_blends_and_bounds() {
        let text = "solid stairs() = p.y - 0.2 * floor(p.x)\n\
                    union(sphere(0.5), box(1), blend: smooth(0.4))\n\
                    sphere(1).round(0.1) - circle(0.2).extrude(3)\nstairs()";
        let found = reflection(text, Target::Wgsl);
        let parts = found["certificate"]["parts"].as_array().unwrap();
        let part = |name: &str| parts.iter().find(|part| part["name"] == name).unwrap();
        let margin = |name| part(name)["blend_margin"].as_f64().unwrap();
        assert!((margin("union") - 0.1).abs() < 1e-3, "{}", margin("union"));
        assert!((margin("round") - 0.1).abs() < 1e-3);
        assert!(margin("difference") < 1e-6, "a hard operator carries nothing");
        assert!(part("sphere")["blend_margin"].is_null());
        assert_eq!(part("stairs")["jump"], "floor");
        assert!(part("union")["jump"].is_null());
        assert_eq!(part("circle")["bounds"]["max"], serde_json::json!([0.2, 0.2, null]));
        assert_eq!(part("sphere")["bounds"]["max"], serde_json::json!([0.5, 0.5, 0.5]));
    }

    #[test]
    fn without_a_constant_nothing_is_certified() {
        let found = reflection("solid s() = p.x * p.x + p.y * p.y - 1\ns()", Target::Glsl);
        let certificate = &found["certificate"];
        assert_eq!(certificate["certified"], false);
        assert!(certificate["lipschitz"]["outside"].is_null());
        assert_eq!(certificate["promise"]["outside"], "none");
        assert!(found["uniform"].is_null());
    }
}
