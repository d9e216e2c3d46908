//! The written sources of small programs.

#![allow(clippy::expect_used, clippy::panic)]

mod common;

use common::{FEATURES, blend, featured, lit, mirrored, program, sphere, twisted, with_material};
use sdfc_codegen::{
    BufferRole, Code, Error, FieldOptions, Lists, MAX_CONSTANT_LIST, PictureOptions, Shader, Stage,
    Target, field_module, march_module, picture_module, render_module, shadertoy_module,
};
use sdfc_graph::{Const, Dim, Graph, Program, Shadow, Table, Type};
use sdfc_march::{METHODS, Method, ViewBlock, stubs};

fn field(program: &Program) -> String {
    let options = FieldOptions::default();
    field_module(program, &options).expect("lowers").wgsl().expect("is written")
}

/// The declarations alone, which show what is linked.
fn outline(shader: &Shader) -> String {
    let text = shader.wgsl().expect("is written");
    let heads = ["fn ", "struct ", "const ", "var", "@group"];
    let lines = text.lines().filter(|line| heads.iter().any(|head| line.starts_with(head)));
    lines.map(|line| line.trim_end_matches(" {")).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_sphere() {
    insta::assert_snapshot!(field(&sphere()));
}

#[test]
fn a_blend_with_a_param() {
    insta::assert_snapshot!(field(&blend()));
}

#[test]
fn a_sphere_with_a_material() {
    insta::assert_snapshot!(field(&with_material()));
}

#[test]
fn a_twisted_box() {
    insta::assert_snapshot!(field(&twisted()));
}

#[test]
fn a_picture_with_slots() {
    let shader = render_module(&blend(), Method::Sphere).expect("links");
    insta::assert_snapshot!(shader.wgsl().expect("is written"));
}

#[test]
fn the_least_picture_links_no_shadow_no_material_no_slots() {
    let shader = render_module(&lit(sphere(), Shadow::Off), Method::Auto).expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn a_shadow_links_the_shadow_ray_alone() {
    let shader = render_module(&lit(sphere(), Shadow::Hard), Method::Auto).expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn a_material_links_its_shading() {
    let shader = render_module(&with_material(), Method::Fixed).expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn a_mirror_links_the_reflected_ray_and_no_shadow() {
    let shader = render_module(&mirrored(sphere()), Method::Auto).expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn rays_of_all_kinds_pass_through_one_call_of_the_field() {
    let shadowed = mirrored(lit(with_material(), Shadow::Hard));
    let unoccluded = (1 << FEATURES) - 1 - (1 << 5);
    for (method, all) in METHODS.into_iter().flat_map(|method| {
        [(method, shadowed.clone()), (method, featured(with_material(), unoccluded))]
    }) {
        let all = all.with_segment_bounds(true, true);
        let shader = render_module(&all, method.method).expect("links");
        let text = shader.wgsl().expect("is written");
        let calls = |name: &str| text.matches(&format!("= {name}(")).count();
        let differences = usize::from(method.gradient.is_some());
        assert_eq!((calls("field"), calls("trace")), (1 + differences, 1), "{}", method.name);
        // Bounds along segments that a method does not use are not linked.
        for stub in [stubs::RANGE, stubs::SLOPE_RANGE] {
            let asked = usize::from(method.calls(stub));
            let (written, called) = (text.matches(&format!("fn {stub}(")).count(), calls(stub));
            assert_eq!((written, called), (asked, asked), "{}: {stub}", method.name);
        }
    }
}

/// Targets that can hold functions without a picture.
const FUNCTIONS: [Target; 6] =
    [Target::Wgsl, Target::Glsl, Target::GlslEs, Target::Hlsl, Target::Msl, Target::Spirv];

/// The reflection of the sphere with a material and a param.
#[test]
fn a_small_scene_in_every_language() {
    let options = FieldOptions { binding: 3, ..FieldOptions::default() };
    let shader = field_module(&blend(), &options).expect("lowers");
    for target in FUNCTIONS {
        let written = shader.write(target, "a\nb\\").expect("is written");
        let Code::Text(text) = written.code else { continue };
        let reflection = written.reflection;
        insta::assert_snapshot!(
            format!("a_blend_as_{}", target.name()),
            format!("{text}\n{:#?}\n{:#?}", reflection.functions, reflection.uniform)
        );
    }
}

/// The ray method as a function beside those of the scene.
#[test]
fn a_march_in_every_language() {
    let options = FieldOptions { gradient: false, ..FieldOptions::default() };
    let shader = march_module(&blend(), Method::Auto, &options).expect("links");
    for target in FUNCTIONS {
        let written = shader.write(target, "a").expect("is written");
        let Code::Text(text) = written.code else { continue };
        let reflection = written.reflection;
        insta::assert_snapshot!(
            format!("a_march_as_{}", target.name()),
            format!("{text}\n{:#?}\n{:#?}", reflection.functions, reflection.structures)
        );
    }
}

/// A radius from a list of this many, selected by the height of the point.
fn looked_up(count: usize) -> Program {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let (length, height) = (graph.length(p), graph.component(p, 1));
    let elements = (0..count).map(|i| Const::new(Type::Scalar, &[i as f64 / 4.0])).collect();
    let radius = graph.element(Table { ty: Type::Scalar, elements }, height);
    let distance = graph.sub(length, radius);
    program(graph, distance)
}

#[test]
fn long_lists_are_in_a_buffer_where_the_language_has_such_buffers() {
    for target in FUNCTIONS {
        for count in [MAX_CONSTANT_LIST, MAX_CONSTANT_LIST + 1] {
            let (lists, gradient) = (target.lists(), false);
            let options =
                FieldOptions { group: 1, binding: 3, lists, gradient, ..Default::default() };
            let shader = field_module(&looked_up(count), &options).expect("lowers");
            let reflection = shader.write(target, "a").expect("is written").reflection;
            if lists == Lists::Constants || count == MAX_CONSTANT_LIST {
                assert_eq!((reflection.buffers.len(), shader.lists().len()), (0, 0), "{target:?}");
                continue;
            }
            let [buffer] = &reflection.buffers[..] else { panic!("{target:?}") };
            assert_eq!(buffer.role, BufferRole::Lists, "{target:?}");
            assert_eq!((buffer.group, buffer.binding), (1, 4), "after the uniform's place");
            assert_eq!(buffer.size as usize, 16 * count, "{target:?}");
            assert_eq!(reflection.lists.len(), count);
            assert_eq!(reflection.lists[5], [1.25, 0.0, 0.0, 0.0]);
        }
    }
    let shader = render_module(&lit(looked_up(2), Shadow::Off), Method::Sphere);
    assert_eq!(shader.expect("links").lists().len(), 2, "the renderer keeps short ones there too");
}

#[test]
fn the_fragment_form_uses_the_given_group_and_binding() {
    let options = PictureOptions {
        method: Method::Sphere,
        stage: Stage::Fragment,
        rows_up: true,
        prefix: "a_".to_owned(),
        group: 2,
        binding: 5,
        lists: Lists::Buffer,
    };
    let shader = picture_module(&blend(), &options).expect("links");
    let reflection = shader.reflection();
    let (buffers, entries) = (reflection.buffers, reflection.entries);
    insta::assert_snapshot!(format!("{}\n{buffers:#?}\n{entries:#?}", outline(&shader)));
    let refused = PictureOptions { prefix: "2".to_owned(), ..options };
    assert_eq!(picture_module(&blend(), &refused).err(), Some(Error::BadPrefix("2".to_owned())));
}

#[test]
fn a_picture_for_shadertoy() {
    let view = vec![0; size_of::<ViewBlock>()];
    let shader = shadertoy_module(&blend(), Method::Sphere, &view).expect("links");
    let written = shader.write(Target::Shadertoy, "a").expect("is written");
    let Code::Text(text) = written.code else { panic!("no text") };
    insta::assert_snapshot!(text);

    let short = shadertoy_module(&blend(), Method::Sphere, &view[4..]);
    assert!(matches!(short, Err(Error::ViewBytes { .. })));
}

/// Names that are allowed in WGSL and keywords in another language.
#[test]
fn params_are_reflected_with_the_names_of_each_language() {
    for word in ["loop", "float4", "half", "vec2", "gl_x", "double", "thread", "_group", "a__b"] {
        let mut scene = blend();
        scene.params[0].name = word.to_owned();
        let shader = field_module(&scene, &FieldOptions::default()).expect("lowers");
        for target in FUNCTIONS {
            let written = shader.write(target, "").expect("is written");
            let member = &written.reflection.members[0].name;
            match written.code {
                Code::Text(text) => {
                    let read = format!("sdf_params.{member};");
                    assert!(text.contains(&read), "{word}, {}: {read}\n{text}", target.name());
                }
                Code::Words(_) => assert_eq!(member, word),
            }
        }
    }
}

#[test]
fn keywords_of_a_language_are_reflected_as_they_are_written() {
    let options = FieldOptions { prefix: String::new(), ..FieldOptions::default() };
    let shader = field_module(&sphere(), &options).expect("lowers");
    let written = shader.write(Target::Glsl, "").expect("is written");
    let distance = &written.reflection.functions[0];
    assert_eq!(distance.name, "distance_");
    assert_eq!(distance.signature, "float distance_(vec3 p)");
}

#[test]
fn what_a_language_cannot_hold_is_refused() {
    let picture = render_module(&sphere(), Method::Auto).expect("links");
    let target = Target::GlslEs;
    let refused = Error::MissingStage { target, stage: Stage::Compute };
    assert_eq!(picture.write(target, ""), Err(refused));

    let field = field_module(&sphere(), &FieldOptions::default()).expect("lowers");
    let refused = field.write(Target::Shadertoy, "");
    assert!(matches!(refused, Err(Error::Unsupported { target: Target::Shadertoy, .. })));

    let options = FieldOptions { binding: 256, ..FieldOptions::default() };
    let shader = field_module(&blend(), &options).expect("lowers");
    for target in [Target::Glsl, Target::Msl] {
        let refused = Error::BindingTooLarge { target, number: 256 };
        assert_eq!(shader.write(target, ""), Err(refused));
    }
    assert!(shader.write(Target::Wgsl, "").is_ok());
}
