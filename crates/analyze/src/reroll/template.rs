//! The formula that nodes share which are equal up to constants.
//!
//! [`template`] builds the common formula of nodes with equal [`ShapeKeys`], in which lists hold
//! the constants that differ.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Const, Graph, MAX_LOOP_DEPTH, Node, NodeId, Stage, Table, TableId, Ternary, Type, Unary,
};

use crate::reroll::linear::{Linear, MAX_INPUTS};
use crate::reroll::nested::{JoinedList, NestedLoop, nested_variable};
use crate::reroll::shape_keys::{LoopForm, Operation, ShapeKeys, View};

/// Largest number of subexpressions of a template. Larger ones are not worth a loop.
const MAX_COLUMNS: usize = 4096;

/// Largest number of per-frame operations that the iterations of a loop repeat.
const MAX_FRAME_OPERATIONS: usize = 16;

/// A subexpression of the template.
enum Expression {
    /// The same node in every iteration, or one that the caller gave.
    Same(NodeId),
    /// Constants that differ, by the index of their column.
    Column(usize),
    /// An operation on other subexpressions.
    Operation(Operation, Vec<usize>),
    /// The element of a list at the index that another subexpression gives.
    Element(TableId, usize),
    /// A part of the state after a loop.
    Loop(NestedLoop),
}

struct Merging<'a> {
    graph: &'a mut Graph,
    keys: &'a mut ShapeKeys,
    expressions: Vec<Expression>,
    known: FxHashMap<Vec<NodeId>, usize>,
    columns: Vec<Vec<Const>>,
    joined: FxHashMap<Vec<TableId>, JoinedList>,
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
    let (expressions, known, columns, joined) = Default::default();
    let frame_operations = 0;
    let mut merging =
        Merging { graph, keys, expressions, known, columns, joined, frame_operations };
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
            if self.graph.loops_around(first) == 0 {
                return Some(self.add(column, Expression::Same(first)));
            }
            if let Node::Variable(..) = self.graph.node(first) {
                let nested = nested_variable(self.graph, first);
                return Some(self.add(column, Expression::Same(nested)));
            }
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
        let expression = match operation {
            Operation::Element(_) => self.element(&column, arguments[0])?,
            Operation::Loop(form, part) => self.nested_loop(&column, (form, part), arguments)?,
            Operation::Unary(_)
            | Operation::Binary(_)
            | Operation::Ternary(_)
            | Operation::Splat(_)
            | Operation::Compose(_)
            | Operation::Swizzle(..)
            | Operation::Transform => Expression::Operation(operation, arguments),
        };
        Some(self.add(column, expression))
    }

    /// The elements of some lists, at the index that a subexpression gives.
    fn element(&mut self, column: &[NodeId], index: usize) -> Option<Expression> {
        let list_of = |&id: &NodeId| {
            let Node::Element(list, ..) = self.graph.node(id) else { return None };
            Some(list)
        };
        let lists: Vec<TableId> = column.iter().map(list_of).collect::<Option<_>>()?;
        if lists.iter().all(|&list| list == lists[0]) {
            return Some(Expression::Element(lists[0], index));
        }
        if !self.joined.contains_key(&lists) {
            let joined = JoinedList::new(self.graph, &lists);
            self.joined.insert(lists.clone(), joined);
        }
        let JoinedList { list, firsts, lasts } = self.joined.get(&lists)?.clone();
        // Each list has its own end, to which indices are clamped.
        let numbers =
            |numbers: Vec<usize>| numbers.into_iter().map(|it| [it as f64, 0.0, 0.0, 0.0]);
        let first = self.constants(Type::Scalar, numbers(firsts))?;
        let last = self.constants(Type::Scalar, numbers(lasts))?;
        let zero = self.constants(Type::Scalar, column.iter().map(|_| [0.0; 4]))?;
        let whole = self.push(Operation::Unary(Unary::Floor), vec![index]);
        let clamped = self.push(Operation::Ternary(Ternary::Clamp), vec![whole, zero, last]);
        let index = self.push(Operation::Binary(Binary::Add), vec![first, clamped]);
        Some(Expression::Element(list, index))
    }

    /// A part of the state after loops of one form. `arguments` are the subexpressions of their
    /// nodes.
    fn nested_loop(
        &mut self,
        column: &[NodeId],
        (form, part): (LoopForm, u16),
        arguments: Vec<usize>,
    ) -> Option<Expression> {
        if form.depth + 1 >= MAX_LOOP_DEPTH {
            return None;
        }
        let iterations_of = |&id: &NodeId| {
            let Node::Loop(id, ..) = self.graph.node(id) else { return None };
            Some(self.graph.loop_at(id).max_iterations)
        };
        let all: Vec<u32> = column.iter().map(iterations_of).collect::<Option<_>>()?;
        let max_iterations = all.iter().copied().max()?;
        let limit = if all.iter().all(|&it| it == max_iterations) {
            None
        } else {
            Some(
                self.constants(Type::Scalar, all.iter().map(|&it| [f64::from(it), 0.0, 0.0, 0.0]))?,
            )
        };
        Some(Expression::Loop(NestedLoop { form, part, max_iterations, limit, arguments }))
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
                Expression::Element(list, at) => self.graph.element_of(*list, values[*at]),
                Expression::Loop(nested) => nested.build(self.graph, &values),
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
