//! The CPU renderer compared with exact solutions, and f32 with f64.
#![allow(clippy::unwrap_used, reason = "a test that cannot be set up fails")]

mod common;

use std::ops::ControlFlow;

use sdfc_graph::eval::{FrameValues, sample_field};
use sdfc_graph::{Program, Shadow};
use sdfc_march::Method;
use sdfc_render::{
    CAPPED, CpuScene, Frame, HIT, Image, MISS, Progress, Real, RenderError, RenderOptions,
    TileSize, View, compare, edges, no_progress,
};

fn draw(program: &Program, size: [u32; 2], method: Method, tile_size: TileSize) -> Frame {
    let view = common::view(program, size);
    let options = RenderOptions { tile_size, region: None };
    CpuScene::new(program)
        .unwrap()
        .render(&view, &FrameValues::default(), method, &options, &mut no_progress)
        .unwrap()
}

fn depths<T: Real>(program: &Program, size: [u32; 2], method: Method) -> Image {
    let view = common::view(program, size);
    let scene = CpuScene::new(program).unwrap();
    scene.depth_map::<T>(&view, &FrameValues::default(), method).unwrap()
}

#[test]
fn a_sphere_lies_where_the_quadratic_formula_says() {
    let program = common::sphere();
    let view = common::view(&program, [64, 64]);
    for method in [Method::Sphere, Method::Auto] {
        for image in
            [depths::<f32>(&program, [64, 64], method), depths::<f64>(&program, [64, 64], method)]
        {
            let edge = edges(&image);
            assert!(edge.iter().filter(|edge| **edge).count() < 64 * 64 / 8);
            for (index, pixel) in image.pixels().iter().enumerate().filter(|(i, _)| !edge[*i]) {
                let expected = common::depth_of_sphere(&view, index as u32 % 64, index as u32 / 64);
                assert_eq!(pixel.status, if expected.is_some() { HIT } else { MISS });
                let Some(depth) = expected else { continue };
                // `auto` promises a quarter of a pixel, `sphere` the tolerance of the view.
                let quarter = 0.5 * view.footprint().at(depth);
                let limit = if method == Method::Auto { quarter } else { 1e-3 };
                let error = (f64::from(pixel.depth) - depth).abs();
                assert!(error < limit, "{method}: off by {error}");
            }
        }
    }
}

#[test]
fn f32_and_f64_agree_outside_edges() {
    for program in [common::sphere(), common::sphere_above_floor()] {
        for method in [Method::Sphere, Method::Auto] {
            let single = depths::<f32>(&program, [64, 64], method);
            let double = depths::<f64>(&program, [64, 64], method);
            let difference = compare(&single, &double).unwrap();
            assert!(difference.depth < 1e-3 && difference.status == 0, "{difference:?}");
            assert!(difference.compared > 3000, "{difference:?}");
        }
    }
}

#[test]
fn tiles_of_any_size_give_the_same_picture() {
    let program = common::sphere_above_floor();
    let whole = draw(&program, [61, 47], Method::Auto, TileSize::Fixed([61, 47]));
    assert_eq!(whole.tiles, 1);
    for tile in [[7, 5], [61, 1], [1, 47], [64, 3]] {
        let tiled = draw(&program, [61, 47], Method::Auto, TileSize::Fixed(tile));
        assert!(tiled.tiles > 1);
        assert_eq!(tiled.image, whole.image, "{tile:?}");
    }
}

/// Hits of one picture that the other lacks, and the greatest difference of depth in pixels where
/// both have one.
fn difference(one: &Image, other: &Image) -> (usize, f32) {
    let pairs = || one.pixels().iter().zip(other.pixels());
    let differing = pairs().filter(|(a, b)| (a.status == HIT) != (b.status == HIT)).count();
    let both = pairs().filter(|(a, b)| a.status == HIT && b.status == HIT);
    let depth = both.map(|(a, b)| (a.depth - b.depth).abs() / one.pixel_width(a.depth));
    (differing, depth.fold(0.0, f32::max))
}

#[test]
fn rays_that_share_work_see_what_single_rays_see() {
    let size = [96, 72];
    let proven = |program: Program| program.with_segment_bounds(true, false);
    for (program, method) in [
        (common::crowd(1.0), Method::Sphere),
        (common::crowd(1.0), Method::Auto),
        (proven(common::crowd(1.0)), Method::Interval),
        (proven(common::crowd(3.0)), Method::Interval),
    ] {
        let shared = draw(&program, size, method, TileSize::default()).image;
        let single = depths::<f64>(&program, size, method);
        assert!(single.counts().hit > 600, "{:?}", single.counts());
        let (differing, depth) = difference(&shared, &single);
        assert!(differing <= 2 && depth < 0.05, "{method}: {differing} pixels, {depth}");
        assert!(method == Method::Interval || shared.counts().unproven == 0, "{method}");
    }
}

#[test]
fn rays_skip_cells_without_a_surface() {
    let program = common::crowd(3.0).with_segment_bounds(true, false);
    let evaluations = |image: &Image| -> u32 {
        image.pixels().iter().map(|pixel| pixel.primary_evaluations).sum()
    };
    let shared = draw(&program, [96, 72], Method::Interval, TileSize::default()).image;
    let single = depths::<f32>(&program, [96, 72], Method::Interval);
    let [shared, single] = [shared, single].map(|image| evaluations(&image));
    assert!(2 * shared < single, "{shared} of {single} evaluations");
}

#[test]
fn cells_that_frames_share_do_not_change_their_pictures() {
    let program = common::swelling_crowd().with_segment_bounds(true, false);
    let scene = CpuScene::new(&program).unwrap();
    for method in [Method::Auto, Method::Interval] {
        let picture = |scene: &CpuScene, eye: [f64; 3], time| {
            let view = View { eye: eye.into(), ..common::view(&program, [64, 48]) };
            let (frame, options) =
                (FrameValues { time, ..FrameValues::default() }, RenderOptions::default());
            scene.render(&view, &frame, method, &options, &mut no_progress).unwrap().image
        };
        let mut hits = Vec::new();
        for (eye, time) in [
            ([0.0, 0.0, 5.0], 0.0),
            ([0.3, 0.2, 4.0], 0.0),
            ([0.3, 0.2, 4.0], 0.3),
            ([0.0, 0.0, 5.0], 0.0),
        ] {
            let shared = picture(&scene, eye, time);
            let alone = picture(&CpuScene::new(&program).unwrap(), eye, time);
            assert_eq!(shared, alone, "{method}: {eye:?} at {time}");
            hits.push(shared.counts().hit);
        }
        assert!(hits[0] > 300 && hits[2] > hits[1] + 50 && hits[3] == hits[0], "{hits:?}");
    }
}

#[test]
fn a_steep_field_is_never_stepped_through() {
    // Its value is three times the distance, so only proofs find its surface.
    let program = common::crowd(3.0).with_segment_bounds(true, false);
    let shared = draw(&program, [160, 120], Method::Interval, TileSize::default()).image;
    let exact = depths::<f64>(&common::crowd(1.0), [160, 120], Method::Auto);
    let (differing, depth) = difference(&shared, &exact);
    assert!(differing <= 4 && depth < 0.1, "{differing} pixels, {depth}");
}

#[test]
fn normals_of_a_shortened_field_are_those_of_the_whole_one() {
    let program = common::crowd(1.0);
    let image = draw(&program, [160, 120], Method::Auto, TileSize::default()).image;
    let view = common::view(&program, [160, 120]);
    let frame = FrameValues::default();
    let (mut lit, mut shadowed) = (0, 0);
    for (index, pixel) in image.pixels().iter().enumerate().filter(|(_, p)| p.status == HIT) {
        let [origin, direction] = view.ray(index as u32 % 160, index as u32 / 160);
        let point = origin + direction * f64::from(pixel.depth);
        let sample = sample_field(&program, &frame, &[point.to_array()]).unwrap();
        // Lambert's law under a light overhead, or shadow.
        let expected = 0.8 * sample[0].gradient[1].max(0.0);
        let shade = f64::from(pixel.color[0]);
        if shade == 0.0 {
            shadowed += 1;
        } else {
            assert!((shade - expected).abs() < 0.02, "{point}: {shade}, {expected}");
            lit += 1;
        }
    }
    assert!(lit > 500 && shadowed > 500, "{lit} lit, {shadowed} not");
}

#[test]
fn a_light_overhead_casts_the_spheres_shadow_on_the_floor() {
    let frame = draw(&common::sphere_above_floor(), [96, 64], Method::Auto, TileSize::default());
    let view = common::view(&common::sphere_above_floor(), [96, 64]);
    let (mut lit, mut shadowed) = (0, 0);
    for (index, pixel) in frame.image.pixels().iter().enumerate() {
        let [x, y] = [index as u32 % 96, index as u32 / 96];
        let point = view.eye + view.ray(x, y)[1] * f64::from(pixel.depth);
        if pixel.status != HIT || (point.y + 1.0).abs() > 1e-3 {
            continue;
        }
        let away = point.x.hypot(point.z);
        let expected = match away {
            _ if away < 0.95 => 0.8 * 0.1,
            _ if away > 1.05 => 0.8 * 1.1,
            _ => continue,
        };
        if away < 1.0 {
            shadowed += 1
        } else {
            lit += 1
        }
        assert!((f64::from(pixel.color[0]) - expected).abs() < 1e-3, "{point}: {:?}", pixel.color);
        assert!(pixel.evaluations > pixel.primary_evaluations);
    }
    assert!(lit > 500 && shadowed > 100, "{lit} lit, {shadowed} in shadow");
}

/// The floor's pixels: their positions and colours.
fn floor_pixels(program: &Program) -> Vec<(glam::DVec3, f64, [f32; 4])> {
    let view = common::view(program, [96, 64]);
    let frame = draw(program, [96, 64], Method::Auto, TileSize::default());
    let pixels = frame.image.pixels().iter().enumerate().map(|(index, pixel)| {
        let direction = view.ray(index as u32 % 96, index as u32 / 96)[1];
        let depth = f64::from(pixel.depth);
        (view.eye + direction * depth, depth, pixel.color, pixel.status)
    });
    let floor =
        pixels.filter(|(point, _, _, status)| *status == HIT && (point.y + 1.0).abs() < 1e-3);
    floor.map(|(point, depth, color, _)| (point, depth, color)).collect()
}

fn fade(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[test]
fn a_soft_shadow_fades_as_the_clearance_says() {
    let sharpness = 4.0;
    let (mut fading, mut dark, mut off) = (0, 0, 0.0f64);
    for (point, _, color) in floor_pixels(&common::soft_shadow(sharpness)) {
        let away = point.x.hypot(point.z);
        // The ray leads straight up past the sphere, whose centre is 1.5 above the floor.
        let ratio = |t: f64| (away.hypot(1.5 - t) - 1.0) / t;
        let clearance = (1..4000).map(|i| ratio(f64::from(i) * 1e-3)).fold(f64::INFINITY, f64::min);
        let light = fade(sharpness * clearance);
        let expected = 0.8 * (0.1 + light);
        fading += usize::from(0.05 < light && light < 0.95);
        dark += usize::from(clearance < 0.0);
        off = off.max((f64::from(color[0]) - expected).abs());
    }
    assert!(fading > 200 && dark > 100, "{fading} between, {dark} in shadow");
    // The samples of a ray are too far apart to contain the nearest point.
    assert!(off < 0.06, "off by {off}");
}

#[test]
fn a_point_light_is_not_in_the_shadow_of_the_ceiling_above_it() {
    let place = glam::DVec3::new(0.0, 0.9, 0.0);
    let mut program = common::light_at_ceiling(place.to_array(), Shadow::Hard);
    let hard = floor_pixels(&program);
    let sharpness = program.graph.number(8.0);
    for light in &mut program.settings.lights {
        light.shadow = Shadow::Soft(sharpness);
    }
    let soft = floor_pixels(&program);
    let mut compared = 0;
    for ((point, _, hard), (_, _, soft)) in hard.into_iter().zip(soft) {
        let way = place - point;
        // Grazing light passes the floor itself narrowly.
        if way.y < 0.3 * way.length() {
            continue;
        }
        compared += 1;
        assert!((hard[0] - soft[0]).abs() < 1e-3, "{point}: {} and {}", hard[0], soft[0]);
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn a_point_light_falls_off_with_the_square_of_the_distance() {
    let place = glam::DVec3::new(3.0, 0.5, 1.0);
    let (mut lit, mut shadowed) = (0, 0);
    for (point, _, color) in floor_pixels(&common::point_light(place.to_array(), 4.0, Shadow::Hard))
    {
        let way = place - point;
        // The distance of the sphere's centre from the ray, if it lies beside it.
        let center = glam::DVec3::new(0.0, 0.5, 0.0) - point;
        let along = center.dot(way.normalize());
        let aside = (center - way.normalize() * along).length();
        let light = match aside {
            _ if aside < 0.95 && along > 0.0 && along < way.length() => 0.0,
            _ if aside > 1.05 || along < 0.0 || along > way.length() + 1.0 => {
                4.0 / way.length_squared() * way.normalize().y
            }
            _ => continue,
        };
        if light > 0.0 {
            lit += 1
        } else {
            shadowed += 1
        }
        assert!((f64::from(color[0]) - 0.8 * (0.1 + light)).abs() < 2e-3, "{point}: {color:?}");
    }
    assert!(lit > 500 && shadowed > 100, "{lit} lit, {shadowed} in shadow");
}

#[test]
fn fog_turns_what_is_far_into_the_sky_behind_it() {
    let density = 0.2;
    let program = common::foggy(density);
    let eye = common::view(&program, [96, 64]).eye;
    let without = floor_pixels(&common::foggy(0.0));
    let with = floor_pixels(&program);
    assert!(with.len() > 500 && with.len() == without.len());
    for ((point, depth, color), (_, _, clear)) in with.iter().zip(without) {
        // The whole floor is seen from above, where the sky has the horizon's colour.
        assert!(point.y < eye.y);
        let left = (-density * depth).exp() as f32;
        for channel in 0..3 {
            let expected = clear[channel] * left + 1.0 - left;
            assert!((color[channel] - expected).abs() < 1e-4, "{point}: {color:?}");
        }
    }
    let frame = draw(&program, [96, 64], Method::Auto, TileSize::default());
    let top = frame.image.pixel(48, 0).unwrap();
    let up = common::view(&program, [96, 64]).ray(48, 0)[1].y;
    assert!(up > 0.1 && (f64::from(top.color[0]) - (1.0 - up).powi(3)).abs() < 1e-4, "{top:?}");
}

#[test]
fn the_floor_is_dark_under_the_sphere_and_open_away_from_it() {
    let (mut under, mut open) = (0, 0);
    for (point, _, color) in floor_pixels(&common::occluded(1.0)) {
        let away = point.x.hypot(point.z);
        // Heights 0.2 to 1 above the floor; the sphere begins 0.5 above it.
        let gap = |height: f64| (away.hypot(1.5 - height) - 1.0).min(height);
        let heights = (1..=5).map(|i| (f64::from(i) / 5.0, 0.5f64.powi(i)));
        let closed: f64 = heights.map(|(h, share)| share * (1.0 - gap(h).max(0.0) / h)).sum();
        let expected = 0.8 * (1.0 - closed / (1.0 - 0.5f64.powi(5)));
        if away < 0.5 {
            under += usize::from(expected < 0.7)
        }
        if away > 2.0 {
            open += usize::from(expected > 0.799)
        }
        assert!((f64::from(color[0]) - expected).abs() < 2e-3, "{point}: {color:?}, {expected}");
    }
    assert!(under > 20 && open > 200, "{under} under it, {open} open");
}

#[test]
fn parallel_rays_see_the_sphere_as_a_disc_of_its_size() {
    let program = common::parallel(4.0);
    let frame = draw(&program, [80, 80], Method::Auto, TileSize::default());
    // 20 pixels per unit.
    let disc = std::f64::consts::PI * 400.0;
    let hits = frame.image.counts().hit as f64;
    assert!((hits - disc).abs() < 0.02 * disc, "{hits} pixels of {disc}");
    for (x, y) in [(40, 40), (50, 33), (27, 45)] {
        let [a, b] = [x, y].map(|at: u32| (f64::from(at) + 0.5) / 20.0 - 2.0);
        let expected = 5.0 - (1.0 - a * a - b * b).sqrt();
        let pixel = frame.image.pixel(x, y).unwrap();
        assert!((f64::from(pixel.depth) - expected).abs() < 1e-3, "{pixel:?}, {expected}");
    }
}

#[test]
fn the_floor_mirrors_the_sphere_where_the_quadratic_formula_says() {
    let program = common::mirrors();
    let view = common::view(&program, [96, 64]);
    let plain =
        draw(&common::sphere_above_floor(), [96, 64], Method::Auto, TileSize::default()).image;
    let mirrored = draw(&program, [96, 64], Method::Auto, TileSize::default()).image;
    let center = glam::DVec3::new(0.0, 0.5, 0.0);
    let (mut spheres, mut skies) = (0, 0);
    for (index, (with, without)) in mirrored.pixels().iter().zip(plain.pixels()).enumerate() {
        let direction = view.ray(index as u32 % 96, index as u32 / 96)[1];
        let point = view.eye + direction * f64::from(with.depth);
        if with.status != HIT || (point.y + 1.0).abs() > 1e-3 {
            continue;
        }
        // Reflected at the floor, from there to the nearest point on its line to the sphere's
        // centre.
        let up = direction * glam::DVec3::new(1.0, -1.0, 1.0);
        let along = (center - point).dot(up);
        let apart = (point + up * along - center).length();
        let added = std::array::from_fn::<f64, 3, _>(|channel| {
            f64::from(with.color[channel] - without.color[channel])
        });
        // Schlick's approximation for a dielectric.
        let fresnel = 0.04 + 0.96 * (1.0 + direction.y).powi(5);
        // The reflected ray starts a fraction of a pixel above the floor.
        let expected = if apart > 1.08 || along < 0.0 {
            skies += 1;
            [0.0, 0.0, 0.5 * fresnel]
        } else if apart < 0.92 {
            spheres += 1;
            let met = point + up * (along - (1.0 - apart * apart).sqrt());
            let light = (met - center).y.max(0.0);
            [1.0, 0.5, 0.25].map(|channel| fresnel * 0.5 * 0.8 * (0.1 + channel * light))
        } else {
            continue;
        };
        let off = added.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.1 * fresnel, "{point}: {added:?} is not {expected:?}");
    }
    assert!(spheres > 100 && skies > 100, "{spheres} of the sphere, {skies} of the sky");
}

#[test]
fn a_ray_that_misses_shows_the_background_and_a_hit_the_paint() {
    let frame = draw(&common::sphere_above_floor(), [16, 16], Method::Sphere, TileSize::default());
    let sky = frame.image.pixel(0, 0).unwrap();
    assert_eq!((sky.status, sky.color), (MISS, [0.0, 0.0, 1.0, 1.0]));

    // Facing the headlight: half of it dielectric, half metal. At n = l = v = h the highlight is F
    // D / 4 with pi D = 1 / alpha^2, and 0.96 squared of the diffuse colour comes back.
    let frame =
        draw(&common::sphere_with_material(), [33, 33], Method::Sphere, TileSize::default());
    let middle = frame.image.pixel(16, 16).unwrap();
    let peak = 0.25 / 0.3f64.powi(4);
    let expected = [0.8, 0.1].map(|c| c * 0.5 * 0.96 * 0.96 + (0.04 + c) / 2.0 * peak);
    for (channel, expected) in middle.color.iter().zip(expected) {
        assert!((f64::from(*channel) - expected).abs() < 1e-3 * peak, "{:?}", middle.color);
    }
}

#[test]
fn a_field_that_is_not_a_number_is_counted() {
    for method in [Method::Sphere, Method::Auto] {
        let counts = draw(&common::half_undefined(), [40, 40], method, TileSize::default());
        let counts = counts.image.counts();
        assert_eq!(counts.nan, 800, "{method}: {counts:?}");
        assert!(counts.hit > 100 && counts.capped == 0, "{method}: {counts:?}");
    }
}

#[test]
fn rays_out_of_steps_are_capped() {
    let mut program = common::sphere_above_floor();
    program.settings.march.steps = Some(3);
    let frame = draw(&program, [32, 32], Method::Sphere, TileSize::default());
    let counts = frame.image.counts();
    assert!(counts.capped > 100, "{counts:?}");
    let longest = frame.image.pixels().iter().map(|pixel| pixel.primary_evaluations).max();
    assert_eq!(longest, Some(3));
    let capped = frame.image.pixels().iter().find(|pixel| pixel.status == CAPPED);
    assert!(capped.is_some_and(|pixel| pixel.color == [0.0, 0.0, 1.0, 1.0]));
}

#[test]
fn a_ray_whose_steps_end_before_a_proof_is_unproven() {
    let mut program = common::sphere().with_segment_bounds(true, false);
    program.settings.march.steps = Some(1);
    let image = depths::<f32>(&program, [32, 32], Method::Interval);
    let misses: Vec<_> = image.pixels().iter().filter(|pixel| pixel.status == MISS).collect();
    let unproven = misses.iter().filter(|pixel| pixel.unproven != 0).count();
    assert!(unproven > 50, "{unproven} misses are unproven");
    assert!(misses.iter().all(|pixel| pixel.unproven != 0 || pixel.evaluations == 1));
}

#[test]
fn counting_unproven_rays_stops_early() {
    let program = common::sphere();
    let view = View { steps: 1, ..common::view(&program, [32, 32]) };
    let frame = FrameValues::default();
    let scene = CpuScene::new(&program).unwrap();
    let limited =
        |most, work| scene.unproven_rays(&view, &frame, Method::Interval, most, work).unwrap();
    let count = |most| limited(most, u64::MAX);
    let all = scene.depth_map::<f32>(&view, &frame, Method::Interval).unwrap().counts().unproven;
    assert!(all > 100, "{all}");
    assert_eq!(count(u64::MAX), all);
    assert!((1..=32).contains(&count(0)), "{}", count(0));
    // Without the work for a step of each ray, nothing is proven.
    assert_eq!(limited(u64::MAX, 32 * 32), 32 * 32);
}

#[test]
fn odd_sizes_are_drawn_and_impossible_ones_refused() {
    for size in [[1, 1], [4097, 3]] {
        let frame = draw(&common::sphere(), size, Method::Sphere, TileSize::default());
        assert_eq!(frame.image.size(), size);
        let pixel = frame.image.pixel(size[0] / 2, size[1] / 2).unwrap();
        assert_eq!(pixel.status, HIT);
    }
    let program = common::sphere();
    let scene = CpuScene::new(&program).unwrap();
    let view = common::view(&program, [0, 4]);
    let error = scene.depth_map::<f32>(&view, &FrameValues::default(), Method::Sphere).unwrap_err();
    assert_eq!(error, RenderError::Size([0, 4]));
}

#[test]
fn faults_of_the_call_are_errors() {
    let program = common::sphere();
    let (view, frame) = (common::view(&program, [64, 64]), FrameValues::default());
    let scene = CpuScene::new(&program).unwrap();
    let options = RenderOptions { tile_size: TileSize::Fixed([16, 16]), region: None };
    let error = scene.render(&view, &frame, Method::Fixed, &options, &mut no_progress).unwrap_err();
    assert_eq!(error, RenderError::MethodNotOnCpu(Method::Fixed));

    let mut calls = 0;
    let mut stop = |progress: Progress| {
        calls += 1;
        assert_eq!(progress.total, 64 * 64);
        if progress.done >= 512 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let error = scene.render(&view, &frame, Method::Sphere, &options, &mut stop).unwrap_err();
    assert_eq!((error, calls), (RenderError::Cancelled, 2));

    let nothing = CpuScene::new(&Program::default()).unwrap_err();
    assert_eq!(nothing, RenderError::NothingDrawn);
}
