//! From the text of `march` to a module whose stubs a scene can fill.

use naga::compact::{KeepUnused, compact};
use naga::{Block, Expression, Function, GlobalVariable, Handle, Module, Statement};
use rustc_hash::FxHashSet;

use crate::Error;

/// Parses joined files, drops the calls to functions of `unused` and all that only they reached.
pub(crate) fn skeleton(source: &str, unused: &[&str]) -> Result<Module, Error> {
    let mut module = naga::front::wgsl::parse_str(source)
        .map_err(|error| Error::Naga(error.emit_to_string(source)))?;
    let dropped: FxHashSet<_> =
        unused.iter().filter_map(|name| find_function(&module, name)).collect();
    for (_, function) in module.functions.iter_mut() {
        drop_calls(&mut function.body, &dropped);
    }
    for entry in &mut module.entry_points {
        drop_calls(&mut entry.function.body, &dropped);
    }
    // The files are valid beside each other, as `compact` requires; a test joins each of them.
    compact(&mut module, KeepUnused::No);
    drop_unused_constants(&mut module);
    Ok(module)
}

/// The function of that name.
pub(crate) fn find_function(module: &Module, name: &str) -> Option<Handle<Function>> {
    let mut functions = module.functions.iter();
    functions.find(|(_, f)| f.name.as_deref() == Some(name)).map(|(handle, _)| handle)
}

/// The variable of that name.
pub(crate) fn find_variable(module: &Module, name: &str) -> Option<Handle<GlobalVariable>> {
    let mut variables = module.global_variables.iter();
    variables.find(|(_, v)| v.name.as_deref() == Some(name)).map(|(handle, _)| handle)
}

/// Replaces a stub by a function of the same signature. A stub calls nothing and so does what
/// replaces it, so the arena keeps callees before callers.
pub(crate) fn fill(module: &mut Module, name: &str, filling: Function) -> Result<(), Error> {
    let handle = find_function(module, name)
        .ok_or_else(|| Error::Naga(format!("the ray method has no `{name}`")))?;
    let stub = module.functions.get_mut(handle);
    let (arguments, result) = (std::mem::take(&mut stub.arguments), stub.result.take());
    *stub = Function { name: stub.name.take(), arguments, result, ..filling };
    Ok(())
}

/// Removes the calls to functions without a result. Blocks nest as deep as the files of `march`
/// write them.
fn drop_calls(block: &mut Block, dropped: &FxHashSet<Handle<Function>>) {
    let kept = std::mem::take(block).span_into_iter().filter(|(statement, _)| {
        !matches!(statement, Statement::Call { function, result: None, .. } if dropped.contains(function))
    });
    let mut rest = Block::new();
    for (mut statement, span) in kept {
        for inner in inner_blocks(&mut statement) {
            drop_calls(inner, dropped);
        }
        rest.push(statement, span);
    }
    *block = rest;
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
