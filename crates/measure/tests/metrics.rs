//! Checks the metrics of a comparison with a ball whose hits are known analytically.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Dim, Graph, Program, gradient};
use sdfc_measure::{
    Camera, Kind, Metrics, Normal, Oracle, PixelSample, Status, Truth, Verdict, compare,
};

const SIZE: usize = 32;

/// Returns a ball of radius 1 about the origin.
fn ball() -> Program {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let (length, radius) = (graph.length(p), graph.number(1.0));
    let field = graph.sub(length, radius);
    let slope = gradient(&mut graph, field, p);
    Program { graph, distance: Some(field), gradient: Some(slope), ..Program::default() }
}

fn camera() -> Camera {
    Camera {
        parallel: false,
        size: [SIZE as u32; 2],
        eye: [0.0, 0.0, 4.0],
        forward: [0.0, 0.0, -1.0],
        right: [0.4, 0.0, 0.0],
        up: [0.0, 0.4, 0.0],
        t_max: 20.0,
        pixel_radius: 0.4 / SIZE as f64,
    }
}

/// Returns a picture without errors.
fn perfect(truth: &Truth) -> Vec<PixelSample> {
    let sample = |verdict: &Verdict| {
        let (status, t) = match *verdict {
            Verdict::Hit(t) => (Status::Hit, t),
            Verdict::Miss | Verdict::Undecided(_) => (Status::Miss, 20.0),
        };
        PixelSample { status, t, evaluations: 10, normal: None }
    };
    truth.verdicts.iter().map(sample).collect()
}

struct Case {
    truth: Truth,
    picture: Vec<PixelSample>,
}

impl Case {
    fn new() -> Self {
        let oracle = Oracle::new(&ball()).expect("it draws something");
        let truth = Truth::find(&oracle, &FrameValues::default(), camera(), &|_| ());
        let picture = perfect(&truth);
        Self { truth, picture }
    }

    fn metrics(&self) -> Metrics {
        let oracle = Oracle::new(&ball()).expect("it draws something");
        compare(&oracle, &FrameValues::default(), &self.truth, &self.picture)
    }

    fn pixel(&self, kind: Kind, hit: bool) -> usize {
        let is = |pixel: &usize| {
            let hits = matches!(self.truth.verdicts[*pixel], Verdict::Hit(_));
            self.truth.kinds[*pixel] == kind && hits == hit
        };
        (0..self.picture.len()).find(is).expect("the picture has such a pixel")
    }
}

/// Solves |o + t d| = 1 with o = (0, 0, 4).
#[test]
fn the_truth_is_the_analytic_solution() {
    let case = Case::new();
    for (pixel, verdict) in case.truth.verdicts.iter().enumerate() {
        let along = -4.0 * camera().ray(pixel).direction[2];
        let inside = along * along - 15.0;
        match *verdict {
            Verdict::Hit(t) => assert!((t - (along - inside.sqrt())).abs() < 1e-9),
            Verdict::Miss => assert!(inside < 0.0),
            Verdict::Undecided(t) => panic!("undecided from {t}"),
        }
    }
}

#[test]
fn edges_are_the_ring_around_the_ball() {
    let case = Case::new();
    let counts = case.truth.counts();
    // A circle with a diameter of 20.6 pixels, and the pixels on both sides of it.
    assert!((80..260).contains(&counts.edge), "{counts:?}");
    assert!(counts.hit > 150 && counts.miss > 300 && counts.undecided == 0, "{counts:?}");
}

#[test]
fn a_perfect_picture_has_no_errors() {
    let metrics = Case::new().metrics();
    assert_eq!((metrics.missed, metrics.false_hits, metrics.nan, metrics.capped), (0, 0, 0, 0));
    assert_eq!(metrics.depth.pixels.max, 0.0);
    assert!(metrics.depth.pixels.n > 0 && metrics.normal.n == 0, "normals are not compared");
    assert_eq!((metrics.evaluations.mean, metrics.evaluations.max), (10.0, 10));
}

#[test]
fn each_error_is_counted_by_its_kind() {
    let mut case = Case::new();
    let [hit, miss] = [true, false].map(|hit| case.pixel(Kind::Plain, hit));
    case.picture[hit] =
        PixelSample { status: Status::Miss, t: 20.0, evaluations: 10, normal: None };
    case.picture[miss] = PixelSample { status: Status::Hit, t: 4.0, evaluations: 10, normal: None };
    let metrics = case.metrics();
    assert_eq!((metrics.missed, metrics.false_hits), (1, 1));

    let mut case = Case::new();
    case.picture[hit].t += 3.0 * camera().pixel_width(case.picture[hit].t);
    let far = case.metrics().depth.pixels.max;
    assert!((far - 3.0).abs() < 1e-9, "{far}");

    let mut case = Case::new();
    case.picture[hit].t = f64::NAN;
    case.picture[miss].status = Status::Capped;
    let metrics = case.metrics();
    assert_eq!((metrics.nan, metrics.capped, metrics.missed), (1, 1, 0));
}

/// At an edge a ray that passes the ball by less than a quarter of a pixel may hit it; a ray that
/// passes it by more may not.
#[test]
fn an_edge_allows_a_quarter_of_a_pixel() {
    let case = Case::new();
    let mut excused = 0;
    for pixel in 0..case.picture.len() {
        if case.truth.kinds[pixel] != Kind::Edge || case.truth.verdicts[pixel] != Verdict::Miss {
            continue;
        }
        // The point of the ray nearest to the ball, and its distance.
        let t = -4.0 * camera().ray(pixel).direction[2];
        let clearance = (16.0 - t * t).sqrt() - 1.0;
        let mut case = Case { truth: case.truth.clone(), picture: case.picture.clone() };
        case.picture[pixel] = PixelSample { status: Status::Hit, t, evaluations: 10, normal: None };
        let near = clearance <= 0.25 * camera().pixel_width(t);
        assert_eq!(case.metrics().false_hits, u64::from(!near), "{clearance}");
        excused += u32::from(near);
    }
    assert!(excused > 0, "no pixel is that near");
}

#[test]
fn a_normal_is_compared_with_the_gradient_at_its_point() {
    let mut case = Case::new();
    let hit = case.pixel(Kind::Plain, true);
    let ray = camera().ray(hit);
    // This point is not on the ball, and the normal differs there.
    case.picture[hit].t += 0.1;
    let point = ray.at(case.picture[hit].t);
    let [x, y, z] = point;
    case.picture[hit].normal = Some(Normal { point, direction: point });
    assert!(case.metrics().normal.max < 1e-9);
    // Rotated about y by half a degree, at most.
    let (sine, cosine) = 0.5f64.to_radians().sin_cos();
    let direction = [cosine * x + sine * z, y, cosine * z - sine * x];
    case.picture[hit].normal = Some(Normal { point, direction });
    let off = case.metrics().normal.max;
    assert!(off > 0.2 && off < 0.5 + 1e-9, "{off}");
    case.picture[hit].normal = Some(Normal { point, direction: [f64::NAN; 3] });
    assert_eq!(case.metrics().normal.max, 180.0);
}

#[test]
fn the_error_of_a_silhouette_is_that_of_its_pixels() {
    let mut case = Case::new();
    assert_eq!(case.metrics().silhouette, 0.0);
    let hits = case.picture.iter().filter(|pixel| pixel.status == Status::Hit).count();
    let hit = case.pixel(Kind::Plain, true);
    case.picture[hit].status = Status::Miss;
    assert!((case.metrics().silhouette - 1.0 / hits as f64).abs() < 1e-12);
}
