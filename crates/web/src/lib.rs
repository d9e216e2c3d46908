//! The compiler for web pages: it takes the source of a scene and returns shader, reflection and
//! diagnostics as JSON.
//!
//! # What
//!
//! [`compile`] takes and returns strings. Built for `wasm32-unknown-unknown`, the crate is the
//! `sdfc.wasm` of the npm package in `npm/`, whose `index.js` calls that function and parses the
//! result.
//!
//! # How
//!
//! ```
//! let compiled = sdfc_web::compile("sphere(1)", r#"{ "target": "glsl-es" }"#);
//! assert!(compiled.contains("float sdf_distance(vec3 p)"));
//!
//! let failed = sdfc_web::compile("spere(1)", "{}");
//! assert!(failed.contains(r#""text":null"#) && failed.contains("did you mean `sphere`?"));
//! ```
//!
//! # Limits
//!
//! The crate renders and measures nothing. A scene can import only the files in the options.

mod options;
#[cfg(target_family = "wasm")]
mod wasm;

use sdfc::{Code, CompileWithError, Compiler, DiagnosticRow, Diagnostics, ShaderReflection};
use serde::Serialize;

use options::{Files, Options};

/// The result of compiling. Pages depend on the keys: new ones may be added, none renamed.
#[derive(Debug, Default, Serialize)]
struct Answer {
    /// The source of the shader; null with errors, and for SPIR-V.
    text: Option<String>,
    /// The words of SPIR-V; null for other targets.
    words: Option<Vec<u32>>,
    /// The reflection as `sdfc compile --reflect` writes it; null with errors.
    reflection: Option<ShaderReflection>,
    /// The diagnostics in the order of their positions.
    diagnostics: Vec<Row>,
}

/// A diagnostic.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Row {
    /// About the scene.
    Scene(DiagnosticRow),
    /// About the call.
    Call(CallError),
}

/// An error without a position in the scene. It has the keys of a [`DiagnosticRow`], and line 0.
#[derive(Debug, Default, Serialize)]
struct CallError {
    /// Always null.
    code: Option<&'static str>,
    severity: &'static str,
    message: String,
    file: &'static str,
    line: u32,
    column: u32,
    end_line: u32,
    end_column: u32,
    help: &'static str,
    /// Always empty.
    fixes: [(); 0],
}

/// Compiles a scene.
///
/// `options` is a JSON object. All its keys are optional: `name`, `target`, `emit`, `stage`,
/// `march`, `prefix`, `group`, `binding` and `live_literals`, as the options of `sdfc compile`;
/// `set`, an object with the values of params as strings, by name; `values`, an object with the
/// values of fixed params as numbers, by name; and `files`, an object with the sources that the
/// scene may import, by path.
///
/// `set` replaces the defaults of params, and a value that a param does not take is an error. From
/// `values` only the params are set that are constants of the shader; everything else in it is
/// ignored. A page passes the values of all its sliders. With `set`, `values` is ignored.
///
/// Returns a JSON object with `text` or `words`, `reflection`, and `diagnostics`, for any input.
pub fn compile(source: &str, options: &str) -> String {
    let answer = match serde_json::from_str(options) {
        Ok(options) => answer(source, options),
        Err(error) => failed(format!("invalid options: {error}")),
    };
    // Plain data, numbers, strings and lists, can always be written.
    serde_json::to_string(&answer).unwrap_or_default()
}

fn answer(source: &str, options: Options) -> Answer {
    let shader = options.shader();
    let files = Files(options.files);
    let mut compiler = Compiler::new().resolver(&files);
    if options.live_literals {
        compiler = compiler.live_literals(None);
    }
    let rows = |found: &Diagnostics| found.rows().into_iter().map(Row::Scene).collect();
    let set: Vec<_> = options.set.iter().map(|(name, value)| (&**name, &**value)).collect();
    let scene = if set.is_empty() {
        compiler.values(&options.values).compile(&options.name, source).map_err(Into::into)
    } else {
        compiler.compile_with(&options.name, source, &set)
    };
    let scene = match scene {
        Ok(scene) => scene,
        Err(CompileWithError::Scene(errors)) => {
            return Answer { diagnostics: rows(&errors), ..Answer::default() };
        }
        Err(error) => return failed(error.to_string()),
    };
    let diagnostics = rows(scene.diagnostics());
    let written = match scene.write_shader(&shader) {
        Ok(written) => written,
        Err(error) => {
            let mut answer = failed(error.to_string());
            answer.diagnostics.splice(..0, diagnostics);
            return answer;
        }
    };
    let reflection = Some(scene.reflect(&shader, &written));
    let (text, words) = match written.code {
        Code::Text(text) => (Some(text), None),
        Code::Words(words) => (None, Some(words)),
    };
    Answer { text, words, reflection, diagnostics }
}

/// Returns an answer with one error that has no position in the scene.
fn failed(message: String) -> Answer {
    let error = CallError { severity: "error", message, ..CallError::default() };
    Answer { diagnostics: vec![Row::Call(error)], ..Answer::default() }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    fn compile(source: &str, options: &Value) -> Value {
        serde_json::from_str(&super::compile(source, &options.to_string())).unwrap()
    }

    #[test]
    fn options_determine_the_shader() {
        let options = json!({
            "name": "a.sdf", "target": "wgsl", "emit": "render", "stage": "fragment", "march": "sphere",
            "prefix": "ball_", "group": 1, "binding": 2,
        });
        let found = compile("param r = 1 in 0..2\nsphere(r)", &options);
        let text = found["text"].as_str().unwrap();
        assert!(text.starts_with("// sdfc") && text.contains("fn ball_fragment"), "{text}");
        assert!(text.contains("@group(1) @binding(2)"), "{text}");
        assert_eq!(found["reflection"]["params"][0]["name"], "r");
        assert_eq!(found["diagnostics"], json!([]));
        let found = compile("sphere(1)", &json!({ "target": "spirv" }));
        assert_eq!((&found["text"], &found["words"][0]), (&Value::Null, &0x0723_0203.into()));
    }

    #[test]
    fn params_are_set_before_the_scene_is_compiled() {
        let scene = "param n: int = 2 in 1..9\nparam r = 1 in 0..2\n\
                     union(for i in 0..n: sphere(r).translate(x: 4 * i))";
        let found = compile(scene, &json!({ "set": { "n": "3", "r": "0.5" } }));
        let reflection = &found["reflection"];
        assert_eq!(reflection["fixed_params"][0]["value"], json!([3.0]));
        assert_eq!(reflection["params"][0]["default"], json!([0.5]));
        let refused = compile(scene, &json!({ "set": { "n": "10" } }));
        let message = refused["diagnostics"][0]["message"].as_str().unwrap();
        assert_eq!(message, "the param `n` takes 1..9; 10 is outside");
    }

    #[test]
    fn values_set_fixed_params_alone() {
        let scene = "param n: int = 2 in 1..9\nparam r = 1 in 0..2\n\
                     union(for i in 0..n: sphere(r).translate(x: 4 * i))";
        let values = json!({ "n": 3, "r": 0.5, "gone": [1, 2, 3, 4] });
        let reflection = &compile(scene, &json!({ "values": values }))["reflection"];
        assert_eq!(reflection["fixed_params"][0]["value"], json!([3.0]));
        assert_eq!(reflection["params"][0]["default"], json!([1.0]));
        // A value outside the range stays from an older text of the scene.
        let reflection = &compile(scene, &json!({ "values": { "n": 10 } }))["reflection"];
        assert_eq!(reflection["fixed_params"][0]["value"], json!([2.0]));
        let refused = compile(scene, &json!({ "values": { "n": [1, 2, 3, 4, 5] } }));
        let message = refused["diagnostics"][0]["message"].as_str().unwrap();
        assert!(message.contains("the value of `n` has 5 numbers"), "{message}");
    }

    #[test]
    fn errors_are_returned_as_data() {
        let found = compile("sphere(1) +", &json!({}));
        let row = &found["diagnostics"][0];
        assert_eq!((&row["severity"], &row["line"]), (&"error".into(), &1.into()));
        assert!(row["code"].is_string() && found["reflection"].is_null());
        let found = compile("spere(1)", &json!({}));
        let edit = &found["diagnostics"][0]["fixes"][0]["edits"][0];
        assert_eq!((&edit["column"], &edit["text"]), (&1.into(), &"sphere".into()));
        let impossible = json!({ "target": "glsl-es", "emit": "render", "stage": "compute" });
        for options in
            [json!({ "target": "cobol" }), json!({ "colour": 1 }), json!("wgsl"), impossible]
        {
            let found = compile("sphere(1)", &options);
            assert!(found["text"].is_null(), "{options}");
            assert_eq!(found["diagnostics"][0]["severity"], "error", "{options}");
        }
        assert!(super::compile("", "\u{0}{").contains("invalid options"));
    }

    #[test]
    fn only_files_in_the_options_are_imported() {
        let scene = "import ball from \"parts.sdf\"\nball()";
        let brought = json!({ "files": { "parts.sdf": "solid ball() = length(p) - 1" } });
        assert!(compile(scene, &brought)["text"].is_string());
        let found = compile(scene, &json!({}));
        assert!(found["text"].is_null() && found["diagnostics"][0]["severity"] == "error");
    }
}
