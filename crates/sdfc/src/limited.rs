//! The part of a scene that has limits.

use std::borrow::Cow;

use rustc_hash::FxHashMap;
use sdfc_analyze::prepare_with;
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{
    Arg, Binary, Bounds, FAR, Graph, MaterialRule, Node, NodeId, Program, Scene as ShapeScene,
    ShapeId, Type, reachable_where,
};
use sdfc_mesh::MeshError;
use serde::Serialize;

use crate::derived_bounds::{Corners, DerivedBounds, corners_of};
use crate::error::Error;
use crate::scene::Scene;

/// The scene without solids or regions that have no limit. It is what meshes, contours,
/// measurements and grids are made of.
pub(crate) struct Limited<'a> {
    pub(crate) program: Cow<'a, Program>,
    pub(crate) bounds: Corners,
    /// True if the field is proven never to exceed the distance to the surface.
    pub(crate) is_certified: bool,
}

/// A report about a part of a scene, to write as JSON. [`Scene::reported`] makes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Reported<T> {
    /// The solids or regions that the report is not about; see [`Scene::left_out`].
    pub left_out: Vec<String>,
    /// The report.
    #[serde(flatten)]
    pub report: T,
}

impl Scene {
    /// The solids or regions that meshes, contours, measurements and grids leave out at a frame:
    /// those that have no limit, such as a floor, where others of the scene's union have limits.
    ///
    /// Each is described by its name or its call, and its line: `plane(y: -1) (line 4)`.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let scene = Compiler::new().compile("a.sdf", "sphere(1)\nplane(y: -1)")?;
    /// assert_eq!(scene.left_out(&scene.defaults()), ["`plane(y: -1)` (line 2)"]);
    /// # Ok::<(), sdfc::CompileWithError>(())
    /// ```
    pub fn left_out(&self, frame: &FrameValues) -> Vec<String> {
        let endless = self.endless(frame);
        endless.into_iter().map(|shape| self.described(shape)).collect()
    }

    /// A report about a mesh, a contour, measurements or a grid of the scene at a frame, with what
    /// was left out.
    pub fn reported<T>(&self, frame: &FrameValues, report: T) -> Reported<T> {
        Reported { left_out: self.left_out(frame), report }
    }

    /// Returns the program and the bounds of all that has limits.
    pub(crate) fn limited(&self, frame: &FrameValues) -> Result<Limited<'_>, Error> {
        let endless = self.endless(frame);
        if endless.is_empty() {
            let bounds = filled(self.bounds_at(frame))?;
            let program = Cow::Borrowed(&self.program);
            return Ok(Limited { program, bounds, is_certified: self.is_certified() });
        }
        let scene = without(&self.elaborated.scene, &endless);
        let bounds = DerivedBounds::of(&scene).and_then(|bounds| bounds.at(frame));
        let prepared = prepare_with(&scene, [0.0; 3], self.loops)?;
        let is_certified = prepared.report.uncertified.is_empty();
        let program = Cow::Owned(prepared.program);
        Ok(Limited { program, bounds: filled(bounds)?, is_certified })
    }

    /// Returns the operands of the scene's union that have no limit, if others have limits.
    fn endless(&self, frame: &FrameValues) -> Vec<ShapeId> {
        let is_limited = |[lo, hi]: &Corners| {
            (0..3).all(|axis| lo[axis] > f64::NEG_INFINITY && hi[axis] < f64::INFINITY)
        };
        if self.bounds_at(frame).is_none_or(|bounds| is_limited(&bounds)) {
            return Vec::new();
        }
        let scene = &self.elaborated.scene;
        let operands = scene.root.map(|root| operands(&scene.graph, root)).unwrap_or_default();
        let mut graph = scene.graph.clone();
        let mut bounds = Bounds::new(&scene.params);
        let has_limits = |shape: &ShapeId| {
            corners_of(&mut graph, &mut bounds, *shape, frame).is_some_and(|it| is_limited(&it))
        };
        let (limited, endless): (Vec<_>, Vec<_>) = operands.into_iter().partition(has_limits);
        if limited.is_empty() { limited } else { endless }
    }

    fn described(&self, shape: ShapeId) -> String {
        let Some(site) = self.sites().iter().find(|site| site.shape == shape) else {
            return format!("`{}`", self.graph().graph.shape(shape).definition);
        };
        let (sources, span) = (self.sources(), site.span);
        let name = self.graph().graph.shape(shape).name.as_deref();
        let text = name.unwrap_or_else(|| sources.slice(span).lines().next().unwrap_or_default());
        format!("`{text}` (line {})", sources.line_column(span.file, span.start).line)
    }
}

/// Returns the bounds of a scene that can have an inside.
fn filled(bounds: Option<Corners>) -> Result<Corners, MeshError> {
    let bounds = bounds.ok_or(MeshError::NothingDrawn)?;
    let is_empty = (0..3).any(|axis| bounds[0][axis] > bounds[1][axis]);
    if is_empty { Err(MeshError::Empty) } else { Ok(bounds) }
}

/// Returns the shapes whose least distance is the formula of a shape; none if it is no such union.
fn operands(graph: &Graph, shape: ShapeId) -> Vec<ShapeId> {
    let level = graph.shape(shape).level;
    let mut found = Vec::new();
    let mut left = vec![graph.shape(shape).formula];
    while let Some(id) = left.pop() {
        let node = graph.node(id);
        if let Node::Binary(Binary::Min, a, b) = node {
            left.extend([b, a]);
        } else if let Node::Sample(operand, at) = node
            && is_own_point(graph, at, level)
        {
            found.push(operand);
        } else {
            return Vec::new();
        }
    }
    found
}

fn is_own_point(graph: &Graph, at: NodeId, level: u16) -> bool {
    matches!(graph.node(at), Node::Point(own, _) if own == level)
}

/// Returns a scene without some operands of its union.
fn without(scene: &ShapeScene, left_out: &[ShapeId]) -> ShapeScene {
    let mut graph = scene.graph.clone();
    let is_kept = |shape: &ShapeId| !left_out.contains(shape);
    let root = scene.root.map(|root| union_without(&mut graph, root, &is_kept));
    ShapeScene {
        graph,
        root,
        layers: scene.layers.iter().copied().filter(is_kept).collect(),
        params: scene.params.clone(),
        settings: scene.settings.clone(),
        has_materials: scene.has_materials,
    }
}

/// Returns a union in which the distances to some operands are far.
fn union_without(graph: &mut Graph, root: ShapeId, is_kept: &impl Fn(&ShapeId) -> bool) -> ShapeId {
    let mut shape = graph.shape(root).clone();
    let mut roots = vec![shape.formula];
    match shape.material {
        MaterialRule::Weighted(weights) => roots.push(weights),
        MaterialRule::Explicit(fields) => roots.extend(fields),
    }
    let far = graph.constant(Type::Scalar, &[FAR]);
    let mut new: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    let enters = |id| !matches!(graph.node(id), Node::Sample(..));
    for id in reachable_where(graph, &roots, enters) {
        let of = |old: NodeId| new.get(&old).copied().unwrap_or(old);
        let node = graph.node(id);
        let replaced = if let Node::Sample(operand, _) = node {
            if is_kept(&operand) { id } else { far }
        } else if let Node::Binary(Binary::Min, a, b) = node
            && [of(a), of(b)].contains(&far)
        {
            if of(a) == far { of(b) } else { of(a) }
        } else {
            graph.rebuild(id, of)
        };
        new.insert(id, replaced);
    }
    let of = |id: NodeId| new.get(&id).copied().unwrap_or(id);
    shape.formula = of(shape.formula);
    shape.material = match shape.material {
        MaterialRule::Weighted(weights) => MaterialRule::Weighted(of(weights)),
        MaterialRule::Explicit(fields) => MaterialRule::Explicit(fields.map(of)),
    };
    shape.children.retain(is_kept);
    // The arguments keep it apart from the whole union.
    shape.args = vec![Arg::Shape(root)];
    graph.add_shape(shape)
}
