//! Pictures without buffers: the values that a host would bind are written into the shader.

use naga::{
    Arena, ArraySize, Constant, Expression, Function, GlobalVariable, Handle, Literal, Module,
    Scalar, Span, Statement, TypeInner,
};
use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{Camera, FormulaChoice, FrameInput, Lens, Node, NodeId, Program, Type};
use sdfc_march::{Form, Method, stubs};

use super::linker::PictureLinker;
use crate::error::Error;
use crate::link::template::{bind, find_function, find_variable};
use crate::lower::body::Body;
use crate::lower::inputs::{Inputs, Raw, input_name, raw_inputs};
use crate::lower::{POINT, struct_function, types};
use crate::shader::Shader;

/// The members of the view that `set_view` of `shadertoy.wgsl` sets.
const SET_BY_CAMERA: [&str; 5] = ["forward", "right", "up", "pixel_radius", "size"];

/// Makes the shader of a program's picture for [`crate::Target::Shadertoy`]. Params are constants
/// with their defaults, `time` and `frame` follow the site's clock, and the camera is the scene's.
/// If the picture has rays, the rest of the view is constant: `view` holds the bytes of a
/// `sdfc_march::ViewBlock`, as a buffer would.
///
/// # Errors
///
/// As [`crate::render_module`]; [`Error::ViewBytes`].
pub fn shadertoy_module(program: &Program, method: Method, view: &[u8]) -> Result<Shader, Error> {
    let program = &program.by_formulas(FormulaChoice::Portable).guarded();
    let mut picture = PictureLinker::new(
        program,
        Form::Shadertoy,
        method.definition(),
        None,
        &unused_loads(program),
        false,
    )?;
    picture.module.entry_points.clear();

    let camera = program.settings.camera.as_ref().map(camera_nodes);
    let mut nodes = picture.slot_nodes();
    nodes.extend(camera.into_iter().flatten());
    let raw = declare_raw(&mut picture.module, program, &nodes)?;
    picture.compute_slots(Inputs::of_raw(raw.clone()))?;
    picture.bind()?;

    let values = View::new(&picture.module, view)?;
    if !program.is_planar() {
        let load = values.load_function(&mut picture.module);
        bind(&mut picture.module, stubs::LOAD_VIEW, load)?;
    }
    let camera = match camera {
        Some(nodes) => camera_of_scene(&mut picture.module, program, &Inputs::of_raw(raw), &nodes)?,
        None => camera_of_view(&mut picture.module, &values, program.is_planar())?,
    };
    bind(&mut picture.module, stubs::CAMERA, camera)?;
    picture.finish()
}

/// The nodes of a camera, in the order of `Camera` in `shadertoy.wgsl`.
fn camera_nodes(camera: &Camera) -> [NodeId; 4] {
    let Camera { eye, target, up, lens: Lens::Fov(lens) | Lens::Height(lens) } = *camera;
    [eye, target, up, lens]
}

/// The functions of `shadertoy.wgsl` that the program does not need.
fn unused_loads(program: &Program) -> Vec<&'static str> {
    let mut nodes = program.uniforms.clone();
    nodes.extend(program.settings.camera.iter().flat_map(camera_nodes));
    let raw = raw_inputs(program, &nodes);
    let is_used = |input| raw.iter().any(|(found, _)| *found == input);
    let is_param = |node| matches!(node, Node::Frame(FrameInput::Param(_), _));
    let only_params = program.uniforms.iter().all(|&node| is_param(program.graph.node(node)));
    let calls = [
        (stubs::LOAD_FRAME, !only_params),
        (stubs::LOAD_TIME, is_used(FrameInput::Time)),
        (stubs::LOAD_COUNT, is_used(FrameInput::Frame)),
        (stubs::LOAD_HEADLIGHT, program.settings.has_headlight()),
    ];
    calls.into_iter().filter(|call| !call.1).map(|call| call.0).collect()
}

/// Declares the raw inputs: params are constants, declared before all others; `time` and `frame`
/// are variables of the file.
fn declare_raw(
    module: &mut Module,
    program: &Program,
    nodes: &[NodeId],
) -> Result<FxHashMap<FrameInput, Raw>, Error> {
    let mut sources = FxHashMap::default();
    let others = std::mem::take(&mut module.constants);
    for (input, ty) in raw_inputs(program, nodes) {
        let source = match input {
            FrameInput::Param(index) => {
                let param = program.params.get(index as usize);
                let value = param.map_or([0.0; 4], |param| param.default);
                let name = input_name(program, input);
                Raw::Constant(declare_constant(module, &name, ty, value))
            }
            FrameInput::Time | FrameInput::Frame => {
                let name = if input == FrameInput::Time { "time" } else { "frame" };
                let variable = find_variable(module, name);
                Raw::Variable(variable.ok_or(Error::MissingRoot("clock"))?)
            }
        };
        sources.insert(input, source);
    }
    append_constants(module, others);
    Ok(sources)
}

fn declare_constant(
    module: &mut Module,
    name: &str,
    ty: Type,
    value: [f64; 4],
) -> Handle<Constant> {
    let literal = |lane: f64| match ty {
        Type::Bool => Literal::Bool(lane != 0.0),
        Type::Scalar | Type::Vec2 | Type::Vec3 | Type::Vec4 => Literal::F32(lane as f32),
    };
    let lanes = value[..ty.width()].iter().map(|&lane| literal(lane));
    let ty = types::value(&mut module.types, ty);
    let components: Vec<_> = lanes
        .map(|lane| module.global_expressions.append(Expression::Literal(lane), Span::UNDEFINED))
        .collect();
    let init = match components[..] {
        [single] => single,
        _ => {
            let compose = Expression::Compose { ty, components };
            module.global_expressions.append(compose, Span::UNDEFINED)
        }
    };
    module.constants.append(Constant { name: Some(name.to_owned()), ty, init }, Span::UNDEFINED)
}

/// Appends constants to the module's, and updates the expressions that read them.
fn append_constants(module: &mut Module, others: Arena<Constant>) {
    let mut moved = FxHashMap::default();
    for (old, constant) in others.iter() {
        moved.insert(old, module.constants.append(constant.clone(), Span::UNDEFINED));
    }
    // The new constants' expressions are literals, so none of them reads an old constant.
    let functions = module.functions.iter_mut().map(|(_, f)| &mut f.expressions);
    for expressions in functions.chain([&mut module.global_expressions]) {
        for (_, expression) in expressions.iter_mut() {
            if let Expression::Constant(constant) = expression
                && let Some(&new) = moved.get(constant)
            {
                *constant = new;
            }
        }
    }
}

fn camera_of_scene(
    module: &mut Module,
    program: &Program,
    inputs: &Inputs,
    nodes: &[NodeId],
) -> Result<Function, Error> {
    let structure = camera_type(module)?;
    struct_function(program, inputs, &mut module.types, stubs::CAMERA, (nodes, structure), &[POINT])
}

/// The camera of the view: in perspective, or parallel for a planar picture.
fn camera_of_view(module: &mut Module, view: &View<'_>, parallel: bool) -> Result<Function, Error> {
    let structure = camera_type(module)?;
    let vector = types::value(&mut module.types, Type::Vec3);
    let [eye, forward, up] = [view.vector("eye")?, view.vector("forward")?, view.vector("up")?];
    let center = [0, 1, 2].map(|axis| eye[axis] + forward[axis]);
    let half_height = up.iter().map(|lane| lane * lane).sum::<f32>().sqrt();
    let mut body = Body::default();
    let mut components = Vec::new();
    for lanes in [eye, center, up] {
        let lanes = lanes.map(|lane| body.literal(lane)).to_vec();
        let compose = Expression::Compose { ty: vector, components: lanes.clone() };
        components.push(body.compute(compose, &lanes));
    }
    let lens = if parallel { half_height } else { half_height.atan() };
    components.push(body.literal(2.0 * lens));
    let compose = Expression::Compose { ty: structure, components: components.clone() };
    let camera = body.compute(compose, &components);
    Ok(body.finish(Some(camera)))
}

fn camera_type(module: &Module) -> Result<Handle<naga::Type>, Error> {
    let camera = find_function(module, stubs::CAMERA);
    let result = camera.and_then(|camera| module.functions[camera].result.as_ref());
    result.map(|result| result.ty).ok_or(Error::MissingRoot("camera"))
}

/// The variable `view` and the bytes of its value.
struct View<'b> {
    variable: Handle<GlobalVariable>,
    members: Vec<naga::StructMember>,
    bytes: &'b [u8],
}

impl<'b> View<'b> {
    fn new(module: &Module, bytes: &'b [u8]) -> Result<Self, Error> {
        let variable = find_variable(module, stubs::VIEW).ok_or(Error::MissingRoot("view"))?;
        let ty = &module.types[module.global_variables[variable].ty].inner;
        let TypeInner::Struct { members, span } = ty else {
            return Err(Error::MissingRoot("view"));
        };
        if bytes.len() != *span as usize {
            return Err(Error::ViewBytes { expected: *span as usize, found: bytes.len() });
        }
        Ok(Self { variable, members: members.clone(), bytes })
    }

    /// A word of the view; 0 beyond its end.
    fn word(&self, offset: u32) -> [u8; 4] {
        let start = offset as usize;
        let bytes = self.bytes.get(start..start + 4);
        bytes.and_then(|bytes| bytes.try_into().ok()).unwrap_or_default()
    }

    fn member(&self, name: &str) -> Option<&naga::StructMember> {
        self.members.iter().find(|member| member.name.as_deref() == Some(name))
    }

    fn vector(&self, name: &str) -> Result<[f32; 3], Error> {
        let offset = self.member(name).ok_or(Error::MissingRoot("view"))?.offset;
        Ok([0, 4, 8].map(|lane| f32::from_ne_bytes(self.word(offset + lane))))
    }

    /// The function that sets the members of the view that the shader reads, except those that
    /// `set_view` sets. Elements of arrays that are all zero are unused.
    fn load_function(&self, module: &mut Module) -> Function {
        let read = members_used(module, self.variable);
        let mut body = Body::default();
        let base = body.declare(Expression::GlobalVariable(self.variable));
        for (member, index) in self.members.iter().zip(0..) {
            let is_set = SET_BY_CAMERA.iter().any(|name| member.name.as_deref() == Some(*name));
            if read.contains(&index) && !is_set {
                self.store_member(module, &mut body, base, index, member.ty, member.offset);
            }
        }
        body.finish(None)
    }

    /// Sets a member of what `base` points to. A view contains no other types than these, and they
    /// nest only as deep as `sdfc-march` declares them.
    fn store_member(
        &self,
        module: &mut Module,
        body: &mut Body,
        base: Handle<Expression>,
        index: u32,
        ty: Handle<naga::Type>,
        offset: u32,
    ) {
        let pointer = body.compute(Expression::AccessIndex { base, index }, &[base]);
        let inner = module.types[ty].inner.clone();
        if let TypeInner::Struct { members, .. } = inner {
            for (member, index) in members.into_iter().zip(0..) {
                let offset = offset + member.offset;
                self.store_member(module, body, pointer, index, member.ty, offset);
            }
        } else if let TypeInner::Array { base, size: ArraySize::Constant(count), stride } = inner {
            for index in 0..count.get() {
                let offset = offset + index * stride;
                let is_zero = |word| self.word(offset + word) == [0; 4];
                if !(0..stride).step_by(4).all(is_zero) {
                    self.store_member(module, body, pointer, index, base, offset);
                }
            }
        } else if let TypeInner::Vector { size, scalar } = inner {
            let lanes = (0..size as u32).map(|lane| self.literal(scalar, offset + 4 * lane));
            let components: Vec<_> =
                lanes.map(|lane| body.declare(Expression::Literal(lane))).collect();
            let compose = Expression::Compose { ty, components: components.clone() };
            let value = body.compute(compose, &components);
            body.push(Statement::Store { pointer, value });
        } else if let TypeInner::Scalar(scalar) = inner {
            let value = body.declare(Expression::Literal(self.literal(scalar, offset)));
            body.push(Statement::Store { pointer, value });
        }
    }

    fn literal(&self, scalar: Scalar, offset: u32) -> Literal {
        let word = self.word(offset);
        match scalar {
            Scalar::U32 => Literal::U32(u32::from_ne_bytes(word)),
            Scalar::I32 => Literal::I32(i32::from_ne_bytes(word)),
            _ => Literal::F32(f32::from_ne_bytes(word)),
        }
    }
}

/// The members of a structure variable that occur in functions.
fn members_used(module: &Module, variable: Handle<GlobalVariable>) -> FxHashSet<u32> {
    let mut used = FxHashSet::default();
    for (_, function) in module.functions.iter() {
        for (_, expression) in function.expressions.iter() {
            if let Expression::AccessIndex { base, index } = *expression
                && function.expressions[base] == Expression::GlobalVariable(variable)
            {
                used.insert(index);
            }
        }
    }
    used
}
