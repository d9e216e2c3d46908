//! Closed paths around the section of a scene by a plane.

use std::ops::ControlFlow;

use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use serde::Serialize;

use crate::arc::Segment;
use crate::certify::Proof;
use crate::curve::{Curve, segments};
use crate::error::{MeshError, MeshOptions, Progress, shown};
use crate::field::{Field, LocalField};
use crate::grid::Grid;
use crate::make::Maker;
use crate::mesh::{check, fitting};
use crate::outline::Outline;
use crate::plane::Plane;
use crate::polygon::{area, parents};
use crate::simplify::DIVIDED;
use crate::surface::MeshCertificate;
use crate::vector::total;

/// The boundary of a scene's section by a plane, in the plane's coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Contour {
    /// Closed paths that neither cross nor touch, with the inside of the scene on their left: outer
    /// paths are counter-clockwise, and holes are clockwise.
    pub paths: Vec<ContourPath>,
    /// The proven properties.
    pub certificate: ContourCertificate,
}

/// A closed path.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ContourPath {
    /// The ends of lines and arcs, in scene units. The last one is connected to the first one.
    pub points: Vec<[f64; 2]>,
    /// The bulge of the line or arc from each point to the next one: 0 for a line, else the
    /// tangent of a quarter of the arc's angle, positive for a counter-clockwise arc. It is at most
    /// 0.6 in size, so each arc turns by less than 124 degrees.
    pub bulges: Vec<f64>,
    /// True if the inside of the scene is outside of the path.
    pub is_hole: bool,
    /// The index of the path directly around this one. Paths around a hole are no holes, and the
    /// reverse.
    pub parent: Option<usize>,
}

/// The proven properties of a contour.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ContourCertificate {
    /// The distance that was asked for, in scene units.
    pub error: f64,
    /// True if every point of the contour is proven to be within `error` of the boundary of the
    /// section, and every point of that boundary within `error` of the contour. If false, this
    /// holds outside the undecided boxes.
    pub is_proven: bool,
    /// Number of rectangles without a proof.
    pub undecided: u64,
    /// Area of the rectangles without a proof.
    pub undecided_area: f64,
    /// Lowest and highest corner of rectangles without a proof; at most
    /// [`MeshCertificate::MAX_BOXES`].
    pub undecided_boxes: Vec<[[f64; 2]; 2]>,
    /// Number of rectangles in which the boundary is proven to be absent.
    pub empty_boxes: u64,
    /// Number of rectangles in which the field is proven to change its sign across the contour.
    pub sheet_boxes: u64,
    /// Number of rectangles, smaller than the error, that contain both signs and part of the
    /// contour.
    pub small_boxes: u64,
}

/// The field counts as outside where it is above minus this fraction of the error. So a plane in a
/// face of the scene has no inside there, and rounding does not decide about it.
const LEVEL: f64 = 1e-6;

/// Makes closed paths around a program's section by a plane, with a certificate.
///
/// The work runs on all threads of the current rayon pool. It stops if `progress` breaks.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use sdfc_graph::eval::FrameValues;
/// use sdfc_graph::{Dim, Graph, Program};
/// use sdfc_mesh::{MeshOptions, Plane, contour};
///
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let (length, radius) = (graph.length(p), graph.number(0.5));
/// let ball = graph.sub(length, radius);
/// let program = Program { graph, distance: Some(ball), ..Program::default() };
///
/// let plane = Plane::new([0.0, 0.0, 1.0], 0.3).expect("a normal");
/// let options = MeshOptions::new([[-0.5; 3], [0.5; 3]], 0.01);
/// let mut progress = |_| ControlFlow::Continue(());
/// let circle = contour(&program, &FrameValues::default(), plane, &options, &mut progress)?;
/// assert!(circle.certificate.is_proven);
/// let [path] = &circle.paths[..] else { panic!("one path") };
/// assert!(path.points.iter().all(|[x, y]| (x.hypot(*y) - 0.4).abs() < 0.01));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`MeshError`]; [`MeshError::NoSection`] if the plane meets no inside.
pub fn contour(
    program: &Program,
    frame: &FrameValues,
    plane: Plane,
    options: &MeshOptions,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Contour, MeshError> {
    let field = Field::new(program)?.ok_or(MeshError::NothingDrawn)?;
    let MeshOptions { bounds, error, max_cells, has_arcs } = *options;
    check(bounds, error)?;
    let shadow = plane.shadow(bounds);
    let grid = fitting(error, |error| Grid::around_flat(shadow, error))?;
    let truth = LocalField::new(field.distance(), frame).in_plane(plane);
    let lowered = truth.clone().at_level(-LEVEL * error);
    let maker = Maker { field: &lowered, truth: &truth, grid: &grid, error, max_cells, has_arcs };
    let (outline, proof) = maker.make::<Outline>(progress)?;
    let certificate = ContourCertificate::of(proof);
    if outline.paths.is_empty() {
        let [from, to] = plane.range(bounds);
        let touches = certificate.undecided > 0;
        return Err(MeshError::NoSection { from, to, at: plane.offset(), touches });
    }
    let divided: Vec<_> = outline.paths.iter().map(|path| path.lines(DIVIDED * error)).collect();
    let path = |((Curve { points, bulges }, parent), divided): ((Curve, _), &Vec<_>)| ContourPath {
        is_hole: area(divided) < 0.0,
        points,
        bulges,
        parent,
    };
    let paths = outline.paths.into_iter().zip(parents(&divided)).zip(&divided).map(path).collect();
    Ok(Contour { paths, certificate })
}

impl ContourCertificate {
    fn of(proof: Proof) -> Self {
        let boxes: Vec<[[f64; 2]; 2]> =
            proof.undecided.iter().map(|corners| corners.map(|[x, y, _]| [x, y])).collect();
        let MeshCertificate { error, is_proven, undecided, .. } = proof.certificate;
        let MeshCertificate { empty_boxes, sheet_boxes, small_boxes, .. } = proof.certificate;
        Self {
            error,
            is_proven,
            undecided,
            undecided_area: total(boxes.iter().map(|[lo, hi]| (hi[0] - lo[0]) * (hi[1] - lo[1]))),
            undecided_boxes: boxes.into_iter().take(MeshCertificate::MAX_BOXES).collect(),
            empty_boxes,
            sheet_boxes,
            small_boxes,
        }
    }
}

/// One line that says what is proven.
impl std::fmt::Display for ContourCertificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { error, is_proven, undecided, undecided_area, .. } = self;
        let error = shown(*error);
        if *is_proven {
            return write!(f, "contour and section are proven to be within {error} of each other");
        }
        write!(
            f,
            "contour and section are within {error} of each other, except in {undecided} \
             undecided boxes with an area of {undecided_area:.3e}"
        )
    }
}

impl Contour {
    /// Returns the area of the section: that of outer paths less that of holes.
    pub fn area(&self) -> f64 {
        total(self.paths.iter().map(|path| {
            area(&path.points) + path.segments().map(|segment| segment.area()).sum::<f64>()
        }))
    }

    /// Returns the length of all paths.
    pub fn length(&self) -> f64 {
        total(self.paths.iter().flat_map(ContourPath::segments).map(|segment| segment.length()))
    }

    /// Returns the lowest and the highest corner of a rectangle around all paths; `None` without
    /// paths.
    pub fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let segments = self.paths.iter().flat_map(ContourPath::segments);
        let mut points = segments.flat_map(|segment| segment.extremes());
        let first = points.next()?;
        Some(points.fold([first; 2], |[lo, hi], [x, y]| {
            [[lo[0].min(x), lo[1].min(y)], [hi[0].max(x), hi[1].max(y)]]
        }))
    }
}

impl ContourPath {
    pub(crate) fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        segments(&self.points, &self.bulges)
    }
}
