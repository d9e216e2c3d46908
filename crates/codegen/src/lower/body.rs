//! A function body under construction: expressions in order, what emits them, and their names.

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, MathFunction,
    ScalarKind, Span, Statement,
};
use rustc_hash::FxHashMap;

/// A value within a function.
pub(crate) type Value = Handle<Expression>;

/// The maximum nesting of values in the written source; a deeper value gets a name. Writers recurse
/// over nested values, and people read them.
const MAX_NESTING: u8 = 6;

/// A function while its statements are appended.
#[derive(Default)]
pub(crate) struct Body {
    function: Function,
    /// The blocks around the current one, outermost first.
    outer: Vec<Block>,
    /// Nesting of each expression in the written source, in arena order.
    nesting: Vec<u8>,
    literals: FxHashMap<u32, Value>,
}

impl Body {
    /// Adds an expression that no statement emits: an argument, global variable or literal.
    pub(crate) fn declare(&mut self, expression: Expression) -> Value {
        self.nesting.push(0);
        self.function.expressions.append(expression, Span::UNDEFINED)
    }

    /// Adds an expression that is computed here from its operands.
    pub(crate) fn compute(&mut self, expression: Expression, operands: &[Value]) -> Value {
        let deepest = operands.iter().map(|operand| self.nesting[operand.index()]).max();
        let nesting = deepest.unwrap_or(0) + 1;
        let value = self.function.expressions.append(expression, Span::UNDEFINED);
        self.nesting.push(nesting);
        self.emit(value);
        if nesting >= MAX_NESTING {
            self.name(value, "t");
        }
        value
    }

    /// Emits one more expression, in the last `Emit` if it directly follows it.
    fn emit(&mut self, value: Value) {
        let last = self.function.body.last_mut();
        if let Some(Statement::Emit(range)) = last
            && let Some((first, last)) = range.first_and_last()
            && last.index() + 1 == value.index()
        {
            *range = naga::Range::new_from_bounds(first, value);
            return;
        }
        self.push(Statement::Emit(naga::Range::new_from_bounds(value, value)));
    }

    /// Adds a local variable without an initial value.
    pub(crate) fn variable(&mut self, name: &str, ty: Handle<naga::Type>) -> Value {
        let variable = LocalVariable { name: Some(name.to_owned()), ty, init: None };
        let variable = self.function.local_variables.append(variable, Span::UNDEFINED);
        self.declare(Expression::LocalVariable(variable))
    }

    /// Loads a variable into a named value.
    pub(crate) fn load(&mut self, pointer: Value, name: &str) -> Value {
        let value = self.compute(Expression::Load { pointer }, &[pointer]);
        self.name(value, name);
        value
    }

    /// Stores a value in a variable.
    pub(crate) fn store(&mut self, pointer: Value, value: Value) {
        self.push(Statement::Store { pointer, value });
    }

    /// Opens the block of a loop or a branch: the next statements are in it.
    pub(crate) fn open_block(&mut self) {
        self.outer.push(std::mem::take(&mut self.function.body));
    }

    fn close_block(&mut self) -> Block {
        std::mem::replace(&mut self.function.body, self.outer.pop().unwrap_or_default())
    }

    /// Leaves the loop if the condition is true.
    pub(crate) fn break_if(&mut self, condition: Value) {
        let accept = Block::from_vec(vec![Statement::Break]);
        self.push(Statement::If { condition, accept, reject: Block::new() });
    }

    /// Closes the loop. Values that were computed within can no longer be used.
    pub(crate) fn close_loop(&mut self) {
        let body = self.close_block();
        self.push(Statement::Loop { body, continuing: Block::new(), break_if: None });
    }

    /// Closes a branch, whose block runs only where the condition is true. Values that were
    /// computed within can no longer be used.
    pub(crate) fn close_branch(&mut self, condition: Value) {
        let accept = self.close_block();
        self.push(Statement::If { condition, accept, reject: Block::new() });
    }

    /// Appends a statement.
    pub(crate) fn push(&mut self, statement: Statement) {
        self.function.body.push(statement, Span::UNDEFINED);
    }

    /// Names a value in the written source; a later name replaces an earlier one.
    pub(crate) fn name(&mut self, value: Value, name: &str) {
        self.function.named_expressions.insert(value, name.to_owned());
        self.nesting[value.index()] = 0;
    }

    /// A 32-bit float.
    pub(crate) fn literal(&mut self, value: f32) -> Value {
        if let Some(&known) = self.literals.get(&value.to_bits()) {
            return known;
        }
        let literal = self.declare(Expression::Literal(Literal::F32(value)));
        self.literals.insert(value.to_bits(), literal);
        literal
    }

    /// A 32-bit unsigned integer.
    pub(crate) fn word(&mut self, value: u32) -> Value {
        self.declare(Expression::Literal(Literal::U32(value)))
    }

    /// Converts to another kind of scalar of `convert` bytes; without `convert`, reinterprets the
    /// bits.
    pub(crate) fn cast(&mut self, expr: Value, kind: ScalarKind, convert: Option<u8>) -> Value {
        self.compute(Expression::As { expr, kind, convert }, &[expr])
    }

    /// Calls a built-in function of one argument.
    pub(crate) fn call1(&mut self, fun: MathFunction, arg: Value) -> Value {
        self.compute(Expression::Math { fun, arg, arg1: None, arg2: None, arg3: None }, &[arg])
    }

    /// Calls a built-in function of two arguments.
    pub(crate) fn call2(&mut self, fun: MathFunction, arg: Value, arg1: Value) -> Value {
        let call = Expression::Math { fun, arg, arg1: Some(arg1), arg2: None, arg3: None };
        self.compute(call, &[arg, arg1])
    }

    /// Calls a built-in function of three arguments.
    pub(crate) fn call3(&mut self, fun: MathFunction, [arg, b, c]: [Value; 3]) -> Value {
        let call = Expression::Math { fun, arg, arg1: Some(b), arg2: Some(c), arg3: None };
        self.compute(call, &[arg, b, c])
    }

    /// Applies a binary operator.
    pub(crate) fn binary(&mut self, op: BinaryOperator, left: Value, right: Value) -> Value {
        self.compute(Expression::Binary { op, left, right }, &[left, right])
    }

    /// Ends the function with a return.
    pub(crate) fn finish(mut self, result: Option<Value>) -> Function {
        if result.is_some() {
            self.push(Statement::Return { value: result });
        }
        self.function
    }
}
