//! What is written, for small programs.

#![allow(clippy::expect_used)]

mod common;

use common::{blend, lit, mirrored, painted, sphere, twisted};
use sdfc_codegen::{
    Code, Error, FieldOptions, Shader, Target, field_module, march_module, render_module,
};
use sdfc_graph::{Program, Shadow};
use sdfc_march::METHODS;

fn field(program: &Program) -> String {
    let options = FieldOptions::default();
    field_module(program, &options).expect("lowers").wgsl().expect("is written")
}

/// Declarations alone: what is linked, not how it is written.
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
fn a_painted_sphere() {
    insta::assert_snapshot!(field(&painted()));
}

#[test]
fn a_twisted_box() {
    insta::assert_snapshot!(field(&twisted()));
}

#[test]
fn a_picture_with_slots() {
    let shader = render_module(&blend(), "sphere").expect("links");
    insta::assert_snapshot!(shader.wgsl().expect("is written"));
}

#[test]
fn the_least_picture_links_no_shadow_no_material_no_slots() {
    let shader = render_module(&lit(sphere(), Shadow::Off), "auto").expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn a_shadow_links_the_shadow_ray_alone() {
    let shader = render_module(&lit(sphere(), Shadow::Hard), "auto").expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn a_material_links_its_shading() {
    let shader = render_module(&painted(), "fixed").expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn a_mirror_links_the_mirrored_ray_and_no_shadow() {
    let shader = render_module(&mirrored(sphere()), "auto").expect("links");
    insta::assert_snapshot!(outline(&shader));
}

#[test]
fn rays_of_all_kinds_pass_through_one_call_of_the_field() {
    let all = mirrored(lit(painted(), Shadow::Hard));
    for method in METHODS {
        let shader = render_module(&all, method.name).expect("links");
        let text = shader.wgsl().expect("is written");
        let calls = |name: &str| text.matches(&format!("= {name}(")).count();
        let differences = usize::from(method.gradient.is_some());
        assert_eq!((calls("field"), calls("trace")), (1 + differences, 1), "{}", method.name);
    }
}

/// The painted sphere with a param, and what the reflection says of it.
#[test]
fn a_small_scene_in_every_text() {
    let options = FieldOptions { binding: 3, ..FieldOptions::default() };
    let shader = field_module(&blend(), &options).expect("lowers");
    for target in Target::ALL {
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
fn a_march_in_every_text() {
    let options = FieldOptions { gradient: false, ..FieldOptions::default() };
    let shader = march_module(&blend(), "auto", &options).expect("links");
    for target in Target::ALL {
        let written = shader.write(target, "a").expect("is written");
        let Code::Text(text) = written.code else { continue };
        let reflection = written.reflection;
        insta::assert_snapshot!(
            format!("a_march_as_{}", target.name()),
            format!("{text}\n{:#?}\n{:#?}", reflection.functions, reflection.structures)
        );
    }
}

#[test]
fn names_that_a_language_has_itself_are_reported_as_they_are_written() {
    let options = FieldOptions { prefix: String::new(), ..FieldOptions::default() };
    let shader = field_module(&sphere(), &options).expect("lowers");
    let written = shader.write(Target::Glsl, "").expect("is written");
    let distance = &written.reflection.functions[0];
    assert_eq!(distance.name, "distance_");
    assert_eq!(distance.signature, "float distance_(vec3 p)");
}

#[test]
fn what_a_language_cannot_hold_is_refused() {
    let picture = render_module(&sphere(), "auto").expect("links");
    let target = Target::GlslEs;
    let refused = Error::Unsupported { target, what: "compute stage" };
    assert_eq!(picture.write(target, ""), Err(refused));

    let options = FieldOptions { binding: 256, ..FieldOptions::default() };
    let shader = field_module(&blend(), &options).expect("lowers");
    for target in [Target::Glsl, Target::Msl] {
        let refused = Error::BindingTooLarge { target, number: 256 };
        assert_eq!(shader.write(target, ""), Err(refused));
    }
    assert!(shader.write(Target::Wgsl, "").is_ok());
}
