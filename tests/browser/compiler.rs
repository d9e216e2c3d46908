//! The npm package of the compiler, in a browser.

use libtest_mimic::Failed;
use sdfc_tests::{compiled_examples, examples_folder, repository};
use serde_json::json;

use crate::Place;
use crate::pages::{STATE, check, drawn, shown};

/// The environment variable that makes the trial fail, not be ignored, where the package was not built.
const REQUIRE: &str = "SDFC_REQUIRE_WASM";
const PACKAGE: &str = "crates/web/npm";

/// Whether there is no `sdfc.wasm`, and none is required.
pub fn is_missing() -> bool {
    std::env::var_os(REQUIRE).is_none_or(|value| value != "1")
        && !repository().join(PACKAGE).join("sdfc.wasm").exists()
}

fn lay(place: &Place) -> Result<(), Failed> {
    for file in ["index.js", "sdfc.wasm"] {
        let bytes = std::fs::read(repository().join(PACKAGE).join(file))?;
        place.server.lay(&format!("crates/web/npm/{file}"), bytes);
    }
    Ok(())
}

/// The playground: what is typed is drawn, and what is wrong is said.
pub fn draws_what_is_typed(place: &mut Place) -> Result<(), Failed> {
    lay(place)?;
    place.chromium.open(&place.server.url("playground/index.html"), [660, 800])?;
    for typed in [None, Some("sphere(1) +"), Some("torus(major: 1, minor: 0.3)\nsphere(0.4)")] {
        if let Some(text) = typed {
            place.chromium.apply(TYPE, &text.into())?;
        }
        let state = place.chromium.evaluate(STATE)?;
        let complaints = place.chromium.complaints();
        if state != "drawn" || !complaints.is_empty() {
            return Err(format!("{typed:?}: {state}, {complaints:?}").into());
        }
        let said = place.chromium.evaluate("document.querySelector('pre').textContent")?;
        let text = place.chromium.evaluate("document.querySelector('textarea').value")?;
        let scene = sdfc::compile("typed.sdf", text.as_str().ok_or("no text")?).scene;
        match scene {
            Some(scene) => {
                check(&shown(place)?, &drawn(&scene, None, None)?, "what is typed")?;
            }
            None if said == "" => return Err("nothing is said of an error".into()),
            None => {}
        }
    }
    Ok(())
}

const TYPE: &str = "text => {
    const editor = document.querySelector('textarea');
    editor.value = text;
    editor.dispatchEvent(new Event('input'));
}";

/// In the browser every example gives what it gives here, reflection and diagnostics included.
pub fn gives_the_same_in_a_browser(place: &mut Place) -> Result<(), Failed> {
    lay(place)?;
    place.server.lay("blank.html", Vec::new());
    place.chromium.open(&place.server.url("blank.html"), [100, 100])?;
    place.chromium.evaluate(
        "import('/crates/web/npm/index.js').then(async ({ load }) => { window.compiler = await load(); })",
    )?;
    let mut asked: Vec<[String; 2]> = Vec::new();
    for (name, _) in compiled_examples()? {
        let text = std::fs::read_to_string(examples_folder().join(&name))?;
        for target in ["wgsl", "glsl-es", "spirv"] {
            asked.push([text.clone(), json!({ "name": name, "target": target }).to_string()]);
        }
    }
    let broken = ["spere(1)", "sphere(1) +", "\u{0}\u{fffd}", "let a = a\na"];
    asked.extend(broken.map(|text| [text.to_owned(), "{}".to_owned()]));
    asked.push(["sphere(1)".to_owned(), json!({ "target": "cobol" }).to_string()]);
    for [source, options] in asked {
        let expected = sdfc_web::compile(&source, &options);
        let found = place.chromium.apply(IS_SAME, &json!([source, options, expected]))?;
        if found != true {
            return Err(format!("{options}: {source:.200} gives something else there").into());
        }
    }
    // Deep nesting ends in a scene or an error, and the compiler goes on.
    let found = place.chromium.evaluate(DEEP)?;
    if found
        .as_array()
        .is_none_or(|found| found.iter().any(|text| text.as_str().is_none_or(str::is_empty)))
    {
        return Err(format!("of deep nesting: {found}").into());
    }
    Ok(())
}

/// Compared there, since numbers of JavaScript forget whether they were written as whole ones. Texts are the same to the byte; numbers of
/// the certificate to what sines and powers of two systems' libraries may differ by. The writer of SPIR-V numbers some ids in the order of
/// a hash map, which is another where addresses have 32 bits: its words are the same in some order.
const IS_SAME: &str = "([source, options, expected]) => {
    const parts = value => typeof value === 'object' && value !== null ? Object.keys(value) : null;
    const same = (a, b) => {
        if (typeof a === 'number' && typeof b === 'number') return Math.abs(a - b) <= 1e-14 * Math.abs(b);
        const [own, others] = [parts(a), parts(b)];
        if (!own || !others) return a === b;
        return own.length === others.length && own.every(key => same(a[key], b[key]));
    };
    const sorted = answer => ({ ...answer, words: answer.words && answer.words.toSorted((a, b) => a - b) });
    return same(sorted(compiler.compile(source, JSON.parse(options))), sorted(JSON.parse(expected)));
}";

/// What each gave: `scene`, or its first error.
const DEEP: &str = "[100, 1000, 10000, 100000].flatMap(depth => [
    '('.repeat(depth) + 'sphere(1)' + ')'.repeat(depth),
    'sphere(1)' + '.round(0.001)'.repeat(depth),
    'sphere(1)' + ' | sphere(2)'.repeat(depth),
    'sphere(' + '-'.repeat(depth) + '1)',
]).concat('sphere(1)').map(source => {
    const { text, diagnostics } = compiler.compile(source);
    return text ? 'scene' : diagnostics[0].message;
})";
