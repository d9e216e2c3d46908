//! Compares the oracle with analytic solutions.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use proptest::prelude::*;
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Binary, Dim, Graph, NodeId, Program, Type, Unary, gradient};
use sdfc_measure::{Oracle, Probe, Ray, Verdict};

fn program(build: impl Fn(&mut Graph, NodeId) -> NodeId) -> Program {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let field = build(&mut graph, p);
    let slope = gradient(&mut graph, field, p);
    Program { graph, distance: Some(field), gradient: Some(slope), ..Program::default() }
}

fn ball(graph: &mut Graph, p: NodeId, center: [f64; 3], radius: f64) -> NodeId {
    let center = graph.constant(Type::Vec3, &center);
    let (offset, radius) = (graph.sub(p, center), graph.number(radius));
    let length = graph.length(offset);
    graph.sub(length, radius)
}

fn probe(program: &Program, ray: &Ray) -> Probe {
    let oracle = Oracle::new(program).expect("it draws something");
    oracle.prober(&FrameValues::default()).first_hit(ray)
}

/// Returns the first positive root of |o + t d - c| = r for an origin outside, and the depth below
/// the surface at which the ray passes, negative outside.
fn intersect(ray: &Ray, center: [f64; 3], radius: f64) -> (Option<f64>, f64) {
    let offset: [f64; 3] = std::array::from_fn(|axis| ray.origin[axis] - center[axis]);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let along = -dot(offset, ray.direction);
    let square = dot(offset, offset) - along * along;
    let inside = radius * radius - square;
    let root = (inside > 0.0 && along > 0.0).then(|| along - inside.sqrt());
    (root.filter(|t| *t < ray.t_max), radius - square.max(0.0).sqrt())
}

proptest! {
    /// The nearer of two balls is hit, by any ray that is not within 1e-6 of a tangent.
    #[test]
    fn the_nearer_of_two_balls_is_hit(
        (x, y) in (-2.0..2.0f64, -2.0..2.0f64),
        (dx, dy) in (-0.5..0.5f64, -0.5..0.5f64),
        far in -6.0..-1.0f64,
    ) {
        let balls = [([0.3, 0.0, 0.0], 0.9), ([-0.4, 0.5, far], 1.1)];
        let program = program(|graph, p| {
            let [a, b] = balls.map(|(center, radius)| ball(graph, p, center, radius));
            graph.min(a, b)
        });
        let length = (dx * dx + dy * dy + 1.0f64).sqrt();
        let ray = Ray {
            origin: [x, y, 4.0],
            direction: [dx / length, dy / length, -1.0 / length],
            t_max: 20.0,
        };
        let found = balls.map(|(center, radius)| intersect(&ray, center, radius));
        prop_assume!(found.iter().all(|(_, depth)| depth.abs() > 1e-6));
        let nearest = found.iter().filter_map(|(t, _)| *t).reduce(f64::min);
        match (probe(&program, &ray).verdict, nearest) {
            (Verdict::Hit(t), Some(wanted)) => prop_assert!((t - wanted).abs() < 1e-9 * wanted),
            (Verdict::Miss, None) => {}
            (verdict, wanted) => prop_assert!(false, "{verdict:?}, not {wanted:?}"),
        }
    }
}

#[test]
fn a_ray_that_starts_inside_hits_at_once() {
    let program = program(|graph, p| ball(graph, p, [0.0; 3], 1.0));
    let ray = Ray { origin: [0.2, 0.0, 0.0], direction: [1.0, 0.0, 0.0], t_max: 5.0 };
    assert_eq!(probe(&program, &ray).verdict, Verdict::Hit(0.0));
}

#[test]
fn a_tangent_ray_is_undecided() {
    let program = program(|graph, p| ball(graph, p, [0.0; 3], 1.0));
    let ray = Ray { origin: [-3.0, 1.0, 0.0], direction: [1.0, 0.0, 0.0], t_max: 9.0 };
    let Verdict::Undecided(t) = probe(&program, &ray).verdict else { panic!("it only touches") };
    assert!((t - 3.0).abs() < 1e-3, "{t}");
}

/// The wall is a millionth thick; a marcher that trusts a false distance steps over it.
#[test]
fn a_very_thin_wall_is_found() {
    let program = program(|graph, p| {
        let shell = ball(graph, p, [0.0; 3], 1.0);
        let shell = graph.abs(shell);
        let wall = graph.number(5e-7);
        graph.sub(shell, wall)
    });
    let ray = Ray { origin: [0.1, 0.2, 5.0], direction: [0.0, 0.0, -1.0], t_max: 20.0 };
    let wanted = 5.0 - ((1.0 + 5e-7f64).powi(2) - 0.05).sqrt();
    let Verdict::Hit(t) = probe(&program, &ray).verdict else { panic!("it hits the wall") };
    assert!((t - wanted).abs() < 1e-9, "{t} is not {wanted}");
}

/// The field is nine times the distance. Every marcher fails on it, the oracle does not.
#[test]
fn a_field_that_exceeds_the_distance_is_intersected() {
    let program = program(|graph, p| {
        let field = ball(graph, p, [0.0; 3], 0.1);
        let factor = graph.number(9.0);
        graph.mul(field, factor)
    });
    let ray = Ray { origin: [0.05, 0.0, 3.0], direction: [0.0, 0.0, -1.0], t_max: 8.0 };
    let wanted = 3.0 - 0.0075f64.sqrt();
    let Verdict::Hit(t) = probe(&program, &ray).verdict else { panic!("it hits the ball") };
    assert!((t - wanted).abs() < 1e-9);
}

/// Returns balls in all cells of a grid of 1, moved and scaled by hashes of the cell. None of them
/// reaches a wall of its cell.
fn jittered(graph: &mut Graph, p: NodeId) -> NodeId {
    let cell = graph.unary(Unary::Round, p);
    let lanes = [0, 1, 2].map(|lane| graph.component(cell, lane));
    let mut random = |seed: f64| {
        let mut state = graph.number(seed);
        for lane in lanes {
            state = graph.binary(Binary::Hash, state, lane);
        }
        let scale = graph.number(1.0 / 16_777_216.0);
        graph.mul(state, scale)
    };
    let random = [1.0, 2.0, 3.0, 4.0].map(&mut random);
    let [least, more] = [0.1, 0.1].map(|value| graph.number(value));
    let [half, reach] = [0.5, 0.3].map(|value| graph.constant(Type::Vec3, &[value; 3]));
    let place = graph.compose(&random[..3]);

    let offset = graph.sub(place, half);
    let offset = graph.mul(offset, reach);
    let center = graph.add(cell, offset);
    let away = graph.sub(p, center);
    let length = graph.length(away);
    let grown = graph.mul(random[3], more);
    let radius = graph.add(least, grown);
    graph.sub(length, radius)
}

/// Returns the first hit of the balls, found by visiting all cells around the ray, and the smallest
/// distance between the ray and a ball's surface.
fn first_ball(ray: &Ray) -> (Option<f64>, f64) {
    use sdfc_graph::eval::hash;
    let (mut nearest, mut doubt) = (None::<f64>, f64::INFINITY);
    let mut tried = std::collections::HashSet::new();
    for step in 0..(ray.t_max * 8.0) as usize {
        let at = ray.at(step as f64 / 8.0);
        for corner in 0..27 {
            let shift = [corner % 3, corner / 3 % 3, corner / 9].map(|i| f64::from(i) - 1.0);
            let cell: [f64; 3] = std::array::from_fn(|i| (at[i] + shift[i]).round_ties_even());
            if !tried.insert(cell.map(|lane| lane as i64)) {
                continue;
            }
            let random = [1.0, 2.0, 3.0, 4.0].map(|seed| {
                cell.iter().fold(seed, |state, lane| hash(state, *lane)) / 16_777_216.0
            });
            let center = std::array::from_fn(|i| cell[i] + 0.3 * (random[i] - 0.5));
            let (t, depth) = intersect(ray, center, 0.1 + 0.1 * random[3]);
            nearest = t.map_or(nearest, |t| Some(nearest.map_or(t, |other| other.min(t))));
            doubt = doubt.min(depth.abs());
        }
    }
    (nearest, doubt)
}

proptest! {
    /// A hash of the cell places each ball, so the formula of each cell differs from that of its
    /// neighbours.
    #[test]
    fn balls_placed_by_a_hash_of_the_cell_are_hit(
        (x, y) in (-0.5..0.5f64, -0.5..0.5f64),
        (dx, dy) in (-0.5..0.5f64, -0.5..0.5f64),
    ) {
        let program = program(jittered);
        let length = (dx * dx + dy * dy + 1.0f64).sqrt();
        let direction = [dx / length, dy / length, -1.0 / length];
        let ray = Ray { origin: [x, y, 0.5], direction, t_max: 20.0 };
        let (nearest, doubt) = first_ball(&ray);
        prop_assume!(doubt > 1e-6);
        let found = probe(&program, &ray);
        match (found.verdict, nearest) {
            (Verdict::Hit(t), Some(wanted)) => prop_assert!((t - wanted).abs() < 1e-8 * wanted.max(1.0), "{t}, not {wanted}"),
            (Verdict::Miss, None) => {}
            (verdict, wanted) => prop_assert!(false, "{verdict:?}, not {wanted:?}"),
        }
    }
}

/// The field jumps from outside to inside without a zero.
#[test]
fn a_jump_through_zero_is_a_surface() {
    let program = program(|graph, p| {
        let x = graph.component(p, 0);
        let whole = graph.unary(Unary::Floor, x);
        let height = graph.number(2.5);
        graph.sub(height, whole)
    });
    let ray = Ray { origin: [0.2, 0.3, 0.1], direction: [1.0, 0.0, 0.0], t_max: 9.0 };
    let Verdict::Hit(t) = probe(&program, &ray).verdict else { panic!("it jumps at x = 3") };
    assert!((t - 2.8).abs() < 1e-6, "{t}");
}

/// The formula of one cell would have a wall inside its neighbour.
#[test]
fn a_cell_has_no_effect_on_its_neighbour() {
    let program = program(|graph, p| {
        let x = graph.component(p, 0);
        let whole = graph.unary(Unary::Floor, x);
        // The field alternates by 1; a wall at 1 + 1e-5 belongs to the formula of the first cell.
        let two = graph.number(2.0);
        let odd = graph.binary(Binary::Rem, whole, two);
        let wall = graph.number(1.0 + 1e-5);
        let away = graph.sub(wall, x);
        graph.add(away, odd)
    });
    let ray = Ray { origin: [0.2, 0.3, 0.1], direction: [1.0, 0.0, 0.0], t_max: 1.79 };
    assert_eq!(probe(&program, &ray).verdict, Verdict::Miss);
}
