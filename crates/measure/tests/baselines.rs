//! The interpreting baselines draw the same picture as the specialised shader, and report what they
//! cannot draw. At 64x64, depths agree within 1e-3 outside edges.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Compiler, FrameValues, LoopStrategy, Method, Scene};
use sdfc_codegen::{FieldSource, benchmark_module};
use sdfc_measure::baseline::{Encoded, Inexpressible, tape, units};
use sdfc_measure::{BenchOptions, bench, suite};
use sdfc_render::{
    Gpu, Image, Pipeline, RenderOptions, View, compare, no_progress, testing, uniform_values,
};

/// Width and height in pixels.
const SIDE: u32 = 64;
/// Largest difference of depth outside edges, in scene units.
const DEPTH: f32 = 1e-3;

/// A view with a tolerance so small that one step more or less changes no depth by `DEPTH`.
const VIEW: &str = "
camera(eye: [3, 2.5, 4], target: 0, fov: 40deg)
sun(direction: [1, 2, 1], shadow: hard)
march(steps: 255, epsilon: 0.0002)
";

/// Scenes for both baselines: every operation and primitive, params, wrappers, single primitives.
const BOTH: [(&str, &str); 4] = [
    ("blend", include_str!("../../../examples/course/blend.sdf")),
    (
        "operations",
        "plane(y: -0.6, normal: [0.2, 1, 0.1])
difference(box([1, 1.2, 0.8]).translate(x: -1), sphere(0.5).translate([-0.7, 0.4, 0.3]))
sphere(0.6) & box(0.9).translate(z: 0.3)
union(sphere(0.4), box(0.5).translate(y: 0.4), blend: smooth(0.3)).translate(x: 1.2)
sphere(0.2).translate(y: 1.1)",
    ),
    (
        "param",
        "param k = 0.3 in 0.1..0.5
union(sphere(k).translate(x: k), box(0.6), blend: smooth(k)).color(#d94f30)",
    ),
    (
        "own operator",
        "shape carve(a: shape, b: shape) = max(a(p), -b(p))
carve(box(1), sphere(0.65))",
    ),
];

/// Scenes that the stack machine can express and units cannot.
const TAPE_ALONE: [(&str, &str, &str); 5] = [
    (
        "conditions",
        "solid steps() lipschitz 1 = if p.x > 0.1 || p.y < 0 { max(p.y, length(p) - 0.8) } \
         else { if p.z <= 0 { length(p) - 0.7 } else { length(p) - 0.6 } }
steps()",
        "`steps` is not a plane, sphere, box",
    ),
    ("torus", "torus(major: 0.8, minor: 0.2)", "`torus` is not a plane, sphere, box"),
    (
        "nested",
        "difference(box(1) & sphere(0.7), sphere(0.4).translate(x: 0.5))",
        "here one is `intersection`",
    ),
    (
        "chain",
        "union(sphere(0.4), box(0.5).translate(x: 0.6), sphere(0.4).translate(z: 0.6), blend: smooth(0.3))",
        "`union` of 3",
    ),
    (
        "rotated",
        "param a = 30deg in 0deg..90deg
box([1, 0.4, 0.6]).rotate(y: a).twist(40deg)",
        "is not",
    ),
];

fn main() {
    let without_gpu = testing::without_gpu();
    let mut trials = vec![
        Trial::test("units report what they cannot express", units_report_what_they_cannot_express),
        Trial::test(
            "the tape reports what it cannot express",
            the_tape_reports_what_it_cannot_express,
        ),
        Trial::test("tables are those made by hand", tables_are_those_made_by_hand),
        Trial::test("many leaves need few locals", many_leaves_need_few_locals),
    ];
    let texts = BOTH.map(|(name, text)| (name, text, true));
    let alone = TAPE_ALONE.map(|(name, text, _)| (name, text, false));
    for (name, text, in_units) in texts.into_iter().chain(alone) {
        if in_units {
            let draw = move || same_picture(text, FieldSource::Units);
            trials.push(Trial::test(format!("units/{name}"), draw).with_ignored_flag(without_gpu));
        }
        let draw = move || same_picture(text, FieldSource::Tape);
        trials.push(Trial::test(format!("tape/{name}"), draw).with_ignored_flag(without_gpu));
    }
    let rows = Trial::test("a row has metrics or reasons", a_row_has_metrics_or_reasons);
    trials.push(rows.with_ignored_flag(without_gpu));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn scene(text: &str) -> Scene {
    let view = if text.contains("camera(") { "" } else { VIEW };
    // The tape cannot express loops.
    let compiler = Compiler::new().loops(LoopStrategy::Unrolled);
    compiler.compile("test.sdf", &format!("{text}{view}")).expect("compiles")
}

fn in_units(scene: &Scene) -> Result<Encoded, Inexpressible> {
    units(scene.graph(), &FrameValues::defaults(scene.params()))
}

fn on_tape(scene: &Scene) -> Result<Encoded, Inexpressible> {
    let frame = FrameValues::defaults(scene.params());
    tape(scene.program(), scene.report().leaves, &frame)
}

fn picture(scene: &Scene, field: FieldSource) -> Result<Image, Failed> {
    let (gpu, frame) = (Gpu::new()?, FrameValues::defaults(scene.params()));
    let mut view = View::new(scene.program(), &frame, scene.bounds_at(&frame), [SIDE; 2])?;
    view.epsilon = 2e-4;
    let uniforms = uniform_values(scene.program(), &frame);
    let (tables, uniforms) = match field {
        FieldSource::Scene | FieldSource::Distance => (Vec::new(), uniforms),
        FieldSource::Units => (in_units(scene).map_err(|e| e.0)?.tables, Vec::new()),
        FieldSource::Tape => (on_tape(scene).map_err(|e| e.0)?.tables, Vec::new()),
    };
    let shader = benchmark_module(scene.program(), Method::Sphere, field)?;
    let pipeline = Pipeline::with_tables(&gpu, shader, uniforms.len(), &tables)?;
    Ok(pipeline.render(&view, &uniforms, &RenderOptions::default(), &mut no_progress)?.image)
}

fn same_picture(text: &str, field: FieldSource) -> Result<(), Failed> {
    let scene = scene(text);
    let (interpreted, expected) =
        (picture(&scene, field)?, picture(&scene, FieldSource::Distance)?);
    let found = compare(&interpreted, &expected).ok_or("the sizes differ")?;
    let few = expected.counts().hit < 100;
    if few || found.depth > DEPTH || found.status > 0 || found.color > 2 {
        return Err(format!("{found:?}, {:?}", expected.counts()).into());
    }
    // Differences give the same normals as the derivative.
    let derived = picture(&scene, FieldSource::Scene)?;
    let found = compare(&expected, &derived).ok_or("the sizes differ")?;
    if scene.program().material.is_none() && found.mean_color > 1.0 {
        return Err(format!("normals by differences: {found:?}").into());
    }
    Ok(())
}

fn units_report_what_they_cannot_express() -> Result<(), Failed> {
    for (name, text, reason) in TAPE_ALONE {
        match in_units(&scene(text)) {
            Err(Inexpressible(said)) if said.contains(reason) => {}
            other => return Err(format!("{name}: {other:?}").into()),
        }
    }
    Ok(())
}

fn the_tape_reports_what_it_cannot_express() -> Result<(), Failed> {
    let exponential = scene("solid wave() lipschitz 1 = p.y - 0.1 * exp(sin(p.x))\nwave()");
    let said = on_tape(&exponential).unwrap_err().0;
    if said != "the tape's machine has no `exp`" {
        return Err(said.into());
    }
    Ok(())
}

/// A plane, and a blended ball and box, are two units.
fn tables_are_those_made_by_hand() -> Result<(), Failed> {
    let scene = scene(
        "plane(y: -0.5)\nunion(sphere(0.25), box([1, 2, 3]).translate(x: 4), blend: smooth(0.5))",
    );
    let encoded = in_units(&scene).unwrap();
    let words = |table: &[u8]| -> Vec<u32> {
        let words = table.chunks_exact(4).map(|word| u32::from_ne_bytes(word.try_into().unwrap()));
        words.collect()
    };
    let floats =
        |table: &[u8]| -> Vec<f32> { words(table).into_iter().map(f32::from_bits).collect() };
    let [units, planes, spheres, boxes] = &encoded.tables[..] else {
        return Err("four tables".into());
    };
    let width = 0.5f32.to_bits();
    let one = 1f32.to_bits();
    assert_eq!(words(units), [1, 0, 2, 0, 3, width, 0, 0, 0, 0, 0, 0, 0, one, 0, 0]);
    assert_eq!(floats(planes)[..4], [0.0, 1.0, 0.0, -0.5]);
    assert_eq!(floats(spheres)[..4], [0.0, 0.0, 0.0, 0.25]);
    assert_eq!(floats(boxes), [4.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.5, 0.0]);
    assert_eq!((encoded.iterations, encoded.leaves), (2, 4));
    Ok(())
}

/// The stack and the locals suffice for scenes of many leaves, joined in a chain or side by side.
fn many_leaves_need_few_locals() -> Result<(), Failed> {
    for (name, text) in suite() {
        let scene = scene(&text);
        let encoded = on_tape(&scene).map_err(|e| format!("{name}: {}", e.0))?;
        let most = 23 * scene.report().leaves;
        if encoded.iterations > most {
            return Err(format!("{name}: {} iterations, over {most}", encoded.iterations).into());
        }
    }
    Ok(())
}

fn a_row_has_metrics_or_reasons() -> Result<(), Failed> {
    let options = BenchOptions::new().size([32, 24]).repetitions(2);
    let text = format!("torus(major: 0.8, minor: 0.2){VIEW}");
    let torus = scene(&text);
    let moving = Compiler::new().live_literals(None).compile("test.sdf", &text)?;
    let gpu = Gpu::new()?;
    let row = bench(&torus, Ok(&moving), "torus", &gpu, &options, &mut no_progress)?;
    let names: Vec<_> = row.variants.iter().map(|variant| variant.name).collect();
    assert_eq!(names, ["units", "tape", "specialized", "live-literals", "loops", "culled"]);
    let [units, tape, specialized, live, looped, culled] = &row.variants[..] else {
        unreachable!()
    };
    assert!(units.frame_ms.is_none() && units.why.contains_key("frame_ms"));
    for drawn in [tape, specialized, live] {
        assert_eq!(drawn.frame_ms.map(|times| times.n), Some(2), "{drawn:?}");
        assert_eq!(drawn.differing_pixels, Some(0));
        assert_eq!(drawn.cpu_ms.is_some(), gpu.info().software);
        assert!(drawn.evals_per_pixel.unwrap().mean > 1.0);
    }
    assert!([looped, culled].iter().all(|none| none.why["frame_ms"].contains("similar")));
    assert_eq!((row.auto, specialized.times_specialized), ("specialized", Some(1.0)));
    assert!(live.live_literals.is_some_and(|count| count >= 2), "{:?}", live.live_literals);
    // No literal of this scene can become live.
    let row = bench(&torus, Ok(&torus), "torus", &gpu, &options, &mut no_progress)?;
    assert!(row.variants[3].why["frame_ms"].contains("no number"), "{:?}", row.variants[3]);
    Ok(())
}
