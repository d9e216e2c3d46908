//! Values that are equal up to constants.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Const, Graph, IdMap, LoopVar, Node, NodeId, Stage, Table, Ternary, Type, Unary,
    reachable,
};

/// More places in one formula than any that is worth a loop.
const MOST_PLACES: usize = 4096;

/// An operation without its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Operation {
    Unary(Unary),
    Binary(Binary),
    Ternary(Ternary),
    Splat(Type),
    Compose(Type),
    Swizzle(Type, [u8; 4]),
    Transform,
}

/// What a node is, constants left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Bones {
    /// Some constant of a type.
    Constant(Type),
    /// This node itself.
    Same(NodeId),
    /// An operation on such.
    Operation(u32, [u32; 4]),
}

/// A node taken apart: its operation and the arguments, those of a sum or product in an order that does not
/// depend on when they were made.
enum View {
    Constant,
    Same,
    Operation(Operation, Vec<NodeId>),
}

/// Numbers by which nodes are told apart that differ in more than constants.
#[derive(Debug, Default)]
pub(super) struct Skeletons {
    known: IdMap<u32>,
    numbers: FxHashMap<Bones, u32>,
    operations: FxHashMap<Operation, u32>,
}

impl Skeletons {
    /// Gives numbers to the nodes that these are computed from.
    pub(super) fn learn(&mut self, graph: &mut Graph, roots: &[NodeId]) {
        for id in reachable(graph, roots) {
            self.learn_one(graph, id);
        }
    }

    /// The number of a node that was learnt.
    pub(super) fn of(&self, id: NodeId) -> u32 {
        self.known.get(id).unwrap_or(u32::MAX)
    }

    fn learn_one(&mut self, graph: &mut Graph, id: NodeId) {
        if self.known.get(id).is_some() {
            return;
        }
        let bones = match self.view(graph, id) {
            View::Constant => Bones::Constant(graph.ty(id)),
            View::Same => Bones::Same(id),
            View::Operation(operation, arguments) => {
                let next = self.operations.len() as u32;
                let operation = *self.operations.entry(operation).or_insert(next);
                let mut numbers = [u32::MAX; 4];
                for (number, &argument) in numbers.iter_mut().zip(&arguments) {
                    // A constant that the view has turned may be new.
                    if self.known.get(argument).is_none() {
                        self.learn_one(graph, argument);
                    }
                    *number = self.of(argument);
                }
                Bones::Operation(operation, numbers)
            }
        };
        let next = self.numbers.len() as u32;
        let number = *self.numbers.entry(bones).or_insert(next);
        self.known.insert(id, number);
    }

    fn view(&self, graph: &mut Graph, id: NodeId) -> View {
        let node = graph.node(id);
        if let Node::Const(constant) = node {
            return if constant.ty() == Type::Bool { View::Same } else { View::Constant };
        }
        if graph.stage(id) < Stage::Point {
            return View::Same;
        }
        let arguments: Vec<NodeId> = graph.arguments(id).collect();
        let operation = match node {
            Node::Unary(op, _) => Operation::Unary(op),
            Node::Binary(Binary::Sub, a, b) if graph.as_const(b).is_some() => {
                let b = graph.neg(b);
                return View::Operation(Operation::Binary(Binary::Add), self.sorted(graph, a, b));
            }
            Node::Binary(op @ (Binary::Add | Binary::Mul), a, b) => {
                return View::Operation(Operation::Binary(op), self.sorted(graph, a, b));
            }
            Node::Binary(op, ..) => Operation::Binary(op),
            Node::Ternary(op, _) => Operation::Ternary(op),
            Node::Splat(ty, _) => Operation::Splat(ty),
            Node::Compose(ty, _) => Operation::Compose(ty),
            Node::Swizzle(ty, _, lanes) => Operation::Swizzle(ty, lanes),
            Node::Transform(..) => Operation::Transform,
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => return View::Same,
        };
        View::Operation(operation, arguments)
    }

    fn sorted(&self, graph: &Graph, a: NodeId, b: NodeId) -> Vec<NodeId> {
        if self.rank(graph, b) < self.rank(graph, a) { vec![b, a] } else { vec![a, b] }
    }

    /// Sums and products of blends' steps are told apart by their own operation: what is in them has no number.
    fn rank(&self, graph: &Graph, id: NodeId) -> (usize, u32) {
        let node = graph.node(id);
        let kinds = [
            matches!(node, Node::Const(_)),
            matches!(node, Node::Binary(Binary::Min, ..)),
            matches!(node, Node::Binary(Binary::Mul, ..)),
        ];
        let kind = kinds.into_iter().position(|is| is).unwrap_or(kinds.len());
        (kind, self.of(id))
    }
}

/// One place in the formula.
enum Spot {
    State,
    Same(NodeId),
    Column(usize),
    Operation(Operation, Vec<usize>),
}

struct Merging<'a> {
    graph: &'a mut Graph,
    skeletons: &'a Skeletons,
    places: Vec<Spot>,
    known: FxHashMap<Vec<NodeId>, usize>,
    columns: Vec<Vec<Const>>,
}

/// Formulas over the round's variable of depth 0 that yield, for each list of nodes, in round i the node at i. `before` is a list
/// that the first part of the state stands for. `None` where the nodes differ in more than constants.
pub(super) fn template(
    graph: &mut Graph,
    skeletons: &Skeletons,
    lists: &[&[NodeId]],
    before: Option<&[NodeId]>,
) -> Option<Vec<NodeId>> {
    let (places, known, columns) = Default::default();
    let mut merging = Merging { graph, skeletons, places, known, columns };
    if let Some(before) = before {
        merging.add(before.to_vec(), Spot::State);
    }
    let roots: Option<Vec<usize>> = lists.iter().map(|list| merging.place(list.to_vec())).collect();
    let roots = roots?;
    let values = merging.build();
    Some(roots.into_iter().map(|root| values[root]).collect())
}

impl Merging<'_> {
    fn add(&mut self, column: Vec<NodeId>, place: Spot) -> usize {
        let index = self.places.len();
        self.places.push(place);
        self.known.insert(column, index);
        index
    }

    fn place(&mut self, column: Vec<NodeId>) -> Option<usize> {
        if let Some(&known) = self.known.get(&column) {
            return Some(known);
        }
        if self.places.len() >= MOST_PLACES {
            return None;
        }
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.new_place(column))
    }

    fn new_place(&mut self, column: Vec<NodeId>) -> Option<usize> {
        let (&first, rest) = column.split_first()?;
        if rest.iter().all(|&id| id == first) {
            return Some(self.add(column, Spot::Same(first)));
        }
        let constants: Option<Vec<Const>> =
            column.iter().map(|&id| self.graph.as_const(id)).collect();
        if let Some(constants) = constants {
            let ty = constants[0].ty();
            if ty == Type::Bool || constants.iter().any(|constant| constant.ty() != ty) {
                return None;
            }
            let number = self.columns.len();
            self.columns.push(constants);
            return Some(self.add(column, Spot::Column(number)));
        }
        let View::Operation(operation, arguments) = self.skeletons.view(self.graph, first) else {
            return None;
        };
        let mut lists: Vec<Vec<NodeId>> = arguments.iter().map(|&id| vec![id]).collect();
        for &id in &column[1..] {
            let View::Operation(other, arguments) = self.skeletons.view(self.graph, id) else {
                return None;
            };
            if other != operation || arguments.len() != lists.len() {
                return None;
            }
            for (list, argument) in lists.iter_mut().zip(arguments) {
                list.push(argument);
            }
        }
        let arguments: Option<Vec<usize>> =
            lists.into_iter().map(|list| self.place(list)).collect();
        let arguments = arguments?;
        Some(self.add(column, Spot::Operation(operation, arguments)))
    }

    /// The nodes of all places.
    fn build(&mut self) -> Vec<NodeId> {
        let reads = self.reads();
        let mut values: Vec<NodeId> = Vec::with_capacity(self.places.len());
        for place in &self.places {
            values.push(match place {
                Spot::State => self.graph.variable(0, LoopVar::State(0), Type::Scalar),
                Spot::Same(id) => *id,
                Spot::Column(number) => reads[*number],
                Spot::Operation(operation, arguments) => {
                    let arguments: Vec<NodeId> = arguments.iter().map(|&at| values[at]).collect();
                    made(self.graph, *operation, &arguments)
                }
            });
        }
        values
    }

    /// What reads each column: elements of lists of four numbers each, the widest columns first.
    fn reads(&mut self) -> Vec<NodeId> {
        let mut order: Vec<usize> = (0..self.columns.len()).collect();
        order.sort_by_key(|&number| std::cmp::Reverse(self.columns[number][0].ty().width()));
        let mut rows: Vec<Vec<usize>> = Vec::new();
        for number in order {
            let width = |number: usize| self.columns[number][0].ty().width();
            let fits = |row: &&mut Vec<usize>| {
                row.iter().map(|&number| width(number)).sum::<usize>() + width(number) <= 4
            };
            match rows.iter_mut().find(fits) {
                Some(row) => row.push(number),
                None => rows.push(vec![number]),
            }
        }
        let round = self.graph.variable(0, LoopVar::Index, Type::Scalar);
        let mut reads = vec![round; self.columns.len()];
        for row in rows {
            let instances = self.columns[row[0]].len();
            let element = |instance: usize| {
                let lanes = row.iter().flat_map(|&number| {
                    let constant = &self.columns[number][instance];
                    constant.lanes().into_iter().take(constant.ty().width())
                });
                Const::new(Type::Vec4, &lanes.collect::<Vec<f64>>())
            };
            let elements = (0..instances).map(element).collect();
            let element = self.graph.element(Table { ty: Type::Vec4, elements }, round);
            let mut lane = 0u8;
            for number in row {
                let width = self.columns[number][0].ty().width() as u8;
                let lanes: Vec<u8> = (lane..lane + width).collect();
                reads[number] = self.graph.swizzle(element, &lanes);
                lane += width;
            }
        }
        reads
    }
}

fn made(graph: &mut Graph, operation: Operation, arguments: &[NodeId]) -> NodeId {
    match (operation, arguments) {
        (Operation::Unary(op), &[a]) => graph.unary(op, a),
        (Operation::Binary(op), &[a, b]) => graph.binary(op, a, b),
        (Operation::Ternary(Ternary::Select), &[condition, yes, no]) => {
            graph.select(condition, yes, no)
        }
        (Operation::Ternary(op), &[a, b, c]) => graph.ternary(op, a, b, c),
        (Operation::Splat(ty), &[a]) => graph.splat(ty, a),
        (Operation::Compose(_), parts) => graph.compose(parts),
        (Operation::Swizzle(ty, lanes), &[a]) => graph.swizzle(a, &lanes[..ty.width()]),
        (Operation::Transform, &[a, b, c, v]) => graph.transform([a, b, c], v),
        // `View` has as many arguments as the operation takes.
        (_, arguments) => arguments[0],
    }
}
