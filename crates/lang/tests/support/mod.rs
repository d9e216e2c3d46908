//! Scenes in tests: from source to a field that can be evaluated.
#![allow(dead_code, unused_macros, unused_imports, reason = "each test binary uses its part")]

use sdfc_diagnostics::{Diagnostic, Sources, render};
use sdfc_graph::eval::{Evaluator, FrameValues, Tape};
use sdfc_graph::{Dim, Expander, Graph, NodeId, Scene, Shape, ShapeId};
use sdfc_lang::Elaborated;

/// Compares a text with the snapshot of the test's name.
macro_rules! snapshot {
    ($text:expr) => {
        insta::with_settings!({ omit_expression => true }, {
            insta::assert_snapshot!($text)
        })
    };
}
pub(crate) use snapshot;

/// The scene, or a panic that shows its diagnostics.
pub fn elaborated(text: &str) -> Elaborated {
    let (sources, scene, found) = front(text);
    scene.unwrap_or_else(|| panic!("{text}\n{}", render(&sources, &found, false)))
}

/// The result of the front end.
pub fn front(text: &str) -> (Sources, Option<Elaborated>, Vec<Diagnostic>) {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    let (scene, found) = sdfc_lang::front(&mut sources, file);
    (sources, scene, found)
}

/// A scene with its rendered diagnostics.
pub fn findings(text: &str) -> String {
    let (sources, _, found) = front(text);
    format!("{}\n\n{}", text.trim_end(), render(&sources, &found, false))
}

/// The shape that the scene draws.
pub fn root(scene: &Scene) -> &Shape {
    scene.graph.shape(scene.root.expect("the scene draws something"))
}

/// The shape's expanded distance at the scene's point; for a region at its x and y.
pub fn flat(graph: &mut Graph, shape: ShapeId) -> NodeId {
    let point = graph.point(0, Dim::Three);
    let point = match graph.shape(shape).dim {
        Dim::Three => point,
        Dim::Two => graph.swizzle(point, &[0, 1]),
    };
    Expander::new().field(graph, shape, point).expect("the shape expands")
}

/// A field in f64 with the params at their defaults.
pub struct Field {
    tape: Tape,
    frame: FrameValues,
}

impl Field {
    pub fn of(scene: &Scene, shape: ShapeId) -> Self {
        let mut graph = scene.graph.clone();
        let distance = flat(&mut graph, shape);
        let tape = Tape::new(&graph, &[distance]).expect("the field is flat");
        Self { tape, frame: FrameValues::defaults(&scene.params) }
    }

    /// The field of a whole scene.
    pub fn drawn(text: &str) -> Self {
        let scene = elaborated(text).scene;
        Self::of(&scene, scene.root.expect("the scene draws something"))
    }

    pub fn evaluator(&self) -> Evaluator<'_, f64> {
        self.tape.prepare(&self.frame)
    }

    pub fn at(&self, point: [f64; 3]) -> f64 {
        self.evaluator().scalar(point)
    }
}
