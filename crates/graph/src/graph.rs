//! The arena: interning, types, stages.

use std::hash::{BuildHasher, BuildHasherDefault, Hash, Hasher};

use hashbrown::HashTable;
use rustc_hash::{FxHashMap, FxHasher};

use crate::range::{Range, range_of};
use crate::repeat::{Loop, Table};
use crate::{
    Arg, Binary, Const, LoopId, Node, NodeId, Shape, ShapeId, Stage, TableId, Ternary, Type, Unary,
};

/// What is known of a node beside its operation.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facts {
    ty: Type,
    stage: Stage,
    range: Range,
    /// One more than the highest level of a point that it depends on; 0 for none.
    levels: u16,
    /// The loops whose variables it depends on, one bit by depth.
    loops: u8,
}

/// What the author of a function states of its result: it changes by at most `lipschitz` where each of
/// the arguments changes by at most 1, vectors by Euclidean length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// A scalar known before the point is.
    pub lipschitz: NodeId,
    /// The arguments that depend on a point.
    pub arguments: Vec<NodeId>,
}

/// Hash-consed nodes and shape instances. Equal nodes have equal ids.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    facts: Vec<Facts>,
    /// By the node's hash, half of which stands beside the id, so that few nodes are looked up.
    ids: HashTable<(u32, NodeId)>,
    shapes: Vec<Shape>,
    shape_ids: FxHashMap<u64, Vec<ShapeId>>,
    claims: FxHashMap<NodeId, Claim>,
    loops: Vec<Loop>,
    loop_ids: FxHashMap<Loop, LoopId>,
    tables: Vec<Table>,
    table_ids: FxHashMap<Table, TableId>,
}

/// The arguments of a node.
#[derive(Clone, Debug)]
pub struct Arguments<'g> {
    own: std::iter::Take<std::array::IntoIter<NodeId, 4>>,
    /// Of a loop, what is left of its arguments.
    repeated: Option<(&'g Loop, usize)>,
}

impl Iterator for Arguments<'_> {
    type Item = NodeId;

    fn next(&mut self) -> Option<NodeId> {
        let Some((repeated, position)) = &mut self.repeated else { return self.own.next() };
        *position += 1;
        repeated.argument(*position - 1)
    }
}

impl Graph {
    /// An empty arena.
    pub fn new() -> Self {
        Self::default()
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The node.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// The node's arguments in order. Those of a loop are all that it mentions, its body's roots among them.
    pub fn arguments(&self, id: NodeId) -> Arguments<'_> {
        self.arguments_of(&self.node(id))
    }

    fn arguments_of(&self, node: &Node) -> Arguments<'_> {
        let repeated =
            if let Node::Loop(id, ..) = *node { Some((self.repeated(id), 0)) } else { None };
        Arguments { own: node.own_arguments(), repeated }
    }

    /// The loop.
    pub fn repeated(&self, id: LoopId) -> &Loop {
        &self.loops[id.0 as usize]
    }

    /// The list.
    pub fn table(&self, id: TableId) -> &Table {
        &self.tables[id.index()]
    }

    /// The loops whose bodies the node lies in, one bit by depth: those whose variables it depends on.
    pub fn loops(&self, id: NodeId) -> u8 {
        self.facts[id.index()].loops
    }

    /// The shape and the place of a sample; `None` of any other node.
    pub fn as_sample(&self, id: NodeId) -> Option<(ShapeId, NodeId)> {
        if let Node::Sample(shape, place) = self.node(id) { Some((shape, place)) } else { None }
    }

    /// The node's type.
    pub fn ty(&self, id: NodeId) -> Type {
        self.facts[id.index()].ty
    }

    /// The node's stage.
    pub fn stage(&self, id: NodeId) -> Stage {
        self.facts[id.index()].stage
    }

    /// Between which values every component of the node lies.
    pub fn range(&self, id: NodeId) -> Range {
        self.facts[id.index()].range
    }

    /// States between which values a per-frame input lies. To be called before anything is built on it.
    pub fn assume_range(&mut self, id: NodeId, range: Range) {
        self.facts[id.index()].range = range;
    }

    /// One more than the highest level of a point that the node depends on; 0 for none.
    pub fn levels(&self, id: NodeId) -> u16 {
        self.facts[id.index()].levels
    }

    /// All ids in order: arguments before their uses.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// All shape ids in order: children before parents.
    pub fn shape_ids(&self) -> impl Iterator<Item = ShapeId> + use<> {
        (0..self.shapes.len() as u32).map(ShapeId)
    }

    /// The shape.
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

    /// The constant in its place: nodes are large to copy.
    pub(crate) fn const_at(&self, id: NodeId) -> Option<&Const> {
        if let Node::Const(value) = &self.nodes[id.index()] { Some(value) } else { None }
    }

    /// The number that every component is, if the node is a constant of equal components.
    pub fn as_uniform(&self, id: NodeId) -> Option<f64> {
        let value = self.const_at(id)?;
        let lanes = value.lanes();
        lanes[1..value.ty().width()].iter().all(|&lane| lane == lanes[0]).then_some(lanes[0])
    }

    /// The id of a node exactly as given: no folding. Callers use the typed builders.
    pub(crate) fn intern(&mut self, node: Node) -> NodeId {
        let half = half_hash_of(&node);
        let known = self
            .ids
            .find(whole_hash(half), |&(other, id)| other == half && self.nodes[id.index()] == node);
        if let Some(&(_, id)) = known {
            return id;
        }
        let facts = self.facts_of(&node);
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(node);
        self.facts.push(facts);
        self.ids.insert_unique(whole_hash(half), (half, id), |&(half, _)| whole_hash(half));
        id
    }

    fn facts_of(&self, node: &Node) -> Facts {
        let (mut stage, mut levels, mut loops) = (Stage::Const, 0, 0);
        for argument in self.arguments_of(node) {
            stage = stage.max(self.stage(argument));
            levels = levels.max(self.levels(argument));
            loops |= self.loops(argument);
        }
        match *node {
            Node::Variable(depth, ..) => (stage, loops) = (Stage::Point, 1 << depth),
            Node::Loop(id, ..) => (stage, loops) = (Stage::Point, loops & !self.repeated(id).bit()),
            Node::Point(level, _) => (stage, levels) = (Stage::Point, level + 1),
            Node::Frame(..) => stage = Stage::Frame,
            Node::Sample(shape, _) | Node::MaterialAt(shape, ..) => {
                // The shape's own arguments may depend on outer points.
                levels = levels.max(self.shape(shape).level);
                loops |= self.loops(self.shape(shape).formula);
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
        Facts { ty, stage, range, levels, loops }
    }

    /// The loop equal to this one.
    pub(crate) fn add_loop(&mut self, repeated: Loop) -> LoopId {
        let next = LoopId(self.loops.len() as u32);
        let id = *self.loop_ids.entry(repeated.clone()).or_insert(next);
        if id == next {
            self.loops.push(repeated);
        }
        id
    }

    /// The list equal to this one.
    pub(crate) fn add_table(&mut self, table: Table) -> TableId {
        let next = TableId(self.tables.len() as u32);
        let id = *self.table_ids.entry(table.clone()).or_insert(next);
        if id == next {
            self.tables.push(table);
        }
        id
    }

    /// The instance equal to this one in definition, dimension, level and arguments, or this one as
    /// a new instance. Its name, if given, is kept by the first.
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
        dim: crate::Dim,
        level: u16,
        args: &[Arg],
    ) -> Option<ShapeId> {
        self.find(shape_key(definition, dim, level, args), definition, dim, level, args)
    }

    fn find(
        &self,
        key: u64,
        definition: &str,
        dim: crate::Dim,
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

    /// Records what is stated of a node, and what follows for the part of it that varies: simplification
    /// moves signs, offsets and factors out of a node, and would leave the claim behind. The first claim stays.
    pub fn claim(&mut self, node: NodeId, mut claim: Claim) {
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

    /// What is stated of a node holds of another that equals its negative.
    pub(crate) fn carry_claim(&mut self, node: NodeId, negative: NodeId) {
        if let Some(claim) = self.claims.get(&node).cloned() {
            self.claim(negative, claim);
        }
    }

    /// A node without its sign and offsets: it changes as fast.
    fn unshifted(&self, mut node: NodeId) -> NodeId {
        while let Some((inner, 1.0)) = self.varying_part(node) {
            node = inner;
        }
        node
    }

    /// The part of `-x`, `x + c`, `x - c`, `c - x`, `x * c` that depends on the point, and by how much the whole
    /// changes faster than it.
    fn varying_part(&self, node: NodeId) -> Option<(NodeId, f64)> {
        let fixed = |id: NodeId| self.stage(id) < Stage::Point;
        match self.node(node) {
            Node::Unary(Unary::Neg, x) => Some((x, 1.0)),
            Node::Binary(Binary::Add | Binary::Sub, x, c) if fixed(c) => Some((x, 1.0)),
            Node::Binary(Binary::Add | Binary::Sub, c, x) if fixed(c) => Some((x, 1.0)),
            Node::Binary(Binary::Mul, x, c) => {
                let factor = self.as_uniform(c)?.abs();
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

    /// What is stated of a node.
    pub fn claim_of(&self, node: NodeId) -> Option<&Claim> {
        self.claims.get(&node)
    }

    /// Gives a shape another material; what has been expanded keeps the one that it had.
    pub fn set_material(&mut self, id: ShapeId, material: crate::MaterialRule) {
        self.shapes[id.index()].material = material;
    }

    /// States where a ray is inside an instance: intervals along it, as [`Shape::hits`] says.
    pub fn set_hits(&mut self, id: ShapeId, hits: Vec<[NodeId; 2]>) {
        self.shapes[id.index()].hits = hits;
    }

    /// Names a shape after the scene's `let`; the first name stays.
    pub fn name_shape(&mut self, id: ShapeId, name: &str) {
        let shape = &mut self.shapes[id.index()];
        shape.name.get_or_insert_with(|| name.to_owned());
    }
}

/// The type of a node, given those of its arguments.
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
            | Binary::Cross => ty(a),
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

/// A hash as the table wants it, which reads its highest and its lowest bits.
fn whole_hash(half: u32) -> u64 {
    u64::from(half) << 32 | u64::from(half)
}

fn shape_key(definition: &str, dim: crate::Dim, level: u16, args: &[Arg]) -> u64 {
    let mut hasher = FxHasher::default();
    (definition, dim, level, args).hash(&mut hasher);
    hasher.finish()
}
