//! `sdfc lsp` over pipes, as an editor runs it.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;
#[path = "common/editor.rs"]
mod editor;

use serde_json::{Value, json};

use editor::Editor;

#[test]
fn an_editor_is_served_from_start_to_end() {
    let folder = common::folder(&[("part.sdf", "solid part(r: length = 1) = length(p) - r\n")]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(&uri, "import part from \"part.sdf\"\n// 😀\nspere(1) | part()\n");
    let found = editor.diagnostics(&uri);
    assert_eq!(found[0]["code"], "E0201");
    assert_eq!(found[0]["range"]["end"], json!({ "line": 2, "character": 5 }));
    let range = found[0]["range"].clone();
    let document = json!({ "uri": uri });
    let params = json!({ "textDocument": document, "range": range, "context": {} });
    let actions = editor.ask("textDocument/codeAction", params);
    assert_eq!(actions[0]["edit"]["changes"][&uri][0]["newText"], "sphere");
    let change = json!([{ "range": range, "text": "sphere" }]);
    editor.notify(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": change }),
    );
    assert_eq!(editor.diagnostics(&uri), json!([]));
    let list = editor.ask("textDocument/completion", Editor::at(&uri, 2, 13));
    assert!(list.as_array().unwrap().iter().any(|it| it["label"] == "part"), "{list}");
    let hover = editor.ask("textDocument/hover", Editor::at(&uri, 2, 2));
    assert!(hover["contents"]["value"].as_str().unwrap().contains("solid sphere("), "{hover}");
    assert!(hover["contents"]["value"].as_str().unwrap().contains("Here: exact;"), "{hover}");
    let picture = "![sphere](data:image/png;base64,iVBORw0KGgo";
    assert!(hover["contents"]["value"].as_str().unwrap().starts_with(picture), "{hover}");
    assert_eq!(editor.registered, ["workspace/didChangeWatchedFiles"]);
    let document = json!({ "textDocument": { "uri": uri } });
    let lenses = editor.ask("textDocument/codeLens", document);
    let title = lenses[0]["command"]["title"].as_str().unwrap();
    assert!(title.ends_with("operations, 100 % of the scene"), "{title}");
    let found = editor.ask("workspace/symbol", json!({ "query": "PAR" }));
    assert_eq!(
        (&found[0]["name"], found.as_array().unwrap().len()),
        (&"part".into(), 1),
        "{found}"
    );
    let declared = editor.ask("textDocument/definition", Editor::at(&uri, 2, 2));
    let library = declared["uri"].as_str().unwrap().strip_prefix("file://").unwrap();
    assert!(std::fs::read_to_string(library).unwrap().contains("solid sphere("));
    let mut rename = Editor::at(&uri, 2, 13);
    rename["newName"] = json!("knob");
    let edit = editor.ask("textDocument/rename", rename.clone());
    assert_eq!(edit["changes"].as_object().unwrap().len(), 2, "{edit}");
    rename["newName"] = json!("solid");
    let refused = editor.answer("textDocument/rename", rename);
    assert!(refused["error"]["message"].as_str().unwrap().contains("reserved"));
    for method in ["documentSymbol", "foldingRange", "documentColor", "semanticTokens/full"] {
        let params = json!({ "textDocument": { "uri": uri } });
        let answer = editor.ask(&format!("textDocument/{method}"), params);
        assert!(answer.is_array() || answer["data"].is_array(), "{method}: {answer}");
    }
    // A file that is open counts with its text, and when it is closed the file on disk does.
    let part = format!("file://{}/part.sdf", folder.path().display());
    editor.open(&part, "let other = 1\n");
    assert_eq!(editor.diagnostics(&uri)[0]["code"], "E0209");
    // It draws nothing, but a scene imports it.
    assert_eq!(editor.diagnostics(&part), json!([]));
    editor.notify("textDocument/didClose", json!({ "textDocument": { "uri": part } }));
    assert_eq!(editor.diagnostics(&uri), json!([]));
    assert_eq!(editor.diagnostics(&part), json!([]));
    let unknown = editor.answer("textDocument/unknown", Editor::at(&uri, 0, 0));
    assert_eq!(unknown["error"]["code"], -32601);
    editor.end();
}

#[test]
fn a_hint_marks_the_call_that_makes_an_uncertified_shape() {
    let folder = common::folder(&[]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(&uri, "solid egg()\n  = length(p) - 1 - floor(p.x)\negg().translate(y: 1)\n");
    let whole =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 4, "character": 0 } });
    let params = json!({ "textDocument": { "uri": uri }, "range": whole });
    let hints = editor.ask("textDocument/inlayHint", params);
    let marked = hints.as_array().unwrap().iter().find(|it| it["label"] == "uncertified").unwrap();
    assert_eq!(marked["position"], json!({ "line": 2, "character": 5 }), "{hints}");
    assert!(marked["tooltip"].as_str().unwrap().starts_with("A ray may step through"), "{hints}");
    editor.end();
}

#[test]
fn a_file_that_a_scene_imports_may_import_from_above() {
    let folder = common::folder(&[
        ("scene.sdf", "import wheel from \"parts/wheel.sdf\"\nwheel()\n"),
        ("common.sdf", "let size = 0.5\n"),
        ("parts/wheel.sdf", ""),
        ("alone/wheel.sdf", ""),
    ]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let text = "import size from \"../common.sdf\"\nsolid wheel() = length(p) - size\n";
    let uri = |name: &str| format!("file://{}/{name}", folder.path().display());
    editor.open(&uri("parts/wheel.sdf"), text);
    assert_eq!(editor.diagnostics(&uri("parts/wheel.sdf")), json!([]));
    let at = Editor::at(&uri("parts/wheel.sdf"), 1, 30);
    let declared = editor.ask("textDocument/definition", at.clone());
    assert_eq!(declared["uri"], uri("common.sdf"));
    let hover = editor.ask("textDocument/hover", at);
    assert!(hover["contents"]["value"].as_str().unwrap().contains("let size: number"), "{hover}");
    // No scene imports this one, so it is a scene of its own.
    editor.open(&uri("alone/wheel.sdf"), text);
    let found = editor.diagnostics(&uri("alone/wheel.sdf"));
    assert!(found[0]["message"].as_str().unwrap().contains("outside the folder"), "{found}");
    editor.end();
}

#[test]
fn a_shared_module_is_opened_where_it_is() {
    let folder = common::folder(&[(".modules/bolt.sdf", "solid bolt() = length(p) - 0.5\n")]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = |name: &str| format!("file://{}/{name}", folder.path().display());
    editor.open(&uri("main.sdf"), "import bolt from \"bolt.sdf\"\nbolt()\n");
    assert_eq!(editor.diagnostics(&uri("main.sdf")), json!([]));
    let declared = editor.ask("textDocument/definition", Editor::at(&uri("main.sdf"), 1, 1));
    assert_eq!(declared["uri"], uri(".modules/bolt.sdf"));
    // A text that is open and not saved counts.
    editor.open(&uri(".modules/bolt.sdf"), "solid nut() = length(p) - 0.5\n");
    assert_eq!(editor.diagnostics(&uri("main.sdf"))[0]["code"], "E0209");
    editor.end();
}

#[test]
fn errors_of_elaboration_in_a_large_scene_come_after_a_pause() {
    let folder = common::folder(&[]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    let ball = |at| format!("sphere(0.3).translate([{at}, 0, 0]).rotate(y: {at}deg)\n");
    let balls: String = (0..2000).map(ball).collect();
    let text = format!(
        "solid ball(r: length) require r > 0, \"a ball needs a radius\" = length(p) - r\n{balls}"
    );
    editor.open(&uri, &text);
    assert_eq!(editor.diagnostics(&uri), json!([]));
    let end = json!({ "line": 2001, "character": 0 });
    let mut type_at_end = |typed: &str| {
        let change = json!([{ "range": { "start": end, "end": end }, "text": typed }]);
        let document = json!({ "uri": uri, "version": 2 });
        let params = json!({ "textDocument": document, "contentChanges": change });
        editor.notify("textDocument/didChange", params);
        editor.diagnostics(&uri)
    };
    // The scene takes long to elaborate, so the answer to a keystroke does not wait for that.
    assert_eq!(type_at_end("ball(-1)\n"), json!([]));
    let found = editor.diagnostics(&uri);
    assert_eq!(found.as_array().unwrap().len(), 1, "{found}");
    assert!(found[0]["message"].as_str().unwrap().contains("a ball needs a radius"), "{found}");
    editor.end();
}

#[test]
fn columns_are_bytes_for_an_editor_that_prefers_them() {
    let folder = common::folder(&[]);
    let mut editor = Editor::start(folder.path(), json!(["utf-8", "utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(&uri, "/// é 😀\nlet a = [\"é\", b]\nsphere(1)\n");
    let found = editor.diagnostics(&uri);
    let unknown = found.as_array().unwrap().iter().find(|it| it["code"] == "E0201").unwrap();
    assert_eq!(unknown["range"]["start"], json!({ "line": 1, "character": 15 }));
    editor.end();
}

#[test]
fn an_editor_gets_params_and_previews_of_unsaved_text() {
    let folder = common::folder(&[("part.sdf", "solid part(r: length = 1) = length(p) - r\n")]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(
        &uri,
        "import part from \"part.sdf\"\nparam r = 0.5 in 0.1..2\nparam tilt = 10deg in 0deg..45deg\n\
         param lid = true\nparam wood = #d94f30\nparam style = \"a\" in [\"a\", \"b\"]\n\
         part(r).color(wood).rotate(y: tilt)\nbackground(#000)\n",
    );
    let document = json!({ "uri": uri });
    let params = editor.ask("sdfc/params", json!({ "textDocument": document }));
    let rows = params["params"].as_array().unwrap();
    assert_eq!(rows.len(), 5, "{params}");
    let row = |name: &str, kind: &str, default: Value, min: Value, max: Value, choices: Value| {
        json!({
            "name": name, "kind": kind, "default": default, "min": min, "max": max,
            "choices": choices,
        })
    };
    let (null, none) = (Value::Null, json!([]));
    assert_eq!(rows[0], row("r", "number", json!(0.5), json!(0.1), json!(2.0), none.clone()));
    assert_eq!(rows[1], row("tilt", "angle", json!(10.0), json!(0.0), json!(45.0), none.clone()));
    assert_eq!(rows[2]["default"], json!(true));
    let wood = row("wood", "color", json!("#d94f30"), null.clone(), null.clone(), none);
    assert_eq!(rows[3], wood);
    assert_eq!(rows[4]["choices"], json!(["a", "b"]));

    let camera = json!({ "eye": [0, 0, 4], "target": [0, 0, 0], "fov": 40 });
    let ask = |values: Value| json!({ "textDocument": document, "size": [64, 48], "camera": camera, "values": values });
    let small = editor.ask("sdfc/preview", ask(json!({})));
    let large = editor.ask("sdfc/preview", ask(json!({ "r": 1.0, "wood": "#fff" })));
    let [small, large] = [small, large].map(|picture| lit_pixels(&picture));
    assert!(small > 100 && large > 3 * small, "{small} pixels, then {large}");

    // Without a camera, the answer has the one that sees the whole scene.
    let picture = json!({ "textDocument": document, "size": [32, 32] });
    let fitted = editor.ask("sdfc/preview", picture.clone())["camera"].clone();
    assert!(fitted["fov"].is_f64() && fitted["eye"][2].as_f64().unwrap() > 1.0, "{fitted}");

    // The unsaved text of the import counts, too.
    let part = format!("file://{}/part.sdf", folder.path().display());
    editor.open(&part, "solid part(r: length = 1) = length(p) - 2 * r\n");
    let grown = editor.ask("sdfc/preview", ask(json!({})));
    assert_eq!(lit_pixels(&grown), large);

    for (wrong, message) in [
        (json!({ "size": [0, 48] }), "from 1 to 2048"),
        (json!({ "size": [64, 4096] }), "from 1 to 2048"),
        (json!({ "values": { "r": 3 } }), "the param `r` takes 0.1..2; 3 is outside"),
        (json!({ "values": { "q": 3 } }), "no param `q`"),
        (json!({ "values": { "r": null } }), "a number, true, false or a string"),
        (json!({ "camera": { "eye": [0, 0, 4], "target": [0, 0, 0] } }), "either `fov`"),
        (json!({ "camera": { "eye": [0, 0, 4], "target": [0, 0, 4], "fov": 40 } }), "same point"),
        (json!({ "camera": { "eye": [0, 0, 4], "target": [0, 0, 0], "fov": 0 } }), "between 0"),
    ] {
        let mut asked = ask(json!({}));
        for (name, value) in wrong.as_object().unwrap() {
            asked[name] = value.clone();
        }
        let answer = editor.answer("sdfc/preview", asked);
        let why = answer["error"]["message"].as_str().unwrap_or_default();
        assert!(why.contains(message), "{wrong}: {answer}");
    }
    // An end of a range that has no short number of degrees.
    let angles = format!("file://{}/angles.sdf", folder.path().display());
    editor.open(&angles, "param turn = 1.5rad in 1rad..2rad\nbox(1).rotate(y: turn)\n");
    let document = json!({ "uri": angles });
    let params = editor.ask("sdfc/params", json!({ "textDocument": document }));
    for end in ["min", "max"] {
        let values = json!({ "turn": params["params"][0][end] });
        let asked = json!({ "textDocument": document, "size": [16, 16], "values": values });
        assert!(editor.ask("sdfc/preview", asked)["png"].is_string(), "{end}: {params}");
    }
    let asked = json!({ "textDocument": document, "size": [16, 16], "values": { "turn": 200 } });
    let answer = editor.answer("sdfc/preview", asked);
    let why = answer["error"]["message"].as_str().unwrap();
    assert!(why.ends_with("114.591559026deg; 200deg is outside"), "{why}");
    let change = json!([{ "text": "part(1\n" }]);
    let changed = json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": change });
    editor.notify("textDocument/didChange", changed);
    let answer = editor.answer("sdfc/preview", picture);
    let why = answer["error"]["message"].as_str().unwrap();
    assert!(why.starts_with("the scene has errors: "), "{why}");
    editor.end();
}

/// The number of pixels of a preview that are not black.
fn lit_pixels(preview: &Value) -> usize {
    let png = data_encoding::BASE64.decode(preview["png"].as_str().unwrap().as_bytes()).unwrap();
    let picture = image::load_from_memory(&png).unwrap().into_rgb8();
    picture.pixels().filter(|pixel| pixel.0.iter().any(|part| *part > 8)).count()
}

/// A scene whose preview takes so long that other answers come first.
const SLOW: &str =
    "union(for i in 0..12: for j in 0..12: gyroid(0.3).translate([i, j, 0]) & box(9))\n";

#[test]
fn typing_goes_on_while_a_preview_is_drawn_and_it_can_be_cancelled() {
    let folder = common::folder(&[]);
    let mut editor = Editor::start(folder.path(), json!(["utf-16"]));
    let uri = format!("file://{}/main.sdf", folder.path().display());
    editor.open(&uri, SLOW);
    let picture = json!({ "textDocument": { "uri": uri }, "size": [2048, 2048] });
    let preview = editor.request("sdfc/preview", picture.clone());
    let second = editor.request("sdfc/preview", picture);
    let hover = editor.request("textDocument/hover", Editor::at(&uri, 0, 2));
    let first = editor.next_answer();
    assert_eq!(first["id"], json!(hover), "{}", first["error"]);
    editor.notify("$/cancelRequest", json!({ "id": preview }));
    editor.notify("$/cancelRequest", json!({ "id": second }));
    for id in [preview, second] {
        let answer = editor.next_answer();
        assert_eq!((&answer["id"], &answer["error"]["code"]), (&json!(id), &json!(-32800)));
    }
    // The thread that draws is free again.
    editor.open(&uri, "sphere(1)\n");
    let picture = json!({ "textDocument": { "uri": uri }, "size": [16, 16] });
    assert!(editor.ask("sdfc/preview", picture)["png"].is_string());
    editor.end();
}
