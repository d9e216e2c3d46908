//! The browser's shader compilers accept every shader: Tint behind WebGPU, ANGLE's translator
//! behind WebGL 2.

use libtest_mimic::Failed;
use sdfc::{Code, Emit, ShaderOptions, Stage, Target};
use sdfc_tests::compiled_examples;
use serde_json::{Value, json};

use crate::Session;

const COMPILERS: &str = include_str!("compiles.js");
const SHADERTOY: &str = include_str!("../targets/shadertoy.glsl");

/// Compiles every part of every example.
pub fn every_example(session: &mut Session, target: Target) -> Result<(), Failed> {
    let mut shaders = Vec::new();
    for (name, scene) in compiled_examples()? {
        for (emit, stage) in PARTS {
            let options = ShaderOptions::new().target(target).emit(emit).stage(stage);
            // `tests/targets` lists the parts that a target does not support.
            let Ok(written) = scene.write_shader(&options) else { continue };
            let Code::Text(text) = written.code else { continue };
            let head = if target == Target::Shadertoy { SHADERTOY } else { "" };
            let label = format!("{name}, {emit:?}, {stage:?}");
            shaders.push(json!({ "label": label, "text": format!("{head}{text}") }));
        }
    }
    let compiler = if target == Target::Wgsl { "wgsl" } else { "glsl_es" };
    session.server.put("blank.html", Vec::new());
    session.chromium.open(&session.server.url("blank.html"), [100, 100])?;
    let function = format!("shaders => {{ {COMPILERS}\n return {compiler}(shaders); }}");
    let wrong = session.chromium.apply(&function, &Value::Array(shaders))?;
    let wrong = wrong.as_array().ok_or("no answer")?;
    if wrong.is_empty() { Ok(()) } else { Err(format!("{wrong:#?}").into()) }
}

const PARTS: [(Emit, Stage); 4] = [
    (Emit::Field, Stage::Compute),
    (Emit::March, Stage::Compute),
    (Emit::Render, Stage::Compute),
    (Emit::Render, Stage::Fragment),
];
