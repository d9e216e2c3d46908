//! What has no mesh, and how that is said.

use std::ops::ControlFlow;

use sdfc::{Error, MeshError, MeshFormat, MeshOptions, MeshSize};

use crate::{mesh, scene};

fn refusal(source: &str, options: &MeshOptions) -> MeshError {
    let result = scene(source).mesh(options, &mut |_| ControlFlow::Continue(()));
    let Err(Error::Mesh(error)) = result else { panic!("{source} has a mesh") };
    error
}

#[test]
fn an_unbounded_solid_is_refused_with_the_way_to_bound_it() {
    let error = refusal("plane(y: 0)", &MeshOptions::new().error(MeshSize::Length(0.1)));
    assert!(matches!(error, MeshError::Unbounded { .. }), "{error}");
    assert!(error.to_string().contains("& box("), "{error}");
}

#[test]
fn an_empty_scene_is_refused() {
    let source = "box([1, 0.8, 0.9]) & sphere(0.5).translate(x: 3)";
    let error = refusal(source, &MeshOptions::new());
    assert_eq!(error, MeshError::Empty);
    let options = MeshOptions::new().error(MeshSize::Length(0.1));
    assert_eq!(refusal("sphere(0)", &options), MeshError::Empty);
    let unseen = refusal("sphere(0.001)\nsphere(0.001).translate(x: 2)", &options);
    assert_eq!(unseen, MeshError::NothingFound { error: 0.1 });
}

#[test]
fn solids_without_limits_beside_others_are_left_out() {
    let alone = "sphere(1).color(#ff0000)";
    let beside =
        format!("let floor = plane(y: -1).color(#00ff00)\nfloor\n{alone}\nfloor - sphere(2)");
    let [alone, beside] = [alone, &beside].map(scene);
    assert_eq!(alone.left_out(&alone.defaults()), [""; 0]);
    let left_out = beside.left_out(&beside.defaults());
    assert_eq!(left_out, ["`floor` (line 1)", "`floor - sphere(2)` (line 4)"]);
    let [alone, beside] = [alone, beside].map(|scene| mesh(&scene, 0.02));
    assert_eq!(alone, beside);
}

#[test]
fn an_error_below_rounding_is_refused_with_the_smallest_possible_one() {
    let source = "sphere(1).translate(x: 1000000)";
    let at = |error: f64| MeshOptions::new().error(MeshSize::Length(error));
    let MeshError::TooFine { least, .. } = refusal(source, &at(1e-12)) else { panic!() };
    assert!(least > 1e-12);
    let limited = at(least).max_cells(1000);
    let error = refusal(source, &limited);
    assert!(matches!(error, MeshError::TooManyCells { limit: 1000 }), "{error}");
}

#[test]
fn work_stops_when_its_progress_breaks() {
    let result = scene("sphere(1)").mesh(&MeshOptions::new(), &mut |_| ControlFlow::Break(()));
    assert!(matches!(result, Err(Error::Mesh(MeshError::Cancelled))));
}

#[test]
fn a_scene_far_from_the_origin_is_meshed_but_not_written_as_stl() {
    let mesh = mesh(&scene("sphere(1).translate(x: 1000000)"), 0.01);
    super::check(&mesh, "far");
    assert!(mesh.certificate.is_proven);
    assert!(MeshFormat::Stl.encode(&mesh).is_err());
    for format in [MeshFormat::Obj, MeshFormat::Ply, MeshFormat::Glb, MeshFormat::ThreeMf] {
        assert!(format.encode(&mesh).is_ok(), "{format:?}");
    }
}
