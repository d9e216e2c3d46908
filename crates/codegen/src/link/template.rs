//! Parses joined WGSL files to a module whose stubs a scene can replace.

use naga::compact::{KeepUnused, compact};
use naga::{Arena, Block, Expression, Function, GlobalVariable, Handle, Module, Statement};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::error::Error;

/// Parses joined files to a template module. Takes one side of each branch on an override and drops
/// the calls to the functions of `unused`, with everything that only they and the other sides
/// reached. `overrides` has a value for each override of the files.
pub(crate) fn parse_template(
    source: &str,
    overrides: &[(&str, bool)],
    unused: &[&str],
) -> Result<Module, Error> {
    let mut module = naga::front::wgsl::parse_str(source)
        .map_err(|error| Error::Naga(error.emit_to_string(source)))?;
    let dropped = unused.iter().filter_map(|name| find_function(&module, name)).collect();
    let value = |name: &Option<String>| {
        let found = overrides.iter().find(|known| Some(known.0) == name.as_deref());
        found.is_some_and(|known| known.1)
    };
    let values = module.overrides.iter().map(|(handle, known)| (handle, value(&known.name)));
    let choices = Choices { dropped, values: values.collect() };
    let entries = module.entry_points.iter_mut().map(|entry| &mut entry.function);
    for function in module.functions.iter_mut().map(|(_, function)| function).chain(entries) {
        let conditions = choices.conditions(function);
        let mut removed = Vec::new();
        choices.apply(&mut function.body, &conditions, &mut removed);
        unname(&removed, function);
    }
    // `compact` keeps what is named; the conditions on overrides are gone, so these may go.
    for (_, known) in module.overrides.iter_mut() {
        known.name = None;
    }
    // Joined files are valid, as `compact` requires; a test joins each of them.
    compact(&mut module, KeepUnused::No);
    module.functions.iter_mut().for_each(|(_, function)| drop_unused_variables(function));
    drop_unused_constants(&mut module);
    Ok(module)
}

/// Returns the function of that name.
pub(crate) fn find_function(module: &Module, name: &str) -> Option<Handle<Function>> {
    let mut functions = module.functions.iter();
    functions.find(|(_, f)| f.name.as_deref() == Some(name)).map(|(handle, _)| handle)
}

/// Returns the variable of that name.
pub(crate) fn find_variable(module: &Module, name: &str) -> Option<Handle<GlobalVariable>> {
    let mut variables = module.global_variables.iter();
    variables.find(|(_, v)| v.name.as_deref() == Some(name)).map(|(handle, _)| handle)
}

/// Binds a function to a stub: replaces the stub's body by that of a function with the same
/// signature. A stub calls nothing, and its replacement only functions that precede it in the
/// files, so the arena keeps callees before callers.
pub(crate) fn bind(module: &mut Module, name: &str, replacement: Function) -> Result<(), Error> {
    let handle = find_function(module, name)
        .ok_or_else(|| Error::Naga(format!("the ray method has no `{name}`")))?;
    let stub = module.functions.get_mut(handle);
    let (arguments, result) = (std::mem::take(&mut stub.arguments), stub.result.take());
    *stub = Function { name: stub.name.take(), arguments, result, ..replacement };
    Ok(())
}

/// The choices of a template.
struct Choices {
    /// Functions whose calls are dropped.
    dropped: FxHashSet<Handle<Function>>,
    values: FxHashMap<Handle<naga::Override>, bool>,
}

impl Choices {
    /// The conditions of a function that are overrides, and their values.
    fn conditions(&self, function: &Function) -> FxHashMap<Handle<Expression>, bool> {
        let expressions = function.expressions.iter().filter_map(|(handle, expression)| {
            let Expression::Override(known) = expression else { return None };
            Some((handle, *self.values.get(known)?))
        });
        expressions.collect()
    }

    /// Removes calls to dropped functions without a result, and the sides of branches that are not
    /// taken, which are added to `removed`. Blocks nest only as deep as the files of `sdfc-march`
    /// write them.
    fn apply(
        &self,
        block: &mut Block,
        conditions: &FxHashMap<Handle<Expression>, bool>,
        removed: &mut Vec<Block>,
    ) {
        let mut rest = Block::new();
        for (mut statement, span) in std::mem::take(block).span_into_iter() {
            if let Statement::Call { function, result: None, .. } = &statement
                && self.dropped.contains(function)
            {
                continue;
            }
            for inner in inner_blocks(&mut statement) {
                self.apply(inner, conditions, removed);
            }
            if let Statement::If { condition, accept, reject } = &mut statement
                && let Some(&value) = conditions.get(condition)
            {
                let [accept, reject] = [accept, reject].map(std::mem::take);
                let (taken, other) = if value { (accept, reject) } else { (reject, accept) };
                append(&mut rest, taken);
                removed.push(other);
            } else if let Statement::Loop { body, .. } = &mut statement
                && runs_once(body)
            {
                // The continuing block is not reached if the loop is left first.
                body.cull(body.len() - 1..);
                append(&mut rest, std::mem::take(body));
            } else {
                rest.push(statement, span);
            }
        }
        *block = rest;
    }
}

/// Removes the names of values that were computed in blocks: named values are kept, and would have
/// to be computed.
fn unname(removed: &[Block], function: &mut Function) {
    let mut todo: Vec<&Statement> = removed.iter().flat_map(|block| block.iter()).collect();
    while let Some(statement) = todo.pop() {
        if let Statement::Emit(range) = statement {
            for value in range.clone() {
                function.named_expressions.swap_remove(&value);
            }
        } else if let Statement::Call { result: Some(value), .. } = statement {
            function.named_expressions.swap_remove(value);
        }
        todo.extend(nested(statement));
    }
}

fn append(block: &mut Block, other: Block) {
    for (statement, span) in other.span_into_iter() {
        block.push(statement, span);
    }
}

/// Returns true if a loop's body ends in `break` and is left nowhere else.
fn runs_once(body: &Block) -> bool {
    let leaves =
        |statement: &Statement| matches!(statement, Statement::Break | Statement::Continue);
    let Some((Statement::Break, before)) = body.split_last() else { return false };
    let mut todo: Vec<&Statement> = before.iter().collect();
    while let Some(statement) = todo.pop() {
        // `break` and `continue` of an inner loop belong to it; in a switch, they may mean either.
        if leaves(statement) || matches!(statement, Statement::Switch { .. }) {
            return false;
        }
        if !matches!(statement, Statement::Loop { .. }) {
            todo.extend(nested(statement));
        }
    }
    true
}

fn inner_blocks(statement: &mut Statement) -> Vec<&mut Block> {
    if let Statement::Block(block) = statement {
        vec![block]
    } else if let Statement::If { accept, reject, .. } = statement {
        vec![accept, reject]
    } else if let Statement::Switch { cases, .. } = statement {
        cases.iter_mut().map(|case| &mut case.body).collect()
    } else if let Statement::Loop { body, continuing, .. } = statement {
        vec![body, continuing]
    } else {
        Vec::new()
    }
}

/// The statements in the blocks of a statement.
fn nested(statement: &Statement) -> Vec<&Statement> {
    if let Statement::Block(block) = statement {
        block.iter().collect()
    } else if let Statement::If { accept, reject, .. } = statement {
        accept.iter().chain(reject.iter()).collect()
    } else if let Statement::Switch { cases, .. } = statement {
        cases.iter().flat_map(|case| case.body.iter()).collect()
    } else if let Statement::Loop { body, continuing, .. } = statement {
        body.iter().chain(continuing.iter()).collect()
    } else {
        Vec::new()
    }
}

/// `compact` keeps all local variables.
fn drop_unused_variables(function: &mut Function) {
    let mut variables = Arena::new();
    let mut moved = FxHashMap::default();
    for (_, expression) in function.expressions.iter_mut() {
        if let Expression::LocalVariable(old) = expression {
            let span = function.local_variables.get_span(*old);
            let variable = &function.local_variables[*old];
            let new = moved.entry(*old);
            *old = *new.or_insert_with(|| variables.append(variable.clone(), span));
        }
    }
    function.local_variables = variables;
}

/// `compact` keeps all named constants.
fn drop_unused_constants(module: &mut Module) {
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    let functions = module.functions.iter().map(|(_, function)| function).chain(entries);
    let mut arenas: Vec<_> = functions.map(|function| &function.expressions).collect();
    arenas.push(&module.global_expressions);
    let expressions = arenas.iter().flat_map(|arena| arena.iter());
    let used: FxHashSet<_> = expressions
        .filter_map(|(_, expression)| {
            let Expression::Constant(constant) = expression else { return None };
            Some(*constant)
        })
        .collect();
    for (handle, constant) in module.constants.iter_mut() {
        if !used.contains(&handle) {
            constant.name = None;
        }
    }
    compact(module, KeepUnused::No);
}
