//! The bounding box of a scene, as nodes that are evaluated for each frame.

use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{Graph, NodeId, Scene, bounds};

/// Lowest and highest corner of everything that is drawn, in a graph of their own.
#[derive(Debug)]
pub(crate) struct DerivedBounds {
    graph: Graph,
    corners: [NodeId; 2],
}

impl DerivedBounds {
    /// Derives the bounds of a scene, or returns `None` if it draws nothing.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let root = scene.root?;
        let mut extract = scene.graph.extract(&[], &[root]);
        let root = extract.shape(root)?;
        let corners = bounds(&mut extract.graph, root, &scene.params);
        Some(Self { graph: extract.graph, corners })
    }

    /// Derives the corners of a scene at one frame alone. They may be tighter than those that hold
    /// for all values of the params.
    pub(crate) fn at_one_frame(scene: &Scene, frame: &FrameValues) -> Option<[[f64; 3]; 2]> {
        let (mut graph, root) = scene.shapes_at(frame)?;
        let corners = bounds(&mut graph, root, &[]);
        Self { graph, corners }.at(frame)
    }

    /// Returns the corners at a frame, infinite where the scene has no limit.
    pub(crate) fn at(&self, frame: &FrameValues) -> Option<[[f64; 3]; 2]> {
        let values = evaluate_frame(&self.graph, &self.corners, frame);
        let corner = |lanes: &[f64; 4]| [lanes[0], lanes[1], lanes[2]];
        Some([corner(values.first()?), corner(values.get(1)?)])
    }
}
