//! Outlines and paths of many pieces have two formulas of one distance. The shaders of pictures
//! find the pieces of an outline by cells and those of a path by balls around them. Everything else
//! has a formula with bounds.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use sdfc::{Compiler, FrameValues, Scene};
use sdfc_analyze::certain_operations;
use sdfc_graph::eval::Tape;
use sdfc_graph::{Binary, FormulaChoice, Node, Program, reachable};

/// Points for each scene and reach.
const POINTS: u32 = 400;
/// Half the sides of cubes of points, in scene units. Outlines are about one unit large.
const REACHES: [f64; 5] = [0.6, 1.5, 8.0, 300.0, 1e5];
/// Error of a distance and of a slope, as a fraction of the reach.
const PRECISION: f64 = 1e-12;

const SCENES: [&str; 9] = [
    "text(\"8\")",
    "text(\"Ag&% fi\", size: 0.3, align: \"center\")",
    "text(\"I\")",
    "param size = 0.5 in 0.1..1\ntext(\"two\\nlines\", size: size)",
    "polygon([for i in 0..90: (0.5 + 0.3 * cos(7 * i)) * [cos(i * 4deg), sin(i * 4deg)]])",
    "circle(0.05).sweep([for i in 0..9: 0.4 * [cos(i), sin(i), 0.3 * i - 1]])",
    "rect([0.1, 0.04]).sweep([for i in 0..30: 0.4 * [cos(i * 0.4), sin(i * 0.4), 0.1 * i - 1]])",
    "polygon([[-0.1, 0], [0, -0.1], [0.1, 0], [0, -0.03]])
      .sweep([for i in 0..9: 0.4 * [cos(i), sin(i), 0.3 * i - 1]])",
    "param bend: number = 1 in 0.8..1.2
     circle(0.05).sweep([for i in 0..9: 0.4 * [cos(bend * i), sin(bend * i), 0.3 * i - 1]])",
];

fn compiled(source: &str) -> Scene {
    Compiler::new().compile("scene", source).expect("the scene compiles")
}

fn has_alternative(program: &Program) -> bool {
    let is_alternative =
        |id| matches!(program.graph.node(id), Node::Binary(Binary::Alternative, ..));
    reachable(&program.graph, &program.roots()).into_iter().any(is_alternative)
}

/// The distance and its gradient at some points.
fn values(program: &Program, points: &[[f64; 3]]) -> Vec<[f64; 4]> {
    let roots = [program.distance.expect("a distance"), program.gradient.expect("a gradient")];
    let tape = Tape::new(&program.graph, &roots).expect("flat math");
    let mut evaluator = tape.prepare::<f64>(&FrameValues::defaults(&program.params));
    let value = |&point: &[f64; 3]| {
        let lanes = evaluator.eval(point);
        [lanes[0][0], lanes[1][0], lanes[1][1], lanes[1][2]]
    };
    points.iter().map(value).collect()
}

/// Points that are spread evenly in a cube around the origin.
fn points(reach: f64) -> Vec<[f64; 3]> {
    let steps = [0.754_877_666_246_693, 0.569_840_290_998_053, 0.819_172_513_396_164];
    let at = |i: u32| steps.map(|step| reach * (2.0 * (step * f64::from(i)).fract() - 1.0));
    (0..POINTS).map(at).collect()
}

#[test]
fn both_formulas_have_the_same_distance_and_gradient() {
    for source in SCENES {
        let scene = compiled(source);
        let program = scene.program();
        assert!(has_alternative(program), "{source} has one formula");
        let [short, bounded] = [FormulaChoice::Short, FormulaChoice::Bounded]
            .map(|choice| program.by_formulas(choice));
        for program in [&short, &bounded] {
            assert!(!has_alternative(program), "{source}: a choice is left");
        }
        assert_ne!(short.distance, bounded.distance, "{source}");
        for reach in REACHES {
            let points = points(reach);
            let both = values(&short, &points).into_iter().zip(values(&bounded, &points));
            for (point, (short, bounded)) in points.iter().zip(both) {
                let apart = short.iter().zip(bounded).map(|(a, b)| (a - b).abs());
                let apart = apart.fold(0.0, f64::max);
                assert!(
                    apart <= PRECISION * reach.max(1.0),
                    "{source} at {point:?}: {short:?} by the short formula, {bounded:?} by the other"
                );
            }
        }
    }
}

#[test]
fn evaluators_take_the_formula_with_bounds() {
    for source in SCENES {
        let scene = compiled(source);
        let program = scene.program();
        let bounded = program.by_formulas(FormulaChoice::Bounded);
        let operations = |program: &Program| {
            let distance = program.distance.expect("a distance");
            Tape::new(&program.graph, &[distance]).expect("flat math").operations()
        };
        assert_eq!(operations(program), operations(&bounded), "{source}");
    }
}

#[test]
fn other_scenes_have_one_formula() {
    let scene = compiled("sphere(1)\npolygon([[0, 0], [1, 0], [0, 1], [0.2, 0.2]]).extrude(1)");
    assert!(!has_alternative(scene.program()));
}

/// `--backend auto` takes the CPU for formulas of many operations that run at every point.
#[test]
fn loops_that_end_early_are_not_certain_to_run() {
    let operations = |source: &str| {
        let scene = compiled(source);
        let field = scene.program().marched_field().expect("a field");
        let certain = certain_operations(&scene.program().graph, &[field]);
        (certain, scene.report().marched_cost.operations)
    };
    let (certain, all) = operations("text(\"8\").extrude(0.2)");
    assert!(certain > 0 && 10 * certain < all, "{certain} of {all}");
    // The loop over the corners of this star has no condition.
    let star = "polygon([for i in 0..24: (1 + i % 2) * [cos(i * 15deg), sin(i * 15deg)]])";
    let (certain, all) = operations(&format!("{star}.extrude(0.2)"));
    assert_eq!(certain, all);
}
