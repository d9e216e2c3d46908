//! A typed program as short text, for snapshots.

use sdfc_lang::hir::*;

/// A program without the declarations of the library.
pub fn print(program: &Program) -> String {
    let own = |file| !program.library.contains(&file);
    let mut lines = Vec::new();
    for param in &program.params {
        let range = param.range.as_ref().map(|range| format!(" in {}", expr(program, range)));
        let default = expr(program, &param.default);
        lines.push(format!(
            "param {}: {:?} = {default}{}",
            param.name,
            param.ty,
            range.unwrap_or_default()
        ));
    }
    for (at, global) in program.globals.iter().enumerate() {
        let value = expr(program, &global.value);
        lines.push(format!("let @{at} {} /{} = {value}", global.name, global.locals));
    }
    for function in program.functions.iter().filter(|function| own(function.file)) {
        let body = expr(program, &function.body);
        let head = parameters(program, &function.parameters);
        lines.push(format!("fn {}({head}) /{} = {body}", function.name, function.locals));
    }
    for shape in program.shapes.iter().filter(|shape| own(shape.file)) {
        let head = parameters(program, &shape.parameters);
        let body = expr(program, &shape.body);
        let bounds = shape.bounds.as_ref().map(|e| format!(" bounds {}", expr(program, e)));
        lines.push(format!(
            "{:?} {}({head}) /{}{} = {body}",
            shape.dim,
            shape.name,
            shape.locals,
            bounds.unwrap_or_default()
        ));
    }
    lines.extend(program.drawn.iter().map(|e| format!("draw {}", expr(program, e))));
    for setting in &program.settings {
        let args: Vec<String> = setting.args.iter().map(|e| optional(program, e)).collect();
        lines.push(format!("set {:?}({})", setting.kind, args.join(", ")));
    }
    lines.join("\n")
}

fn parameters(program: &Program, parameters: &[Parameter]) -> String {
    let one = |parameter: &Parameter| match &parameter.default {
        Some(default) => format!("{} = {}", parameter.name, expr(program, default)),
        None => parameter.name.clone(),
    };
    parameters.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn optional(program: &Program, e: &Option<Expr>) -> String {
    e.as_ref().map_or("_".into(), |e| expr(program, e))
}

fn all(program: &Program, list: &[Expr]) -> String {
    list.iter().map(|e| expr(program, e)).collect::<Vec<_>>().join(", ")
}

fn element(program: &Program, of: &Element) -> String {
    match of {
        Element::One(e) => expr(program, e),
        Element::Spread(e) => format!("...{}", expr(program, e)),
        Element::For(each) => format!(
            "for ${} in {}: {}",
            each.local.0,
            expr(program, &each.over),
            element(program, &each.body)
        ),
    }
}

fn expr(program: &Program, e: &Expr) -> String {
    let show = |e: &Expr| expr(program, e);
    match &e.kind {
        ExprKind::Number(value) => format!("{value}"),
        ExprKind::Color(value) => format!("{value:.3?}"),
        ExprKind::Text(text) => format!("{text:?}"),
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Local(local) => format!("${}", local.0),
        ExprKind::Param(id) => program.params[id.0 as usize].name.clone(),
        ExprKind::Global(id) => format!("@{}", id.0),
        ExprKind::Time => "time".into(),
        ExprKind::SurfaceVector(vector) => vector.name().into(),
        ExprKind::Frame => "frame".into(),
        ExprKind::List(list) => {
            let list: Vec<String> = list.iter().map(|e| element(program, e)).collect();
            format!("list[{}]", list.join(", "))
        }
        ExprKind::Record(fields) => format!("({})", all(program, fields)),
        ExprKind::Field(base, at) => format!("{}.{at}", show(base)),
        ExprKind::MaterialField(base, field) => format!("{}.{field:?}", show(base)),
        ExprKind::Range(lo, hi) => format!("{}..{}", show(lo), show(hi)),
        ExprKind::Vector(parts) => format!("[{}]", all(program, parts)),
        ExprKind::Swizzle(base, picked) => format!("{}.{picked:?}", show(base)),
        ExprKind::RangeEnd(base, low) => {
            format!("{}.{}", show(base), if *low { "lo" } else { "hi" })
        }
        ExprKind::Index(base, index) | ExprKind::Slice(base, index) => {
            format!("{}[{}]", show(base), show(index))
        }
        ExprKind::Block(lets, result) => {
            let lets: Vec<String> = lets
                .iter()
                .map(|(at, name, e)| format!("${} {name} = {}", at.0, show(e)))
                .collect();
            format!("{{ {}; {} }}", lets.join("; "), show(result))
        }
        ExprKind::If(c, a, b) => format!("if {} {{ {} }} else {{ {} }}", show(c), show(a), show(b)),
        ExprKind::Lambda(lambda) => {
            let captures: Vec<String> =
                lambda.captures.iter().map(|at| format!("${}", at.0)).collect();
            format!(
                "fn<{}>({}) /{} = {}",
                captures.join(", "),
                lambda.names.join(", "),
                lambda.locals,
                show(&lambda.body)
            )
        }
        ExprKind::FnValue(id) => format!("&{}", program.functions[id.0 as usize].name),
        ExprKind::Call(id, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(|e| optional(program, e)).collect();
            format!("{}({})", program.functions[id.0 as usize].name, arguments.join(", "))
        }
        ExprKind::Build(id, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(|e| optional(program, e)).collect();
            let shape = &program.shapes[id.0 as usize];
            format!("{}:{:?}({})", shape.name, shape.dim, arguments.join(", "))
        }
        ExprKind::Sample(shape, at) => format!("sample({}, {})", show(shape), show(at)),
        ExprKind::Apply(function, arguments) => {
            format!("apply({}, {})", show(function), all(program, arguments))
        }
        ExprKind::Kernel(kernel, arguments) => format!("{kernel:?}({})", all(program, arguments)),
        ExprKind::With(base, changes) => {
            let changes: Vec<String> =
                changes.iter().map(|(field, e)| format!("{field:?}: {}", show(e))).collect();
            format!("with({}, {})", show(base), changes.join(", "))
        }
        ExprKind::Splat(value) => format!("splat({})", show(value)),
        ExprKind::Constant(value) => format!("const({})", show(value)),
        ExprKind::Error => "error".into(),
    }
}
