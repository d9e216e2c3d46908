//! The shader of a picture: a scene's functions linked into a ray method and shading.

use naga::{Function, Module, ResourceBinding, UniqueArena};
use rustc_hash::FxHashSet;
use sdfc_graph::{LightSource, NodeId, Program, Rays, Settings, Shadow, reachable_where};
use sdfc_march::{Features, FieldSource, Form, MethodDefinition, method, source_with, stubs};

use crate::culling::{Visits, culling};
use crate::inputs::{Inputs, declare_members, declare_slots, declare_variable, raw_inputs};
use crate::lower::{function_of, store_function, struct_function};
use crate::names::{check_prefix, make_public};
use crate::reflect::{Parts, Role};
use crate::tables::Tables;
use crate::{Error, Lists, Shader, link};

/// Where the per-frame slots are bound.
pub(crate) const SLOTS: ResourceBinding = ResourceBinding { group: 0, binding: 1 };
/// Where long lists are bound.
pub(crate) const LISTS: ResourceBinding = ResourceBinding { group: 0, binding: 3 };

/// The compute shader of a program's picture, entry point `main`, workgroups of 8x8 pixels.
///
/// Group 0 has these bindings. 0: uniform `sdfc_march::ViewBlock`. 1: uniform array with one
/// `vec4<f32>` for each of `Program::uniforms`, a value in its first lanes, a truth value as 0 or 1;
/// absent where the functions use none of them ([`crate::Reflection::uniform`] is `None`). 2: storage
/// array of `sdfc_march::PixelBlock`, one for each pixel of the tile, row by row. 3: storage array of what
/// [`Shader::lists`] gives; absent if that is empty.
///
/// Of shading, what the settings and the program need is linked and nothing else: [`Shader::features`] tells.
///
/// # Errors
///
/// [`Error::UnknownMethod`]; [`Error::NothingDrawn`] and [`Error::MissingRoot`] where the program
/// has no distance or no gradient; others where its nodes cannot be lowered.
pub fn render_module(program: &Program, method_name: &str) -> Result<Shader, Error> {
    let method = known_method(method_name)?;
    link_picture(program, Form::Compute, method, None)
}

/// As [`render_module`], for views from elsewhere than the scene's camera, by rays that are parallel or not whatever those of
/// that camera are.
///
/// # Errors
///
/// As [`render_module`].
pub fn render_module_with_camera(
    program: &Program,
    method_name: &str,
    parallel: bool,
) -> Result<Shader, Error> {
    let method = known_method(method_name)?;
    link_picture(program, Form::Compute, method, Some(parallel))
}

/// As [`render_module`], with the unit normals of what rays from the eye meet for colours, and no other rays: what
/// the normals of pictures are measured by. The method may be one that is not in the table.
///
/// # Errors
///
/// As [`render_module`].
pub fn normals_module(program: &Program, method: &MethodDefinition) -> Result<Shader, Error> {
    let Settings { camera, march, .. } = program.settings.clone();
    let settings = Settings { camera, march, ..Settings::default() };
    let unlit = Program { material: None, settings, ..program.clone() };
    link_picture(&unlit, Form::Normals, method, None)
}

/// As [`render_module`], with the gradient by differences of a field that is the scene's distance or an
/// interpreter, and without materials: what pictures have in common that are compared for speed.
///
/// An interpreter reads its program from storage buffers at the bindings that [`FieldSource`] tells, and
/// nothing at binding 1.
///
/// # Errors
///
/// As [`render_module`].
pub fn benchmark_module(
    program: &Program,
    method_name: &str,
    field: FieldSource,
) -> Result<Shader, Error> {
    measured(program, method_name, field, false)
}

/// As [`benchmark_module`] of the scene's distance, whose pixels tell as evaluations how many rounds of loops were visited, where these
/// are listed; those for normals are among them.
///
/// # Errors
///
/// As [`render_module`].
pub fn instrumented_module(program: &Program, method_name: &str) -> Result<Shader, Error> {
    measured(program, method_name, FieldSource::Distance, true)
}

fn measured(
    program: &Program,
    method_name: &str,
    field: FieldSource,
    instrumented: bool,
) -> Result<Shader, Error> {
    let method = known_method(method_name)?;
    let distance = match field {
        FieldSource::Scene => return link_picture(program, Form::Compute, method, None),
        FieldSource::Distance => Some(program.distance.ok_or(Error::NothingDrawn)?),
        FieldSource::Units | FieldSource::Tape => None,
    };
    // All of the field is marched.
    let culled = field == FieldSource::Distance && is_culled(program, method);
    let instrumented = culled && instrumented;
    let features = Features { materials: false, culled, instrumented, ..features(program, false) };
    let used = distance.map_or_else(Vec::new, |distance| used_slots(program, vec![distance]));
    let source = source_with(field, Form::Compute, method, features);
    let mut module = skeleton(&source, features, &used, &[])?;
    let (mut inputs, load_frame) = declare_slots(&mut module, program, &used, SLOTS);
    inputs.tables = Tables::in_buffer(LISTS);
    inputs.visits = Visits::of(&module, program);
    inputs.tables.declare(&mut module, program, distance.as_slice())?;
    if let Some(load_frame) = load_frame {
        link::fill(&mut module, stubs::LOAD_FRAME, load_frame)?;
    }
    if let Some(distance) = distance {
        let types = &mut module.types;
        let field = Filling::of_point(None, stubs::FIELD, distance);
        let function = field.function(program, &inputs, types)?;
        link::fill(&mut module, stubs::FIELD, function)?;
    }
    let parts = Parts { lists: inputs.tables.into_buffer(), ..Parts::default() };
    Ok(Shader::new(module, parts, features)?.culled_by(culling(program, features)?))
}

/// Whether rays from the eye visit the rounds of loops that can matter to them alone. Those of methods that look at stretches do
/// not: what they know of a stretch holds all rounds.
fn is_culled(program: &Program, method: &MethodDefinition) -> bool {
    let stretches = [stubs::RANGE, stubs::SLOPE_RANGE];
    !program.cullable_loops.is_empty() && !stretches.into_iter().any(|stub| method.calls(stub))
}

/// The stages of a picture's shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Stage {
    /// A compute stage that writes pixels into a buffer.
    #[default]
    Compute,
    /// A triangle over the target, and a fragment stage that gives a pixel's colour.
    Fragment,
}

impl Stage {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::Compute, Self::Fragment];

    /// What messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Compute => "compute stage",
            Self::Fragment => "fragment stage",
        }
    }
}

/// How a picture's shader for an engine of someone else's is called and named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureOptions {
    /// The ray method.
    pub method: String,
    /// The stages.
    pub stage: Stage,
    /// Whether the first row of the target is the lowest, as in OpenGL, for [`Stage::Fragment`].
    pub rows_up: bool,
    /// Start of every name.
    pub prefix: String,
    /// Bind group of the buffers.
    pub group: u32,
    /// Binding of the view; params have the next one, then pixels, then lists.
    pub binding: u32,
    /// Where long lists are.
    pub lists: Lists,
}

/// The shader of a program's picture, for an engine of someone else's: it needs no values but those of params,
/// `time` and `frame`, in a structure as that of [`crate::field_module`]; what follows from them is computed once
/// for each pixel.
///
/// Uniform `view` is a `sdfc_march::ViewBlock`. With [`Stage::Compute`] the entry point is `main`, and
/// `pixels` a storage array as in [`render_module`]; with [`Stage::Fragment`] there are `vertex`, to be called for
/// three vertices without buffers, and `fragment`, which gives a linear colour.
///
/// # Errors
///
/// [`Error::BadPrefix`]; others as [`render_module`].
pub fn picture_module(program: &Program, options: &PictureOptions) -> Result<Shader, Error> {
    check_prefix(&options.prefix)?;
    let method = known_method(&options.method)?;
    let form = match options.stage {
        Stage::Compute => Form::Compute,
        Stage::Fragment if options.rows_up => Form::FragmentUp,
        Stage::Fragment => Form::Fragment,
    };
    let mut picture = Picture::skeleton(program, form, method, None, &[], false)?;
    let place = |offset| ResourceBinding {
        group: options.group,
        binding: options.binding.saturating_add(offset),
    };
    for (_, variable) in picture.module.global_variables.iter_mut() {
        if let Some(binding) = &mut variable.binding {
            *binding = place(binding.binding);
        }
    }
    let raw = raw_inputs(program, &picture.slot_nodes());
    let (mut inputs, members) =
        declare_members(&mut picture.module, program, &raw, place(SLOTS.binding));
    inputs.tables = Tables::new(options.lists, place(LISTS.binding));
    picture.parts.members = members;
    picture.parts.prefix.clone_from(&options.prefix);
    picture.compute_slots(inputs)?;
    picture.fill()?;
    make_public(&mut picture.module, &picture.parts, &options.prefix);
    picture.finish()
}

/// `parallel` is as of [`Picture::skeleton`].
fn link_picture(
    program: &Program,
    form: Form,
    method: &MethodDefinition,
    parallel: Option<bool>,
) -> Result<Shader, Error> {
    let mut picture = Picture::skeleton(program, form, method, parallel, &[], true)?;
    let (inputs, load_frame) = declare_slots(&mut picture.module, program, &picture.used, SLOTS);
    if let Some(load_frame) = load_frame {
        link::fill(&mut picture.module, stubs::LOAD_FRAME, load_frame)?;
    }
    picture.inputs = inputs;
    picture.inputs.tables = Tables::in_buffer(LISTS);
    picture.inputs.visits = Visits::of(&picture.module, program);
    picture.fill()?;
    let features = picture.features;
    Ok(picture.finish()?.culled_by(culling(program, features)?))
}

/// A picture's shader while the scene's parts are put into it.
pub(crate) struct Picture<'p> {
    program: &'p Program,
    fillings: Vec<Filling>,
    features: Features,
    /// Positions in `Program::uniforms` of those that the scene's functions read.
    used: Vec<usize>,
    pub(crate) module: Module,
    inputs: Inputs,
    parts: Parts,
}

impl<'p> Picture<'p> {
    /// The files of `march`, without calls to these functions and what else the scene has no need of. It may be `culled` if
    /// what calls it runs the other shader first. Rays are `parallel` as the scene's camera says, if nothing else does.
    pub(crate) fn skeleton(
        program: &'p Program,
        form: Form,
        method: &MethodDefinition,
        parallel: Option<bool>,
        unused: &[&str],
        culled: bool,
    ) -> Result<Self, Error> {
        let distance = program.distance.ok_or(Error::NothingDrawn)?;
        let gradient = program.gradient.ok_or(Error::MissingRoot("gradient"))?;
        let mut features = features(program, method.pre_intersects);
        features.culled = culled && is_culled(program, method);
        features.parallel = parallel.unwrap_or(features.parallel);
        let mut fillings = ahead(program, features);
        let steps = features.steps() && !features.analytic;
        if steps || features.occlusion {
            fillings.push(Filling::of_point(Some(Role::Distance), stubs::FIELD, distance));
        }
        if method.gradient.is_none() {
            fillings.push(Filling::of_point(Some(Role::Gradient), stubs::GRADIENT, gradient));
        }
        fillings.extend(stretches(program, method)?);
        let mut roots: Vec<_> = fillings.iter().map(|filling| filling.root).collect();
        roots.extend(program.material.into_iter().flatten());
        let used = used_slots(program, roots);
        let source = source_with(FieldSource::Scene, form, method, features);
        let module = skeleton(&source, features, &used, unused)?;
        let (inputs, parts) = Default::default();
        Ok(Self { program, fillings, features, used, module, inputs, parts })
    }

    pub(crate) fn slot_nodes(&self) -> Vec<NodeId> {
        self.used.iter().map(|&slot| self.program.uniforms[slot]).collect()
    }

    /// Lets `load_frame` compute what follows from raw inputs, into private variables.
    pub(crate) fn compute_slots(&mut self, mut raw: Inputs) -> Result<(), Error> {
        let nodes = self.slot_nodes();
        raw.tables.declare(&mut self.module, self.program, &nodes)?;
        let (program, module) = (self.program, &mut self.module);
        let kept = self.used.iter().map(|&slot| program.uniforms[slot]);
        let kept = kept.filter(|&node| !raw.is_constant(program.graph.node(node)));
        let declare = |node| (node, declare_variable(module, program, node));
        let kept: Vec<_> = kept.map(declare).collect();
        if link::find_function(module, stubs::LOAD_FRAME).is_some() {
            let load = store_function(program, &raw, &mut module.types, &kept)?;
            link::fill(module, stubs::LOAD_FRAME, load)?;
        }
        self.inputs = raw.with_slots(kept.into_iter().collect());
        Ok(())
    }

    /// Fills the stubs with the scene's functions.
    pub(crate) fn fill(&mut self) -> Result<(), Error> {
        self.parts.uniform = self.inputs.buffer;
        let mut roots: Vec<_> = self.fillings.iter().map(|filling| filling.root).collect();
        roots.extend(self.program.material.into_iter().flatten());
        self.inputs.tables.declare(&mut self.module, self.program, &roots)?;
        let (module, inputs) = (&mut self.module, &self.inputs);
        for filling in &self.fillings {
            let function = filling.function(self.program, inputs, &mut module.types)?;
            link::fill(module, filling.stub, function)?;
            let place = link::find_function(module, filling.stub);
            self.parts.functions.extend(filling.role.zip(place));
        }
        let Some(fields) = self.program.material else { return Ok(()) };
        let stub = stubs::MATERIAL;
        let handle = link::find_function(module, stub);
        let structure = handle.and_then(|f| module.functions[f].result.as_ref());
        let structure = structure.ok_or(Error::MissingRoot("material"))?.ty;
        let types = &mut module.types;
        let function = struct_function(self.program, inputs, types, stub, &fields, structure)?;
        link::fill(module, stub, function)?;
        self.parts.functions.extend(handle.map(|f| (Role::Material, f)));
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Result<Shader, Error> {
        self.parts.lists = self.inputs.tables.into_buffer();
        Shader::new(self.module, self.parts, self.features)
    }
}

/// What fills a stub.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filling {
    /// What it is to those who embed it; none: nothing.
    pub role: Option<Role>,
    pub stub: &'static str,
    pub root: NodeId,
    /// The points that it is a function of.
    arguments: &'static [&'static str],
}

impl Filling {
    pub(crate) fn of_point(role: Option<Role>, stub: &'static str, root: NodeId) -> Self {
        Self { role, stub, root, arguments: &["p"] }
    }

    fn of_ray(stub: &'static str, root: NodeId) -> Self {
        Self { role: None, stub, root, arguments: &["origin", "direction"] }
    }

    /// The stub, and what fills it where there is a root.
    fn of_stretch(
        role: Role,
        stub: &'static str,
        root: Option<NodeId>,
        arguments: &'static [&'static str],
    ) -> (&'static str, Option<Self>) {
        (stub, root.map(|root| Self { role: Some(role), stub, root, arguments }))
    }

    pub(crate) fn function(
        &self,
        program: &Program,
        inputs: &Inputs,
        types: &mut UniqueArena<naga::Type>,
    ) -> Result<Function, Error> {
        function_of(program, inputs, types, self.stub, self.root, self.arguments)
    }
}

/// What fills the stubs of `rays.wgsl` that are called.
pub(crate) fn ahead(program: &Program, features: Features) -> Vec<Filling> {
    if !features.analytic && !features.clipped && !features.copies {
        return Vec::new();
    }
    let Rays { first_hit: hits, analytic: closed, marched, clip, copies } = program.rays;
    let closed = closed.filter(|_| features.soft_shadows);
    let marched = marched.filter(|_| features.analytic && features.steps());
    let of_ray =
        [(stubs::ANALYTIC_HIT, hits), (stubs::CLIP_INTERVAL, clip), (stubs::COPIES, copies)]
            .into_iter();
    let of_point =
        [(stubs::ANALYTIC_DISTANCE, closed), (stubs::MARCHED_DISTANCE, marched)].into_iter();
    of_ray
        .filter_map(|(stub, root)| Some(Filling::of_ray(stub, root?)))
        .chain(of_point.filter_map(|(stub, root)| Some(Filling::of_point(None, stub, root?))))
        .collect()
}

/// What a method wants to know of stretches of rays.
pub(crate) fn stretches(
    program: &Program,
    method: &MethodDefinition,
) -> Result<Vec<Filling>, Error> {
    let known = [
        Filling::of_stretch(Role::Range, stubs::RANGE, program.range, &["a", "b"]),
        Filling::of_stretch(
            Role::SlopeRange,
            stubs::SLOPE_RANGE,
            program.slope_range,
            &["a", "b", "direction"],
        ),
    ];
    let wanted = known.into_iter().filter(|(stub, _)| method.calls(stub));
    wanted.map(|(stub, filling)| filling.ok_or(Error::MissingRoot(stub))).collect()
}

/// The ray method of that name.
pub(crate) fn known_method(name: &str) -> Result<&'static MethodDefinition, Error> {
    method(name).ok_or_else(|| Error::UnknownMethod(name.to_owned()))
}

/// Files of `march` without what these features and slots do not need, nor calls to `unused` functions.
pub(crate) fn skeleton(
    source: &str,
    features: Features,
    used_slots: &[usize],
    unused: &[&str],
) -> Result<Module, Error> {
    let mut unused = unused.to_vec();
    unused.extend(features.unused());
    unused.extend(used_slots.is_empty().then_some(stubs::LOAD_FRAME));
    link::skeleton(source, &features.overrides(), &unused)
}

/// What of a scene's rays is known before they are marched, for a method that asks for it.
pub(crate) fn ray_features(program: &Program, pre_intersects: bool) -> Features {
    let Rays { first_hit: hits, analytic: _, marched, clip, copies } = program.rays;
    Features {
        analytic: pre_intersects && hits.is_some(),
        marched: !pre_intersects || hits.is_none() || marched.is_some(),
        clipped: pre_intersects && clip.is_some(),
        copies: pre_intersects && copies.is_some(),
        ..Features::default()
    }
}

/// What a scene's picture needs beyond the least.
fn features(program: &Program, pre_intersects: bool) -> Features {
    let settings = &program.settings;
    let mut features = Features {
        materials: program.material.is_some(),
        reflections: settings.reflections.is_some_and(|mirrors| mirrors.count > 0),
        occlusion: settings.occlusion.is_some(),
        sky: settings.sky.is_some(),
        fog: settings.fog.is_some(),
        fog_color: settings.fog.is_some_and(|fog| fog.color.is_some()),
        parallel: settings.is_parallel(),
        ..ray_features(program, pre_intersects)
    };
    for light in &settings.lights {
        match light.source {
            LightSource::Sun { .. } => {}
            LightSource::Point { .. } => features.positional_lights = true,
            LightSource::Spot { .. } => {
                (features.positional_lights, features.spot_lights) = (true, true)
            }
        }
        match light.shadow {
            Shadow::Off => {}
            Shadow::Hard => features.shadows = true,
            Shadow::Soft(_) => (features.shadows, features.soft_shadows) = (true, true),
        }
    }
    features
}

/// Positions in `Program::uniforms` of those that the roots read.
pub(crate) fn used_slots(program: &Program, roots: Vec<NodeId>) -> Vec<usize> {
    let slots: FxHashSet<_> = program.uniforms.iter().copied().collect();
    let needed = reachable_where(&program.graph, &roots, |node| !slots.contains(&node));
    // In ascending order, so that a search finds them.
    let is_needed = |node: &NodeId| needed.binary_search(node).is_ok();
    let positions = program.uniforms.iter().enumerate();
    positions.filter(|(_, node)| is_needed(node)).map(|(slot, _)| slot).collect()
}
