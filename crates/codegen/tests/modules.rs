//! Whole modules: each links, validates and is accepted by readers; errors are values.

#![allow(clippy::expect_used)]

mod common;

use std::mem::{offset_of, size_of};

use common::{
    FEATURES, blend, chain, featured, lit, mirrored, number_param, program, sphere, twisted,
    with_material,
};
use sdfc_codegen::{
    Error, FieldOptions, Lists, PictureOptions, Role, Stage, field_module, march_module,
    picture_module, render_module, shadertoy_module,
};
use sdfc_graph::{Dim, FrameInput, Graph, Loop, LoopVar, Program, Rays, Shadow, Type, Unary};
use sdfc_march::{LightBlock, METHODS, Method, PixelBlock, ViewBlock};

fn scenes() -> Vec<Program> {
    let mut scenes = Vec::new();
    for build in [sphere, blend, with_material, twisted] {
        scenes.push(build());
        scenes.push(lit(build(), Shadow::Hard));
    }
    let mut both = lit(with_material(), Shadow::Hard);
    let k = both.graph.frame_input(FrameInput::Time, Type::Scalar);
    both.distance = both.distance.map(|distance| both.graph.add(distance, k));
    both.uniforms = vec![k];
    for copies in [false, true] {
        for marched in [false, true] {
            let mut scene = pre_intersected(sphere(), copies, marched);
            scenes.push(scene.clone());
            let sharpness = scene.graph.number(8.0);
            scenes.push(lit(scene, Shadow::Soft(sharpness)));
        }
    }
    scenes.push(mirrored(both.clone()));
    scenes.push(mirrored(sphere()));
    scenes.push(both);
    scenes
}

/// The scene with functions of rays, whose values mean nothing.
fn pre_intersected(mut scene: Program, copies: bool, marched: bool) -> Program {
    let [origin, direction] = [0, 1].map(|level| scene.graph.point(level, Dim::Three));
    let [hit, free] = [origin, direction].map(|vector| scene.graph.component(vector, 0));
    let ends = scene.graph.compose(&[hit, free]);
    scene.rays = Rays {
        first_hit: Some(hit),
        analytic: scene.distance,
        marched: scene.distance.filter(|_| marched),
        clip: Some(ends).filter(|_| marched),
        copies: Some(ends).filter(|_| copies && marched),
    };
    scene
}

#[test]
fn every_method_links_with_every_kind_of_scene() {
    for method in METHODS {
        for scene in scenes() {
            let scene = scene.with_segment_bounds(true, true);
            let shader = render_module(&scene, method.method).expect("links");
            common::check(&shader.wgsl().expect("is written"));
            common::check_spirv(&shader.spirv().expect("is written"), "vulkan1.1");
            for stage in Stage::ALL {
                let (method, prefix) = (method.method, "a_".to_owned());
                let (rows_up, group, binding, lists) = (true, 0, 3, Lists::Buffer);
                let options =
                    PictureOptions { method, stage, rows_up, prefix, group, binding, lists };
                let shader = picture_module(&scene, &options).expect("links");
                common::check(&shader.wgsl().expect("is written"));
                common::check_spirv(&shader.spirv().expect("is written"), "vulkan1.1");
            }
            let view = vec![0; size_of::<ViewBlock>()];
            shadertoy_module(&scene, method.method, &view).expect("links");
            let shader = march_module(&scene, method.method, &FieldOptions::default());
            common::check(&shader.expect("links").wgsl().expect("is written"));
        }
    }
}

#[test]
fn any_two_features_and_all_but_one_link_together() {
    let (none, all) = (0, (1 << FEATURES) - 1);
    let bits = (0..FEATURES as u32).map(|bit| 1 << bit);
    let pairs = bits.clone().flat_map(|one| bits.clone().map(move |other| one | other));
    for chosen in pairs.chain(bits.clone().map(|one| all & !one)).chain([none, all]) {
        let shader =
            render_module(&featured(with_material(), chosen), Method::Auto).expect("links");
        common::check(&shader.wgsl().expect("is written"));
        common::check_spirv(&shader.spirv().expect("is written"), "vulkan1.1");
        assert!(shader.module().overrides.is_empty());
    }
}

#[test]
fn every_scene_has_a_field_module() {
    for scene in scenes() {
        for prefix in ["", "sdf_", "scene2", "_x_"] {
            let options = FieldOptions { prefix: prefix.to_owned(), ..FieldOptions::default() };
            let shader = field_module(&scene, &options).expect("lowers");
            let text = shader.wgsl().expect("is written");
            common::check(&text);
            common::check_spirv(&shader.spirv().expect("is written"), "spv1.3");
            for function in shader.reflection().functions {
                assert!(text.contains(&format!("{} {{", function.signature)), "{text}");
            }
        }
    }
}

/// Names and offsets of a structure's members in the module, and its size.
fn layout(module: &naga::Module, name: &str) -> (Vec<u32>, u32) {
    let mut types = module.types.iter().map(|(_, ty)| ty);
    let ty = types.find(|ty| ty.name.as_deref() == Some(name)).expect("is declared");
    let naga::TypeInner::Struct { members, span } = &ty.inner else { return (Vec::new(), 0) };
    (members.iter().map(|member| member.offset).collect(), *span)
}

#[test]
fn blocks_have_the_layout_of_the_shader() {
    let shader = render_module(&sphere(), Method::Fixed).expect("links");
    let module = shader.module();
    let offsets = |list: &[usize]| list.iter().map(|&offset| offset as u32).collect::<Vec<_>>();
    macro_rules! block {
        ($block:ident: $($field:ident)*) => {
            (offsets(&[$(offset_of!($block, $field)),*]), size_of::<$block>() as u32)
        };
    }
    assert_eq!(
        layout(module, "View"),
        block!(ViewBlock: eye pixel_radius right t_max up epsilon forward steps size tile_origin
            tile_size light_count tolerance ambient reflections background reflection_strength
            zenith fog_density horizon occlusion_radius fog_color occlusion_strength lights)
    );
    assert_eq!(
        layout(module, "Light"),
        block!(LightBlock: position kind color shadow axis sharpness rim pad)
    );
    assert_eq!(
        layout(module, "Pixel"),
        block!(PixelBlock: color depth status evaluations primary_evaluations)
    );
}

#[test]
fn params_are_reflected_with_their_offsets() {
    let mut graph = Graph::new();
    let types = [Type::Scalar, Type::Vec3, Type::Bool, Type::Vec2, Type::Vec4, Type::Scalar];
    let mut distance = common::floor(&mut graph, 0.5);
    for (index, ty) in (0..).zip(types) {
        let input = graph.frame_input(FrameInput::Param(index), ty);
        let part = match ty {
            Type::Bool => {
                let (one, zero) = (graph.number(1.0), graph.number(0.0));
                graph.select(input, one, zero)
            }
            Type::Scalar => input,
            Type::Vec2 | Type::Vec3 | Type::Vec4 => graph.length(input),
        };
        distance = graph.add(distance, part);
    }
    let mut scene = program(graph, distance);
    // The last has a name that is reserved in WGSL.
    for name in ["a", "b", "c", "d", "e", "loop"] {
        scene.params.push(number_param(name, 0.0));
    }
    let options = FieldOptions { group: 2, binding: 3, ..FieldOptions::default() };
    let shader = field_module(&scene, &options).expect("lowers");
    let reflection = shader.reflection();
    let places: Vec<_> =
        reflection.members.iter().map(|m| (m.name.as_str(), m.offset, m.size)).collect();
    let expected =
        [("a", 0, 4), ("b", 16, 12), ("c", 28, 4), ("d", 32, 8), ("e", 48, 16), ("loop_", 64, 4)];
    assert_eq!(places, expected);
    let uniform = reflection.uniform.expect("has params");
    assert_eq!((uniform.group, uniform.binding, uniform.size), (2, 3, 80));
    assert_eq!(uniform.structure.as_deref(), Some("sdf_Params"));
    assert_eq!(uniform.variable, "sdf_params");
    // The reader lays the structure out by WGSL's rules, which must give the same.
    let text = shader.wgsl().expect("is written");
    let read = naga::front::wgsl::parse_str(&text).expect("is WGSL");
    assert_eq!(layout(&read, "sdf_Params"), (vec![0, 16, 28, 32, 48, 64], 80));
}

#[test]
fn names_that_wgsl_does_not_allow_are_changed() {
    for name in ["loop", "distance", "p", "_", "", "2d", "a__b", "é", "x y", "sdf_distance", "q1"]
    {
        let mut scene = blend();
        for node in scene.names.clone().into_keys() {
            scene.names.insert(node, name.to_owned());
        }
        scene.params[0].name = name.to_owned();
        let shader = field_module(&scene, &FieldOptions::default()).expect("lowers");
        common::check(&shader.wgsl().expect("is written"));
        let shader = render_module(&scene, Method::Auto).expect("links");
        common::check(&shader.wgsl().expect("is written"));
    }
}

#[test]
fn instructions_are_counted() {
    // length(p - c) - r: subtract, length, subtract, return.
    let shader = field_module(&sphere(), &FieldOptions::default()).expect("lowers");
    let costs = shader.instructions().expect("is written");
    assert_eq!((costs[0].role, costs[0].instructions, costs[0].arithmetic), (Role::Distance, 4, 3));
    // The distance with it: one more subtraction, and a vector of four lanes.
    assert_eq!(
        (costs[1].role, costs[1].instructions, costs[1].arithmetic),
        (Role::Gradient, 11, 6)
    );
    let linked = render_module(&sphere(), Method::Auto).expect("links").instructions();
    let linked = linked.expect("is written");
    assert_eq!(linked[0], costs[0]);
    // normalize(p - c): subtract, dot, max, inverseSqrt, multiply, return.
    assert_eq!(
        (linked[1].role, linked[1].instructions, linked[1].arithmetic),
        (Role::Gradient, 6, 5)
    );
}

#[test]
fn drivers_know_the_limits_of_short_loops_alone() {
    let hides = |max_iterations| {
        let mut graph = Graph::new();
        let index = graph.variable(0, LoopVar::Index, Type::Scalar);
        let state = graph.variable(0, LoopVar::State(0), Type::Scalar);
        let ball = common::ball(&mut graph, [0.0; 3], 0.5);
        let other = graph.add(ball, index);
        let (step, init) = (vec![graph.min(state, other)], vec![graph.number(9.0)]);
        let (count, condition, skip) = (None, None, None);
        let around = Loop { depth: 0, max_iterations, count, condition, init, step, skip };
        let distance = graph.add_loop(around)[0];
        let shader = render_module(&program(graph, distance), Method::Auto).expect("links");
        shader.wgsl().expect("is written").contains("let unreached = loop_limit;")
    };
    assert_eq!([8, 9].map(hides), [false, true]);
}

#[test]
fn a_long_chain_needs_little_stack() {
    let thread = std::thread::Builder::new().stack_size(2 << 20);
    let worker = thread.spawn(|| {
        let shader = field_module(&chain(1000), &FieldOptions::default()).expect("lowers");
        common::check(&shader.wgsl().expect("is written"));
        common::check_spirv(&shader.spirv().expect("is written"), "spv1.3");
        render_module(&chain(1000), Method::Auto)
            .expect("links")
            .instructions()
            .expect("is written")
    });
    let costs = worker.expect("starts").join().expect("does not overflow");
    assert!(costs[0].arithmetic > 8000, "{costs:?}");
}

#[test]
fn a_deep_chain_of_values_used_once_is_cut_into_names() {
    let mut graph = Graph::new();
    let mut value = common::floor(&mut graph, 0.25);
    for i in 0..10_000 {
        let other = common::ball(&mut graph, [f64::from(i % 7), 0.0, 0.0], 0.5);
        value = if i % 2 == 0 { graph.min(value, other) } else { graph.max(other, value) };
    }
    let shader = field_module(&program(graph, value), &FieldOptions::default()).expect("lowers");
    shader.spirv().expect("is written");
    let text = shader.wgsl().expect("is written");
    let deepest = text.lines().map(|line| {
        line.chars().fold((0i32, 0), |(now, most), c| match c {
            '(' => (now + 1, most.max(now + 1)),
            ')' => (now - 1, most),
            _ => (now, most),
        })
    });
    assert!(deepest.map(|(_, most)| most).max() < Some(20));
}

#[test]
fn infinite_numbers_are_literals_that_every_shader_compiler_accepts() {
    let mut graph = Graph::new();
    let distance = common::floor(&mut graph, f64::NEG_INFINITY);
    let shader = field_module(&program(graph, distance), &FieldOptions::default());
    let text = shader.expect("lowers").wgsl().expect("is written");
    common::check(&text);
    let (_, literal) = text.split_once("p.y + ").expect("the floor is a sum");
    let digits: String = literal.chars().take_while(char::is_ascii_digit).collect();
    // In f64, because a text that is rounded to f32 is never above its largest number.
    let literal: f64 = digits.parse().expect("a number");
    assert!((1e38..=f64::from(f32::MAX)).contains(&literal), "{text}");
}

#[test]
fn what_cannot_be_lowered_is_an_error() {
    let field = |program: &Program| field_module(program, &FieldOptions::default()).err();
    assert_eq!(field(&Program::default()), Some(Error::NothingDrawn));

    let mut no_gradient = sphere();
    no_gradient.gradient = None;
    assert_eq!(field(&no_gradient), Some(Error::MissingRoot("gradient")));
    assert!(render_module(&no_gradient, Method::Auto).is_err());

    for prefix in ["2d", "a__b", "a-b", "é"] {
        let options = FieldOptions { prefix: prefix.to_owned(), ..FieldOptions::default() };
        assert!(matches!(field_module(&sphere(), &options), Err(Error::BadPrefix(_))));
    }

    for value in [f64::NAN, 1e39, -1e300] {
        let mut graph = Graph::new();
        let distance = common::floor(&mut graph, value);
        let error = field(&program(graph, distance));
        assert!(matches!(error, Some(Error::NotFinite { .. })), "{value}: {error:?}");
    }

    // Without a uniform slot a picture cannot read a per-frame input.
    let mut unbound = blend();
    unbound.uniforms.clear();
    assert!(matches!(render_module(&unbound, Method::Auto), Err(Error::UnboundInput(_))));

    let mut graph = Graph::new();
    let other = graph.point(1, sdfc_graph::Dim::Three);
    let distance = graph.length(other);
    assert_eq!(field(&program(graph, distance)), Some(Error::NotFlat(other)));

    let mut graph = Graph::new();
    let p = common::point(&mut graph);
    let wrong = graph.unary(Unary::Not, p);
    let distance = graph.length(wrong);
    assert_eq!(field(&program(graph, distance)), Some(Error::IllTyped(wrong)));
}
