//! The graphs that scenes become: formulas, instances, evaluation rates.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use sdfc_graph::{Stage, dump};
use support::{elaborated, flat, root};

/// The expanded distance of a scene.
fn distance(text: &str) -> String {
    let mut scene = elaborated(text).scene;
    let root = scene.root.expect("the scene draws something");
    let distance = flat(&mut scene.graph, root);
    dump(&scene.graph, &[("distance", distance)])
}

#[test]
fn a_sphere_becomes_a_formula() {
    support::snapshot!(distance("sphere(0.5)"));
}

#[test]
fn a_torus_becomes_a_formula() {
    support::snapshot!(distance("torus(major: 0.8, minor: 0.25)"));
}

#[test]
fn the_width_of_a_smooth_union_can_be_a_param() {
    support::snapshot!(distance(
        "param k = 0.4 in 0..1\nunion(sphere(0.5), sphere(1).translate(x: 1), blend: smooth(k))"
    ));
}

#[test]
fn a_hard_union_folds_to_minima() {
    support::snapshot!(distance("sphere(0.5) | plane(y: -0.5) | box(1).translate(x: 2)"));
}

#[test]
fn a_shape_of_the_scene_becomes_a_formula() {
    support::snapshot!(distance(
        "solid egg(r: length = 0.5) = length([p.x, p.y * 0.8, p.z]) - r\negg(0.3)"
    ));
}

#[test]
fn a_twist_becomes_a_formula() {
    support::snapshot!(distance("sphere(0.5).translate(x: 1).twist(90deg)"));
}

#[test]
fn equal_calls_share_an_instance_but_not_a_site() {
    let scene = elaborated("sphere(0.5) | sphere(0.5).translate(x: 1)\nsphere(0.5)");
    let spheres: Vec<_> = scene.sites.iter().filter(|site| site.name == "sphere").collect();
    assert_eq!(spheres.len(), 3);
    assert!(spheres.iter().all(|site| site.shape == spheres[0].shape));
    assert_eq!(
        spheres.iter().map(|site| site.span.start).collect::<Vec<_>>(),
        [0, 14, 42],
        "each call has its own site"
    );
}

#[test]
fn a_shape_of_the_scene_is_equal_to_a_library_entry() {
    let own = "solid ball(r: length = 1 in 0..inf)\n  exact\n  bounds -r..r\n  = length(p) - r\n";
    let own = elaborated(&format!("{own}ball(0.5)")).scene;
    let library = elaborated("sphere(0.5)").scene;
    let (own, library) = (root(&own), root(&library));
    assert_eq!(own.definition, "ball");
    assert_eq!(own.contract, library.contract);
    assert_eq!(own.formula, library.formula);
}

#[test]
fn the_evaluation_rate_of_a_value_follows_from_its_inputs() {
    let text = "param r = 0.5 in 0..1\nlet big = r * 2\nsphere(big)\nsphere(0.5 * 2)\nsphere(0.5 + 0.1 * sin(time))";
    let scene = elaborated(text).scene;
    let stage = |child: usize| {
        let shape = scene.graph.shape(root(&scene).children[child]);
        let [sdfc_graph::Arg::Node(radius)] = shape.args[..] else { panic!("one argument") };
        (scene.graph.stage(radius), scene.graph.as_number(radius), scene.graph.stage(shape.formula))
    };
    assert_eq!(stage(0), (Stage::Frame, None, Stage::Point));
    assert_eq!(stage(1), (Stage::Const, Some(1.0), Stage::Point));
    assert_eq!(stage(2), (Stage::Frame, None, Stage::Point));
}

#[test]
fn a_shape_built_at_a_point_has_the_next_level() {
    let text = "solid beads() = sphere(0.1 + 0.1 * saturate(p.y))(p)\nbeads()";
    let scene = elaborated(text).scene;
    let beads = root(&scene);
    assert_eq!(beads.level, 0);
    let ball = scene.graph.shape(beads.children[0]);
    assert_eq!((ball.definition.as_str(), ball.level), ("sphere", 1));
    assert_eq!(ball.contract.bounds, None, "bounds that depend on the point are ignored");
}

#[test]
fn only_drawn_materials_count() {
    assert!(!elaborated("sphere(1) | box(1)").scene.has_materials);
    assert!(elaborated("sphere(1).color(#f00) | box(1)").scene.has_materials);
    assert!(!elaborated("let unused = sphere(1).color(#f00)\nbox(1)").scene.has_materials);
}

#[test]
fn a_function_s_lipschitz_constant_is_recorded_with_its_result() {
    let scene = elaborated("union(sphere(1), box(1), blend: smooth(0.2))").scene;
    let union = root(&scene);
    let claim = scene.graph.lipschitz_claim(union.formula).expect("`smooth` states a constant");
    assert_eq!(scene.graph.as_number(claim.lipschitz), Some(1.0));
    let point = scene.graph.clone().point(0, sdfc_graph::Dim::Three);
    let samples = union.children.iter().map(|&child| scene.graph.clone().sample(child, point));
    // The blend's width, a capture, does not depend on the point.
    assert_eq!(claim.arguments.len(), 2);
    assert!(samples.into_iter().all(|sample| claim.arguments.contains(&sample)));
    let text = "fn wave(q: vec3, by: number) lipschitz 2 * by = by * sin(q.x + q.y)\n\
                solid it() = length(p) - 1 - wave(p, 0.25)\nit()";
    let scene = elaborated(text).scene;
    let claims = scene.graph.ids().filter_map(|id| scene.graph.lipschitz_claim(id));
    let constants: Vec<_> = claims.map(|claim| scene.graph.as_number(claim.lipschitz)).collect();
    // The constant of the sine, which changes 1 / 0.25 times as much, and that of the product.
    assert_eq!(constants, [Some(2.0), Some(0.5)]);
}
