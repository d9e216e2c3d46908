//! Drawing on an adapter. Without one every test here is reported as ignored, unless
//! `SDFC_REQUIRE_GPU=1` is set.

mod common;

use std::ops::ControlFlow;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_graph::{Program, Shadow, eval::FrameValues};
use sdfc_march::Method;
use sdfc_render::{
    Clock, CpuScene, DeviceTexture, Display, Frame, Gpu, Image, Pipeline, Progress, RenderError,
    RenderOptions, TileSize, View, compare, no_progress, testing, uniform_values,
};

type Outcome = Result<(), Failed>;

const PATTERN: &str = include_str!("pattern.wgsl");
const VALUES: [[f32; 4]; 2] = [[0.0; 4], [0.0, 0.0, 0.0, 0.75]];

fn main() {
    let arguments = Arguments::from_args();
    let ignored = testing::without_gpu();
    let trials = vec![
        Trial::test("every_pixel_comes_back_from_its_place", every_pixel_comes_back_from_its_place),
        Trial::test("an_adaptive_frame_grows_its_tiles", an_adaptive_frame_grows_its_tiles),
        Trial::test("a_frame_begins_with_larger_tiles", a_frame_begins_with_larger_tiles),
        Trial::test("impossible_calls_are_refused", impossible_calls_are_refused),
        Trial::test("a_bad_shader_is_an_error", a_bad_shader_is_an_error),
        Trial::test("the_device_survives_an_error", the_device_survives_an_error),
        Trial::test("gpu_and_cpu_agree", gpu_and_cpu_agree),
        Trial::test("every_method_casts_the_same_soft_shadow", soft_shadows_are_the_same),
        Trial::test("tiles_give_the_picture_of_one_tile", tiles_give_the_picture_of_one_tile),
        Trial::test("a_texture_shows_the_picture_that_is_copied", textures_show_the_same),
        Trial::test("a_param_moves_the_surface", a_param_moves_the_surface),
        Trial::test("fields_that_are_no_numbers_are_counted", not_a_number_is_counted),
        Trial::test("a_lost_device_is_an_error_and_stays_one", a_lost_device_stays_lost),
        Trial::test(
            "progress_is_reported_and_can_cancel_the_frame",
            progress_is_reported_and_can_cancel_the_frame,
        ),
    ];
    let trials = trials.into_iter().map(|trial| trial.with_ignored_flag(ignored)).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

fn pattern(gpu: &Gpu, view: &View, tile_size: TileSize) -> Result<Frame, RenderError> {
    let options = RenderOptions { tile_size, region: None };
    Pipeline::from_wgsl(gpu, PATTERN, 2)?.render(view, &VALUES, &options, &mut no_progress)
}

/// A frame of a program, drawn by its own shader.
fn draw(
    gpu: &Gpu,
    program: &Program,
    frame: &FrameValues,
    size: [u32; 2],
    method: Method,
    tile_size: TileSize,
) -> Result<Frame, Failed> {
    let shader = sdfc_codegen::render_module(program, method)?;
    let pipeline = Pipeline::new(gpu, shader, program.uniforms.len())?;
    let view = View::new(program, frame, None, size)?;
    let uniforms = uniform_values(program, frame);
    let options = RenderOptions { tile_size, region: None };
    Ok(pipeline.render(&view, &uniforms, &options, &mut no_progress)?)
}

fn gpu_and_cpu_agree() -> Outcome {
    let gpu = Gpu::new()?;
    let (size, frame) = ([64, 64], FrameValues::default());
    for program in [
        common::sphere(),
        common::sphere_above_floor(),
        common::sphere_with_material(),
        common::steep_sphere(),
        common::mirrors(),
        common::soft_shadow(4.0),
        // At the edge of a hard shadow rounding decides.
        common::point_light([3.0, 0.5, 1.0], 4.0, Shadow::Off),
        common::foggy(0.2),
        common::occluded(1.0),
        common::parallel(4.0),
    ] {
        let program = program.with_segment_bounds(true, false);
        let view = common::view(&program, size);
        let scene = CpuScene::new(&program)?;
        for method in [Method::Sphere, Method::Auto, Method::Interval] {
            let tiles = TileSize::default();
            let on_gpu = draw(&gpu, &program, &frame, size, method, tiles)?.image;
            let options = RenderOptions::default();
            let on_cpu = scene.render(&view, &frame, method, &options, &mut no_progress)?.image;
            let close = compare(&on_gpu, &on_cpu).ok_or("different sizes")?;
            assert!(close.depth < 1e-3 && close.status == 0, "{method}: {close:?}");
            assert!(close.color <= 1 && close.mean_color < 0.1, "{method}: {close:?}");
            assert!(close.compared > 3000, "{method}: {close:?}");
            check_evaluations(method, &on_gpu, &on_cpu);

            let double = scene.depth_map::<f64>(&view, &frame, method)?;
            let close = compare(&on_gpu, &double).ok_or("different sizes")?;
            assert!(close.depth < 1e-3 && close.status == 0, "{method}: {close:?}");
        }
    }
    Ok(())
}

fn check_evaluations(method: Method, on_gpu: &Image, on_cpu: &Image) {
    let count = |image: &Image| image.pixels().iter().map(|p| u64::from(p.evaluations)).sum();
    // On the CPU, the rays of `interval` pass cells of space instead of segments of their own.
    if method == Method::Interval {
        let [on_gpu, on_cpu]: [u64; 2] = [on_gpu, on_cpu].map(count);
        assert!(on_cpu < on_gpu, "{on_cpu} evaluations on the CPU, {on_gpu} on the GPU");
        return;
    }
    // Rounding ends a few rays a step earlier or later.
    let pairs = on_gpu.pixels().iter().zip(on_cpu.pixels());
    let differing = pairs.filter(|(one, other)| one.evaluations != other.evaluations).count();
    assert!(differing < 40, "{method}: {differing}");
}

fn textures_show_the_same() -> Outcome {
    let gpu = Gpu::new()?;
    let display = Display::new(&gpu)?;
    let (size, program, frame) = ([77, 50], common::sphere_above_floor(), FrameValues::default());
    let shader = sdfc_codegen::render_module(&program, Method::Auto)?;
    let pipeline = Pipeline::new(&gpu, shader, program.uniforms.len())?;
    let view = View::new(&program, &frame, None, size)?;
    let uniforms = uniform_values(&program, &frame);
    let options = RenderOptions::default();
    let copied = pipeline.render(&view, &uniforms, &options, &mut no_progress)?.image.to_srgb8();
    for tile_size in [TileSize::default(), TileSize::Fixed([16, 24])] {
        let target = DeviceTexture::new(&gpu, size)?;
        pipeline.show(&view, &uniforms, tile_size, (&display, &target), &mut no_progress)?;
        let shown = testing::read_texture(&gpu, &target)?;
        let shown: Vec<u8> = shown.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
        assert_eq!(shown.len(), copied.len());
        // The driver's `pow` may round differently.
        let far = shown.iter().zip(&copied).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        assert_eq!(far, 0, "{tile_size:?}");
        assert!(copied.iter().any(|byte| *byte > 100));
    }
    let other = DeviceTexture::new(&gpu, [8, 8])?;
    let target = (&display, &other);
    let refused = pipeline.show(&view, &uniforms, TileSize::default(), target, &mut no_progress);
    assert_eq!(refused, Err(RenderError::TextureSize { texture: [8, 8], picture: size }));
    Ok(())
}

/// Steps of another length sample other positions of a ray, from which its shadow is estimated.
fn soft_shadows_are_the_same() -> Outcome {
    let gpu = Gpu::new()?;
    let program = common::soft_shadow(4.0).with_segment_bounds(true, true);
    let (size, frame) = ([96, 64], FrameValues::default());
    let picture = |method| {
        Ok::<_, Failed>(draw(&gpu, &program, &frame, size, method, TileSize::default())?.image)
    };
    let plain = picture(Method::Sphere)?;
    let is_same = |image: &Image, what: &str| {
        let close = compare(image, &plain).ok_or("different sizes")?;
        assert!(close.mean_color < 0.5, "{what}: {close:?}");
        Ok::<_, Failed>(())
    };
    // Neither of these finds what the others do.
    let walks = |method: &Method| ![Method::Fixed, Method::Practical].contains(method);
    for method in Method::all().filter(walks) {
        is_same(&picture(method)?, method.name())?;
    }
    let view = common::view(&program, size);
    let (scene, options) = (CpuScene::new(&program)?, RenderOptions::default());
    for method in [Method::Auto, Method::Interval] {
        let on_cpu = scene.render(&view, &frame, method, &options, &mut no_progress)?.image;
        is_same(&on_cpu, &format!("{method} on the CPU"))?;
    }
    Ok(())
}

fn tiles_give_the_picture_of_one_tile() -> Outcome {
    let (gpu, program) = (Gpu::new()?, common::sphere_above_floor());
    let frame = FrameValues::default();
    let picture =
        |tile| draw(&gpu, &program, &frame, [61, 47], Method::Auto, TileSize::Fixed(tile));
    let whole = picture([61, 47])?;
    assert_eq!(whole.tiles, 1);
    for tile in [[7, 5], [61, 1], [1, 47], [64, 3]] {
        assert_eq!(picture(tile)?.image, whole.image, "{tile:?}");
    }
    Ok(())
}

fn a_param_moves_the_surface() -> Outcome {
    let (gpu, program) = (Gpu::new()?, common::sphere_of_param());
    for radius in [1.0, 0.5] {
        let params = vec![[radius, 0.0, 0.0, 0.0]];
        let frame = FrameValues { params, time: 0.0, frame: 0.0 };
        let drawn = draw(&gpu, &program, &frame, [33, 33], Method::Sphere, TileSize::default())?;
        let depth = drawn.image.pixel(16, 16).ok_or("no such pixel")?.depth;
        assert!((f64::from(depth) - (5.0 - radius)).abs() < 1e-3, "{depth}");
    }
    Ok(())
}

fn not_a_number_is_counted() -> Outcome {
    let (gpu, program) = (Gpu::new()?, common::half_undefined());
    let frame = FrameValues::default();
    for method in [Method::Sphere, Method::Auto] {
        let drawn = draw(&gpu, &program, &frame, [40, 40], method, TileSize::default())?;
        let counts = drawn.image.counts();
        assert_eq!(counts.nan, 800, "{method}: {counts:?}");
    }
    Ok(())
}

fn every_pixel_comes_back_from_its_place() -> Outcome {
    let gpu = Gpu::new()?;
    for size in [[1, 1], [4097, 3], [61, 47]] {
        let view = common::view(&common::sphere(), size);
        for tile_size in [
            TileSize::default(),
            TileSize::Fixed([7, 5]),
            TileSize::Fixed([64, 1]),
            TileSize::Fixed([4097, 47]),
        ] {
            let frame = pattern(&gpu, &view, tile_size)?;
            for (index, pixel) in frame.image.pixels().iter().enumerate() {
                assert_eq!(pixel.evaluations as usize, index, "{size:?} {tile_size:?}");
                assert_eq!(pixel.color, [0.75, 5.0, 1.0, 1.0]);
                assert_eq!(pixel.depth, view.t_max as f32);
                assert_eq!((pixel.status, pixel.primary_evaluations), (1, view.steps));
            }
        }
    }
    Ok(())
}

fn an_adaptive_frame_grows_its_tiles() -> Outcome {
    let gpu = Gpu::new()?;
    let view = common::view(&common::sphere(), [1024, 512]);
    let adaptive = pattern(&gpu, &view, TileSize::Adaptive { milliseconds: 1e6 })?;
    // 64 pixels, then four times as many each, until a band of 64 rows is full.
    assert!(adaptive.tiles < 40, "{} tiles", adaptive.tiles);
    let timid = pattern(&gpu, &view, TileSize::Adaptive { milliseconds: 1e-9 })?;
    assert!(timid.tiles > 1000, "{} tiles", timid.tiles);
    assert_eq!(adaptive.clock == Clock::Gpu, gpu.has_timestamps());
    assert!(adaptive.milliseconds > 0.0 && adaptive.milliseconds < 60_000.0);
    Ok(())
}

fn a_frame_begins_with_larger_tiles() -> Outcome {
    let gpu = Gpu::new()?;
    let view = common::view(&common::sphere(), [1024, 512]);
    let pipeline = Pipeline::from_wgsl(&gpu, PATTERN, 2)?;
    let tile_size = TileSize::Adaptive { milliseconds: 1e6 };
    let options = RenderOptions { tile_size, region: None };
    let frame = || pipeline.render(&view, &VALUES, &options, &mut no_progress);
    let (first, second) = (frame()?, frame()?);
    assert!(first.tiles > 1, "nothing is known of the first frame");
    assert_eq!(second.tiles, 1);
    assert_eq!(first.image.pixels(), second.image.pixels());
    // A cancelled frame is one that something is known of, too.
    let stop = &mut |_| std::ops::ControlFlow::Break(());
    let cancelled = pipeline.render(&view, &VALUES, &options, stop).err();
    assert_eq!(cancelled, Some(RenderError::Cancelled));
    assert_eq!(frame()?.tiles, 1);
    Ok(())
}

fn impossible_calls_are_refused() -> Outcome {
    let gpu = Gpu::new()?;
    for size in [[0, 4], [4, 0], [16_385, 1], [16_384, 16_384]] {
        let view = common::view(&common::sphere(), size);
        let refused = pattern(&gpu, &view, TileSize::default()).err();
        assert_eq!(refused, Some(RenderError::Size(size)));
    }
    let view = common::view(&common::sphere(), [4, 4]);
    let pipeline = Pipeline::from_wgsl(&gpu, PATTERN, 2)?;
    let refused =
        pipeline.render(&view, &VALUES[..1], &RenderOptions::default(), &mut no_progress).err();
    assert_eq!(refused, Some(RenderError::UniformCount { given: 1, expected: 2 }));
    let many = Pipeline::from_wgsl(&gpu, PATTERN, 1 << 40).err();
    assert!(matches!(many, Some(RenderError::Uniforms { .. })), "{many:?}");
    Ok(())
}

fn a_bad_shader_is_an_error() -> Outcome {
    let gpu = Gpu::new()?;
    let no_wgsl = Pipeline::from_wgsl(&gpu, "fn main( {", 0).err();
    assert!(matches!(no_wgsl, Some(RenderError::Validation(_))), "{no_wgsl:?}");
    let no_entry = Pipeline::from_wgsl(&gpu, "fn other() {}", 0).err();
    assert!(matches!(no_entry, Some(RenderError::Validation(_))), "{no_entry:?}");
    // The pattern reads binding 1, which the layout of a scene without per-frame values lacks.
    let no_values = Pipeline::from_wgsl(&gpu, PATTERN, 0).err();
    assert!(matches!(no_values, Some(RenderError::Validation(_))), "{no_values:?}");
    Ok(())
}

fn the_device_survives_an_error() -> Outcome {
    let gpu = Gpu::new()?;
    assert!(Pipeline::from_wgsl(&gpu, "fn other() {}", 0).is_err());
    let view = common::view(&common::sphere(), [9, 9]);
    assert_eq!(pattern(&gpu, &view, TileSize::default())?.image.counts().hit, 81);
    Ok(())
}

fn a_lost_device_stays_lost() -> Outcome {
    let gpu = Gpu::new()?;
    let view = common::view(&common::sphere(), [64, 64]);
    let pipeline = Pipeline::from_wgsl(&gpu, PATTERN, 2)?;
    let options = RenderOptions { tile_size: TileSize::Fixed([16, 16]), region: None };
    let mut tiles = 0;
    let mut lose = |_: Progress| {
        tiles += 1;
        if tiles == 3 {
            testing::lose(&gpu);
        }
        ControlFlow::Continue(())
    };
    let lost = pipeline.render(&view, &VALUES, &options, &mut lose).err();
    assert!(matches!(lost, Some(RenderError::DeviceLost(_))), "{lost:?}");
    assert_eq!(tiles, 3);
    let again = pipeline.render(&view, &VALUES, &options, &mut no_progress).err();
    assert!(matches!(again, Some(RenderError::DeviceLost(_))), "{again:?}");
    let anew = Pipeline::from_wgsl(&gpu, PATTERN, 2).err();
    assert!(matches!(anew, Some(RenderError::DeviceLost(_))), "{anew:?}");
    // Another device of the same adapter draws.
    assert_eq!(pattern(&Gpu::new()?, &view, TileSize::default())?.image.counts().hit, 64 * 64);
    Ok(())
}

fn progress_is_reported_and_can_cancel_the_frame() -> Outcome {
    let gpu = Gpu::new()?;
    let view = common::view(&common::sphere(), [64, 64]);
    let pipeline = Pipeline::from_wgsl(&gpu, PATTERN, 2)?;
    let options = RenderOptions { tile_size: TileSize::Fixed([16, 16]), region: None };
    let mut seen = Vec::new();
    let mut stop = |Progress { done, total }| {
        seen.push((done, total));
        if seen.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let cancelled = pipeline.render(&view, &VALUES, &options, &mut stop).err();
    assert_eq!(cancelled, Some(RenderError::Cancelled));
    assert_eq!(seen, [(256, 4096), (512, 4096), (768, 4096)]);
    let again = pipeline.render(&view, &VALUES, &options, &mut no_progress)?;
    assert_eq!(again.image.counts().hit, 64 * 64);
    Ok(())
}
