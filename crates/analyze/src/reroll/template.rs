//! Nodes that are equal up to constants, and the formulas they share.
//!
//! Equal shape keys mean equal structure. [`template`] builds the common formula of nodes with
//! equal keys, in which lists hold the constants that differ. A per-frame value may count as a
//! constant: lists hold its factors as a linear function.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Const, Graph, IdMap, Node, NodeId, Stage, Table, Ternary, Type, Unary, reachable,
};

use crate::reroll::linear::{Linear, Linears, MAX_INPUTS};

/// Largest number of subexpressions of a template. Larger ones are not worth a loop.
const MAX_COLUMNS: usize = 4096;

/// Largest number of per-frame operations that the iterations of a loop repeat.
const MAX_FRAME_OPERATIONS: usize = 16;

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

/// The structure of a node without its constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Structure {
    /// Any constant of a type, or any value that counts as one.
    Constant(Type),
    /// Exactly this node.
    Same(NodeId),
    /// An operation and the keys of its arguments.
    Operation(u32, [u32; 4]),
}

/// A node as an operation and its arguments. The arguments of sums and products are in an order
/// that does not depend on the order in which they were built.
enum View {
    /// A constant, or a value that counts as one, which may differ between similar nodes.
    Constant,
    /// A node that must be the same in all similar nodes.
    Same,
    /// An operation with arguments.
    Operation(Operation, Vec<NodeId>),
}

/// The per-frame values in which similar nodes may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PerFrame {
    /// All that have a finite range.
    #[default]
    Any,
    /// Linear functions of params and time. Other values have the same structure.
    Linear,
    /// None.
    Same,
}

/// Shape keys: numbers that are equal for nodes that are equal up to constants.
#[derive(Debug, Default)]
pub(super) struct ShapeKeys {
    known: IdMap<u32>,
    keys: FxHashMap<Structure, u32>,
    operations: FxHashMap<Operation, u32>,
    linears: Linears,
    per_frame: PerFrame,
}

impl ShapeKeys {
    /// Keys of nodes that differ in fewer per-frame values; `None` if these differ in none.
    pub(super) fn stricter(&self) -> Option<Self> {
        let per_frame = match self.per_frame {
            PerFrame::Any => PerFrame::Linear,
            PerFrame::Linear => PerFrame::Same,
            PerFrame::Same => return None,
        };
        let mut stricter = Self { per_frame, ..Self::default() };
        stricter.linears.of_raw_inputs = true;
        Some(stricter)
    }

    /// Computes the keys of all nodes that the roots depend on.
    pub(super) fn compute(&mut self, graph: &mut Graph, roots: &[NodeId]) {
        for id in reachable(graph, roots) {
            self.compute_one(graph, id);
        }
    }

    /// The key of a node; `u32::MAX` if it was not computed.
    pub(super) fn of(&self, id: NodeId) -> u32 {
        self.known.get(id).unwrap_or(u32::MAX)
    }

    fn compute_one(&mut self, graph: &mut Graph, id: NodeId) {
        if self.known.get(id).is_some() {
            return;
        }
        let structure = match self.view(graph, id) {
            View::Constant => Structure::Constant(graph.ty(id)),
            View::Same => Structure::Same(id),
            View::Operation(operation, arguments) => {
                let next = self.operations.len() as u32;
                let operation = *self.operations.entry(operation).or_insert(next);
                let mut argument_keys = [u32::MAX; 4];
                for (number, &argument) in argument_keys.iter_mut().zip(&arguments) {
                    // The view negates constants, so this one may be new.
                    if self.known.get(argument).is_none() {
                        self.compute_one(graph, argument);
                    }
                    *number = self.of(argument);
                }
                Structure::Operation(operation, argument_keys)
            }
        };
        let next = self.keys.len() as u32;
        let key = *self.keys.entry(structure).or_insert(next);
        self.known.insert(id, key);
    }

    /// A per-frame value that counts as a constant, as a linear function.
    fn linear(&mut self, graph: &mut Graph, id: NodeId) -> Option<Linear> {
        match self.per_frame {
            PerFrame::Any | PerFrame::Linear => self.linears.of(graph, id),
            PerFrame::Same => None,
        }
    }

    /// True for a constant, or a value that counts as one.
    fn is_constant(&mut self, graph: &mut Graph, id: NodeId) -> bool {
        graph.as_const(id).is_some() || self.linear(graph, id).is_some()
    }

    /// Takes a node apart.
    fn view(&mut self, graph: &mut Graph, id: NodeId) -> View {
        if graph.stage(id) < Stage::Point && graph.ty(id) == Type::Bool {
            return View::Same;
        }
        if self.is_constant(graph, id) {
            return View::Constant;
        }
        if self.per_frame == PerFrame::Same && graph.stage(id) < Stage::Point {
            return View::Same;
        }
        let node = graph.node(id);
        let arguments: Vec<NodeId> = graph.arguments(id).collect();
        let operation = match node {
            Node::Unary(op, _) => Operation::Unary(op),
            Node::Binary(Binary::Sub, a, b) if self.is_constant(graph, b) => {
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

    /// The operands of a sum or product in order of their rank.
    fn sorted(&mut self, graph: &mut Graph, a: NodeId, b: NodeId) -> Vec<NodeId> {
        if self.rank(graph, b) < self.rank(graph, a) { vec![b, a] } else { vec![a, b] }
    }

    /// The sort key of an operand. The steps of a blend have no shape key, so their kind of
    /// operation comes first.
    fn rank(&mut self, graph: &mut Graph, id: NodeId) -> (usize, u32) {
        let node = graph.node(id);
        let kinds = [
            self.is_constant(graph, id),
            matches!(node, Node::Binary(Binary::Min, ..)),
            matches!(node, Node::Binary(Binary::Mul, ..)),
        ];
        let kind = kinds.into_iter().position(|is| is).unwrap_or(kinds.len());
        (kind, self.of(id))
    }
}

/// A subexpression of the template.
enum Expression {
    /// The same node in every iteration, or one that the caller gave.
    Same(NodeId),
    /// Constants that differ, by the index of their column.
    Column(usize),
    /// An operation on other subexpressions.
    Operation(Operation, Vec<usize>),
}

struct Merging<'a> {
    graph: &'a mut Graph,
    keys: &'a mut ShapeKeys,
    expressions: Vec<Expression>,
    known: FxHashMap<Vec<NodeId>, usize>,
    columns: Vec<Vec<Const>>,
    /// The number of per-frame operations that iterations repeat.
    frame_operations: usize,
}

/// Builds one formula for each list of nodes, whose value is the list's node i where `index` is i.
/// `given` are lists whose formulas are known. Returns `None` if the nodes differ in more than
/// constants.
pub(super) fn template(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    lists: &[&[NodeId]],
    given: &[(&[NodeId], NodeId)],
    index: NodeId,
) -> Option<Vec<NodeId>> {
    let (expressions, known, columns) = Default::default();
    let mut merging = Merging { graph, keys, expressions, known, columns, frame_operations: 0 };
    for (list, formula) in given {
        merging.add(list.to_vec(), Expression::Same(*formula));
    }
    let roots: Option<Vec<usize>> =
        lists.iter().map(|list| merging.expression(list.to_vec())).collect();
    let roots = roots?;
    let values = merging.build(index);
    Some(roots.into_iter().map(|root| values[root]).collect())
}

impl Merging<'_> {
    fn add(&mut self, column: Vec<NodeId>, expression: Expression) -> usize {
        let index = self.expressions.len();
        self.expressions.push(expression);
        self.known.insert(column, index);
        index
    }

    fn expression(&mut self, column: Vec<NodeId>) -> Option<usize> {
        if let Some(&known) = self.known.get(&column) {
            return Some(known);
        }
        if self.expressions.len() >= MAX_COLUMNS {
            return None;
        }
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.new_expression(column))
    }

    fn new_expression(&mut self, column: Vec<NodeId>) -> Option<usize> {
        let (&first, rest) = column.split_first()?;
        if rest.iter().all(|&id| id == first) {
            return Some(self.add(column, Expression::Same(first)));
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
            return Some(self.add(column, Expression::Column(number)));
        }
        if column.iter().all(|&id| self.graph.stage(id) < Stage::Point) {
            if let Some(sum) = self.linear(&column) {
                self.known.insert(column, sum);
                return Some(sum);
            }
            self.frame_operations += 1;
            if self.frame_operations > MAX_FRAME_OPERATIONS {
                return None;
            }
        }
        let View::Operation(operation, arguments) = self.keys.view(self.graph, first) else {
            return None;
        };
        let mut lists: Vec<Vec<NodeId>> = arguments.iter().map(|&id| vec![id]).collect();
        for &id in &column[1..] {
            let View::Operation(other, arguments) = self.keys.view(self.graph, id) else {
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
            lists.into_iter().map(|list| self.expression(list)).collect();
        let arguments = arguments?;
        Some(self.add(column, Expression::Operation(operation, arguments)))
    }

    /// The linear functions of a column as one function of the inputs, whose factors are columns.
    fn linear(&mut self, column: &[NodeId]) -> Option<usize> {
        let ty = self.graph.ty(*column.first()?);
        let of = |id: &NodeId| self.keys.linear(self.graph, *id);
        let functions: Vec<Linear> = column.iter().map(of).collect::<Option<_>>()?;
        let mut inputs: Vec<NodeId> = Vec::new();
        for (input, _) in functions.iter().flat_map(|function| &function.terms) {
            if !inputs.contains(input) {
                inputs.push(*input);
            }
        }
        if inputs.len() > MAX_INPUTS {
            return None;
        }
        let mut sum = self.constants(ty, functions.iter().map(|function| function.offset))?;
        for input in inputs {
            let factors = functions.iter().map(|function| function.factors(input));
            let factor = self.constants(ty, factors)?;
            let value = self.graph.splat(ty, input);
            let value = self.expression(vec![value; column.len()])?;
            let product = self.push(Operation::Binary(Binary::Mul), vec![value, factor]);
            sum = self.push(Operation::Binary(Binary::Add), vec![product, sum]);
        }
        Some(sum)
    }

    /// The subexpression of a column of constants.
    fn constants(&mut self, ty: Type, lanes: impl Iterator<Item = [f64; 4]>) -> Option<usize> {
        let column = lanes.map(|lanes| self.graph.constant(ty, &lanes[..ty.width()])).collect();
        self.expression(column)
    }

    fn push(&mut self, operation: Operation, arguments: Vec<usize>) -> usize {
        self.expressions.push(Expression::Operation(operation, arguments));
        self.expressions.len() - 1
    }

    /// Builds the nodes of all subexpressions.
    fn build(&mut self, index: NodeId) -> Vec<NodeId> {
        let reads = self.reads(index);
        let mut values: Vec<NodeId> = Vec::with_capacity(self.expressions.len());
        for expression in &self.expressions {
            values.push(match expression {
                Expression::Same(id) => *id,
                Expression::Column(number) => reads[*number],
                Expression::Operation(operation, arguments) => {
                    let arguments: Vec<NodeId> = arguments.iter().map(|&at| values[at]).collect();
                    build_operation(self.graph, *operation, &arguments)
                }
            });
        }
        values
    }

    /// The nodes that read the columns: lanes of elements of lists with four numbers each. Wide
    /// columns are placed first.
    fn reads(&mut self, index: NodeId) -> Vec<NodeId> {
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
        let mut reads = vec![index; self.columns.len()];
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
            let element = self.graph.element(Table { ty: Type::Vec4, elements }, index);
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

/// Builds an operation.
fn build_operation(graph: &mut Graph, operation: Operation, arguments: &[NodeId]) -> NodeId {
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
        // Unreachable: `View` has as many arguments as the operation takes.
        (_, arguments) => arguments[0],
    }
}
