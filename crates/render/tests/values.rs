//! Single values as an adapter computes them, bit-exact where they must be. Without an adapter
//! every test here is reported as ignored, unless `SDFC_REQUIRE_GPU=1` is set.

mod common;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_codegen::{FieldOptions, field_module};
use sdfc_graph::eval::{FrameValues, Tape};
use sdfc_graph::{Binary, Graph, NodeId, Type};
use sdfc_render::{Gpu, Pipeline, RenderOptions, TileSize, no_progress, testing};

type Outcome = Result<(), Failed>;

const READ_BACK: &str = include_str!("values.wgsl");
/// The capacity of `values.wgsl`.
const POINTS: usize = 256;

fn main() {
    let arguments = Arguments::from_args();
    let ignored = testing::without_gpu();
    let trials = vec![Trial::test("hashes_have_the_same_bits", hashes_have_the_same_bits)];
    let trials = trials.into_iter().map(|trial| trial.with_ignored_flag(ignored)).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

/// Evaluates a function at points: on the adapter, and on the CPU in f32 and f64.
fn values(
    points: &[[f32; 4]],
    build: impl FnOnce(&mut Graph, NodeId) -> NodeId,
) -> Result<Vec<[f64; 3]>, Failed> {
    let program = common::program_of(build);
    let options = FieldOptions { gradient: false, ..FieldOptions::default() };
    let text = field_module(&program, &options)?.wgsl()? + READ_BACK;

    let gpu = Gpu::new()?;
    let pipeline = Pipeline::from_wgsl(&gpu, &text, POINTS)?;
    let mut padded = points.to_vec();
    padded.resize(POINTS, [0.0; 4]);
    let view = common::view(&common::sphere(), [points.len() as u32, 1]);
    let options = RenderOptions { tile_size: TileSize::default(), region: None };
    let frame = pipeline.render(&view, &padded, &options, &mut no_progress)?;

    let tape = Tape::new(&program.graph, program.distance.as_slice())?;
    let frame_values = FrameValues::default();
    let mut narrow = tape.prepare::<f32>(&frame_values);
    let mut wide = tape.prepare::<f64>(&frame_values);
    let both = points.iter().zip(frame.image.pixels());
    Ok(both
        .map(|(&[x, y, z, _], pixel)| {
            let wide = wide.scalar([x, y, z].map(f64::from));
            [f64::from(pixel.depth), f64::from(narrow.scalar([x, y, z])), wide]
        })
        .collect())
}

/// Coordinates of cells: near 0 on both sides, at the ends of the range of words, and beyond.
fn cells() -> Vec<[f32; 4]> {
    let delicate = [
        0.0,
        -0.0,
        0.999,
        -0.001,
        -1.0,
        -1.5,
        7.0,
        1e6,
        -1e6,
        16_777_216.0,
        -16_777_217.0,
        2_147_483_520.0,
        2_147_483_648.0,
        -2_147_483_648.0,
        -2_147_483_904.0,
        4e9,
        -4e9,
        1e20,
        -1e20,
        f32::MAX,
        f32::MIN,
    ];
    let spread = (0..200).map(|i| (i as f32 - 100.0) * 37.3);
    let xs: Vec<f32> = delicate.into_iter().chain(spread).collect();
    xs.iter().enumerate().map(|(i, &x)| [x, xs[(i * 7 + 3) % xs.len()], x * 0.5, 0.0]).collect()
}

fn hashes_have_the_same_bits() -> Outcome {
    let scalar = values(&cells(), |graph, p| {
        let start = graph.number(0.0);
        (0..3).fold(start, |state, lane| {
            let part = graph.component(p, lane);
            graph.binary(Binary::Hash, state, part)
        })
    })?;
    let vector = values(&cells(), |graph, p| {
        let starts = graph.constant(Type::Vec3, &[0.0, 10_368_889.0, 4_370_562.0]);
        let hashed = graph.binary(Binary::Hash, starts, p);
        // Sums of 24-bit numbers would round, so the point selects the last lane.
        let [x, y, z] = [0, 1, 2].map(|lane| graph.component(hashed, lane));
        let (place, limit) = (graph.component(p, 1), graph.number(0.0));
        let left = graph.lt(place, limit);
        let either = graph.select(left, x, y);
        let behind = graph.lt(limit, place);
        graph.select(behind, z, either)
    })?;
    for (list, cells) in [(scalar, cells()), (vector, cells())] {
        for ([gpu, narrow, wide], cell) in list.into_iter().zip(cells) {
            assert_eq!([gpu, narrow], [wide; 2], "at {cell:?}");
        }
    }
    Ok(())
}
