//! Scenes of regions are drawn as planar pictures: in the colours that they state, each region over
//! the ones before it, with edges that cover the right part of a pixel.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::ops::ControlFlow;

use sdfc::{
    Backend, Code, Compiler, Emit, Error, Image, MeshOptions, Method, PictureOptions, Plane, Pose,
    Scene, ShaderOptions, Stage, Target, no_progress,
};
use sdfc_graph::eval::Tape;
use sdfc_render::{HIT, linear_to_srgb8};

fn scene(text: &str) -> Scene {
    Compiler::new().compile("planar.sdf", text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn drawn(text: &str, options: &PictureOptions) -> Image {
    let options = options.clone().backend(Backend::Cpu);
    scene(text).render(&options, &mut no_progress).unwrap().image
}

fn options(size: [u32; 2]) -> PictureOptions {
    PictureOptions::new().size(size)
}

fn srgb(image: &Image, [x, y]: [u32; 2]) -> [u8; 3] {
    let [red, green, blue, _] = image.pixel(x, y).unwrap().color;
    [red, green, blue].map(linear_to_srgb8)
}

/// A camera whose picture is 4 units high, around the origin.
const CAMERA: &str = "\ncamera(eye: [0, 0, 1], height: 4)";

#[test]
fn colours_are_shown_as_written_and_later_regions_cover_earlier_ones() {
    let text = "rect([2, 2]).color(#336699)\ncircle(0.5).color(#f0a010)\nbackground(#102030)";
    let image = drawn(&(text.to_owned() + CAMERA), &options([41, 41]));
    assert_eq!(srgb(&image, [20, 20]), [0xf0, 0xa0, 0x10]);
    assert_eq!(srgb(&image, [12, 12]), [0x33, 0x66, 0x99]);
    assert_eq!(srgb(&image, [2, 2]), [0x10, 0x20, 0x30]);
    // The circle lies deeper in the square than the square's own edge: in a union, it is not seen.
    let union = format!("union(rect([2, 2]).color(#336699), circle(0.5).color(#f0a010)){CAMERA}");
    assert_eq!(srgb(&drawn(&union, &options([41, 41])), [20, 20]), [0x33, 0x66, 0x99]);
}

#[test]
fn emission_adds_to_the_colour_and_a_region_without_a_material_has_the_default_one() {
    let red = drawn("circle(1).color(#000).emission(#f00)", &options([9, 9]));
    assert_eq!(srgb(&red, [4, 4]), [255, 0, 0]);
    let plain = drawn("circle(1)", &options([9, 9]));
    assert_eq!(srgb(&plain, [4, 4]), [linear_to_srgb8(0.8); 3]);
}

/// The middle of a picture of what is below and a circle over it.
fn middle(below: &str, circle: &str) -> [u8; 3] {
    let text = format!("{below}\n{circle}\nbackground(#0f0){CAMERA}");
    srgb(&drawn(&text, &options([9, 9])), [4, 4])
}

#[test]
fn layers_show_through_a_colour_that_is_not_opaque() {
    let half = linear_to_srgb8(0.5);
    let near = |found: [u8; 3], expected: [u8; 3]| {
        let is_near = found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
        assert!(is_near, "{found:?}, expected {expected:?}");
    };
    let blue = "circle(1).color(rgb(0, 0, 1, 0.5))";
    near(middle("rect([2, 2]).color(#f00)", blue), [half, 0, half]);
    near(middle("", blue), [0, half, half]);
    near(middle("", "circle(1).color(fn(q: vec3) = rgb(0, 0, 1, 0.5 + q.x))"), [0, half, half]);
    // Colours of one region cover each other, and the result its layer.
    near(middle("", "circle(1).color(#f00).color(rgb(0, 0, 1, 0.5))"), [half, 0, half]);
    let quarter = linear_to_srgb8(0.25);
    let twice = "circle(1).color(rgb(1, 0, 0, 0.5)).color(rgb(0, 0, 1, 0.5))";
    near(middle("", twice), [quarter, quarter, half]);
    let grey = [linear_to_srgb8(0.8); 3];
    near(middle("rect([2, 2]).color(#f00)", "circle(1)"), grey);
    near(middle("rect([2, 2]).color(#f00)", "circle(1).roughness(0.1)"), grey);
    // The part of a union without a colour stays opaque.
    let union = "union(circle(1), circle(0.5).color(rgb(0, 0, 1, 0.5)).translate([1.5, 0]))";
    near(middle("rect([2, 2]).color(#f00)", union), grey);
}

#[test]
fn a_param_sets_how_much_shows_through() {
    let text = "param tint = rgb(0, 0, 1, 0.5)\nrect([2, 2]).color(#f00)\ncircle(1).color(tint)";
    let scene = scene(&(text.to_owned() + CAMERA));
    let middle = |tint: [f64; 4]| {
        let mut frame = scene.defaults();
        scene.set(&mut frame, "tint", tint).unwrap();
        let options = options([9, 9]).backend(Backend::Cpu).frame(frame);
        srgb(&scene.render(&options, &mut no_progress).unwrap().image, [4, 4])
    };
    assert_eq!(middle([0.0, 0.0, 1.0, 0.0]), [255, 0, 0]);
    assert_eq!(middle([0.0, 0.0, 1.0, 1.0]), [0, 0, 255]);
    assert_eq!(middle([0.0, 0.0, 1.0, 0.5]), [linear_to_srgb8(0.5), 0, linear_to_srgb8(0.5)]);
}

/// The part of each pixel that is inside, by the sign of a field at 32x32 points of the pixel, and
/// by the picture of a white region before black.
fn coverages(region: &str, side: u32, inside: impl Fn([f64; 2]) -> bool) -> Vec<[f64; 2]> {
    let text = format!("{region}.color(#fff)\nbackground(#000){CAMERA}");
    let image = drawn(&text, &options([side; 2]));
    let fine = 32;
    let position = |pixel: u32, part: u32| {
        4.0 * (f64::from(pixel) + (f64::from(part) + 0.5) / f64::from(fine)) / f64::from(side) - 2.0
    };
    let part = |x: u32, y: u32| {
        let parts = (0..fine).flat_map(|i| (0..fine).map(move |j| [i, j]));
        let hits = parts.filter(|[i, j]| inside([position(x, *i), -position(y, *j)])).count();
        hits as f64 / f64::from(fine * fine)
    };
    let pixels = (0..side).flat_map(|y| (0..side).map(move |x| [x, y]));
    pixels.map(|[x, y]| [part(x, y), f64::from(image.pixel(x, y).unwrap().color[0])]).collect()
}

/// The points that a region contains.
type Inside<'a> = &'a dyn Fn([f64; 2]) -> bool;

#[test]
fn an_edge_covers_the_part_of_a_pixel_that_is_inside() {
    let disc = |[x, y]: [f64; 2]| x.hypot(y) < 1.3;
    let band = |[x, y]: [f64; 2]| (0.6..1.4).contains(&x.hypot(y));
    let ellipse = |[x, y]: [f64; 2]| (x / 1.7).hypot(y / 0.6) < 1.0;
    let cases: [(&str, Inside<'_>); 5] = [
        ("circle(1.3)", &disc),
        // These fields are not the distance: their gradients have other lengths.
        ("steep()", &disc),
        ("square()", &disc),
        ("circle(1).scale([1.7, 0.6])", &ellipse),
        ("(circle(1.4) - (circle(0.4) | circle(0.6))).rotate(30deg)", &band),
    ];
    let own = "region steep() = 5 * (length(p) - 1.3)\nregion square() = dot(p, p) - 1.69\n";
    for (region, inside) in cases {
        let found = coverages(&format!("{own}{region}"), 48, inside);
        let worst = found.iter().map(|[a, b]| (a - b).abs()).fold(0.0, f64::max);
        let mean = found.iter().map(|[a, b]| a - b).sum::<f64>() / found.len() as f64;
        // A straight edge is exact where it is along an axis. A diagonal one covers half of a
        // pixel more slowly than a linear ramp of the same width: at the distance 1/2 the pixel has
        // (sqrt(1/2) - 1/2)^2 = 0.043 left, and the ramp nothing; near a quarter the two differ by
        // 0.03. Curvature and the 32x32 samples add to that.
        assert!(worst < 0.06 && mean.abs() < 1e-3, "{region}: {worst}, {mean}");
        let partial = found.iter().filter(|[a, _]| 0.1 < *a && *a < 0.9).count();
        assert!(partial > 50, "{region}: {partial} pixels are at the edge");
    }
}

#[test]
fn isolines_are_where_the_distance_is_a_multiple_of_the_spacing() {
    let text = format!("circle(0.5).color(#fff)\nbackground(#000){CAMERA}");
    // 400 pixels for 4 units: the pixel at column 200 + n has its middle at x = (n + 0.5) / 100.
    let lines = drawn(&text, &options([400, 400]).isolines(0.25));
    let plain = drawn(&text, &options([400, 400]));
    let row = |image: &Image| -> Vec<f32> {
        (200..400).map(|x| image.pixel(x, 199).unwrap().color[0]).collect()
    };
    let changed: Vec<usize> = row(&lines)
        .into_iter()
        .zip(row(&plain))
        .enumerate()
        .filter(|(_, (a, b))| (a - b).abs() > 0.05)
        .map(|(column, _)| column)
        .collect();
    let near = |column: &usize| {
        let distance = (*column as f64 + 0.5) / 100.0 - 0.5;
        let line = (distance / 0.25).round() * 0.25;
        (distance - line).abs() * 100.0 <= 2.0
    };
    assert!(changed.iter().all(near), "{changed:?}");
    for line in [25, 50, 75, 100, 125, 150] {
        assert!(changed.iter().any(|column| column.abs_diff(line) <= 1), "{line}: {changed:?}");
    }
    // The setting and the option draw the same.
    let stated = drawn(&format!("{text}\nisolines(0.25)"), &options([400, 400]));
    assert_eq!(stated, lines);
    // Without any distance between them there are no lines but the edge.
    let param = format!("param s = 0 in 0..1\n{text}\nisolines(s)");
    let none = drawn(&param, &options([400, 400]));
    assert!(none.pixels().iter().all(|pixel| pixel.color.iter().all(|lane| lane.is_finite())));
    assert_eq!(none.pixel(250, 10), plain.pixel(250, 10));
}

#[test]
fn a_fitted_picture_shows_all_of_the_region_with_a_margin() {
    for text in ["rect([6, 1]).translate([100, 3])", "rect([1, 6])", "circle(0.001)"] {
        let image = drawn(text, &options([120, 80]));
        let inside = |[x, y]: [u32; 2]| image.pixel(x, y).unwrap().status == HIT;
        let all = (0..80).flat_map(|y| (0..120).map(move |x| [x, y]));
        let hits: Vec<[u32; 2]> = all.filter(|at| inside(*at)).collect();
        let range = |axis: usize| {
            let values = || hits.iter().map(|at| at[axis]);
            [values().min().unwrap(), values().max().unwrap()]
        };
        let ([left, right], [top, bottom]) = (range(0), range(1));
        assert!(left > 2 && right < 117 && top > 2 && bottom < 77, "{text}: {left}..{right}");
        assert!(
            right - left > 100 || bottom - top > 68,
            "{text}: {left}..{right}, {top}..{bottom}"
        );
    }
}

#[test]
fn the_camera_gives_the_middle_the_height_and_the_direction_upwards() {
    let text = "circle(0.4).translate([3, 1]).color(#f00)\n";
    let at =
        |camera: &str, pixel| srgb(&drawn(&format!("{text}{camera}"), &options([80, 40])), pixel);
    assert_eq!(at("camera(eye: [3, 1, 9], target: [3, 1, 0], height: 1)", [40, 20]), [255, 0, 0]);
    assert_eq!(at("camera(eye: [0, 1, 2], target: [0, 1, 0], height: 4)", [70, 20]), [255, 0, 0]);
    // With x upwards, what lies at the right is at the top.
    let turned = "camera(eye: [0, 1, 2], target: [0, 1, 0], up: [1, 0, 0], height: 8)";
    assert_eq!(at(turned, [40, 5]), [255, 0, 0]);
}

#[test]
fn any_pose_shows_a_planar_picture_from_the_front() {
    let text = "circle(1).color(#f00)\nrect([0.4, 0.4]).translate([0.5, 0.5]).color(#00f)";
    let seen = |eye: [f64; 3], parallel, half_height| {
        let (eye, target, up) = (eye.into(), [0.2, 0.1, 0.0].into(), [0.0, 1.0, 0.0].into());
        let pose = Pose { eye, target, up, parallel, half_height };
        drawn(text, &options([40, 30]).pose(pose))
    };
    let front = seen([0.2, 0.1, 1.0], true, 2.0);
    // From the side, at the distance 5: a half height of 0.4 at the distance 1 is 2 there.
    assert_eq!(seen([0.2 + 3.0, 0.1, 4.0], false, 0.4), front);
    assert_ne!(seen([0.2, 0.1, 1.0], true, 1.0), front);
}

/// The CPU renderer leaves out of a square of pixels what cannot matter there.
#[test]
fn squares_of_pixels_show_what_the_whole_formula_shows() {
    let strokes: String = (0..60)
        .map(|i: i32| {
            let [x, y] = [f64::from(i * 37 % 60) / 16.0 - 1.9, f64::from(i * 23 % 60) / 20.0 - 1.5];
            format!("abs(length(p - [{x}, {y}]) - 0.11) - 0.02,\n")
        })
        .collect();
    let scenes = [
        format!("region page() = min({strokes})\npage().color(#d0c080)"),
        "rect([1, 2]).repeat(spacing: [1.4, 2.3]).color(stripes(#f00, #00f, width: 0.3))\n\
         circle(0.7).translate(x: 1).scale(0.8).color(#123456)\nisolines(0.21)"
            .to_owned(),
        "text(\"Sp8\", size: 2).translate(x: -1.5).color(#fff)\n\
         union(regular_polygon(5, 0.6), circle(0.5).translate(y: 0.6), blend: smooth(0.3)).color(checker(#0a0, #aa0))"
            .to_owned(),
    ];
    let size = [150, 133];
    for text in scenes {
        let camera = "camera(eye: [0.2, 0, 1], target: [0.2, 0, 0], up: [0.3, 1, 0], height: 4)";
        let scene = scene(&format!("{text}\n{camera}"));
        let image =
            scene.render(&options(size).backend(Backend::Cpu), &mut no_progress).unwrap().image;
        let (program, frame) = (scene.program(), scene.defaults());
        let tape = Tape::for_rays(&program.graph, &[program.planar_pixel.unwrap()]).unwrap();
        let mut whole = tape.prepare::<f32>(&frame);
        let view = scene.view(&frame, size).unwrap();
        let width = (2.0 * view.footprint().radius) as f32;
        for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
            let middle = view.ray(x, y)[0].to_array().map(|place| place as f32);
            let [[red, green, blue, distance]] = *whole.eval_ray(middle, [width; 3]) else {
                panic!("one root")
            };
            let pixel = image.pixel(x, y).unwrap();
            for (seen, expected) in pixel.color.into_iter().zip([red, green, blue]) {
                assert!(
                    (seen - expected).abs() < 1e-4,
                    "{text}: {seen}, not {expected} at {x}, {y}"
                );
            }
            assert_eq!(pixel.status == HIT, distance <= 0.0, "{text} at {x}, {y}");
        }
    }
}

#[test]
fn params_and_time_change_a_planar_picture_without_a_recompile() {
    let text = format!("param r = 0.5 in 0..2\ncircle(r).translate(x: time).color(#f00){CAMERA}");
    let scene = scene(&text);
    let painter = scene.painter(&options([40, 40]).backend(Backend::Cpu)).unwrap();
    let mut frame = scene.defaults();
    frame.time = 1.0;
    scene.set(&mut frame, "r", 0.2).unwrap();
    let image = painter.paint(&frame, 1, &mut no_progress).unwrap().image;
    assert_eq!(srgb(&image, [30, 20]), [255, 0, 0]);
    assert_ne!(srgb(&image, [20, 20]), [255, 0, 0]);
}

#[test]
fn the_shader_of_a_planar_picture_has_no_rays_and_no_point_in_space() {
    let text = "circle(1) - rect([1, 1])\nregion wave() = 0.5 * (p.y - sin(p.x))\nwave()";
    let render = ShaderOptions::new().emit(Emit::Render);
    let toy = render.clone().target(Target::Shadertoy).stage(Stage::Fragment);
    for options in [ShaderOptions::new(), render, toy] {
        let Code::Text(code) = scene(text).write_shader(&options).unwrap().code else { panic!() };
        for word in ["trace", "Ray", "(p: vec3", "(vec3 p", "intersect", "light_at"] {
            assert!(!code.contains(word), "{word} is in:\n{code}");
        }
    }
    let field = scene(text).write_shader(&ShaderOptions::new()).unwrap().code;
    let Code::Text(field) = field else { panic!() };
    assert!(field.contains("fn sdf_distance(p: vec2<f32>) -> f32"), "{field}");
    assert!(field.contains("-> vec3<f32>"), "the gradient has the distance in its last lane");
}

#[test]
fn shapes_of_exact_distances_need_no_gradient_in_their_pictures() {
    let code = |text: &str| {
        let options = ShaderOptions::new().emit(Emit::Render);
        let Code::Text(code) = scene(text).write_shader(&options).unwrap().code else { panic!() };
        code.matches("length(").count()
    };
    assert_eq!(code("circle(1)"), 1);
    assert_eq!(code("region disc() = length(p) - 1\ndisc()"), 2);
    // So does a union of exact shapes, which is no exact distance inside, but not a blend.
    let pair = "circle(1).color(#f00), circle(1).translate(x: 1)";
    assert_eq!(code(&format!("union({pair}).rotate(20deg)")), 2);
    assert!(code(&format!("union({pair}, blend: smooth(0.2))")) > 2);
}

#[test]
fn what_needs_solids_is_refused_and_the_message_says_what_to_write() {
    let scene = scene("circle(1)");
    let refused = [
        scene.mesh(&MeshOptions::new(), &mut |_| ControlFlow::Continue(())).err(),
        scene.measure(&Default::default(), &mut |_| ControlFlow::Continue(())).err(),
        scene.bake(&Default::default(), &mut |_| ControlFlow::Continue(())).err(),
        scene.write_shader(&ShaderOptions::new().emit(Emit::March)).err(),
    ];
    for error in refused {
        let error = error.unwrap();
        assert!(matches!(error, Error::Planar(_)) && error.is_call(), "{error}");
        assert!(error.to_string().contains(".extrude(0.2)"), "{error}");
    }
    let solid = Compiler::new().compile("a", "sphere(1)").unwrap();
    let isolines = solid.painter(&options([8, 8]).backend(Backend::Cpu).isolines(1.0));
    assert!(matches!(isolines.err(), Some(Error::NotPlanar)));
}

#[test]
fn a_ray_method_has_no_effect_and_the_picture_says_so() {
    let options = options([8, 8]).backend(Backend::Cpu).method(Method::Interval);
    let picture = scene("circle(1)").render(&options, &mut no_progress).unwrap();
    assert_eq!(picture.stats.method, "none");
    assert!(picture.note.unwrap().contains("no rays"));
}

#[test]
fn a_contour_of_regions_goes_around_them() {
    let plane = Plane::new([0.0, 0.0, 1.0], 0.0).unwrap();
    let mut proceed = |_| ControlFlow::Continue(());
    let scene = scene("circle(1)\ncircle(0.5).translate(x: 3)");
    let contour = scene.contour(plane, &MeshOptions::new(), &mut proceed).unwrap();
    assert!(contour.certificate.is_proven);
    let area = std::f64::consts::PI * 1.25;
    assert!((contour.area() - area).abs() < 0.02, "{}", contour.area());
    let other = Plane::new([1.0, 0.0, 0.0], 0.0).unwrap();
    let refused = scene.contour(other, &MeshOptions::new(), &mut proceed);
    assert!(matches!(refused, Err(Error::PlaneOfRegions)));
}

#[test]
fn the_field_of_a_planar_scene_ignores_z() {
    let scene = scene("rect([2, 1]).color(#f00)\ncircle(0.2).color(#00f)");
    assert_eq!(scene.distance([2.0, 0.0, 7.0]).unwrap(), 1.0);
    let sample = scene.gradient([2.0, 0.0, 7.0]).unwrap();
    assert_eq!(sample.gradient, [1.0, 0.0, 0.0]);
    // The circle covers the rectangle, although the rectangle's edge is farther away.
    let material = scene.material([0.0, 0.0, 0.0]).unwrap().unwrap();
    assert_eq!(material.color, [0.0, 0.0, 1.0]);
}

#[test]
fn many_similar_regions_become_loops() {
    let dots = "union(for i in 0..1200: circle(0.2 + 0.2 * hash(i))\
                .translate([i % 30, floor(i / 30)]).color(hsv(hash(i, 2), 0.7, 0.9)))";
    let scene = scene(dots);
    let explained = scene.explain().unwrap();
    // One circle is at the origin, without a translation.
    assert_eq!((&explained.loops[..], explained.layers), (&[1199][..], 1));
    assert!(explained.code_why.contains("pixels evaluate all"), "{}", explained.code_why);
}

#[test]
fn a_region_is_certified_as_a_solid_is() {
    let points = [0.5, 1.0, 2.0].map(|x| [x, 2.0 * x, 0.0]);
    // The edge is a circle around the origin.
    let divided = scene("region grown(a: region) = a(1.1 * p) - 0.1\ncircle().grown()");
    assert!(divided.is_certified());
    for point in points {
        let truth = point[0] * 5.0_f64.sqrt() - 0.6 / 1.1;
        let distance = divided.distance(point).unwrap();
        assert!(distance <= truth * (1.0 + 1e-12), "{distance} at {point:?}, {truth} away");
    }
    let unknown = scene("region under() = p.y - exp(p.x)\nunder()");
    assert!(!unknown.is_certified());
    // Its picture needs no proof.
    assert!(unknown.diagnostics().is_empty(), "{}", unknown.diagnostics());
    let options = PictureOptions::new().size([32, 32]).backend(Backend::Cpu);
    let picture = unknown.render(&options, &mut no_progress).unwrap();
    assert_eq!(picture.unproven, None);
}
