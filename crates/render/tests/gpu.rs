//! Drawing on an adapter. Without one every test here is reported as ignored, unless
//! `SDFC_REQUIRE_GPU=1` is set.

mod common;

use std::ops::ControlFlow;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_render::{
    Clock, Frame, Gpu, Pipeline, Progress, RenderError, RenderOptions, TileSize, View, testing,
    unwatched,
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
        Trial::test("impossible_calls_are_refused", impossible_calls_are_refused),
        Trial::test("a_bad_shader_is_an_error", a_bad_shader_is_an_error),
        Trial::test("the_device_survives_an_error", the_device_survives_an_error),
        Trial::test("progress_is_told_and_stops_the_frame", progress_is_told_and_stops_the_frame),
    ];
    let trials = trials.into_iter().map(|trial| trial.with_ignored_flag(ignored)).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

fn pattern(gpu: &Gpu, view: &View, tile_size: TileSize) -> Result<Frame, RenderError> {
    let options = RenderOptions { tile_size };
    Pipeline::from_wgsl(gpu, PATTERN, 2)?.render(view, &VALUES, &options, &mut unwatched)
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
    // 4096 pixels, then four times as many each.
    assert!(adaptive.tiles < 16, "{} tiles", adaptive.tiles);
    let timid = pattern(&gpu, &view, TileSize::Adaptive { milliseconds: 1e-9 })?;
    assert!(timid.tiles > 1000, "{} tiles", timid.tiles);
    assert_eq!(adaptive.clock == Clock::Gpu, gpu.has_timestamps());
    assert!(adaptive.milliseconds > 0.0 && adaptive.milliseconds < 60_000.0);
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
        pipeline.render(&view, &VALUES[..1], &RenderOptions::default(), &mut unwatched).err();
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
    // The pattern reads binding 1, which the layout of a scene without values lacks.
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

fn progress_is_told_and_stops_the_frame() -> Outcome {
    let gpu = Gpu::new()?;
    let view = common::view(&common::sphere(), [64, 64]);
    let pipeline = Pipeline::from_wgsl(&gpu, PATTERN, 2)?;
    let options = RenderOptions { tile_size: TileSize::Fixed([16, 16]) };
    let mut seen = Vec::new();
    let mut stop = |Progress { done, total }| {
        seen.push((done, total));
        if seen.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let cancelled = pipeline.render(&view, &VALUES, &options, &mut stop).err();
    assert_eq!(cancelled, Some(RenderError::Cancelled));
    assert_eq!(seen, [(256, 4096), (512, 4096), (768, 4096)]);
    let again = pipeline.render(&view, &VALUES, &options, &mut unwatched)?;
    assert_eq!(again.image.counts().hit, 64 * 64);
    Ok(())
}
