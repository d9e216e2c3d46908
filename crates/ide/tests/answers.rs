//! Answers about small scenes. `$0` marks the cursor.
#![allow(missing_docs, clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use sdfc_ide::{
    Analysis, Edit, Resolver, ShapeFacts, actions, colors, complete, definition, diagnostics,
    folds, hints, hover, lenses, references, rename, selection, signature_help, symbols, tokens,
};

/// Files in memory.
#[derive(Default)]
struct Files(BTreeMap<&'static str, &'static str>);

impl Resolver for Files {
    fn read(&self, path: &str) -> Result<String, String> {
        self.0.get(path).map(|text| (*text).to_owned()).ok_or_else(|| "no such file".into())
    }
}

fn cursor(scene: &str) -> (String, usize) {
    let offset = scene.find("$0").expect("the scene has a cursor");
    (scene.replacen("$0", "", 1), offset)
}

fn scene(text: &str) -> Analysis {
    Analysis::new("scene.sdf", text, &Files::default())
}

fn at(text: &str) -> (Analysis, usize) {
    let (text, offset) = cursor(text);
    (scene(&text), offset)
}

fn labels(text: &str) -> Vec<String> {
    let (text, offset) = cursor(text);
    let files = ["parts/gear.sdf".to_owned()];
    let resolver = Files(BTreeMap::from([("gear.sdf", GEAR)]));
    let mut found = complete("scene.sdf", &text, offset, &resolver, &files);
    found.sort_by_key(|it| it.rank);
    found.into_iter().map(|it| it.label).collect()
}

fn shown(text: &str) -> String {
    let (scene, offset) = at(text);
    hover(&scene, offset, &mut |_| None).map(|it| it.markdown).unwrap_or_default()
}

fn applied(text: &str, edits: &[Edit]) -> String {
    let mut text = text.to_owned();
    for edit in edits.iter().rev() {
        text.replace_range(edit.at.range(), &edit.text);
    }
    text
}

const GEAR: &str = "/// A gear.\nsolid gear(r: length = 1) = length(p) - r\nlet _own = 1\n";

#[test]
fn a_dot_is_completed_by_the_type_of_the_receiver() {
    let of_solid = labels("let ball = sphere(1)\nball.$0\n");
    assert!(of_solid.contains(&"translate".into()) && of_solid.contains(&"twist".into()));
    assert!(!of_solid.contains(&"extrude".into()) && !of_solid.contains(&"sin".into()));
    let of_region = labels("circle(1).ex$0");
    assert!(of_region.contains(&"extrude".into()) && !of_region.contains(&"twist".into()));
    let of_vector = labels("solid a() = p.$0");
    assert_eq!(of_vector[..3], ["x", "y", "z"]);
    assert!(of_vector.contains(&"length".into()) && !of_vector.contains(&"translate".into()));
    assert_eq!(labels("let r = 0..1\nlet a = r.$0")[..2], ["lo", "hi"]);
    let record = "let a = (size: 1, at: [1, 2])\n";
    let of_record = labels(&format!("{record}let b = a.$0"));
    assert_eq!(of_record[..2], ["size", "at"]);
    assert!(of_record.contains(&"with".into()) && !of_record.contains(&"sin".into()));
    assert_eq!(labels(&format!("{record}let b = a.at.$0"))[..2], ["x", "y"]);
    assert_eq!(labels("let a = material()\nlet b = a.$0")[..2], ["color", "roughness"]);
    let own = labels("fn halved(a: solid) = a.scale(0.5)\nsphere(1).ha$0");
    assert!(own.contains(&"halved".into()));
    // A colour is a pattern too.
    let of_color = labels("fn dots(a: pattern) = a\nfn steep(a: blend) = a\n#fff.$0");
    assert!(of_color.contains(&"dots".into()) && !of_color.contains(&"steep".into()));
}

#[test]
fn names_in_scope_are_completed() {
    let inside =
        labels("fn f(count: int) = {\n  let inner = 2\n  in$0 + count\n}\nlet later = 1\n");
    for name in ["inner", "count", "f", "sphere", "sin"] {
        assert!(inside.contains(&name.into()), "{name}");
    }
    assert!(!inside.contains(&"later".into()) && !inside.contains(&"camera".into()));
    let top = labels("let a = 1\n$0");
    for name in ["a", "camera", "solid", "param", "sphere"] {
        assert!(top.contains(&name.into()), "{name}");
    }
    assert!(labels("solid a() = $0").contains(&"p".into()));
    // Words of the syntax are no values.
    let value = labels("let a = $0");
    for word in ["exact", "copies", "import", "solid"] {
        assert!(!value.contains(&word.into()), "{word}");
    }
    assert!(labels("let a = sphere(1).displace(fn(q) = q$0)").contains(&"q".into()));
}

#[test]
fn arguments_types_clauses_and_strings_are_completed() {
    let of_box = labels("cylinder($0)");
    assert!(of_box.contains(&"h:".into()), "{of_box:?}");
    let rest = labels("cylinder(h: 1, $0)");
    assert!(rest.contains(&"r:".into()) && !rest.contains(&"h:".into()));
    assert!(labels("camera(eye: [1, 2, 3], $0)").contains(&"fov:".into()));
    let types = labels("solid a(r: $0) = length(p) - r");
    assert!(types.contains(&"vec3".into()) && !types.contains(&"sphere".into()));
    let clauses = labels("solid a(r: length)\n  ex$0\n");
    assert!(clauses.contains(&"exact".into()) && !clauses.contains(&"sphere".into()));
    assert_eq!(labels("march(method: \"$0\")"), ["auto", "fixed", "sphere", "segment", "interval"]);
    assert_eq!(labels("import gear from \"$0\""), ["parts/gear.sdf"]);
    assert_eq!(labels("import $0 from \"gear.sdf\""), ["gear"]);
    assert_eq!(
        labels("param s = \"a\" in [\"a\", \"b\"]\nlet x = if s == \"$0\" { 1 } else { 2 }"),
        ["a", "b"]
    );
    assert_eq!(labels("// sph$0"), [""; 0]);
    assert_eq!(labels("let na$0"), [""; 0]);
}

#[test]
fn the_expected_type_comes_first() {
    let found = labels("let tilt = 40deg\nlet size = 1\nsphere(1).rotate(x: $0)");
    assert_eq!(found[0], "tilt");
}

#[test]
fn hover_shows_signature_documentation_and_source() {
    insta::with_settings!({ omit_expression => true }, {
    insta::assert_snapshot!("hover_of_the_library", shown("sph$0ere(1)"));
    insta::assert_snapshot!(
        "hover_of_a_scene",
        [
            shown("/// How wide.\nparam wid$0th = 2 in 1..3\nsphere(width)"),
            shown("let bal$0l = sphere(1)\nball"),
            shown("/// A knob.\n/// r: its radius\nsolid knob(r: length) = length(p) - r\nknob($0r: 1)"),
            shown("solid knob(r: length) = length($0p) - r"),
            shown("cam$0era(eye: [1, 2, 3])"),
            shown("camera(e$0ye: [1, 2, 3])"),
            shown("let a = s$0in(1)"),
            shown("fn f(v: ve$0c3) = v.x"),
            shown("sphere(1) $0| sphere(2)"),
        ]
        .join("---\n")
    );
    });
    assert!(shown("solid a() ex$0act = length(p)\na()").contains("the distance is exact"));
    assert!(shown("le$0t a = 1\nsphere(a)").starts_with("```sdf\nlet name = value\n```"));
    assert_eq!(shown("let a = [1, 2].bou$0nds\nsphere(a)"), "");
}

#[test]
fn facts_are_asked_of_the_call_that_a_name_stands_for() {
    let asked = |marked: &str| {
        let (scene, offset) = at(marked);
        let mut calls = Vec::new();
        let mut facts = |call: std::ops::Range<usize>| {
            calls.push(scene.text()[call].to_owned());
            None
        };
        hover(&scene, offset, &mut facts);
        calls
    };
    assert_eq!(asked("sph$0ere(1).scale(2) | box(1)"), ["sphere(1)"]);
    assert_eq!(asked("sphere(1).sc$0ale(2) | box(1)"), ["sphere(1).scale(2)"]);
    assert_eq!(asked("sphere(1) $0| box(1)"), ["sphere(1) | box(1)"]);
    assert_eq!(asked("let a = (box(1).scale(2))\nlet b = a\n$0b"), ["box(1).scale(2)"]);
    assert_eq!(asked("sphere(sq$0rt(2))"), [""; 0]);
    let (scene, _) = cursor("let a = box(1)\na\nsphere(1)\nbackground(#fff)\n(a - a)$0");
    let scene = self::scene(&scene);
    let mut facts = |call: std::ops::Range<usize>| {
        Some(ShapeFacts { quality: String::new(), cost: scene.text()[call].to_owned() })
    };
    let labels: Vec<String> = lenses(&scene, &mut facts).into_iter().map(|it| it.label).collect();
    assert_eq!(labels, ["box(1)", "sphere(1)", "a - a"]);
}

#[test]
fn definitions_lead_into_files_and_the_library() {
    let (scene, offset) = at("let ball = sphere(1)\nba$0ll");
    assert_eq!(definition(&scene, offset).map(|it| it.range()), Some(4..8));
    let (scene, offset) = at("sphe$0re(1)");
    let found = definition(&scene, offset).expect("the library declares it");
    assert_eq!(found.file, "std/solids.sdf");
    let text = scene.text_of("std/solids.sdf").expect("the library is a file");
    assert_eq!(&text[found.range()], "sphere");
    // The dimension of the first argument decides.
    let (scene, offset) = at("circle(1).trans$0late(x: 1).extrude(1)");
    let found = definition(&scene, offset).expect("the library declares it");
    assert!(text_before(&scene, &found).ends_with("region "), "{found:?}");
}

fn text_before<'s>(scene: &'s Analysis, at: &sdfc_ide::Location) -> &'s str {
    &scene.text_of(&at.file).expect("the file is known")[..at.start]
}

#[test]
fn references_and_rename_follow_imports() {
    let files = Files(BTreeMap::from([("gear.sdf", GEAR)]));
    let main =
        "import gear from \"gear.sdf\"\nimport gear as cog from \"gear.sdf\"\ngear(r: 2) | cog()\n";
    let scene = Analysis::new("dir/main.sdf", main, &files);
    let uses = references(&scene, &[], main.find("gear(r").unwrap_or(0), true);
    assert_eq!(uses.len(), 6, "{uses:?}");
    let edits = rename(&scene, &[], main.find("gear(r").unwrap_or(0), "wheel").expect("a name");
    let files: Vec<&str> = edits.iter().map(|edit| edit.at.file.as_str()).collect();
    assert_eq!(files, ["dir/gear.sdf", "dir/main.sdf", "dir/main.sdf", "dir/main.sdf"]);
    assert_eq!(
        applied(main, &edits[1..]),
        "import wheel from \"gear.sdf\"\nimport wheel as cog from \"gear.sdf\"\nwheel(r: 2) | cog()\n"
    );
    // The name that an import gives changes in its file alone.
    let edits = rename(&scene, &[], main.find("cog()").unwrap_or(0), "tooth").expect("a name");
    assert_eq!(applied(main, &edits).matches("tooth").count(), 2);
    assert!(edits.iter().all(|edit| edit.at.file == "dir/main.sdf"));
    // From the imported file, with the scene that imports it.
    let gear = Analysis::new("dir/gear.sdf", GEAR, &Files::default());
    let edits = rename(&gear, &[&scene], GEAR.find("gear(").unwrap_or(0), "wheel").expect("a name");
    assert_eq!(edits.len(), 4);
}

#[test]
fn a_parameter_is_renamed_with_its_named_arguments() {
    let text =
        "fn f(width, k = 1) = width * k\nlet a = f(width: 2)\nlet b = [for i in 0..2: f(i)]\n";
    let found = scene(text);
    let edits = rename(&found, &[], 6, "w").expect("a name");
    assert_eq!(
        applied(text, &edits),
        "fn f(w, k = 1) = w * k\nlet a = f(w: 2)\nlet b = [for i in 0..2: f(i)]\n"
    );
}

#[test]
fn a_bad_new_name_is_refused() {
    let text = "let ball = sphere(1)\nlet other = ball\nother";
    let found = scene(text);
    let refused = |offset, to| rename(&found, &[], offset, to).expect_err("it is refused");
    assert!(refused(4, "other").contains("already"));
    assert!(refused(4, "solid").contains("reserved"));
    assert!(refused(4, "a b").contains("not a name"));
    assert!(refused(11, "kugel").contains("library"));
    let point = scene("solid a() = length(p)");
    assert!(rename(&point, &[], 19, "q").is_err());
}

#[test]
fn fixes_change_the_source() {
    let fixed = |text: &str| -> String {
        let found = scene(text);
        let actions = actions(&found, 0..text.len());
        actions.first().map(|it| applied(text, &it.edits)).unwrap_or_default()
    };
    assert_eq!(fixed("spere(1)"), "sphere(1)");
    assert_eq!(fixed("camera(eey: [1, 2, 3])"), "camera(eye: [1, 2, 3])");
    assert_eq!(fixed("sphere(1).rotate(x: 90)"), "sphere(1).rotate(x: 90deg)");
    assert_eq!(fixed("circle(1)\nbox(1)"), "circle(1).extrude(0.2)\nbox(1)");
    assert_eq!(fixed("circle(1) | rect(2)\nbox(1)"), "(circle(1) | rect(2)).extrude(0.2)\nbox(1)");
    assert_eq!(fixed("sphere(.5)"), "sphere(0.5)");
    assert_eq!(fixed("sphere(r = 1)"), "sphere(r : 1)");
    assert_eq!(fixed("sphere(1"), "sphere(1)");
    assert_eq!(fixed("box([1 2, 3])"), "box([1, 2, 3])");
    let block = "sphere({\n  let unused = 2\n  1\n})\n";
    assert_eq!(fixed(block), "sphere({\n  1\n})\n");
}

#[test]
fn diagnostics_have_codes_and_related_positions() {
    let found = diagnostics(&scene("let a = 1\nlet a = 2\nsphere(a)"), false);
    assert_eq!(found[0].range, 14..15);
    assert_eq!((found[0].code.is_empty(), found[0].related.len()), (false, 1));
    let files = Files(BTreeMap::from([("bad.sdf", "let x = \n")]));
    let found =
        diagnostics(&Analysis::new("s.sdf", "import x from \"bad.sdf\"\nsphere(x)", &files), false);
    assert!(
        found.iter().any(|it| it.range == (14..23) && it.message.contains("bad.sdf")),
        "{found:?}"
    );
}

#[test]
fn signatures_know_the_active_parameter() {
    let active = |text: &str| {
        let (scene, offset) = at(text);
        let help = signature_help(&scene, offset).into_iter().next()?;
        Some(help.parameters.get(help.active?)?.0.split(':').next()?.to_owned())
    };
    assert_eq!(active("cylinder($0").as_deref(), Some("r"));
    assert_eq!(active("cylinder(1, $0)").as_deref(), Some("h"));
    assert_eq!(active("cylinder(h: $0)").as_deref(), Some("h"));
    assert_eq!(active("camera(eye: [1, $0 2, 3])").as_deref(), Some("eye"));
    assert_eq!(active("fn f(a, b) = a\nlet c = 1.f($0)").as_deref(), Some("b"));
    assert_eq!(active("let a = ($0)"), None);
}

#[test]
fn an_entry_of_the_library_has_an_example_to_draw() {
    let example = |text: &str| hover(&scene(text), 0, &mut |_| None)?.example;
    let drawn = example("torus(1, 0.2)\n").map(|it| (it.name, it.source.contains("torus(")));
    assert_eq!(drawn, Some(("torus".to_owned(), true)));
    assert_eq!(example("sqrt(1)\n"), None);
    assert_eq!(example("background(#102030)\n"), None);
}

#[test]
fn hints_symbols_folds_selections_and_colours() {
    let text = "// A\n// B\nlet lid = cylinder(1, 0.2)\nlid.color(rgb(1, 0.5, 0))\nbackground(#102030)\nsolid k(r: length = 1)\n  exact\n  = length(p) - r\n";
    let found = scene(text);
    let made = text.find("lid.color").unwrap_or(0);
    let uncertified = [(made..made + "lid.color(rgb(1, 0.5, 0))".len(), "no constant".to_owned())];
    let hints = hints(&found, 0..text.len(), &uncertified);
    let labels: Vec<&str> = hints.iter().map(|hint| hint.label.as_str()).collect();
    assert_eq!(labels, [": solid", "r:", "h:", "r:", "g:", "b:", "uncertified"]);
    let names: Vec<String> = symbols(&found).into_iter().map(|it| it.name).collect();
    assert_eq!(names, ["lid", "lid.color(rgb(1, 0.5, 0))", "background", "k"]);
    assert_eq!(folds(&found).len(), 2);
    assert_eq!(colors(&found).len(), 2);
    let at = text.find("0.2").unwrap_or(0);
    let sizes: Vec<&str> = selection(&found, at).into_iter().map(|it| &text[it]).collect();
    assert_eq!(sizes[..3], ["0.2", "cylinder(1, 0.2)", "let lid = cylinder(1, 0.2)"]);
    let roles = tokens(&found);
    assert!(roles.iter().any(|it| &text[it.range.clone()] == "cylinder" && it.built_in));
    assert!(roles.iter().any(|it| &text[it.range.clone()] == "exact"));
}
