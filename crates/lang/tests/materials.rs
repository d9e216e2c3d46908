//! The materials of surfaces.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{Dim, Expander, MaterialField, MaterialRule};
use support::elaborated;

const RED: [f64; 3] = [1.0, 0.0, 0.0];
const BLUE: [f64; 3] = [0.0, 0.0, 1.0];

/// The base colour of a scene at a point.
fn color(text: &str, at: [f64; 3]) -> [f64; 3] {
    let scene = elaborated(text).scene;
    let mut graph = scene.graph.clone();
    let point = graph.point(0, Dim::Three);
    let root = scene.root.expect("the scene draws something");
    let material = Expander::new().material(&mut graph, root, point).expect("it expands");
    let tape = Tape::new(&graph, &material[..1]).expect("the material is flat");
    let [r, g, b, _] = tape.prepare::<f64>(&FrameValues::defaults(&scene.params)).eval(at)[0];
    [r, g, b]
}

fn default_color() -> [f64; 3] {
    let [r, g, b, _] = MaterialField::Color.default_value();
    [r, g, b]
}

#[test]
fn an_empty_material_is_the_default_material() {
    assert_eq!(color("sphere(1).paint(material())", [1.0, 0.0, 0.0]), default_color());
}

#[test]
fn material_rules_exist_only_if_a_shape_has_a_material() {
    let has_rule = |text: &str| {
        let scene = elaborated(text).scene;
        let root = scene.graph.shape(scene.root.expect("the scene draws something"));
        root.material != MaterialRule::Weighted(root.formula)
    };
    assert!(has_rule("intersection(box(1).color(#f00), sphere(0.6))"));
    assert!(!has_rule("intersection(box(1), sphere(0.6))"));
}

#[test]
fn a_face_cut_by_a_shape_without_material_shows_the_body() {
    for blend in ["", ", blend: smooth(0.1)"] {
        // The ball has the larger distance at x = 0.5, the box at x = 0.8.
        let cut = |a: &str, b: &str, x: f64| {
            color(&format!("intersection({a}, {b}{blend})"), [x, 0.0, 0.0])
        };
        let (body, knife) = ("box(2)", "sphere(0.5)");
        let (red, blue) = (format!("{body}.color(#f00)"), format!("{knife}.color(#00f)"));
        assert_eq!(cut(&red, knife, 0.5), RED, "the cut face{blend}");
        assert_eq!(cut(&red, &blue, 0.5), BLUE, "a knife with a material{blend}");
        assert_eq!(
            cut(body, &blue, 0.5),
            BLUE,
            "a knife with a material and a body without{blend}"
        );
        assert_eq!(
            cut(knife, &red, 0.5),
            default_color(),
            "the first shape, without a material{blend}"
        );
        assert_eq!(cut(knife, body, 0.5), default_color(), "no materials{blend}");
        let carved = format!("difference({red}, {knife}{blend})");
        assert_eq!(color(&carved, [0.5, 0.0, 0.0]), RED, "a hole{blend}");
        let lined = format!("difference({red}, {blue}{blend})");
        assert_eq!(color(&lined, [0.5, 0.0, 0.0]), BLUE, "a lined hole{blend}");
    }
}
