//! The trees of source texts: precedence, lines, brackets, documentation.

#![allow(clippy::panic, reason = "these are tests")]

use sdfc_diagnostics::{Diagnostic, Sources, Span, render};
use sdfc_syntax::ast::{
    Arg, ClauseKind, Decl, Element, Expr, ExprKind, File, Item, Side, TypeExpr, TypeExprKind, Unit,
};
use sdfc_syntax::parse;

fn tree(text: &str) -> File {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    let (tree, found): (File, Vec<Diagnostic>) = parse(&sources, file);
    assert!(found.is_empty(), "{}", render(&sources, &found, false));
    tree
}

/// Returns the items that are expressions, fully bracketed, one per line.
fn shown(text: &str) -> String {
    let show_item = |item: &Item| match item {
        Item::Expr(expr) => show(text, expr),
        Item::Let(binding) => format!("{} = {}", binding.name.text, show(text, &binding.value)),
        Item::Import(_) | Item::Param(_) | Item::Decl(_) => format!("{item:?}"),
    };
    tree(text).items.iter().map(show_item).collect::<Vec<_>>().join("\n")
}

fn slice(text: &str, span: Span) -> &str {
    &text[span.start as usize..span.end as usize]
}

fn show(text: &str, expr: &Expr) -> String {
    let show = |expr: &Expr| show(text, expr);
    match &expr.kind {
        ExprKind::Number { .. } | ExprKind::Color(_) | ExprKind::Text(_) | ExprKind::Bool(_) => {
            slice(text, expr.span).to_owned()
        }
        ExprKind::Name(name) => name.clone(),
        ExprKind::Paren(inner) => format!("P{}", show(inner)),
        ExprKind::Block(lets, result) => {
            let lets = lets.iter().map(|l| format!("{} = {}; ", l.name.text, show(&l.value)));
            format!("{{{}{}}}", lets.collect::<String>(), show(result))
        }
        ExprKind::If(condition, then, other) => {
            format!("(if {} {} {})", show(condition), show(then), show(other))
        }
        ExprKind::Lambda(signature, body) => {
            let names = signature.parms.iter().map(|parm| parm.name.text.as_str());
            format!("(fn {} = {})", names.collect::<Vec<_>>().join(" "), show(body))
        }
        ExprKind::List(elements) => {
            let shown: Vec<_> = elements.iter().map(|e| show_element(text, e)).collect();
            format!("[{}]", shown.join(", "))
        }
        ExprKind::Record(fields) => {
            let shown = fields.iter().map(|it| format!("{}: {}", it.name.text, show(&it.value)));
            format!("({})", shown.collect::<Vec<_>>().join(", "))
        }
        ExprKind::Call(callee, args) => {
            let shown: Vec<_> = args.iter().map(|arg| show_arg(text, arg)).collect();
            format!("{}({})", show(callee), shown.join(", "))
        }
        ExprKind::Field(base, name) => format!("{}.{}", show(base), name.text),
        ExprKind::Index(base, index) => format!("{}[{}]", show(base), show(index)),
        ExprKind::Unary(op, operand) => format!("({op:?} {})", show(operand)),
        ExprKind::Binary(_, place, a, b) => {
            format!("({} {} {})", show(a), slice(text, *place), show(b))
        }
        ExprKind::Error => "?".to_owned(),
    }
}

fn show_arg(text: &str, arg: &Arg) -> String {
    let name = arg.name.as_ref().map_or(String::new(), |name| format!("{}: ", name.text));
    name + &show_element(text, &arg.value)
}

fn show_element(text: &str, element: &Element) -> String {
    match element {
        Element::Expr(expr) => show(text, expr),
        Element::For(part) => {
            let condition = part.condition.as_ref().map(|c| format!(" if {}", show(text, c)));
            format!(
                "for {} in {}{}: {}",
                part.name.text,
                show(text, &part.over),
                condition.unwrap_or_default(),
                show_element(text, &part.body)
            )
        }
    }
}

fn decl(text: &str) -> Decl {
    match tree(text).items.pop() {
        Some(Item::Decl(decl)) => *decl,
        other => panic!("{other:?}"),
    }
}

#[test]
fn operators_have_the_documented_precedence() {
    let cases = [
        ("a | b - c & d", "(((a | b) - c) & d)"),
        ("a + b * c - d", "((a + (b * c)) - d)"),
        ("a * b / c % d", "(((a * b) / c) % d)"),
        ("-a * b", "((Neg a) * b)"),
        ("-a.f(b)[c]", "(Neg a.f(b)[c])"),
        ("!-a", "(Not (Neg a))"),
        ("a - -b", "(a - (Neg b))"),
        ("a + 1..b * 2", "((a + 1) .. (b * 2))"),
        ("-r..r", "((Neg r) .. r)"),
        ("a..b == c..d", "((a .. b) == (c .. d))"),
        ("a < b + 1 && c || d && !e", "(((a < (b + 1)) && c) || (d && (Not e)))"),
        ("a || b || c", "((a || b) || c)"),
        ("(a | b).f", "P(a | b).f"),
        ("a == b && c != d", "((a == b) && (c != d))"),
    ];
    for (text, expected) in cases {
        assert_eq!(shown(text), expected, "{text}");
    }
}

#[test]
fn lines_end_items_unless_an_operator_or_a_point_begins_the_next() {
    let cases = [
        ("a\nb", "a\nb"),
        ("a\n| b\n  - c", "((a | b) - c)"),
        ("a |\nb", "(a | b)"),
        ("a\n  .f(1)\n  .g", "a.f(1).g"),
        ("a\n(b)", "a\nPb"),
        ("a\n[b]", "a\n[b]"),
        ("a // c\n  - b", "(a - b)"),
        ("a; b", "a\nb"),
        ("let a =\n  b\nc", "a = b\nc"),
        ("let a = { let b = 1; b }; a", "a = {b = 1; b}\na"),
        ("{\n  let b = 1\n  let b = b\n  - 2\n  b\n}", "{b = 1; b = (b - 2); b}"),
        ("f(\na,\nb\n)", "f(a, b)"),
    ];
    for (text, expected) in cases {
        assert_eq!(shown(text), expected, "{text}");
    }
}

#[test]
fn arguments_elements_and_branches_are_parsed() {
    let cases = [
        ("f(a, b: 1, c: [2],)", "f(a, b: 1, c: [2])"),
        (
            "f(for i in 0..3: for j in a if i < j: [i, j])",
            "f(for i in (0 .. 3): for j in a if (i < j): [i, j])",
        ),
        ("[for i in l: i, 2]", "[for i in l: i, 2]"),
        ("a(c)(q)[0]", "a(c)(q)[0]"),
        ("2.max(3)", "2.max(3)"),
        ("if a { b } else if c { d } else { e }.f", "(if a {b} (if c {d} {e})).f"),
        ("f(fn(a, b) lipschitz 1 = a + b, c)", "f((fn a b = (a + b)), c)"),
        ("fn(a) = fn(b) = a", "(fn a = (fn b = a))"),
        ("[]", "[]"),
        ("l[1..len(l)]", "l[(1 .. len(l))]"),
    ];
    for (text, expected) in cases {
        assert_eq!(shown(text), expected, "{text}");
    }
}

#[test]
fn numbers_keep_their_unit_and_form() {
    let number = |text: &str| match tree(text).items.pop() {
        Some(Item::Expr(Expr { kind: ExprKind::Number { value, unit, whole }, .. })) => {
            (value, unit, whole)
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(number("3"), (3.0, None, true));
    assert_eq!(number("3.0"), (3.0, None, false));
    assert_eq!(number("90deg"), (90.0, Some(Unit::Deg), false));
}

#[test]
fn all_parts_of_a_signature_are_parsed() {
    let decl = decl(
        "solid s(parts: shape..., f: fn(vec3, [number]) -> length, r: length = 1 in 0..inf)\n  \
         exact outside if r > 0\n  bound\n  lipschitz 2\n  bounds -r..r\n  \
         require r > 0, \"a \\\"b\\\"\"\n  material m\n  = r",
    );
    let [parts, f, r] = &decl.signature.parms[..] else { panic!() };
    assert!(parts.variadic && !f.variadic && r.default.is_some() && r.range.is_some());
    let Some(TypeExpr { kind: TypeExprKind::Fn(from, to), .. }) = &f.ty else { panic!() };
    assert!(matches!(from[1].kind, TypeExprKind::List(_)));
    assert_eq!(to.kind, TypeExprKind::Named("length".to_owned()));
    let clauses: Vec<_> = decl.signature.clauses.iter().map(|clause| &clause.kind).collect();
    let [exact, bound, _, _, require, _] = clauses[..] else { panic!("{clauses:?}") };
    assert!(matches!(exact, ClauseKind::Exact(Some(Side::Outside), Some(_))));
    assert!(matches!(bound, ClauseKind::Bound(None, None)));
    assert!(matches!(require, ClauseKind::Require(_, text) if text.text == "a \"b\""));
}

#[test]
fn types_may_begin_lines() {
    let decl = decl("fn f(\n  a: fn(\n    solid,\n    region\n  ) -> number,\n) = a");
    let Some(TypeExpr { kind: TypeExprKind::Fn(from, _), .. }) = &decl.signature.parms[0].ty else {
        panic!()
    };
    assert_eq!(from.len(), 2);
}

#[test]
fn clause_words_are_names_elsewhere() {
    let text = "let exact = bounds(material).lo\nlet from = as + require";
    assert_eq!(shown(text), "exact = bounds(material).lo\nfrom = (as + require)");
}

#[test]
fn documentation_is_the_comment_right_above() {
    let lines = |text: &str| decl(text).docs.lines;
    assert_eq!(lines("/// a\n///  b\n// c\n///\nfn f() = 1"), ["a", " b", ""]);
    assert_eq!(lines("/// title\n\n/// a\nfn f() = 1"), ["a"]);
    assert_eq!(lines("let x = 1 /// x\nfn f() = 1"), [""; 0]);
    assert_eq!(lines("//// ruler\nfn f() = 1"), [""; 0]);
    assert_eq!(lines("\u{feff}/// a\r\nfn f() = 1"), ["a"]);
    let params = tree("/// a\nparam k = 1 in 0..2\n");
    assert!(matches!(&params.items[..], [Item::Param(p)] if p.docs.lines == ["a"]));
}

#[test]
fn spans_cover_the_source() {
    let text = "let a = -(b + c).f(1) | d\n";
    let items = tree(text).items;
    let [Item::Let(binding)] = &items[..] else { panic!() };
    assert_eq!(slice(text, binding.span), "let a = -(b + c).f(1) | d");
    let ExprKind::Binary(_, _, left, right) = &binding.value.kind else { panic!() };
    assert_eq!(slice(text, left.span), "-(b + c).f(1)");
    assert_eq!(slice(text, right.span), "d");
    let ExprKind::Unary(_, call) = &left.kind else { panic!() };
    assert_eq!(slice(text, call.span), "(b + c).f(1)");
}
