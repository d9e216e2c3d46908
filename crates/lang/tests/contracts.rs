//! Every clause of the library, sampled. What a field is compared with is not the field itself:
//! surface points found by bisection between signs, and the foot point that an exact distance
//! and its gradient name.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use sdfc_graph::eval::{Dual, FrameValues, Tape};
use sdfc_graph::{Dim, Graph, NodeId, Scene, ShapeId, SidePromise};
use sdfc_lang::library;
use support::{elaborated, flat};

/// Pairs for a Lipschitz constant, points for a promise, of which so many are compared with all points of
/// a surface.
const PAIRS: usize = 4000;
const POINTS: usize = 3000;
const COMPARED: usize = 600;
const SURFACE: usize = 1500;
/// How far an unbounded shape, and the outside of any, is looked at.
const REACH: f64 = 1.5;

/// Entries without clauses that keep what their one child promises: by the rules of derivation.
const TRANSPARENT: [&str; 7] =
    ["translate", "rotate", "scale", "color", "roughness", "metallic", "paint"];

/// Arguments where formulas degenerate or contracts change; the examples have the usual ones.
const AWKWARD: [&str; 17] = [
    "torus(major: 0.3, minor: 0.5)",
    "capsule([0.1, 0.2, 0.3], [0.1, 0.2, 0.3], r: 0.3)",
    "box([2, 0.5, 0.02])",
    "ellipsoid([2, 0.5, 0.1])",
    "ellipsoid_fast([2, 0.5, 0.1])",
    "plane(y: 0.3, normal: [1, 2, 3])",
    "cylinder(r: 0.05, h: 2)",
    "circle(0.3).revolve()",
    "circle(0.3).translate(x: -0.1, y: 0.4).revolve()",
    "rect([0.4, 1]).translate(x: 0.2).revolve()",
    "box([0.6, 2, 0.6]).twist(-150deg)",
    // A bound whose gradient has no part towards the axis, which an exact distance has far out.
    "solid plate() lipschitz 1 bounds [-1, -1, -0.05] .. [1, 1, 0.05] = max(abs(p.x) - 1, abs(p.y) - 1, abs(p.z) - 0.05)\nplate().twist(90deg)",
    "ellipsoid([0.9, 0.4, 0.2]).twist(90deg).scale(0.7)",
    "union(sphere(0.5), box(0.8).translate(x: 0.5), blend: smooth(0))",
    "intersection(sphere(0.7), box(1.1), blend: smooth(0.2))",
    "difference(box(1), sphere(0.6), cylinder(r: 0.2, h: 2), blend: chamfer(0.1))",
    "rect([1, 0.3]).rotate(30deg).round(0.1).extrude(0.2).rotate(x: 50deg, y: -20deg)",
];

#[test]
fn every_entry_keeps_its_contract() {
    for entry in library::entries() {
        let scene = elaborated(&entry.example).scene;
        if entry.kind != "fn" {
            let of_entry = |&id: &ShapeId| scene.graph.shape(id).definition == entry.name;
            assert!(
                scene.graph.shape_ids().any(|id| of_entry(&id)),
                "{}: its example lacks it",
                entry.name
            );
        }
        check_scene(&scene, &entry.example);
    }
}

#[test]
fn contracts_hold_for_awkward_arguments() {
    for text in AWKWARD {
        check_scene(&elaborated(text).scene, text);
    }
}

#[test]
fn blends_change_no_faster_than_they_state() {
    for entry in library::entries().iter().filter(|entry| entry.signature.ends_with("-> blend")) {
        let call = format!("{}({{k}})", entry.name);
        for k in ["0", "0.1", "0.7"] {
            let blend = call.replace("{k}", k);
            // Distances that are coordinates: the blend as a function of two numbers.
            let text = format!(
                "union(plane(normal: [1, 0, 0]), plane(normal: [0, 1, 0]), blend: {blend})"
            );
            let scene = elaborated(&text).scene;
            let formula = support::root(&scene).formula;
            let claim = scene.graph.claim_of(formula).expect("a blend states its constant");
            let constant = scene.graph.as_number(claim.lipschitz).expect("it is constant");
            let field = support::Field::drawn(&text);
            let mut random = Random(11);
            for round in 0..PAIRS {
                let p = [0; 3].map(|_| random.next() * 2.0 - 1.0);
                let q = mix(p, [0; 3].map(|_| random.next() * 2.0 - 1.0), [1.0, 0.01][round % 2]);
                let rise = (field.at(p) - field.at(q)).abs();
                let run = (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
                assert!(rise <= constant * run + 1e-12, "{blend}: {rise} over {run}");
            }
        }
    }
}

#[test]
fn the_entry_that_the_documentation_adds_is_right() {
    let page = include_str!("../../../docs/adding-a-shape.md");
    let entry = page.split("```").nth(1).expect("the page shows an entry").trim();
    let example = entry.lines().find_map(|line| line.strip_prefix("/// example:"));
    let text = format!("{entry}\n{}", example.expect("the entry has an example"));
    check_scene(&elaborated(&text).scene, &text);
}

#[test]
fn a_contract_that_is_false_is_found() {
    let cases = [
        "solid wrong() exact bounds -1..1 = 1.1 * (length(p) - 1)\nwrong()",
        "solid wrong() exact bounds -0.9..0.9 = length(p) - 1\nwrong()",
        "solid wrong() lipschitz 0.9 bounds -1..1 = length(p) - 1\nwrong()",
        "solid wrong() bound outside bounds -1..1 = if length(p) < 1 { -1 } else { 1.01 * (length(p) - 1) }\nwrong()",
        // The constant that is often given for a twist.
        "solid wrong() lipschitz sqrt(2) bounds -1..1 = rect([1.2, 0.1])([p.x * cos(p.y) - p.z * sin(p.y), p.x * sin(p.y) + p.z * cos(p.y)])\nwrong()",
    ];
    for text in cases {
        let scene = elaborated(text).scene;
        let result = std::panic::catch_unwind(|| check_scene(&scene, text));
        assert!(result.is_err(), "nothing was found in {text}");
    }
}

#[test]
fn every_entry_is_documented() {
    for entry in library::entries() {
        let name = &entry.name;
        assert!(entry.summary.ends_with('.'), "{name}: its summary is a sentence");
        assert!(!entry.source.is_empty(), "{name}: it says where its formula is from");
        assert!(!entry.example.is_empty(), "{name}: it has an example");
    }
}

fn check_scene(scene: &Scene, text: &str) {
    let facts = Facts::all(&scene.graph);
    for id in scene.graph.shape_ids() {
        if scene.graph.shape(id).level == 0 {
            let label = format!("`{}` in {text}", scene.graph.shape(id).definition);
            Probe::new(scene, id, label).check(&facts[id.index()]);
        }
    }
}

/// What an instance promises, its children's shortcomings counted.
#[derive(Clone, Copy, Debug)]
struct Facts {
    exact: [bool; 2],
    bound: [bool; 2],
    lipschitz: f64,
    /// Whether the constant holds beyond the bounds of whatever states it.
    everywhere: bool,
}

impl Facts {
    fn all(graph: &Graph) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for id in graph.shape_ids() {
            let shape = graph.shape(id);
            let children: Vec<Self> =
                shape.children.iter().map(|child| all[child.index()]).collect();
            all.push(Self::of(graph, shape, &children));
        }
        all
    }

    fn of(graph: &Graph, shape: &sdfc_graph::Shape, children: &[Self]) -> Self {
        let contract = &shape.contract;
        let sides = [contract.outside, contract.inside];
        let silent = contract.lipschitz.is_none() && sides == [SidePromise::default(); 2];
        let keeps = silent && TRANSPARENT.contains(&shape.definition.as_str());
        let holds = |promise: Option<NodeId>| {
            promise.is_some_and(|c| graph.as_const(c).is_some_and(|c| c.lanes()[0] != 0.0))
        };
        let all_exact = children.iter().all(|child| child.exact == [true; 2]);
        let all_bound = children.iter().all(|child| child.bound == [true; 2]);
        let exact = sides.map(|side| all_exact && (keeps || holds(side.exact)));
        let largest = children.iter().map(|child| child.lipschitz).fold(1.0, f64::max);
        let stated = contract.lipschitz.and_then(|node| graph.as_number(node));
        let own = match stated {
            Some(constant) => constant,
            None if sides.iter().all(|side| holds(side.exact)) => 1.0,
            // Without clauses all of the library's operators keep the constant.
            None if silent && !children.is_empty() => 1.0,
            None => f64::INFINITY,
        };
        let lipschitz = own * largest;
        let mut bound = sides.map(|side| all_bound && holds(side.bound));
        for (bound, exact) in bound.iter_mut().zip(exact) {
            *bound |= exact || lipschitz <= 1.0;
        }
        let everywhere = own <= 1.0 && children.iter().all(|child| child.everywhere);
        Self { exact, bound, lipschitz, everywhere }
    }
}

/// A field with the means to ask it.
struct Probe {
    tape: Tape,
    frame: FrameValues,
    dim: Dim,
    /// The stated or derived bounds, cut where they are infinite, and as they are.
    bounds: [[f64; 3]; 2],
    stated: [[f64; 3]; 2],
    label: String,
    random: Random,
}

impl Probe {
    fn new(scene: &Scene, id: ShapeId, label: String) -> Self {
        let mut graph = scene.graph.clone();
        let dim = graph.shape(id).dim;
        let ends = sdfc_graph::bounds(&mut graph, id, &scene.params);
        let lanes = |node| {
            let [x, y, z, _] = graph.as_const(node).expect("examples have constant bounds").lanes();
            [x, y, z]
        };
        let stated = ends.map(lanes);
        let bounds = [
            stated[0].map(|end| if end.is_finite() { end } else { -REACH }),
            stated[1].map(|end| if end.is_finite() { end } else { REACH }),
        ];
        let distance = flat(&mut graph, id);
        let tape = Tape::new(&graph, &[distance]).expect("the field is flat");
        let frame = FrameValues::defaults(&scene.params);
        Self { tape, frame, dim, bounds, stated, label, random: Random(7) }
    }

    fn at(&self, p: [f64; 3]) -> f64 {
        self.tape.prepare::<f64>(&self.frame).scalar(p)
    }

    fn point(&mut self, grown: f64) -> [f64; 3] {
        let mut point = [0.0; 3];
        let axes = if self.dim == Dim::Two { 2 } else { 3 };
        for (axis, place) in point.iter_mut().enumerate().take(axes) {
            let (lo, hi) = (self.bounds[0][axis] - grown, self.bounds[1][axis] + grown);
            // Worst cases like edges and corners: one coordinate in four lies on a face.
            let share = match self.random.below(8) {
                0 => 0.0,
                1 => 1.0,
                _ => self.random.next(),
            };
            *place = lo + (hi - lo) * share;
        }
        point
    }

    fn check(mut self, facts: &Facts) {
        let known =
            facts.everywhere || self.stated.as_flattened().iter().all(|end| end.is_finite());
        let lipschitz = if known { facts.lipschitz } else { f64::INFINITY };
        self.check_lipschitz(lipschitz);
        let surface = self.surface();
        self.check_bounds(&surface);
        for round in 0..POINTS {
            let p = self.point([0.0, REACH][round % 2]);
            let f = self.at(p);
            assert!(f.is_finite(), "{}: {f} at {p:?}", self.label);
            let side = usize::from(f < 0.0);
            if facts.bound[side] && round < COMPARED {
                self.check_bound(p, f.abs(), &surface);
            }
            if facts.exact[side] && !surface.is_empty() {
                self.check_exact(p, f);
            }
        }
        if lipschitz.is_finite() {
            for _ in 0..COMPARED {
                let p = self.point(0.0);
                self.check_bound(p, self.at(p).abs() / lipschitz.max(1.0), &surface);
            }
        }
    }

    fn check_lipschitz(&mut self, constant: f64) {
        if !constant.is_finite() {
            return;
        }
        for round in 0..PAIRS {
            let p = self.point(0.0);
            let other = self.point(0.0);
            // Near pairs find a steep place, far pairs a step.
            let share = [1.0, 1e-2, 1e-4][round % 3];
            let q = mix(p, other, share);
            let (rise, run) = ((self.at(p) - self.at(q)).abs(), distance(p, q));
            assert!(
                rise <= constant * run + 1e-12,
                "{}: lipschitz {constant}, but {} between {p:?} and {q:?}",
                self.label,
                rise / run
            );
            // The slope in the steepest direction, which few pairs happen to lie in.
            let slope = distance(self.slope(p), [0.0; 3]);
            assert!(
                slope <= constant + 1e-9,
                "{}: lipschitz {constant}, but a slope of {slope} at {p:?}",
                self.label
            );
        }
    }

    fn slope(&self, p: [f64; 3]) -> [f64; 3] {
        self.tape.prepare::<Dual>(&self.frame).scalar(Dual::point(p)).partials
    }

    /// Points of the surface, between points of opposite sign.
    fn surface(&mut self) -> Vec<[f64; 3]> {
        let points: Vec<_> =
            (0..SURFACE).map(|i| self.point(if i % 2 == 0 { 0.0 } else { 0.2 })).collect();
        let (inside, outside): (Vec<_>, Vec<_>) =
            points.into_iter().partition(|&p| self.at(p) < 0.0);
        if inside.is_empty() || outside.is_empty() {
            return Vec::new();
        }
        (0..SURFACE)
            .map(|i| {
                let mut a = inside[i % inside.len()];
                let mut b = outside[self.random.below(outside.len())];
                for _ in 0..60 {
                    let middle = mix(a, b, 0.5);
                    let end = if self.at(middle) < 0.0 { &mut a } else { &mut b };
                    *end = middle;
                }
                a
            })
            .collect()
    }

    fn check_bounds(&mut self, surface: &[[f64; 3]]) {
        let outside: Vec<_> = (0..PAIRS).map(|_| self.point(REACH)).collect();
        let inside = outside.into_iter().filter(|&p| self.at(p) < 0.0);
        for p in inside.chain(surface.iter().copied()) {
            let axes = if self.dim == Dim::Two { 2 } else { 3 };
            let within = (0..axes).all(|axis| {
                self.stated[0][axis] - 1e-9 <= p[axis] && p[axis] <= self.stated[1][axis] + 1e-9
            });
            assert!(within, "{}: {p:?} is inside but not within {:?}", self.label, self.stated);
        }
    }

    /// A sampled surface point can only be farther than the nearest one, so this accuses nobody
    /// wrongly.
    fn check_bound(&self, p: [f64; 3], claimed: f64, surface: &[[f64; 3]]) {
        let nearest = surface.iter().map(|&s| distance(p, s)).fold(f64::INFINITY, f64::min);
        assert!(
            claimed <= nearest + 1e-9,
            "{}: bound, but {claimed} at {p:?}, which is {nearest} from the surface",
            self.label
        );
    }

    /// With [`Self::check_bound`]: the distance is no less than |f|, and here no more. Beyond the foot
    /// point the sign changes: a zero within the inside is no surface.
    fn check_exact(&self, p: [f64; 3], f: f64) {
        let slope = self.slope(p);
        let foot = [0, 1, 2].map(|axis| p[axis] - f * slope[axis]);
        let beyond = [0, 1, 2].map(|axis| foot[axis] - 1e-4 * f.signum() * slope[axis]);
        let (rest, length) = (self.at(foot), distance(slope, [0.0; 3]));
        assert!(
            rest.abs() < 1e-6 && (length - 1.0).abs() < 1e-6 && self.at(beyond) * f <= 0.0,
            "{}: exact, but {f} at {p:?} leads to {foot:?}, where it is {rest}",
            self.label
        );
    }
}

fn mix(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * t)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    [0, 1, 2].map(|axis| (a[axis] - b[axis]).powi(2)).iter().sum::<f64>().sqrt()
}

/// SplitMix64: the same numbers on every machine.
struct Random(u64);

impl Random {
    fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In 0..1.
    fn next(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next_u64() % count as u64) as usize
    }
}
