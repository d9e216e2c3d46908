//! The compiler in a web page: a scene's text in; shader, reflection and diagnostics out, all as JSON.
//!
//! # What
//!
//! [`compile`] is a function of two texts. Built for `wasm32-unknown-unknown` the crate is the `sdfc.wasm` of the npm
//! package beside it (`npm/`), whose `index.js` calls that function and parses what it gives.
//!
//! # How
//!
//! ```
//! let found = sdfc_web::compile("sphere(1)", r#"{ "target": "glsl-es" }"#);
//! assert!(found.contains("float sdf_distance(vec3 p)"));
//!
//! let wrong = sdfc_web::compile("spere(1)", "{}");
//! assert!(wrong.contains(r#""text":null"#) && wrong.contains("did you mean `sphere`?"));
//! ```
//!
//! # Limits
//!
//! Nothing is drawn here, and nothing measured. A scene can import the files that its options bring, and no others.

mod options;
#[cfg(target_family = "wasm")]
mod wasm;

use sdfc::{Code, DiagnosticRow, ShaderReflection};
use serde::Serialize;

use options::{Files, Options};

/// What compiling gave. The keys are a promise to pages: some may be added, none renamed.
#[derive(Debug, Default, Serialize)]
struct Answer {
    /// The shader; null with errors, and for SPIR-V.
    text: Option<String>,
    /// The words of SPIR-V; null for all else.
    words: Option<Vec<u32>>,
    /// As `sdfc compile --reflect` writes it; null with errors.
    reflection: Option<ShaderReflection>,
    /// Findings in order of place.
    diagnostics: Vec<Finding>,
}

/// A diagnostic.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Finding {
    /// Of the scene.
    Scene(DiagnosticRow),
    /// Of the call.
    Call(Refusal),
}

/// The keys of a [`DiagnosticRow`]; what has no place has line 0.
#[derive(Debug, Default, Serialize)]
struct Refusal {
    /// Null.
    code: Option<&'static str>,
    severity: &'static str,
    message: String,
    file: &'static str,
    line: u32,
    column: u32,
    end_line: u32,
    end_column: u32,
    help: &'static str,
}

/// Compiles a scene. The options are a JSON object, all of whose keys may be left out: `name`, `target`, `emit`,
/// `stage`, `march`, `prefix`, `group`, `binding`, `slots`, as the options of `sdfc compile`, and `files`, an object of
/// texts that the scene may import, by path.
///
/// Gives a JSON object with `text` or `words`, `reflection`, and `diagnostics`, whatever it is given.
pub fn compile(source: &str, options: &str) -> String {
    let answer = match serde_json::from_str(options) {
        Ok(options) => answer(source, options),
        Err(error) => refused(format!("the options are not understood: {error}")),
    };
    // Plain data: numbers, texts, lists.
    serde_json::to_string(&answer).unwrap_or_default()
}

fn answer(source: &str, options: Options) -> Answer {
    let front = sdfc::lang::Options { live_literals: options.slots, ..Default::default() };
    let shader = options.shader();
    let compiled = sdfc::compile_with(&options.name, source, &Files(options.files), front);
    let diagnostics = compiled.rows().into_iter().map(Finding::Scene).collect();
    let Some(scene) = compiled.scene else { return Answer { diagnostics, ..Answer::default() } };
    let written = match scene.write_shader(&shader) {
        Ok(written) => written,
        Err(error) => {
            let mut found = refused(error.to_string());
            found.diagnostics.splice(..0, diagnostics);
            return found;
        }
    };
    let reflection = Some(scene.reflect(&shader, &written));
    let (text, words) = match written.code {
        Code::Text(text) => (Some(text), None),
        Code::Words(words) => (None, Some(words)),
    };
    Answer { text, words, reflection, diagnostics }
}

/// An error without a place in the scene.
fn refused(message: String) -> Answer {
    let found = Refusal { severity: "error", message, ..Refusal::default() };
    Answer { diagnostics: vec![Finding::Call(found)], ..Answer::default() }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    fn compile(source: &str, options: &Value) -> Value {
        serde_json::from_str(&super::compile(source, &options.to_string())).unwrap()
    }

    #[test]
    fn what_is_asked_for_comes_out() {
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
    fn what_is_wrong_is_data() {
        let found = compile("sphere(1) +", &json!({}));
        let row = &found["diagnostics"][0];
        assert_eq!((&row["severity"], &row["line"]), (&"error".into(), &1.into()));
        assert!(row["code"].is_string() && found["reflection"].is_null());
        let impossible = json!({ "target": "glsl-es", "emit": "render", "stage": "compute" });
        for options in
            [json!({ "target": "cobol" }), json!({ "colour": 1 }), json!("wgsl"), impossible]
        {
            let found = compile("sphere(1)", &options);
            assert!(found["text"].is_null(), "{options}");
            assert_eq!(found["diagnostics"][0]["severity"], "error", "{options}");
        }
        assert!(super::compile("", "\u{0}{").contains("not understood"));
    }

    #[test]
    fn only_files_that_are_brought_are_imported() {
        let scene = "import ball from \"parts.sdf\"\nball()";
        let brought = json!({ "files": { "parts.sdf": "solid ball() = length(p) - 1" } });
        assert!(compile(scene, &brought)["text"].is_string());
        let found = compile(scene, &json!({}));
        assert!(found["text"].is_null() && found["diagnostics"][0]["severity"] == "error");
    }
}
