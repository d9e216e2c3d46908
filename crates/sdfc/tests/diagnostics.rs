//! Diagnostics of the analyses and of sampling, with their positions in the scene.

#![allow(clippy::panic, reason = "a test stops where it fails")]

use sdfc::Compiler;
use sdfc_lang::library;

/// Returns the codes, lines and messages of the diagnostics.
fn diagnostics(text: &str) -> Vec<(&'static str, u32, String)> {
    let found = Compiler::new().verify(true).check("scene.sdf", text).located().into_iter();
    found.map(|f| (f.code, f.start.line, f.message)).collect()
}

fn codes(text: &str) -> Vec<(&'static str, u32)> {
    diagnostics(text).into_iter().map(|(code, line, _)| (code, line)).collect()
}

#[test]
fn a_clause_that_sampling_refutes_is_an_error_at_the_clause() {
    let cases = [
        // Too short outside, too long inside.
        ("solid it()\n  exact\n  = length(p * [1, 0.7, 1]) - 1", 2),
        ("solid it()\n  exact inside\n  lipschitz 1\n  = max(abs(p.x), abs(p.y), abs(p.z)) - 1", 0),
        (
            "solid it()\n  exact outside\n  lipschitz 1\n  = max(abs(p.x), abs(p.y), abs(p.z)) - 1",
            2,
        ),
        ("solid it()\n  bound\n  = 1.02 * (length(p) - 1)", 2),
        ("solid it()\n  bound inside\n  = if length(p) < 1 { length(p) - 1 } else { 3 }", 0),
        ("solid it()\n  bounds -1..1\n  lipschitz 1.9\n  = 2 * (length(p) - 1)", 3),
        ("solid it()\n  exact\n  bounds -0.95..0.95\n  = length(p) - 1", 3),
        // The constant that is often given for a twist. Here the field also slopes along and around
        // the axis.
        (
            "solid it()\n  lipschitz sqrt(2)\n  bounds -1..1\n  = {\n    let q = spin(p.xz, p.y * 1rad)\n\
             capsule([-0.9, 0, 0], [0.9, 0, 0], r: 0.1)([q.x, p.y, q.y])\n}",
            2,
        ),
        // True at the default, false at one end of the range.
        ("param k = 1 in 0.5..2\nsolid it()\n  exact\n  = k * (length(p) - 1)", 3),
        // Only exact children keep this promise.
        ("solid it(a: solid = box(1))\n  exact outside\n  = a(p / 2)", 2),
        // The clause is false, but its condition does not hold.
        ("solid it(k: number = 1)\n  exact if k == 2\n  lipschitz 1\n  = 0.5 * (length(p) - k)", 0),
    ];
    for (text, line) in cases {
        let mut found = codes(&format!("{text}\nit()"));
        found.retain(|(code, _)| *code != "W0602");
        let expected: &[_] = if line == 0 { &[] } else { &[("E0502", line)] };
        assert_eq!(found, expected, "{text}");
        assert!(!Compiler::new().check("scene.sdf", text).has_errors());
    }
}

#[test]
fn no_clause_of_the_library_is_refuted() {
    for entry in library::entries() {
        let compiled = Compiler::new().compile(&entry.name, &entry.example);
        let scene = compiled.unwrap_or_else(|errors| panic!("{errors}"));
        let shapes: Vec<_> = scene.graph().graph.shape_ids().collect();
        let refuted = sdfc_analyze::refute(scene.graph(), &shapes, u64::MAX);
        assert!(refuted.is_empty(), "{}: {refuted:?}", entry.name);
    }
}

#[test]
fn a_field_without_a_constant_is_a_warning_with_its_reason() {
    let found = diagnostics("solid odd() = p.x * p.y - 0.1\nsphere(1)\nodd() | box(1)");
    let reason =
        "`odd` is uncertified: the slope of `*` depends on the point, and no limit of it is known";
    assert_eq!(found, [("W0602", 3, reason.to_owned())]);
    // A problem of a shape that an entry of the library builds is reported at the scene's call.
    assert_eq!(codes("sphere(1)\nbox(1)\n  - plane().twist(20deg)"), [("W0602", 3)]);
    assert_eq!(codes("param k = 20deg in 0deg..90deg\nplane().twist(k)"), [("W0602", 2)]);
    assert_eq!(codes("box([0.6, 2, 0.6]).twist(20deg)\nsphere(1)"), []);
}

#[test]
fn clauses_are_tested_at_several_times() {
    let ball = "solid ball() bounds -2..2 lipschitz 1 = length(p - [0, 2 * sin(time), 0]) - 1";
    assert_eq!(codes(&format!("{ball}\nball()")), [("E0502", 1)]);
    assert_eq!(codes(&format!("{}\nball()", ball.replace("-2..2", "-3..3"))), []);
    assert_eq!(codes("solid wave() lipschitz 1 = p.y - sin(p.x) * time\nwave()"), [("E0502", 1)]);
}

#[test]
fn stated_bounds_limit_copies_whose_size_depends_on_the_cell() {
    for shape in ["hex_prism(r: 0.45, h: 0.4 + hash(c))", "cone(r: 0.4, h: 0.4 + hash(c))"] {
        assert_eq!(codes(&format!("repeat(fn(c) = {shape}, spacing: [1, 0, 1])")), [], "{shape}");
    }
}

#[test]
fn a_bound_needs_no_constant() {
    let text = "solid s() = (length(p) - 1) / (1 + length(p))\ns()";
    assert_eq!(codes(text), [("W0602", 2)]);
    assert_eq!(codes(&text.replace("s() =", "s() bound =")), []);
}

/// Returns the helps of the warnings W0602.
fn helps(text: &str) -> Vec<String> {
    let found = Compiler::new().check("scene.sdf", text);
    let about = found.iter().filter(|diagnostic| diagnostic.code.0 == "W0602");
    about.flat_map(|diagnostic| diagnostic.help.clone()).collect()
}

/// Returns a scene with the clauses of its only help: its first code, before the first `=`.
fn with_help(text: &str) -> String {
    let helps = helps(text);
    let [help] = &helps[..] else { panic!("{helps:?}\n{text}") };
    let clauses = help.split("write `").nth(1).and_then(|rest| rest.split('`').next());
    let Some(clauses) = clauses else { panic!("no clauses in {help}\n{text}") };
    text.replacen('=', &format!("{clauses}\n  ="), 1)
}

#[test]
fn samples_do_not_refute_the_suggested_clauses() {
    let texts = [
        // Without an end.
        "solid pond() = p.y - 0.03 * sin(30 * length(p.xz)) * exp(-6 * abs(length(p.xz) - 1))\n\
         pond()",
        "solid planet() = length(p) - 1 - 0.15 * fbm(normalize(p) * 3)\nplanet()",
        // A gear of radius 22, of involute teeth.
        "region gear() = {\n  let base = 20 * cos(20deg)\n  let r = length(p)\n  \
         let t = abs((atan2(p.y, p.x) + 9deg) % 18deg - 9deg)\n  \
         let a = acos(base / max(r, base))\n  \
         let half = 4.5deg + (tan(20deg) - 20deg) - (tan(a) - a)\n  \
         min(max(r * (t - half), r - 22), r - 17.5)\n}\ngear().extrude(8)",
    ];
    for text in texts {
        let fixed = with_help(text);
        assert!(codes(&fixed).iter().all(|(code, _)| *code != "E0502"), "{fixed}");
    }
    // The default of the param is not the steepest.
    let ramp = "param a: number = 1 in 0..1\nsolid ramp() bounds -2..2\n  = max(p.y - 0.3 * \
                smoothstep(a, 0.5, p.x), length(p) - 1.5)\nramp()";
    let help = helps(ramp).concat();
    let constant = help.split("lipschitz ").nth(1).and_then(|rest| rest.split('`').next());
    let constant: f64 = constant.and_then(|text| text.parse().ok()).expect("a constant");
    assert!(constant > 5.0, "{help}");
    // The field jumps.
    let steps = "solid steps() bounds -1..1\n  = max(0.2 * p.x * p.y + p.z - 0.3 * floor(2 * p.x), \
                 length(p) - 0.9)\nsteps()";
    assert!(helps(steps).concat().contains("grows without limit"), "{:?}", helps(steps));
    // The slope grows without limit near the axis.
    let knot = "solid knot() = {\n  let q = vec2(length(p.xz) - 1, p.y)\n  \
                let r = spin(q, 1.5 * atan2(p.z, p.x))\n  \
                length(vec2(abs(r.x) - 0.3, r.y)) - 0.15\n}\nknot()";
    let found = helps(knot);
    assert!(matches!(&found[..], [help] if help.contains("grows without limit")), "{found:?}");
}

#[test]
fn writing_the_help_of_an_uncertified_shape_certifies_it() {
    let own = [
        "solid s() = p.y - p.x * p.x * p.z\ns() & box(2)",
        "solid s()\n  bounds -1..1\n  = {\n    let d = dot(p, [1, 2, 3])\n    \
         max(d * d * d - 0.1, length(p) - 0.9)\n  }\ns()",
        "solid s() = {\n  let d = dot(p, [1, 2, 3])\n  d * d * d - 0.1\n}\ns() & box(2)",
        "solid s() = exp(p.x) - 2 * p.y\ns() & box(2)",
        "solid s()\n  bounds -1 .. 1\n  = max(p.x * p.y - 0.1, length(p) - 0.8)\n\
         union(s(), sphere(0.7), blend: smooth(0.2))",
        "solid s() = if p.x > 0.3 { length(p) - 1 } else { length(p) - 1.5 }\ns()",
    ];
    for text in own {
        let fixed = with_help(text);
        let left: Vec<_> = codes(&fixed).into_iter().filter(|(code, _)| *code != "E0502").collect();
        assert_eq!(left, [], "{fixed}");
    }
    // Such bounds are enough for a sum with a box.
    assert_eq!(codes("solid s() bounds -1..1 = box(1)(p) - 0.05 * p.x * p.y\ns()"), []);
    // What a call of the library needs, written into the call.
    let calls = [
        ("plane().twist(20deg)", "(plane() & box(4)).twist(20deg)", "`(a & box(4)).twist(...)`"),
        (
            "plane().twist(20deg).translate(x: 1).scale([1, 2, 1])",
            "(plane() & box(4)).twist(20deg).translate(x: 1).scale([1, 2, 1])",
            "`twist`: limit the shape first, for example `(a & box(4)).twist(...)`",
        ),
        (
            "heightfield(fn(q) = 0.1 * q.x * q.y) & box(2)",
            "heightfield(fn(q) lipschitz 1 = 0.1 * q.x * q.y) & box(2)",
            "`fn(q) lipschitz 1 = ...`",
        ),
        (
            "sphere(1).displace(fn(q) = 0.1 * q.x * q.y)",
            "sphere(1).displace(fn(q) lipschitz 1 = 0.1 * q.x * q.y)",
            "`fn(q) lipschitz 1 = ...`",
        ),
        (
            "sphere(1).displace(fn(q) = 0.1 * fract(q.x))",
            "sphere(1).displace(fn(q) = 0.1 * sin(q.x))",
            "such as `sin`, in place of `fract`",
        ),
        (
            "sphere(1).displace(fn(q) = 0.1 * hash(1, q))",
            "sphere(1).displace(fn(q) = 0.1 * gradient_noise(q))",
            "such as `gradient_noise`, in place of `hash`",
        ),
    ];
    for (text, fixed, advice) in calls {
        let helps = helps(text);
        assert!(helps.iter().any(|help| help.contains(advice)), "{helps:?}\n{text}");
        assert!(!codes(fixed).iter().any(|(code, _)| *code == "W0602"), "{fixed}");
    }
}

#[test]
fn an_operator_that_needs_a_distance_warns_about_a_bound() {
    let blend = "let a = union(sphere(1), box(1), blend: smooth(0.2))";
    let found = diagnostics(&format!("{blend}\na\n  .round(0.1)"));
    let message = "`round` is applied to a field that is only a bound: the distance between the \
                   surfaces will vary";
    assert_eq!(found, [("W0601", 2, message.to_owned())]);
    // A hard union is exact outside, an intersection inside.
    assert_eq!(codes("union(sphere(1), box(1)).round(0.1)"), []);
    assert_eq!(codes("(sphere(1) & box(1)).round(0.1)"), [("W0601", 1)]);
    assert_eq!(codes("solid eroded(a: solid) = a(p) + 0.1\neroded(sphere(1) & box(1.5))"), []);
    // Rounding an exact distance gives an exact distance outside.
    assert_eq!(codes("box(1).round(0.1).round(0.1).round(0.1)"), []);
    assert_eq!(codes("param r = 0.1 in 0..0.2\nbox(1).round(r).round(r).round(r)"), []);
    assert_eq!(
        codes("solid grown(a: solid) = a(p) + 0.1\ngrown(box(1).round(0.2))"),
        [("W0601", 2)]
    );
    let skin = "solid skin(a: solid) = abs(a(p)) - 0.1\n";
    assert_eq!(codes(&format!("{skin}skin(box(1))")), []);
    assert_eq!(codes(&format!("{skin}skin(sphere(1) | box(1))")), [("W0601", 2)]);
}

#[test]
fn copies_without_effect_are_reported() {
    let row = |head: &str, formula: &str| {
        format!(
            "solid row(a: solid)\n  copies\n  = {{\n    let t = p.x - round(p.x)\n    {formula}\n  }}\n{head}row(sphere(0.3))"
        )
    };
    let reported = |text: &str| {
        let found = codes(text).into_iter().filter(|(code, _)| *code != "W0602");
        found.collect::<Vec<_>>()
    };
    assert_eq!(reported(&row("", "min(a([t, p.y, p.z]), 0.7 - abs(t))")), []);
    let idle = [
        "a([t, p.y, p.z])",
        "min(a([t, 0.5 * p.y, p.z]), 0.7 - abs(t))",
        "min(a([t, p.y, p.z]) - 0.1, 0.6 - abs(t))",
        "min(length([t, p.y, p.z]) - 0.2, 0.7 - abs(t))",
    ];
    for formula in idle {
        let found = reported(&row("", formula));
        assert!(found.contains(&("W0606", 2)), "{formula}: {found:?}");
    }
    let flat = "region row(a: region)\n  copies\n  = min(a(p), 9)\nrow(circle(1)).extrude(1)";
    assert_eq!(codes(flat), [("E0210", 2)]);
}
