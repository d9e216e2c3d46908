//! The arena: interned nodes with their types, stages and ranges, and shape instances.

use std::hash::{BuildHasher, BuildHasherDefault, Hash, Hasher};
use std::sync::Arc;

use hashbrown::HashTable;
use rustc_hash::{FxHashMap, FxHasher};

use crate::loops::{Loop, Table};
use crate::node::{
    Binary, Const, LoopId, Node, NodeId, ShapeId, Stage, SurfaceVector, TableId, Ternary, Type,
    Unary,
};
use crate::range::{Range, range_of};
use crate::shape::{Arg, Shape};

/// Properties of a node that follow from its operation and its arguments.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facts {
    ty: Type,
    stage: Stage,
    range: Range,
    /// One more than the highest level of the points that it depends on; 0 for none.
    levels: u16,
    /// The loops whose variables it depends on, one bit per depth.
    loops: u8,
    /// The most loops that are nested in its evaluation, those of sampled shapes included.
    nesting: u8,
}

/// A Lipschitz constant that the author of a function claims: the result changes by at most
/// `lipschitz` where each of the arguments changes by at most 1. Vectors are measured by Euclidean
/// length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LipschitzClaim {
    /// The constant, a scalar that does not depend on the point.
    pub lipschitz: NodeId,
    /// The arguments that depend on a point.
    pub arguments: Vec<NodeId>,
}

/// Hash-consed nodes and shape instances. Equal nodes have equal ids.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    facts: Vec<Facts>,
    /// Ids by the nodes' hashes. Half of the hash is stored beside the id, so that lookups rarely
    /// have to read the node.
    ids: HashTable<(u32, NodeId)>,
    shapes: Vec<Shape>,
    shape_ids: FxHashMap<u64, Vec<ShapeId>>,
    claims: FxHashMap<NodeId, LipschitzClaim>,
    loops: Vec<Loop>,
    loop_ids: FxHashMap<Loop, LoopId>,
    /// Shared, because a table may be large and graphs are copied.
    tables: Vec<Arc<Table>>,
    table_ids: FxHashMap<Arc<Table>, TableId>,
}

/// The arguments of a node.
#[derive(Clone, Debug)]
pub struct Arguments<'g> {
    own: std::iter::Take<std::array::IntoIter<NodeId, 4>>,
    /// For a loop: the loop, and the position of its next argument.
    loop_: Option<(&'g Loop, usize)>,
}

impl Iterator for Arguments<'_> {
    type Item = NodeId;

    fn next(&mut self) -> Option<NodeId> {
        let Some((loop_, position)) = &mut self.loop_ else { return self.own.next() };
        *position += 1;
        loop_.argument(*position - 1)
    }
}

impl Graph {
    /// An empty arena.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True if there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The node.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// The node's arguments in order. A loop's arguments are all nodes that it refers to, the roots
    /// of its body among them.
    pub fn arguments(&self, id: NodeId) -> Arguments<'_> {
        self.arguments_of(&self.node(id))
    }

    fn arguments_of(&self, node: &Node) -> Arguments<'_> {
        let loop_ = if let Node::Loop(id, ..) = *node { Some((self.loop_at(id), 0)) } else { None };
        Arguments { own: node.own_arguments(), loop_ }
    }

    /// The loop with this id.
    pub fn loop_at(&self, id: LoopId) -> &Loop {
        &self.loops[id.0 as usize]
    }

    /// The table with this id.
    pub fn table(&self, id: TableId) -> &Table {
        &self.tables[id.index()]
    }

    /// The table with this id, for another graph.
    pub(crate) fn shared_table(&self, id: TableId) -> Arc<Table> {
        Arc::clone(&self.tables[id.index()])
    }

    /// The loops whose bodies the node lies in, because it depends on their variables: one bit per
    /// depth.
    pub fn loops_around(&self, id: NodeId) -> u8 {
        self.facts[id.index()].loops
    }

    /// The most loops that are nested when the node is evaluated, those of the distances that it
    /// samples included.
    pub fn loop_nesting(&self, id: NodeId) -> u8 {
        self.facts[id.index()].nesting
    }

    /// The number of loops that must lie around a new loop which depends on the node.
    pub(crate) fn next_loop_depth(&self, id: NodeId) -> u8 {
        (u8::BITS - self.loops_around(id).leading_zeros()) as u8
    }

    /// The shape and the point of a sample; `None` for any other node.
    pub fn as_sample(&self, id: NodeId) -> Option<(ShapeId, NodeId)> {
        if let Node::Sample(shape, point) = self.node(id) { Some((shape, point)) } else { None }
    }

    /// The node's type.
    pub fn ty(&self, id: NodeId) -> Type {
        self.facts[id.index()].ty
    }

    /// The node's stage.
    pub fn stage(&self, id: NodeId) -> Stage {
        self.facts[id.index()].stage
    }

    /// The range that contains every component of the node.
    pub fn range(&self, id: NodeId) -> Range {
        self.facts[id.index()].range
    }

    /// Sets the range of a per-frame input. Must be called before any node is built on it.
    pub fn assume_range(&mut self, id: NodeId, range: Range) {
        self.facts[id.index()].range = range;
    }

    /// One more than the highest level of the points that the node depends on; 0 for none.
    pub fn levels(&self, id: NodeId) -> u16 {
        self.facts[id.index()].levels
    }

    /// All ids in ascending order: arguments before their uses.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// All shape ids in ascending order: children before parents.
    pub fn shape_ids(&self) -> impl Iterator<Item = ShapeId> + use<> {
        (0..self.shapes.len() as u32).map(ShapeId)
    }

    /// The shape with this id.
    pub fn shape(&self, id: ShapeId) -> &Shape {
        &self.shapes[id.index()]
    }

    /// The number, if the node is a constant scalar.
    pub fn as_number(&self, id: NodeId) -> Option<f64> {
        self.const_at(id).and_then(Const::scalar)
    }

    /// The constant, if the node is one.
    pub fn as_const(&self, id: NodeId) -> Option<Const> {
        self.const_at(id).copied()
    }

    /// A reference to the constant, since nodes are large to copy.
    pub(crate) fn const_at(&self, id: NodeId) -> Option<&Const> {
        if let Node::Const(value) = &self.nodes[id.index()] { Some(value) } else { None }
    }

    /// The value of every component, if the node is a constant of equal components.
    pub fn as_splat_number(&self, id: NodeId) -> Option<f64> {
        let value = self.const_at(id)?;
        let lanes = value.lanes();
        lanes[1..value.ty().width()].iter().all(|&lane| lane == lanes[0]).then_some(lanes[0])
    }

    /// The id of a node exactly as given, without folding. Callers outside this crate use the typed
    /// builders.
    pub(crate) fn intern(&mut self, node: Node) -> NodeId {
        let half = half_hash_of(&node);
        let known = self
            .ids
            .find(whole_hash(half), |&(other, id)| other == half && self.nodes[id.index()] == node);
        if let Some(&(_, id)) = known {
            return id;
        }
        let facts = self.facts_of(&node);
        self.insert(node, facts, half)
    }

    /// Adds a node that is known to be new.
    fn insert(&mut self, node: Node, facts: Facts, half: u32) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(node);
        self.facts.push(facts);
        self.ids.insert_unique(whole_hash(half), (half, id), |&(half, _)| whole_hash(half));
        id
    }

    /// Adds a node that is known to be new, with the properties of a node of another graph.
    pub(crate) fn adopt(&mut self, node: Node, other: &Self, id: NodeId) -> NodeId {
        self.insert(node, other.facts[id.index()], half_hash_of(&node))
    }

    /// Adds a claim about a node as it is.
    pub(crate) fn adopt_claim(&mut self, node: NodeId, claim: LipschitzClaim) {
        self.claims.insert(node, claim);
    }

    fn facts_of(&self, node: &Node) -> Facts {
        let (mut stage, mut levels, mut loops, mut nesting) = (Stage::Const, 0, 0, 0);
        for argument in self.arguments_of(node) {
            stage = stage.max(self.stage(argument));
            levels = levels.max(self.levels(argument));
            loops |= self.loops_around(argument);
            nesting = nesting.max(self.loop_nesting(argument));
        }
        match *node {
            Node::Variable(depth, ..) => (stage, loops) = (Stage::Point, 1 << depth),
            Node::Loop(id, ..) => {
                let loop_ = self.loop_at(id);
                (stage, loops) = (Stage::Point, loops & !loop_.bit());
                nesting = nesting.max(loop_.depth + 1);
            }
            // A direction at the surface depends on the point of no formula.
            Node::Point(level, _) if SurfaceVector::of_level(level).is_some() => {
                stage = Stage::Point;
            }
            Node::Point(level, _) => (stage, levels) = (Stage::Point, level + 1),
            Node::Frame(..) => stage = Stage::Frame,
            Node::Sample(shape, point) | Node::MaterialAt(shape, point, _) => {
                // A shape's own arguments may depend on outer points.
                levels = levels.max(self.shape(shape).level);
                let formula = self.shape(shape).formula;
                loops |= self.loops_around(formula);
                let around = self.next_loop_depth(point);
                nesting = nesting.max(around.saturating_add(self.loop_nesting(formula)));
                stage = Stage::Point;
            }
            Node::Const(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Element(..)
            | Node::Transform(..) => {}
        }
        let ty = result_type(node, |id| self.ty(id));
        let range = range_of(node, |id| self.range(id), ty.width());
        Facts { ty, stage, range, levels, loops, nesting }
    }

    /// Interns a loop.
    pub(crate) fn intern_loop(&mut self, loop_: Loop) -> LoopId {
        let next = LoopId(self.loops.len() as u32);
        let id = *self.loop_ids.entry(loop_.clone()).or_insert(next);
        if id == next {
            self.loops.push(loop_);
        }
        id
    }

    /// Interns a table.
    pub(crate) fn intern_table(&mut self, table: Arc<Table>) -> TableId {
        let next = TableId(self.tables.len() as u32);
        let id = *self.table_ids.entry(Arc::clone(&table)).or_insert(next);
        if id == next {
            self.tables.push(table);
        }
        id
    }

    /// Adds a shape instance. An instance that is equal in definition, dimension, level and
    /// arguments is returned instead if there is one; it keeps its name.
    pub fn add_shape(&mut self, shape: Shape) -> ShapeId {
        let key = shape_key(&shape.definition, shape.dim, shape.level, &shape.args);
        if let Some(id) = self.find(key, &shape.definition, shape.dim, shape.level, &shape.args) {
            return id;
        }
        let id = ShapeId(self.shapes.len() as u32);
        self.shapes.push(shape);
        self.shape_ids.entry(key).or_default().push(id);
        id
    }

    /// The instance with these arguments, if it was built before: saves elaborating it again.
    pub fn find_shape(
        &self,
        definition: &str,
        dim: crate::node::Dim,
        level: u16,
        args: &[Arg],
    ) -> Option<ShapeId> {
        self.find(shape_key(definition, dim, level, args), definition, dim, level, args)
    }

    fn find(
        &self,
        key: u64,
        definition: &str,
        dim: crate::node::Dim,
        level: u16,
        args: &[Arg],
    ) -> Option<ShapeId> {
        let candidates = self.shape_ids.get(&key)?;
        candidates.iter().copied().find(|&id| {
            let shape = self.shape(id);
            shape.definition == definition
                && shape.dim == dim
                && shape.level == level
                && shape.args == args
        })
    }

    /// Records a Lipschitz claim about a node, and what follows from it for the varying part of the
    /// node: simplification moves signs, offsets and factors out of a node, and would leave the
    /// claim behind. The first claim about a node stays.
    pub fn claim_lipschitz(&mut self, node: NodeId, mut claim: LipschitzClaim) {
        for argument in &mut claim.arguments {
            *argument = self.unshifted(*argument);
        }
        let mut part = node;
        while !claim.arguments.contains(&part) {
            self.claims.entry(part).or_insert_with(|| claim.clone());
            let Some((inner, factor)) = self.varying_part(part) else { return };
            if factor != 1.0 {
                let inverse = self.number(1.0 / factor);
                claim.lipschitz = self.mul(claim.lipschitz, inverse);
            }
            part = inner;
        }
    }

    /// Copies the claim about a node to another node that equals its negative.
    pub(crate) fn carry_claim(&mut self, node: NodeId, negative: NodeId) {
        if let Some(claim) = self.claims.get(&node).cloned() {
            self.claim_lipschitz(negative, claim);
        }
    }

    /// The node without its sign and offsets, which changes as fast as the node.
    fn unshifted(&self, mut node: NodeId) -> NodeId {
        while let Some((inner, 1.0)) = self.varying_part(node) {
            node = inner;
        }
        node
    }

    /// The part x of `-x`, `x + c`, `x - c`, `c - x` or `x * c` that depends on the point, and the
    /// factor by which the node changes faster than x.
    fn varying_part(&self, node: NodeId) -> Option<(NodeId, f64)> {
        let fixed = |id: NodeId| self.stage(id) < Stage::Point;
        match self.node(node) {
            Node::Unary(Unary::Neg, x) => Some((x, 1.0)),
            Node::Binary(Binary::Add | Binary::Sub, x, c) if fixed(c) => Some((x, 1.0)),
            Node::Binary(Binary::Add | Binary::Sub, c, x) if fixed(c) => Some((x, 1.0)),
            Node::Binary(Binary::Mul, x, c) => {
                let factor = self.as_splat_number(c)?.abs();
                (factor > 0.0).then_some((x, factor))
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
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }

    /// The Lipschitz claim about a node.
    pub fn lipschitz_claim(&self, node: NodeId) -> Option<&LipschitzClaim> {
        self.claims.get(&node)
    }

    /// Replaces a shape's material. Nodes that were expanded before keep the old one.
    pub fn set_material(&mut self, id: ShapeId, material: crate::shape::MaterialRule) {
        self.shapes[id.index()].material = material;
    }

    /// Sets the intervals along a ray that lie inside a shape: see [`Shape::intersect`].
    pub fn set_intersect(&mut self, id: ShapeId, intervals: Vec<[NodeId; 2]>) {
        self.shapes[id.index()].intersect = intervals;
    }

    /// Names a shape after the scene's `let`. The first name stays.
    pub fn name_shape(&mut self, id: ShapeId, name: &str) {
        let shape = &mut self.shapes[id.index()];
        shape.name.get_or_insert_with(|| name.to_owned());
    }
}

/// The type of a node, given the types of its arguments.
pub(crate) fn result_type(node: &Node, ty: impl Fn(NodeId) -> Type) -> Type {
    match *node {
        Node::Const(value) => value.ty(),
        Node::Point(_, dim) => dim.point_type(),
        Node::Frame(_, own)
        | Node::Splat(own, _)
        | Node::Compose(own, _)
        | Node::Variable(.., own)
        | Node::Loop(.., own)
        | Node::Element(.., own)
        | Node::Swizzle(own, ..) => own,
        Node::Unary(Unary::Length, _) => Type::Scalar,
        Node::Unary(_, a) => ty(a),
        Node::Binary(op, a, _) => match op {
            Binary::Dot => Type::Scalar,
            Binary::Lt | Binary::Le | Binary::Eq | Binary::Ne | Binary::And | Binary::Or => {
                Type::Bool
            }
            Binary::Add
            | Binary::Sub
            | Binary::Mul
            | Binary::Div
            | Binary::Rem
            | Binary::Min
            | Binary::Max
            | Binary::Pow
            | Binary::Atan2
            | Binary::Step
            | Binary::Hash
            | Binary::Cross
            | Binary::Alternative => ty(a),
        },
        Node::Ternary(Ternary::Select, [_, yes, _]) => ty(yes),
        Node::Ternary(_, [a, ..]) => ty(a),
        Node::Transform(..) => Type::Vec3,
        Node::Sample(..) => Type::Scalar,
        Node::MaterialAt(.., field) => field.ty(),
    }
}

fn half_hash_of(node: &Node) -> u32 {
    let hash = BuildHasherDefault::<FxHasher>::default().hash_one(node);
    (hash ^ (hash >> 32)) as u32
}

/// The hash that the table uses, which reads its highest and its lowest bits.
fn whole_hash(half: u32) -> u64 {
    u64::from(half) << 32 | u64::from(half)
}

fn shape_key(definition: &str, dim: crate::node::Dim, level: u16, args: &[Arg]) -> u64 {
    let mut hasher = FxHasher::default();
    (definition, dim, level, args).hash(&mut hasher);
    hasher.finish()
}
