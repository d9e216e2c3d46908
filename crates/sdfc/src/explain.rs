//! Explains what the compiler did with a scene.

use sdfc_codegen::{FieldOptions, Role};
use sdfc_graph::{FrameInput, Node, NodeId, Shape, ShapeId, reachable};
use sdfc_march::Features;

use crate::error::Error;
use crate::explanation::{Bounds, Explanation, Input};
use crate::scene::Scene;

impl Scene {
    /// Explains how the scene was compiled and what is known of its field.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Codegen`].
    pub fn explain(&self) -> Result<Explanation, Error> {
        let program = &self.program;
        if program.distance.is_none() {
            return Err(Error::NothingDrawn);
        }
        let options = FieldOptions { gradient: false, material: false, ..FieldOptions::default() };
        let costs = self.field_shader(&options)?.instructions()?;
        let field = costs.iter().find(|cost| cost.role == Role::Distance);
        let features = self.picture_shader(self.method())?.features();
        let report = &self.report;
        Ok(Explanation {
            leaves: report.leaves,
            nodes: report.distance_cost.nodes,
            ops_per_eval: report.distance_cost.operations,
            ops_per_gradient: report.gradient_cost.operations,
            ops_per_frame: report.distance_cost.per_frame,
            gradient: if report.gradient.in_parts { "parts" } else { "sweep" },
            gradient_live: report.gradient.live_lanes,
            gradient_live_of_sweep: report.gradient.live_lanes_of_sweep,
            code: if report.loops.is_empty() { "unrolled" } else { "loops" },
            code_why: self.why_loops(),
            loops: report.loops.iter().map(|rolled| rolled.operands).collect(),
            analytic: self.names(&report.analytic),
            marched: self.names(&report.marched),
            guarded: self.names_with_lines(&self.skipped()),
            ops_per_ray: report.ray_cost.operations,
            ops_per_step: report.marched_cost.operations,
            spirv_instructions: field.map_or(0, |cost| cost.instructions as usize),
            spirv_arithmetic: field.map_or(0, |cost| cost.arithmetic as usize),
            features: feature_names(features),
            method: if self.is_planar() { "none" } else { self.marched_by(self.method()).name() },
            method_why: match self.is_planar() {
                true => Some("regions have no rays".to_owned()),
                false => self.why_marched_by(self.method()),
            },
            layers: self.graph().layers.len(),
            ops_per_pixel: report.pixel_cost.operations,
            step_scale: 1.0,
            certified: self.is_certified(),
            bounds: self.finite_bounds(),
            inputs: self.inputs(),
            costs: self.call_costs(),
            quality: self.quality_rows(),
        })
    }

    /// Returns one line that says why the code has loops or is unrolled.
    fn why_loops(&self) -> String {
        let rolled = &self.report.loops;
        let most = self.report.unrolled_limit;
        if rolled.is_empty() {
            return match self.report.distance_cost.operations > most {
                true => "few of its parts are similar".to_owned(),
                false => format!("at most {most} operations"),
            };
        }
        let parts: usize = rolled.iter().map(|rolled| rolled.operands).sum();
        let loops = match rolled.len() {
            1 => "one loop".to_owned(),
            count => format!("{count} loops"),
        };
        let culling = match self.program.cullable_loops.is_empty() {
            true if self.is_planar() => "pixels evaluate all of them",
            true => "rays evaluate all of them",
            false => "rays evaluate those that they can hit",
        };
        format!("{parts} parts in {loops}, over {most} operations; {culling}")
    }

    fn names(&self, shapes: &[ShapeId]) -> Vec<String> {
        let shape = |&id: &ShapeId| self.graph().graph.shape(id);
        let name = |id| {
            let Shape { name, definition, .. } = shape(id);
            name.as_ref().unwrap_or(definition).clone()
        };
        shapes.iter().map(name).collect()
    }

    /// The guarded shapes that are not evaluated everywhere. In a union of nothing but guarded
    /// operands, the first one is.
    fn skipped(&self) -> Vec<ShapeId> {
        let report = &self.report;
        let mut shapes = report.guarded.clone();
        let has_others =
            self.is_planar() || !report.analytic.is_empty() || report.marched.len() > shapes.len();
        let guards = self.program.guards.iter().enumerate();
        if !has_others && let Some((first, _)) = guards.min_by_key(|(_, guard)| guard.operand) {
            shapes.remove(first);
        }
        shapes
    }

    /// The names of shapes and the lines where they are made, as in `text at line 3`.
    fn names_with_lines(&self, shapes: &[ShapeId]) -> Vec<String> {
        let with_line = |(name, shape): (String, &ShapeId)| {
            let Some(site) = self.sites().iter().find(|site| site.shape == *shape) else {
                return name;
            };
            let place = self.sources().line_column(site.span.file, site.span.start);
            format!("{name} at line {}", place.line)
        };
        self.names(shapes).into_iter().zip(shapes).map(with_line).collect()
    }

    pub(crate) fn finite_bounds(&self) -> Bounds {
        let frame = self.defaults();
        self.bounds_at(&frame).map(Bounds::of).unwrap_or_default()
    }

    fn inputs(&self) -> Vec<Input> {
        let used: Vec<Node> = reachable(&self.program.graph, &self.all_roots())
            .into_iter()
            .map(|id| self.program.graph.node(id))
            .collect();
        let is_used =
            |input| used.iter().any(|node| matches!(node, Node::Frame(i, _) if *i == input));
        let mut inputs: Vec<Input> = self
            .params()
            .iter()
            .enumerate()
            .map(|(index, param)| Input {
                name: param.name.clone(),
                stage: if param.fixed.is_some() { "compile" } else { "frame" },
                used: param.fixed.is_some() || is_used(FrameInput::Param(index as u32)),
            })
            .collect();
        for (name, input) in [("time", FrameInput::Time), ("frame", FrameInput::Frame)] {
            if is_used(input) {
                inputs.push(Input { name: name.to_owned(), stage: "frame", used: true });
            }
        }
        inputs
    }

    /// Returns the roots of the field, the material and the settings.
    fn all_roots(&self) -> Vec<NodeId> {
        let program = &self.program;
        let mut roots: Vec<NodeId> = program.distance.into_iter().collect();
        roots.extend(program.material.into_iter().flatten());
        roots.extend(program.settings.nodes());
        let environment = program.settings.environment;
        roots.extend(environment.into_iter().flat_map(|it| [it.radiance, it.irradiance]));
        roots
    }
}

/// Returns the names of the features that a shader has.
pub(crate) fn feature_names(features: Features) -> Vec<String> {
    let Features {
        planar: _,
        materials,
        seen_materials,
        unlit,
        analytic,
        marched: _,
        clipped,
        copies,
        shadows,
        soft_shadows,
        positional_lights,
        spot_lights,
        reflections,
        occlusion,
        sky,
        ground: _,
        environment,
        fog,
        fog_color: _,
        exposure,
        neutral_tone,
        film_tone,
        parallel,
        culled,
        instrumented: _,
        proved: _,
        records_gaps: _,
        loose: _,
        estimated: _,
        projected: _,
        loops: _,
    } = features;
    let names = [
        ("material", materials),
        ("normal and view in materials", seen_materials),
        ("unlit materials", unlit),
        ("analytic intersection", analytic),
        ("ray clipping", clipped),
        ("analytic copies", copies),
        ("shadow", shadows),
        ("soft shadow", soft_shadows),
        ("point light", positional_lights),
        ("spot light", spot_lights),
        ("reflection", reflections),
        ("ambient occlusion", occlusion),
        ("sky", sky),
        ("environment image", environment),
        ("fog", fog),
        ("exposure", exposure),
        ("tone curve", neutral_tone || film_tone),
        ("parallel camera", parallel),
        ("active lists", culled),
    ];
    names.iter().filter(|name| name.1).map(|name| name.0.to_owned()).collect()
}
