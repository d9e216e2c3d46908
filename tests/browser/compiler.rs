//! The npm package of the compiler works in a browser.

use libtest_mimic::Failed;
use sdfc_tests::{compiled_examples, examples_folder, repository};
use serde_json::json;

use crate::Session;
use crate::pages::{STATE, check, drawn, shown};

/// The environment variable that makes the tests fail instead of being ignored if the package was
/// not built.
const REQUIRE: &str = "SDFC_REQUIRE_WASM";
const PACKAGE: &str = "crates/web/npm";

/// Returns true if there is no `sdfc.wasm` and it is not required.
pub fn is_missing() -> bool {
    std::env::var_os(REQUIRE).is_none_or(|value| value != "1")
        && !repository().join(PACKAGE).join("sdfc.wasm").exists()
}

fn put_package(session: &Session) -> Result<(), Failed> {
    for file in ["index.js", "sdfc.wasm"] {
        let bytes = std::fs::read(repository().join(PACKAGE).join(file))?;
        session.server.put(&format!("crates/web/npm/{file}"), bytes);
    }
    Ok(())
}

/// The page draws the typed scene and shows its errors.
pub fn draws_the_typed_scene(session: &mut Session) -> Result<(), Failed> {
    put_package(session)?;
    session.chromium.open(&session.server.url("compiler/index.html"), [660, 800])?;
    for typed in [None, Some("sphere(1) +"), Some("torus(major: 1, minor: 0.3)\nsphere(0.4)")] {
        if let Some(text) = typed {
            session.chromium.apply(TYPE, &text.into())?;
        }
        let state = session.chromium.evaluate(STATE)?;
        let errors = session.chromium.errors();
        if state != "drawn" || !errors.is_empty() {
            return Err(format!("{typed:?}: {state}, {errors:?}").into());
        }
        let said = session.chromium.evaluate("document.querySelector('pre').textContent")?;
        let text = session.chromium.evaluate("document.querySelector('textarea').value")?;
        let text = text.as_str().ok_or("no text")?;
        let scene = sdfc::Compiler::new().compile("typed.sdf", text);
        match scene {
            Ok(scene) => {
                check(&shown(session)?, &drawn(&scene, None, None)?, "what is typed")?;
            }
            Err(_) if said == "" => return Err("an error is not shown".into()),
            Err(_) => {}
        }
    }
    Ok(())
}

const TYPE: &str = "text => {
    const editor = document.querySelector('textarea');
    editor.value = text;
    editor.dispatchEvent(new Event('input'));
}";

/// In the browser every example compiles to the same result as here, including reflection and
/// diagnostics.
pub fn compiles_the_same_in_a_browser(session: &mut Session) -> Result<(), Failed> {
    put_package(session)?;
    session.server.put("blank.html", Vec::new());
    session.chromium.open(&session.server.url("blank.html"), [100, 100])?;
    session.chromium.evaluate(
        "import('/crates/web/npm/index.js').then(async ({ load }) => { window.compiler = await load(); })",
    )?;
    let mut inputs: Vec<[String; 2]> = Vec::new();
    for (name, _) in compiled_examples()? {
        let text = std::fs::read_to_string(examples_folder().join(name))?;
        for target in ["wgsl", "glsl-es", "spirv"] {
            inputs.push([text.clone(), json!({ "name": name, "target": target }).to_string()]);
        }
    }
    let broken = ["spere(1)", "sphere(1) +", "\u{0}\u{fffd}", "let a = a\na"];
    inputs.extend(broken.map(|text| [text.to_owned(), "{}".to_owned()]));
    inputs.push(["sphere(1)".to_owned(), json!({ "target": "cobol" }).to_string()]);
    for [source, options] in inputs {
        let expected = sdfc_web::compile(&source, &options);
        let found = session.chromium.apply(IS_SAME, &json!([source, options, expected]))?;
        if found != true {
            return Err(
                format!("{options}: {source:.200} compiles differently in the browser").into()
            );
        }
    }
    // Deep nesting results in a scene or an error, and the compiler works afterwards.
    let found = session.chromium.evaluate(DEEP)?;
    if found
        .as_array()
        .is_none_or(|found| found.iter().any(|text| text.as_str().is_none_or(str::is_empty)))
    {
        return Err(format!("deep nesting: {found}").into());
    }
    Ok(())
}

/// Compares in the browser, because JavaScript numbers do not keep the form in which they were
/// written. Strings must be the same to the byte. Numbers of the certificate may differ as much as
/// sines and powers of two math libraries. The SPIR-V writer numbers some ids in the order of a
/// hash map, which is different with 32-bit addresses: its words must be the same in some order.
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

/// Returns `scene` or the first error for each deeply nested source.
const DEEP: &str = "[100, 1000, 10000, 100000].flatMap(depth => [
    '('.repeat(depth) + 'sphere(1)' + ')'.repeat(depth),
    'sphere(1)' + '.round(0.001)'.repeat(depth),
    'sphere(1)' + ' | sphere(2)'.repeat(depth),
    'sphere(' + '-'.repeat(depth) + '1)',
]).concat('sphere(1)').map(source => {
    const { text, diagnostics } = compiler.compile(source);
    return text ? 'scene' : diagnostics[0].message;
})";
