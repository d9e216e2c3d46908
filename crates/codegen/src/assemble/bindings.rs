//! The functions of a scene that replace the stubs of a template.

use naga::{Function, ResourceBinding, UniqueArena};
use sdfc_graph::{Environment, NodeId, Program, Rays};
use sdfc_march::{Features, MethodDefinition, stubs};

use crate::error::Error;
use crate::lower::inputs::Inputs;
use crate::lower::{POINT, function_of};
use crate::reflection::Role;

/// The binding of the uniform slots.
pub(crate) const SLOTS: ResourceBinding = ResourceBinding { group: 0, binding: 1 };
/// The binding of long lists.
pub(crate) const LISTS: ResourceBinding = ResourceBinding { group: 0, binding: 3 };

/// A function of the scene that replaces a stub.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StubBinding {
    /// The function's role for embedders; `None` if it has none.
    pub role: Option<Role>,
    pub stub: &'static str,
    pub root: NodeId,
    /// Names of its vector arguments.
    arguments: &'static [&'static str],
}

impl StubBinding {
    pub(crate) fn of_point(role: Option<Role>, stub: &'static str, root: NodeId) -> Self {
        Self { role, stub, root, arguments: &[POINT] }
    }

    /// A function without arguments, of a per-frame value.
    pub(crate) fn of_frame(stub: &'static str, root: NodeId) -> Self {
        Self { role: None, stub, root, arguments: &[] }
    }

    /// The light of the surroundings, in a direction by a roughness and by a normal.
    pub(crate) fn of_environment(environment: Environment) -> [Self; 2] {
        let Environment { radiance, irradiance } = environment;
        let (role, arguments) = (None, &["direction", "roughness"]);
        let radiance = Self { role, stub: stubs::RADIANCE, root: radiance, arguments };
        let arguments = &["normal"];
        [radiance, Self { role, stub: stubs::IRRADIANCE, root: irradiance, arguments }]
    }

    /// The formula of a pixel: a function of its middle and its size.
    pub(crate) fn of_pixel(root: NodeId) -> Self {
        Self { role: None, stub: stubs::PLANAR_PIXEL, root, arguments: &[POINT, "size"] }
    }

    fn of_ray(stub: &'static str, root: NodeId) -> Self {
        Self { role: None, stub, root, arguments: &["origin", "direction"] }
    }

    /// The stub, and its binding if there is a root.
    fn of_segment(
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

/// The bindings of the stubs of `analytic.wgsl` that are called.
pub(crate) fn analytic_bindings(program: &Program, features: Features) -> Vec<StubBinding> {
    if !features.analytic && !features.clipped && !features.copies {
        return Vec::new();
    }
    let Rays { first_hit: hits, analytic: closed, marched, clip, copies } = program.rays;
    let closed = closed.filter(|_| features.soft_shadows);
    let marched = marched.filter(|_| features.analytic && features.steps());
    let copies = copies.filter(|_| features.copies);
    let of_ray =
        [(stubs::ANALYTIC_HIT, hits), (stubs::CLIP_INTERVAL, clip), (stubs::COPIES, copies)]
            .into_iter();
    let of_point =
        [(stubs::ANALYTIC_DISTANCE, closed), (stubs::MARCHED_DISTANCE, marched)].into_iter();
    of_ray
        .filter_map(|(stub, root)| Some(StubBinding::of_ray(stub, root?)))
        .chain(of_point.filter_map(|(stub, root)| Some(StubBinding::of_point(None, stub, root?))))
        .collect()
}

/// The bounds along ray segments that a method asks for. Without bounds of the value a method
/// samples instead, and where nothing is marched it needs none.
pub(crate) fn segment_bindings(
    program: &Program,
    method: &MethodDefinition,
    features: Features,
) -> Result<Vec<StubBinding>, Error> {
    let known = [
        StubBinding::of_segment(Role::Range, stubs::RANGE, program.range, &["a", "b"]),
        StubBinding::of_segment(
            Role::SlopeRange,
            stubs::SLOPE_RANGE,
            program.slope_range,
            &["a", "b", "direction"],
        ),
    ];
    let proves = program.range.is_some() && features.marches();
    let is_unused = |stub| stub == stubs::RANGE && !proves;
    let wanted = known.into_iter().filter(|(stub, _)| method.calls(stub) && !is_unused(*stub));
    wanted.map(|(stub, binding)| binding.ok_or(Error::MissingRoot(stub))).collect()
}
