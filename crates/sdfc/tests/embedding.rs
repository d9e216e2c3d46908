//! Any input of an embedding program gives a result or an error, and opens no file.
#![allow(missing_docs, clippy::panic, clippy::expect_used, reason = "a test fails by panicking")]

use std::sync::Mutex;

use proptest::prelude::*;
use sdfc::{
    Compiler, Diagnostics, Emit, Error, Field, FrameValues, Method, Resolver, Scene, ShaderOptions,
    Stage, Target, uniform_bytes,
};
use sdfc_lang::NoFiles;

const SCENE: &str = "param r = 1 in 0.5..2\nparam n: int = 3 in 1..9\nparam tilt = 10deg in \
                     0deg..45deg\nparam lid = true\nparam wood = #8a5a34\nparam style = \"round\" \
                     in [\"round\", \"flat\"]\nlet ball = if lid { sphere(r) } else { box(r) }\n\
                     ball.rotate(y: tilt).color(wood)\ntorus(major: n, minor: 0.1).translate(x: time)";

fn scene() -> Scene {
    Compiler::new().compile("a.sdf", SCENE).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Each step reads the last one twice, and a loop reads the last step.
#[test]
fn shared_values_outside_a_loop_are_looked_at_once() {
    let source = "param m = 0.5 in 0.4..0.6\nfn step(s: number, n: int) -> number = if n == 0 { s } \
                  else { step(s * (1 - s) * 3, n - 1) }\nlet k = step(m, 40)\npolygon([for i in 0..8: \
                  [3 + 0.1 * k * i, 0.05 * k * i * i]]).polar_repeat(18).extrude(8)";
    let scene =
        Compiler::new().compile("a.sdf", source).unwrap_or_else(|errors| panic!("{errors}"));
    let written = scene.write_shader(&ShaderOptions::new().emit(Emit::Field));
    assert!(written.is_ok(), "{:?}", written.err());
}

#[test]
fn threads_may_share_scenes() {
    fn shared<T: Send + Sync>() {}
    shared::<Scene>();
    shared::<Field<'_>>();
    shared::<Diagnostics>();
    shared::<Error>();
    shared::<sdfc::ParamError>();
    shared::<sdfc::Written>();
    shared::<sdfc::bind::Bindings>();
}

/// Returns random sequences of words that are likely to form a scene.
fn words() -> impl Strategy<Value = String> {
    const KNOWN: [&str; 30] = [
        "sphere",
        "(",
        ")",
        "1",
        "\n",
        "box",
        ",",
        ".",
        "param r = ",
        " in ",
        "0..1",
        "union",
        "|",
        "translate",
        "x: ",
        "p",
        "solid s() = ",
        "length(p)",
        "-",
        "for i in 0..9: ",
        "[",
        "]",
        "import a from \"b.sdf\"",
        "camera",
        "1e308",
        "if ",
        " { ",
        " } else { ",
        "color",
        "#f00",
    ];
    let word =
        prop_oneof![4 => prop::sample::select(&KNOWN[..]).prop_map(str::to_owned), 1 => ".{0,3}"];
    prop::collection::vec(word, 0..40).prop_map(|words| words.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_bytes_are_a_scene_or_errors(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        compiles_or_reports_errors(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn any_words_are_a_scene_or_errors(text in words()) {
        compiles_or_reports_errors(&text);
    }

    #[test]
    fn any_value_is_taken_or_refused(
        name in prop::sample::select(&["r", "n", "tilt", "lid", "wood", "style", "", "q"][..]),
        number in any::<f64>(),
        lanes in any::<[f64; 4]>(),
        text in ".{0,12}",
    ) {
        let scene = scene();
        let mut frame = scene.defaults();
        let _ = scene.set(&mut frame, name, number);
        let _ = scene.set(&mut frame, name, lanes);
        let _ = scene.set(&mut frame, name, text.as_str());
        let _ = scene.set_param(&mut frame, name, &text);
        // A value that was accepted is a number, and so is the field.
        prop_assert!(frame.params.as_flattened().iter().all(|lane| lane.is_finite()));
        let mut field = scene.field(&frame)?;
        prop_assert!(field.distance([0.1, 0.2, 0.3]).is_finite());
    }

    #[test]
    fn any_frame_gives_some_field(
        params in prop::collection::vec(any::<[f64; 4]>(), 0..9),
        time in any::<f64>(),
        point in any::<[f64; 3]>(),
    ) {
        let scene = scene();
        let frame = FrameValues { params, time, frame: time };
        let mut field = scene.field(&frame)?;
        let points = [point; 9];
        prop_assert_eq!(field.distances(&points).len(), 9);
        prop_assert_eq!(field.gradients(&points).len(), 9);
        prop_assert_eq!(field.materials(&points).len(), 9);
        let _ = scene.bounds_at(&frame);
        let written = scene.write_shader(&ShaderOptions::default())?;
        prop_assert_eq!(uniform_bytes(&written.reflection, &frame).len() % 16, 0);
    }

    #[test]
    fn any_names_and_places_are_taken_or_refused(
        prefix in ".{0,8}",
        group in any::<u32>(),
        binding in any::<u32>(),
        method in prop::option::of(prop::sample::select(Method::all().collect::<Vec<_>>())),
        target in prop::sample::select(&Target::ALL[..]),
        emit in prop::sample::select(&[Emit::Field, Emit::March, Emit::Render][..]),
        stage in prop::sample::select(&[Stage::Compute, Stage::Fragment][..]),
    ) {
        let options = ShaderOptions::new().target(target)
            .emit(emit)
            .stage(stage)
            .method(method)
            .prefix(prefix)
            .group(group)
            .binding(binding);
        let _ = scene().write_shader(&options);
    }
}

#[test]
fn a_batch_gives_the_same_values_as_its_points() -> Result<(), Error> {
    let scene = scene();
    let mut field = scene.field(&scene.defaults())?;
    let points: Vec<_> = (0..19).map(|i| [0.1 * f64::from(i), 0.3, -0.05 * f64::from(i)]).collect();
    let one_by_one: Vec<_> = points.iter().map(|&point| field.distance(point)).collect();
    assert_eq!(field.distances(&points), one_by_one);
    let one_by_one: Vec<_> = points.iter().map(|&point| field.gradient(point)).collect();
    assert_eq!(field.gradients(&points), one_by_one);
    assert_eq!(field.materials(&points).len(), points.len());
    Ok(())
}

fn compiles_or_reports_errors(text: &str) {
    match Compiler::new().compile("any.sdf", text) {
        Err(errors) => assert!(errors.has_errors()),
        Ok(scene) => {
            let _ = scene.distance([f64::NAN, f64::INFINITY, 0.0]);
            let _ = scene.gradient([1e300, 0.0, 0.0]);
            let _ = scene.material([0.0; 3]);
            let _ = scene.write_shader(&ShaderOptions::default());
        }
    }
}

/// Refuses all files, and records their paths.
#[derive(Default)]
struct Asked(Mutex<Vec<String>>);

impl Resolver for Asked {
    fn read(&self, path: &str) -> Result<String, String> {
        self.0.lock().expect("nothing panicked").push(path.to_owned());
        Err("no".to_owned())
    }
}

const READERS: [&str; 6] = [
    "import a from \"/etc/passwd\"\nsphere(1)",
    "import a from \"../secret.sdf\"\nsphere(1)",
    "import a from \"parts/../../secret.sdf\"\nsphere(1)",
    "import a from \"C:\\\\secret.sdf\"\nsphere(1)",
    "import a from \"parts/gear.sdf\"\nsphere(1)",
    "text(\"A\", font: \"parts/font.ttf\").extrude(1)",
];

#[test]
fn shapes_whose_end_depends_on_a_param_are_written_for_every_target() {
    let repeated = "param b = true\n(if b { sphere(0.5) } else { helix() }).repeat(spacing: 3)";
    let sheared = "param k = 1 in 0.5..2\n\
                   polar_repeat(ellipse([1, k]).extrude().shear(sin(time)))";
    for text in [repeated, sheared] {
        let scene = Compiler::new().compile("a.sdf", text).unwrap_or_else(|e| panic!("{e}"));
        // Shadertoy has pictures only.
        for target in Target::ALL.into_iter().filter(|target| *target != Target::Shadertoy) {
            let options = ShaderOptions::new().target(target).emit(Emit::Field);
            scene.write_shader(&options).unwrap_or_else(|e| panic!("{}: {e}", target.name()));
        }
    }
}

#[test]
fn a_scene_reads_no_file_unless_its_resolver_does() {
    for text in READERS {
        // These files exist in the repository, so a file access would succeed.
        let compiler = Compiler::new().resolver(&NoFiles);
        assert!(compiler.compile("crates/sdfc/a.sdf", text).is_err(), "{text}");
        assert!(Compiler::new().compile("a.sdf", text).is_err(), "{text}");
    }
}

struct Storeys;

impl Resolver for Storeys {
    fn read(&self, _: &str) -> Result<String, String> {
        Ok("param width = 1 in 0.5..3\nfn storey() = box(width)\n".to_owned())
    }
}

#[test]
fn params_of_files_with_the_same_name_are_set_and_reflected_one_by_one() {
    let text = "import storey from \"house/storey.sdf\"\nimport storey as tower from \
                \"tower/storey.sdf\"\nstorey()\ntower().translate(x: 5)";
    let compiler = Compiler::new().resolver(&Storeys);
    let scene = compiler.compile("a.sdf", text).unwrap_or_else(|e| panic!("{e}"));
    let mut frame = scene.defaults();
    scene.set_param(&mut frame, "tower/storey.width", "2").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!([frame.params[0][0], frame.params[1][0]], [1.0, 2.0]);
    for (name, help) in [
        ("storey.width", "write `house/storey.width` or `tower/storey.width`"),
        ("width", "write `house/storey.width` or `tower/storey.width`"),
        ("house/storey.widht", "did you mean `house/storey.width`?"),
    ] {
        let error = scene.set_param(&mut frame, name, "2").expect_err("unknown");
        assert_eq!(error.to_string(), format!("the scene has no param `{name}`; {help}"));
    }
    let options = ShaderOptions::new();
    let written = scene.write_shader(&options).unwrap_or_else(|e| panic!("{e}"));
    let reflected = scene.reflect(&options, &written).params;
    let names: Vec<[&str; 2]> =
        reflected.iter().map(|row| [row.name.as_str(), row.param.as_str()]).collect();
    let [house, tower] = ["house", "tower"]
        .map(|folder| [format!("{folder}_storey_width"), format!("{folder}/storey.width")]);
    assert_eq!(names, [house.each_ref().map(String::as_str), tower.each_ref().map(String::as_str)]);
}

#[test]
fn a_resolver_is_asked_for_nothing_outside_the_folder_of_the_scene() {
    let asked = Asked::default();
    for text in READERS {
        let compiler = Compiler::new().resolver(&asked);
        assert!(compiler.compile("a.sdf", text).is_err(), "{text}");
    }
    assert_eq!(
        asked.0.into_inner().expect("nothing panicked"),
        ["parts/gear.sdf", "parts/font.ttf"]
    );
}
