//! Links a scene's functions into the template of its picture.

use naga::Module;
use sdfc_graph::{NodeId, Program};
use sdfc_march::{FieldSource, Form, MethodDefinition, source_with, stubs};

use super::bindings::{StubBinding, analytic_bindings, segment_bindings};
use super::template::{features, has_loops, is_culled, template, used_slots};
use crate::error::Error;
use crate::link::template::{bind, find_function, find_variable};
use crate::lower::inputs::{Inputs, declare_variable};
use crate::lower::{POINT, store_function, struct_function};
use crate::reflection::{ModuleParts, Role};
use crate::shader::Shader;
use sdfc_march::Features;

/// The number of lanes of per-frame values up to which a shader that computes them itself stores
/// all of them.
const MAX_STORED_LANES: usize = 32;

/// The stub of the scene's material.
struct MaterialStub {
    stub: &'static str,
    fields: [NodeId; 6],
    arguments: &'static [&'static str],
}

/// The stub that shading calls; `None` without materials. The formula of a planar picture's pixel
/// contains them.
fn material(program: &Program) -> Option<MaterialStub> {
    if program.is_planar() {
        return None;
    }
    let arguments = &[POINT, "normal", "toward_eye"];
    let seen = program.seen_material.map(|fields| (stubs::SEEN_MATERIAL, fields, &arguments[..]));
    let (stub, fields, arguments) =
        seen.or_else(|| Some((stubs::MATERIAL, program.material?, &arguments[..1])))?;
    Some(MaterialStub { stub, fields, arguments })
}

/// A picture's shader while the scene's functions are linked into it.
pub(crate) struct PictureLinker<'p> {
    program: &'p Program,
    bindings: Vec<StubBinding>,
    pub(super) features: Features,
    /// Indices in `Program::uniforms` of the values that the scene's functions read.
    pub(super) used: Vec<usize>,
    pub(crate) module: Module,
    pub(super) inputs: Inputs,
    pub(super) parts: ModuleParts,
}

impl<'p> PictureLinker<'p> {
    /// Parses the template, without calls to `unused` functions and other parts that the scene does
    /// not need. `culled` is true if the caller runs the culling shader first. `parallel` overrides
    /// whether camera rays are parallel.
    pub(crate) fn new(
        program: &'p Program,
        form: Form,
        method: &MethodDefinition,
        parallel: Option<bool>,
        unused: &[&str],
        culled: bool,
    ) -> Result<Self, Error> {
        if let Some(pixel) = program.planar_pixel {
            return Self::of_planar(program, form, method, pixel, unused);
        }
        let distance = program.distance.ok_or(Error::NothingDrawn)?;
        let gradient = program.gradient.ok_or(Error::MissingRoot("gradient"))?;
        let mut features = features(program, Some(method));
        features.culled = culled && is_culled(program, method);
        let writes_pixels = matches!(form, Form::Compute | Form::Normals);
        features.records_gaps = writes_pixels && method.calls(stubs::RECORD_GAP);
        features.parallel = parallel.unwrap_or(features.parallel);
        features.estimated &= form != Form::Normals;
        features.projected &= form != Form::Normals;
        let mut bindings = analytic_bindings(program, features);
        let steps = features.steps() && !features.analytic;
        if steps || features.occlusion {
            bindings.push(StubBinding::of_point(Some(Role::Distance), stubs::FIELD, distance));
        }
        if let Some(estimate) = program.estimate.filter(|_| features.estimated) {
            bindings.push(StubBinding::of_point(None, stubs::ESTIMATE, estimate));
        }
        if method.gradient.is_none() {
            bindings.push(StubBinding::of_point(Some(Role::Gradient), stubs::GRADIENT, gradient));
        }
        bindings.extend(segment_bindings(program, method, features)?);
        let exposure = program.settings.exposure.and_then(|exposure| exposure.factor);
        bindings.extend(exposure.map(|root| StubBinding::of_frame(stubs::EXPOSURE, root)));
        let environment = program.settings.environment;
        bindings.extend(environment.into_iter().flat_map(StubBinding::of_environment));
        let mut roots: Vec<_> = bindings.iter().map(|binding| binding.root).collect();
        roots.extend(material(program).into_iter().flat_map(|it| it.fields));
        let used = used_slots(program, roots);
        let source = source_with(FieldSource::Scene, form, method, features);
        let module = template(&source, features, &used, unused)?;
        let (inputs, parts) = Default::default();
        Ok(Self { program, bindings, features, used, module, inputs, parts })
    }

    /// As [`Self::new`], for a picture without rays. The files of the method are among those that
    /// the template is parsed from, but nothing reaches them.
    fn of_planar(
        program: &'p Program,
        form: Form,
        method: &MethodDefinition,
        pixel: NodeId,
        unused: &[&str],
    ) -> Result<Self, Error> {
        if form == Form::Normals {
            return Err(Error::Planar("a picture of normals"));
        }
        let features = Features { planar: true, loops: has_loops(program), ..Features::default() };
        let bindings = vec![StubBinding::of_pixel(pixel)];
        let used = used_slots(program, vec![pixel]);
        let source = source_with(FieldSource::Scene, form, method, features);
        let module = template(&source, features, &used, unused)?;
        let (inputs, parts) = Default::default();
        Ok(Self { program, bindings, features, used, module, inputs, parts })
    }

    pub(crate) fn slot_nodes(&self) -> Vec<NodeId> {
        self.used.iter().map(|&slot| self.program.uniforms[slot]).collect()
    }

    /// The per-frame values that a shader which computes them itself does so once per pixel. Each
    /// takes a register as long as the shader runs. Where there are many, functions that a ray
    /// calls once compute theirs when they are called.
    fn stored_nodes(&self) -> Vec<NodeId> {
        let all = self.slot_nodes();
        let graph = &self.program.graph;
        let lanes: usize = all.iter().map(|&node| graph.ty(node).width()).sum();
        if lanes <= MAX_STORED_LANES {
            return all;
        }
        let once = [stubs::ANALYTIC_HIT, stubs::CLIP_INTERVAL, stubs::ESTIMATE, stubs::GRADIENT];
        let steps = self.bindings.iter().filter(|binding| !once.contains(&binding.stub));
        let slots = used_slots(self.program, steps.map(|binding| binding.root).collect());
        slots.into_iter().map(|slot| self.program.uniforms[slot]).collect()
    }

    /// Makes `load_frame` compute per-frame values from raw inputs, into private variables.
    pub(crate) fn compute_slots(&mut self, mut raw: Inputs) -> Result<(), Error> {
        let nodes = self.stored_nodes();
        raw.tables.declare(&mut self.module, self.program, &nodes)?;
        let (program, module) = (self.program, &mut self.module);
        let stored = nodes.into_iter().filter(|&node| !raw.is_constant(program.graph.node(node)));
        let declare = |node| (node, declare_variable(module, program, node));
        let stored: Vec<_> = stored.map(declare).collect();
        if find_function(module, stubs::LOAD_FRAME).is_some() {
            let load = store_function(program, &raw, &mut module.types, &stored)?;
            bind(module, stubs::LOAD_FRAME, load)?;
        }
        self.inputs = raw.with_slots(stored.into_iter().collect());
        Ok(())
    }

    /// Binds the scene's functions to the stubs.
    pub(crate) fn bind(&mut self) -> Result<(), Error> {
        self.parts.uniform = self.inputs.buffer;
        let mut roots: Vec<_> = self.bindings.iter().map(|binding| binding.root).collect();
        roots.extend(material(self.program).into_iter().flat_map(|it| it.fields));
        self.inputs.tables.declare(&mut self.module, self.program, &roots)?;
        self.inputs.loop_limit = find_variable(&self.module, stubs::LOOP_LIMIT);
        let (module, inputs) = (&mut self.module, &self.inputs);
        for binding in &self.bindings {
            let function = binding.function(self.program, inputs, &mut module.types)?;
            bind(module, binding.stub, function)?;
            let function = find_function(module, binding.stub);
            self.parts.functions.extend(binding.role.zip(function));
        }
        let Some(MaterialStub { stub, fields, arguments }) = material(self.program) else {
            return Ok(());
        };
        let handle = find_function(module, stub);
        let structure = handle.and_then(|f| module.functions[f].result.as_ref());
        let structure = structure.ok_or(Error::MissingRoot("material"))?.ty;
        let types = &mut module.types;
        let returned = (&fields[..], structure);
        let function = struct_function(self.program, inputs, types, stub, returned, arguments)?;
        bind(module, stub, function)?;
        self.parts.functions.extend(handle.map(|f| (Role::Material, f)));
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Result<Shader, Error> {
        self.parts.lists = self.inputs.tables.into_buffer();
        Shader::new(self.module, self.parts, self.features)
    }
}
