//! Expansion: from shape instances to flat math.
//!
//! An instance's formula is written in the point of its level and samples other shapes. Expanding
//! it at a point replaces its point by that point, and each sample by the sampled shape's formula,
//! expanded at the sample's point. A shape of level L sees the points of the formulas around it: if
//! it is sampled at q where those points are E, its own points are E\[0..L\] and q. If q depends on
//! a loop, the loops of the sampled shape are nested in it.

mod chains;
mod environment;
mod material;
mod names;

use rustc_hash::FxHashMap;

use self::chains::Expanded;
pub use self::chains::{MaterialChain, MaterialStep};
use self::environment::{Env, Environments};
use self::material::Material;
use self::names::Names;
use crate::graph::Graph;
use crate::node::{MaterialField, Node, NodeId, ShapeId, Stage, SurfaceVector};

/// Maximum number of nodes in one arena, and of (node, points) pairs in one [`Expander`].
pub const NODE_LIMIT: usize = 4_000_000;

/// The reason why shapes could not be expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpandError {
    /// The arena or the number of expanded nodes exceeds the limit.
    TooManyNodes {
        /// [`NODE_LIMIT`], unless the expander was given another.
        limit: usize,
    },
    /// A formula uses a point of this level, but no formula around it has one.
    MissingPoint {
        /// The level.
        level: u16,
    },
}

impl std::fmt::Display for ExpandError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TooManyNodes { limit } => {
                write!(f, "the expanded scene has more than {limit} nodes")
            }
            Self::MissingPoint { level } => {
                write!(f, "a formula uses a point of level {level}, which it does not have")
            }
        }
    }
}

impl std::error::Error for ExpandError {}

/// Expands shapes of one arena. Expansions are cached, so an expander must not be used with another
/// arena.
///
/// ```
/// use sdfc_graph::{Contract, Dim, Expander, Graph, MaterialRule, Shape, dump};
///
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let shape = |name: &str, formula, children: &[_]| Shape {
///     definition: name.to_owned(),
///     dim: Dim::Three,
///     level: 0,
///     args: Vec::new(),
///     formula,
///     contract: Contract::default(),
///     intersect: Vec::new(),
///     material: MaterialRule::Weighted(formula),
///     children: children.to_vec(),
///     depth: 1,
///     name: None,
/// };
/// let (length, radius) = (graph.length(p), graph.number(1.0));
/// let formula = graph.sub(length, radius);
/// let ball = graph.add_shape(shape("ball", formula, &[]));
///
/// let by = graph.constant(p_type(), &[0.0, 2.0, 0.0]);
/// let moved = graph.sub(p, by);
/// let sample = graph.sample(ball, moved);
/// let raised = graph.add_shape(shape("raised", sample, &[ball]));
///
/// let distance = Expander::new().field(&mut graph, raised, p)?;
/// assert_eq!(
///     dump(&graph, &[("distance", distance)]),
///     "%0 = point 0 : vec3\n\
///      %1 = sub %0 [0, 2, 0] : vec3\n\
///      %2 = length %1 : number\n\
///      %3 = sub %2 1 : number\n\
///      distance = %3\n"
/// );
/// # fn p_type() -> sdfc_graph::Type { Dim::Three.point_type() }
/// # Ok::<(), sdfc_graph::ExpandError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Expander {
    environments: Environments,
    done: FxHashMap<Key, NodeId>,
    materials: FxHashMap<ShapeId, Material>,
    /// Where materials with chains were expanded.
    blended: Expanded,
    names: Names,
    /// The arguments of the current node, with their expansions.
    arguments: Vec<(NodeId, NodeId)>,
    limit: usize,
}

impl Default for Expander {
    fn default() -> Self {
        Self {
            environments: Environments::default(),
            done: FxHashMap::default(),
            materials: FxHashMap::default(),
            blended: Expanded::default(),
            names: Names::default(),
            arguments: Vec::new(),
            limit: NODE_LIMIT,
        }
    }
}

/// The outcome of one step of an expansion.
enum Step {
    Done(NodeId),
    Wait,
}

/// A node under the points around it.
type Task = (NodeId, Env);

/// A node, the points that it depends on, and the number of loops around its formula if it lies in
/// one of the formula's own.
type Key = (NodeId, Env, u8);

impl Expander {
    /// An expander with an empty cache.
    pub fn new() -> Self {
        Self::default()
    }

    /// An expander with another limit than [`NODE_LIMIT`].
    pub fn with_limit(limit: usize) -> Self {
        Self { limit, ..Self::default() }
    }

    /// The distance of a shape of level 0 at a point.
    ///
    /// # Errors
    /// If the node limit is exceeded.
    pub fn field(
        &mut self,
        graph: &mut Graph,
        shape: ShapeId,
        point: NodeId,
    ) -> Result<NodeId, ExpandError> {
        self.field_under(graph, shape, &[], point)
    }

    /// The distance of a shape at a point. `outer` are the points of the formulas around the shape,
    /// outermost first.
    ///
    /// # Errors
    /// If the node limit is exceeded or a point is missing.
    pub fn field_under(
        &mut self,
        graph: &mut Graph,
        shape: ShapeId,
        outer: &[NodeId],
        point: NodeId,
    ) -> Result<NodeId, ExpandError> {
        let sample = graph.sample(shape, point);
        self.under(graph, shape, outer, point, sample)
    }

    /// The material of a shape of level 0 at a point, in the order of [`MaterialField::ALL`].
    ///
    /// # Errors
    /// If the node limit is exceeded.
    pub fn material(
        &mut self,
        graph: &mut Graph,
        shape: ShapeId,
        point: NodeId,
    ) -> Result<[NodeId; 6], ExpandError> {
        let mut fields = [point; 6];
        for (entry, field) in fields.iter_mut().zip(MaterialField::ALL) {
            let node = graph.material_at(shape, point, field);
            *entry = self.under(graph, shape, &[], point, node)?;
        }
        Ok(fields)
    }

    /// The chains of blends in the materials that were expanded so far.
    ///
    /// # Errors
    /// If the node limit is exceeded.
    pub fn material_chains(
        &mut self,
        graph: &mut Graph,
    ) -> Result<Vec<MaterialChain>, ExpandError> {
        let mut expanded = Vec::new();
        for (shape, env) in self.blended.order.clone() {
            let chains = self.materials.get(&shape).map(|material| material.chains.clone());
            for chain in chains.unwrap_or_default() {
                let nodes: Result<Vec<NodeId>, ExpandError> =
                    chain.nodes().into_iter().map(|node| self.expand(graph, (node, env))).collect();
                expanded.push(chain.with_nodes(&nodes?));
            }
        }
        Ok(expanded)
    }

    /// Expands a node of a formula. `points` are the points of levels 0, 1, ….
    ///
    /// # Errors
    /// If the node limit is exceeded or a point is missing.
    pub fn node(
        &mut self,
        graph: &mut Graph,
        node: NodeId,
        points: &[NodeId],
    ) -> Result<NodeId, ExpandError> {
        let env = self.environments.of(graph, points);
        self.expand(graph, (node, env))
    }

    /// Names for the expanded nodes: the scene's name for the first shape whose distance the node
    /// is, else that shape's definition. Constants and points have none.
    pub fn names(&self) -> FxHashMap<NodeId, String> {
        self.names.to_map()
    }

    /// Names the flat value of a shape whose parts a caller expanded itself.
    pub fn name(&mut self, graph: &Graph, value: NodeId, shape: ShapeId) {
        self.names.record(graph, value, shape);
    }

    /// Expands a sample of a shape at a point that is already expanded.
    fn under(
        &mut self,
        graph: &mut Graph,
        shape: ShapeId,
        outer: &[NodeId],
        point: NodeId,
        sample: NodeId,
    ) -> Result<NodeId, ExpandError> {
        let inner = self.environments.of(graph, outer);
        let env = self.inside(graph, shape, inner, point)?;
        let formula = self.formula_of(graph, sample, env);
        let result = self.expand(graph, (formula, env))?;
        if let Node::Sample(..) = graph.node(sample) {
            self.names.record(graph, result, shape);
        }
        Ok(result)
    }

    /// The points that a shape's formula sees when it is sampled at `point` in the environment
    /// `env`.
    fn inside(
        &mut self,
        graph: &Graph,
        shape: ShapeId,
        env: Env,
        point: NodeId,
    ) -> Result<Env, ExpandError> {
        let level = graph.shape(shape).level;
        let outer = self.environments.prefix(env, level);
        if self.environments.depth(outer) < level {
            return Err(ExpandError::MissingPoint { level: level - 1 });
        }
        Ok(self.environments.push(graph, outer, point))
    }

    /// The formula that replaces a sample, in the sampled shape's own point. `env` are the points
    /// that the formula sees.
    fn formula_of(&mut self, graph: &mut Graph, sample: NodeId, env: Env) -> NodeId {
        match graph.node(sample) {
            Node::Sample(shape, _) => graph.shape(shape).formula,
            Node::MaterialAt(shape, _, field) => {
                let material =
                    self.materials.entry(shape).or_insert_with(|| material::formulas(graph, shape));
                if !material.chains.is_empty() {
                    self.blended.insert(shape, env);
                }
                material.fields[field.index()]
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..) => sample,
        }
    }

    fn expand(&mut self, graph: &mut Graph, task: Task) -> Result<NodeId, ExpandError> {
        let mut stack = vec![task];
        while let Some(&(node, env)) = stack.last() {
            let before = stack.len();
            match self.step(graph, node, env, &mut stack)? {
                Step::Done(result) => {
                    stack.truncate(before - 1);
                    let key = self.key(graph, node, env);
                    self.done.insert(key, result);
                }
                Step::Wait => {}
            }
            if graph.len().max(self.done.len()) > self.limit {
                return Err(ExpandError::TooManyNodes { limit: self.limit });
            }
        }
        self.lookup(graph, task).ok_or(ExpandError::TooManyNodes { limit: self.limit })
    }

    /// Expands a node whose arguments are expanded, or pushes the missing arguments on the stack.
    fn step(
        &mut self,
        graph: &mut Graph,
        node: NodeId,
        env: Env,
        stack: &mut Vec<Task>,
    ) -> Result<Step, ExpandError> {
        if let Some(result) = self.lookup(graph, (node, env)) {
            return Ok(Step::Done(result));
        }
        if let Node::Point(level, _) = graph.node(node) {
            if SurfaceVector::of_level(level).is_some() {
                return Ok(Step::Done(node));
            }
            let point = self.environments.point(env, level);
            return point.map(Step::Done).ok_or(ExpandError::MissingPoint { level });
        }
        let around = self.environments.loops(env);
        if let Node::Variable(depth, variable, ty) = graph.node(node) {
            return Ok(Step::Done(graph.variable(depth + around, variable, ty)));
        }
        let before = stack.len();
        self.arguments.clear();
        for argument in graph.arguments(node) {
            match self.lookup(graph, (argument, env)) {
                Some(new) => self.arguments.push((argument, new)),
                None => stack.push((argument, env)),
            }
        }
        if stack.len() > before {
            return Ok(Step::Wait);
        }
        let find = |old| self.arguments.iter().find(|pair| pair.0 == old);
        let expanded = |old| find(old).map_or(old, |pair| pair.1);
        match graph.node(node) {
            Node::Sample(shape, point) | Node::MaterialAt(shape, point, _) => {
                self.step_into(graph, node, shape, (point, env), stack)
            }
            Node::Loop(id, position, _) => {
                Ok(Step::Done(graph.rebuild_loop(id, position, around, expanded)))
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Element(..) => Ok(Step::Done(graph.rebuild(node, expanded))),
        }
    }

    fn step_into(
        &mut self,
        graph: &mut Graph,
        sample: NodeId,
        shape: ShapeId,
        (point, env): Task,
        stack: &mut Vec<Task>,
    ) -> Result<Step, ExpandError> {
        let at = self.lookup(graph, (point, env)).unwrap_or(point);
        let inner = self.inside(graph, shape, env, at)?;
        let formula = self.formula_of(graph, sample, inner);
        let Some(result) = self.lookup(graph, (formula, inner)) else {
            stack.push((formula, inner));
            return Ok(Step::Wait);
        };
        if let Node::Sample(..) = graph.node(sample) {
            self.names.record(graph, result, shape);
        }
        Ok(Step::Done(result))
    }

    /// Nodes that depend on fewer points than the environment has share one expansion.
    fn key(&self, graph: &Graph, node: NodeId, env: Env) -> Key {
        let is_in_loop = graph.loops_around(node) != 0;
        let around = if is_in_loop { self.environments.loops(env) } else { 0 };
        (node, self.environments.prefix(env, graph.levels(node)), around)
    }

    fn lookup(&self, graph: &Graph, (node, env): Task) -> Option<NodeId> {
        if graph.stage(node) < Stage::Point {
            return Some(node);
        }
        self.done.get(&self.key(graph, node, env)).copied()
    }
}
