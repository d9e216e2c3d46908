//! A compiled scene's field on the CPU, as a shader, and explained.

use sdfc_codegen::{FieldOptions, Role, Shader, field_module, render_module};
use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{FrameInput, Graph, Node, NodeId, Shape, ShapeId, bounds, reachable};
use sdfc_render::View;

use crate::explain::{Bounds, Explanation, Knob, feature_names};
use crate::marched::with_stretches;
use crate::{Error, Scene};

/// Lowest and highest point of what is drawn, per-frame nodes of a graph of their own.
#[derive(Debug)]
pub(crate) struct DerivedBounds {
    graph: Graph,
    corners: [NodeId; 2],
}

impl Scene {
    /// Whether the field is known nowhere to exceed the distance.
    pub fn is_certified(&self) -> bool {
        self.report.uncertified.is_empty()
    }

    /// The field alone, as functions to embed.
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`].
    pub fn field_shader(&self, options: &FieldOptions) -> Result<Shader, Error> {
        Ok(field_module(&self.program, options)?)
    }

    /// The shader of the picture.
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`], for an unknown method too.
    pub fn picture_shader(&self, method: &str) -> Result<Shader, Error> {
        let method = self.marched_by(method);
        Ok(render_module(&with_stretches(&self.program, method), method)?)
    }

    /// Where the scene lies at a frame: lowest and highest corner, infinite where not limited.
    pub fn bounds_at(&self, frame: &FrameValues) -> Option<[[f64; 3]; 2]> {
        let derived = self.bounds.get_or_init(|| self.derive_bounds()).as_ref()?;
        let values = evaluate_frame(&derived.graph, &derived.corners, frame);
        let corner = |lanes: &[f64; 4]| [lanes[0], lanes[1], lanes[2]];
        Some([corner(values.first()?), corner(values.get(1)?)])
    }

    /// The view of a frame that a picture of that size has.
    ///
    /// # Errors
    ///
    /// [`Error::View`].
    pub fn view(&self, frame: &FrameValues, size: [u32; 2]) -> Result<View, Error> {
        Ok(View::new(self.drawn(), frame, self.bounds_at(frame), size)?)
    }

    fn derive_bounds(&self) -> Option<DerivedBounds> {
        let mut graph = self.graph().graph.clone();
        let corners = bounds(&mut graph, self.graph().root?, self.params());
        Some(DerivedBounds { graph, corners })
    }

    /// What was modelled and why.
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
            writing: if report.loops.is_empty() { "inline" } else { "rolled" },
            writing_why: self.why_written(),
            loops: report.loops.iter().map(|rolled| rolled.operands).collect(),
            closed: self.names(&report.analytic),
            marched: self.names(&report.marched),
            ops_per_ray: report.ray_cost.operations,
            ops_per_step: report.marched_cost.operations,
            spirv_instructions: field.map_or(0, |cost| cost.instructions as usize),
            spirv_arithmetic: field.map_or(0, |cost| cost.arithmetic as usize),
            features: feature_names(features),
            method: self.marched_by(self.method()).to_owned(),
            method_why: self.why_marched_by(self.method()),
            step_scale: 1.0,
            certified: self.is_certified(),
            bounds: self.finite_bounds(),
            knobs: self.knobs(),
            quality: self.quality_rows(),
        })
    }

    /// Why the field is written as it is, in one line.
    fn why_written(&self) -> String {
        let rolled = &self.report.loops;
        let most = self.report.unrolled_limit;
        if rolled.is_empty() {
            return match self.report.distance_cost.operations > most {
                true => "few of its parts are alike".to_owned(),
                false => format!("at most {most} operations"),
            };
        }
        let parts: usize = rolled.iter().map(|rolled| rolled.operands).sum();
        let loops = match rolled.len() {
            1 => "one loop".to_owned(),
            count => format!("{count} loops"),
        };
        let visited = match self.program.cullable_loops.is_empty() {
            true => "rays visit all",
            false => "rays visit what they can meet",
        };
        format!("{parts} parts in {loops}, over {most} operations; {visited}")
    }

    fn names(&self, shapes: &[ShapeId]) -> Vec<String> {
        let shape = |&id: &ShapeId| self.graph().graph.shape(id);
        let name = |id| {
            let Shape { name, definition, .. } = shape(id);
            name.as_ref().unwrap_or(definition).clone()
        };
        shapes.iter().map(name).collect()
    }

    pub(crate) fn finite_bounds(&self) -> Bounds {
        let frame = self.defaults();
        self.bounds_at(&frame).map(Bounds::of).unwrap_or_default()
    }

    fn knobs(&self) -> Vec<Knob> {
        let used: Vec<Node> = reachable(&self.program.graph, &self.all_roots())
            .into_iter()
            .map(|id| self.program.graph.node(id))
            .collect();
        let is_used =
            |input| used.iter().any(|node| matches!(node, Node::Frame(i, _) if *i == input));
        let mut knobs: Vec<Knob> = self
            .params()
            .iter()
            .enumerate()
            .map(|(index, param)| Knob {
                name: param.name.clone(),
                stage: "frame",
                used: is_used(FrameInput::Param(index as u32)),
            })
            .collect();
        for (name, input) in [("time", FrameInput::Time), ("frame", FrameInput::Frame)] {
            if is_used(input) {
                knobs.push(Knob { name: name.to_owned(), stage: "frame", used: true });
            }
        }
        knobs
    }

    /// Field, gradient, material and settings.
    fn all_roots(&self) -> Vec<NodeId> {
        let program = &self.program;
        let mut roots: Vec<NodeId> = program.distance.into_iter().collect();
        roots.extend(program.material.into_iter().flatten());
        roots.extend(program.settings.nodes());
        roots
    }
}
