//! The template of a shader: the WGSL files that a scene needs, without what it does not.

use naga::Module;
use rustc_hash::FxHashSet;
use sdfc_graph::{
    LightSource, MaterialField, Node, NodeId, Program, Rays, Shadow, Tone, reachable,
    reachable_where,
};
use sdfc_march::{Features, MethodDefinition, stubs};

use crate::error::Error;
use crate::link::template::parse_template;

/// Parses files of `sdfc-march` without the parts that these features and uniform slots do not
/// need, and without calls to `unused` functions.
pub(crate) fn template(
    source: &str,
    features: Features,
    used_slots: &[usize],
    unused: &[&str],
) -> Result<Module, Error> {
    let mut unused = unused.to_vec();
    unused.extend(features.unused());
    unused.extend(used_slots.is_empty().then_some(stubs::LOAD_FRAME));
    parse_template(source, &features.overrides(), &unused)
}

/// The features for the analytic intersection of rays, if there is a method that asks for it.
pub(crate) fn ray_features(program: &Program, method: Option<&MethodDefinition>) -> Features {
    let pre_intersects = method.is_some_and(|method| method.pre_intersects);
    let intersects_copies = method.is_some_and(|method| method.calls(stubs::COPIES));
    let Rays { first_hit: hits, analytic: _, marched, clip, copies } = program.rays;
    Features {
        analytic: pre_intersects && hits.is_some(),
        marched: !pre_intersects || hits.is_none() || marched.is_some(),
        clipped: pre_intersects && clip.is_some(),
        copies: intersects_copies && copies.is_some(),
        proved: program.range.is_some(),
        loose: program.is_loose,
        ..Features::default()
    }
}

/// The features that a scene's picture needs.
pub(super) fn features(program: &Program, method: Option<&MethodDefinition>) -> Features {
    let settings = &program.settings;
    let mut features = Features {
        materials: program.material.is_some(),
        seen_materials: program.seen_material.is_some(),
        unlit: is_unlit(program),
        loops: has_loops(program),
        reflections: settings.reflections.is_some_and(|mirrors| mirrors.count > 0),
        occlusion: settings.occlusion.is_some(),
        sky: settings.sky.is_some(),
        ground: settings.sky.is_some_and(|sky| sky.ground.is_some()),
        environment: settings.environment.is_some(),
        fog: settings.fog.is_some(),
        fog_color: settings.fog.is_some_and(|fog| fog.color.is_some()),
        exposure: settings.exposure.is_some_and(|exposure| exposure.factor.is_some()),
        estimated: program.estimate.is_some(),
        projected: program.falls_behind,
        neutral_tone: settings.exposure.is_some_and(|it| it.tone == Tone::Neutral),
        film_tone: settings.exposure.is_some_and(|it| it.tone == Tone::Film),
        parallel: settings.is_parallel(),
        ..ray_features(program, method)
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

/// Returns true if the occlusion of a material may be below 0, where it keeps direct light away.
fn is_unlit(program: &Program) -> bool {
    let occlusion = |fields: [NodeId; 6]| fields[MaterialField::Occlusion.index()];
    program.material.is_some_and(|fields| program.graph.range(occlusion(fields)).lo < 0.0)
}

/// Returns true if the functions of a program contain loops.
pub(super) fn has_loops(program: &Program) -> bool {
    let nodes = reachable(&program.graph, &program.roots());
    nodes.into_iter().any(|id| matches!(program.graph.node(id), Node::Loop(..)))
}

/// Returns true if camera rays run only the iterations of loops that can affect them. Methods that
/// use bounds along ray segments do not: their bounds hold for all iterations.
pub(super) fn is_culled(program: &Program, method: &MethodDefinition) -> bool {
    let segment_bounds = [stubs::RANGE, stubs::SLOPE_RANGE];
    !program.cullable_loops.is_empty() && !segment_bounds.into_iter().any(|stub| method.calls(stub))
}

/// Indices in `Program::uniforms` of the values that the roots read.
pub(crate) fn used_slots(program: &Program, roots: Vec<NodeId>) -> Vec<usize> {
    let slots: FxHashSet<_> = program.uniforms.iter().copied().collect();
    let needed = reachable_where(&program.graph, &roots, |node| !slots.contains(&node));
    // `needed` is ascending, so it can be searched.
    let is_needed = |node: &NodeId| needed.binary_search(node).is_ok();
    let positions = program.uniforms.iter().enumerate();
    positions.filter(|(_, node)| is_needed(node)).map(|(slot, _)| slot).collect()
}
