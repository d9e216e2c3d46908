//! The guarantees of a part's field about the distance.

use std::collections::HashSet;

use sdfc::Scene;
use sdfc_analyze::Promise;
use sdfc_graph::ShapeId;

/// The guarantee of a field outside its shape, from best to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DistanceQuality {
    /// The field is the exact distance.
    Exact,
    /// The field never exceeds the distance.
    Bound,
    /// The field, or a part of it, is divided by a constant so that it never exceeds the distance.
    Scaled,
    /// The field may exceed the distance: rays may step through the surface.
    Uncertified,
}

impl DistanceQuality {
    /// The quality of a part, which takes every shape below it into account.
    pub fn of(scene: &Scene, part: ShapeId) -> Self {
        let (report, graph) = (scene.report(), &scene.graph().graph);
        let (mut below, mut next) = (HashSet::from([part]), vec![part]);
        while let Some(shape) = next.pop() {
            next.extend(graph.shape(shape).children.iter().filter(|child| below.insert(**child)));
        }
        let of = |shape: ShapeId| report.shapes.iter().find(move |it| it.shape == shape);
        let divided = report.shapes.iter().any(|it| it.divided && below.contains(&it.shape));
        if report.uncertified.iter().any(|found| below.contains(&found.shape)) {
            Self::Uncertified
        } else if divided {
            Self::Scaled
        } else if of(part).is_some_and(|it| it.sides.outside == Promise::Exact) {
            Self::Exact
        } else {
            Self::Bound
        }
    }
}
