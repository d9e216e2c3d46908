//! Params that decide what a scene consists of are constants of the compiled scene. Compiling with
//! a value gives the scene whose source states that value.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{Code, CompileValues, CompileWithError, Compiler, Emit, ParamError, Scene};
use sdfc::{ShaderOptions, Target};

/// Scenes in which `n` decides what is built. `N` stands for its default.
const SCENES: [&str; 9] = [
    "param n: int = N in 3..16\nsphere(0.1).translate(x: 1.22).polar_repeat(n)",
    "param n: int = N in 3..16\nparam r = 0.1 in 0.05..0.3\nsphere(r).translate(x: 1.2).polar_repeat(n)",
    "param n: int = N in 1..9\nparam r = 0.1\nunion(for i in 0..n: sphere(r).translate(x: i))",
    "param n: int = N in 1..9\nlet radii = [for i in 1..10: 0.1 * i]\n\
     union(for r in radii[0..n]: sphere(r).translate(x: 4 * r))",
    "param n: int = N in 0..5\nlet parts = [sphere(1), box(1), torus(), cone(), capsule(), sphere(2)]\n\
     parts[n]",
    "param n: int = N in 0..5\nfn tree(n: int) -> solid = if n == 0 { sphere(0.2) } else {\n\
     capsule([0, 0, 0], [0, 1, 0], r: 0.1) | tree(n - 1).rotate(z: 20deg).translate(y: 1)\n}\ntree(n)",
    "param n: int = N in 1..9\nparam r = 0.2\n\
     fn row(n: int) -> [solid] = if n > 3 { [sphere(r)] } else { [sphere(r), box(r)] }\nunion(row(n))",
    "param n: int = N\nfn all(k: int) -> bool = k == 0 || k < 4 && all(k - 1)\n\
     if all(n) { sphere(1) } else { box(1) }",
    "param n: int = N in 1..9\nparam m: int = n in 0..20\n\
     union(for i in 0..m: sphere(0.1).translate(x: i))",
];

fn scene_with_default(text: &str, default: u32) -> String {
    text.replace('N', &default.to_string())
}

fn compiled(text: &str) -> Scene {
    Compiler::new().compile("a.sdf", text).unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

/// The shader of a picture without its first line, which names the source.
fn shader(scene: &Scene) -> String {
    let options = ShaderOptions::new().target(Target::Wgsl).emit(Emit::Render);
    let Code::Text(text) = scene.write_shader(&options).unwrap().code else { unreachable!() };
    text.split_once('\n').unwrap().1.to_owned()
}

#[test]
fn a_value_gives_the_scene_whose_source_states_it() {
    for text in SCENES {
        let plain = scene_with_default(text, 4);
        assert!(compiled(&plain).is_fixed("n"), "{text}");
        for value in [3, 5] {
            let expected = compiled(&scene_with_default(text, value));
            let set = Compiler::new().compile_with("a.sdf", &plain, &[("n", &value.to_string())]);
            assert!(shader(&set.unwrap()) == shader(&expected), "{text} with {value}");
        }
        let other = shader(&compiled(&scene_with_default(text, 3)));
        assert!(shader(&compiled(&plain)) != other, "{text}: `n` has no effect");
    }
}

#[test]
fn live_literals_do_not_change_which_params_are_fixed() {
    for text in SCENES {
        let text = scene_with_default(text, 4);
        let compiler = Compiler::new().live_literals(None);
        let live = compiler.compile("a.sdf", &text).unwrap();
        assert!(live.is_fixed("n"), "{text}");
        let values = CompileValues::from([("n".to_owned(), [5.0, 0.0, 0.0, 0.0])]);
        let live = compiler.values(&values).compile("a.sdf", &text).unwrap();
        let plain = Compiler::new().values(&values).compile("a.sdf", &text).unwrap();
        for i in 0..50 {
            let point = [0.0, 1.0, 2.0].map(|axis| 3.0 * (f64::from(i) * (1.7 + axis)).sin());
            let [live, plain] = [&live, &plain].map(|scene| scene.distance(point).unwrap());
            assert!((live - plain).abs() < 1e-12, "{text} at {point:?}: {live}, {plain}");
        }
    }
}

#[test]
fn other_params_stay_per_frame_inputs() {
    let text = "param n: int = 3 in 1..9\nparam r = 0.5 in 0..1\nparam lid = true\n\
                union(for i in 0..n: sphere(r).translate(x: 4 * i))\n\
                if lid { box(0.1) } else { sphere(0.1) }";
    let scene = compiled(text);
    let fixed: Vec<bool> = ["n", "r", "lid"].map(|name| scene.is_fixed(name)).into();
    assert_eq!(fixed, [true, false, false]);
    let stages: Vec<&str> =
        scene.explain().unwrap().inputs.iter().map(|input| input.stage).collect();
    assert_eq!(stages, ["compile", "frame", "frame"]);
    let written = scene.write_shader(&ShaderOptions::new()).unwrap();
    let found = scene.reflect(&ShaderOptions::new(), &written);
    let uniform: Vec<&str> = found.params.iter().map(|row| row.param.as_str()).collect();
    assert_eq!(uniform, ["r", "lid"]);
    let [row] = &found.fixed_params[..] else { panic!("{:?}", found.fixed_params) };
    assert_eq!((row.param.as_str(), row.kind, &row.value[..]), ("n", "int", &[3.0][..]));
    assert_eq!((row.min, row.max), (Some(1.0), Some(9.0)));

    let set = [("r", "0.25"), ("n", "4"), ("lid", "false")];
    let scene = Compiler::new().compile_with("a.sdf", text, &set).unwrap();
    assert_eq!(scene.distance([12.0, 0.0, 0.0]).unwrap(), -0.25);
    assert_eq!(scene.defaults().params[1][0], 0.25);
}

#[test]
fn a_fixed_param_is_refused_in_a_frame_and_checked_by_the_compiler() {
    let text = "param n: int = 3 in 1..9\nunion(for i in 0..n: sphere(1).translate(x: i))";
    let scene = compiled(text);
    let mut frame = scene.defaults();
    assert_eq!(scene.set(&mut frame, "n", 3), Ok(()));
    let refused = scene.set(&mut frame, "n", 4);
    assert_eq!(refused, Err(ParamError::Fixed { name: "n".to_owned() }));
    for (value, part) in [("10", "takes 1..9"), ("2.5", "an integer"), ("x", "an integer")] {
        let error = Compiler::new().compile_with("a.sdf", text, &[("n", value)]).unwrap_err();
        assert!(matches!(error, CompileWithError::Param(_)), "{error}");
        assert!(error.to_string().contains(part), "{error}");
    }
    let values = |n| CompileValues::from([("n".to_owned(), [n, 0.0, 0.0, 0.0])]);
    let takes_compilation = [3.0, 4.0, 10.0, 2.5].map(|value| scene.needs_compile(&values(value)));
    assert_eq!(takes_compilation, [false, true, false, false]);
}

#[test]
fn values_that_are_invalid_together_are_errors_of_the_scene() {
    let text = "param n: int = 3 in 0..9\n\
                union([for i in 0..n: sphere(1).translate(x: i)][0..2])";
    assert!(Compiler::new().check("a.sdf", text).is_empty());
    let error = Compiler::new().compile_with("a.sdf", text, &[("n", "1")]).unwrap_err();
    assert!(matches!(error, CompileWithError::Scene(_)), "{error}");
    assert!(error.to_string().contains("slice 0..2 is outside 0..1"), "{error}");
}

#[test]
fn values_fix_a_scene_that_is_wrong_with_its_defaults() {
    let text = "param n: int = 1 in 0..9\nparam r = 0.5 in 0..1\n\
                union([for i in 0..n: sphere(r).translate(x: 4 * i)][0..2])";
    assert!(Compiler::new().check("a.sdf", text).has_errors());
    let set = [("n", "3"), ("r", "0.25")];
    let scene = Compiler::new().compile_with("a.sdf", text, &set).unwrap();
    assert_eq!(scene.distance([4.0, 0.0, 0.0]).unwrap(), -0.25);
    let error = Compiler::new().compile_with("a.sdf", text, &[("r", "0.25")]).unwrap_err();
    assert!(error.to_string().contains("slice 0..2 is outside 0..1"), "{error}");
}

#[test]
fn a_choice_can_be_the_words_of_a_text() {
    let text = "param word = \"i\" in [\"i\", \"long\"]\ntext(word).extrude(0.2)";
    let width = |set: &[(&str, &str)]| {
        let scene = Compiler::new().compile_with("a.sdf", text, set).unwrap();
        let [lo, hi] = scene.bounds_at(&scene.defaults()).unwrap();
        hi[0] - lo[0]
    };
    assert!(width(&[("word", "long")]) > 3.0 * width(&[]));
}

#[test]
fn a_param_without_a_range_gets_one_that_fits_its_default() {
    let range = |param: &str| compiled(&format!("param a{param}\nsphere(1)")).params()[0].range;
    assert_eq!(range(" = 0.5"), Some([0.0, 1.0]));
    assert_eq!(range(" = -2"), Some([-4.0, 0.0]));
    assert_eq!(range(" = 0"), Some([-1.0, 1.0]));
    assert_eq!(range(": int = 8"), Some([1.0, 16.0]));
    assert_eq!(range(": int = -3"), Some([-6.0, 0.0]));
    assert_eq!(range(": int = 0"), Some([-10.0, 10.0]));
    assert_eq!(range(" = 0deg"), Some([-std::f64::consts::PI, std::f64::consts::PI]));
    assert_eq!(range(" = true"), None);
    assert_eq!(range(" = 3 in 0..inf"), Some([0.0, f64::INFINITY]));
}
