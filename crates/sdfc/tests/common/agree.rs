//! Checks that GPU, CPU in f32 and CPU in f64 render the same surface at 64x64. Outside edges,
//! depths differ by at most 1e-3, by less in small scenes, and far from the origin by no more than
//! the rounding of coordinates. Where a picture says that it proves nothing, rays are sampled at
//! points that depend on rounding, so there a small part of the pixels may differ.

use libtest_mimic::Failed;
use sdfc::{Backend, Compiler, FrameValues, Method, PictureOptions, Scene, no_progress};
use sdfc_render::{CpuScene, Difference, HIT, Image, compare, edges, is_unproven};

/// Width and height in pixels.
const SIDE: u32 = 64;
/// Largest difference of depth outside edges, in scene units and relative to the scene's scale.
const DEPTH: f32 = 1e-3;
const DEPTH_PART: f32 = 1e-4;
/// Eight units in the last place of coordinates, relative to the scale: the tolerance of the
/// shader.
const ROUNDING: f32 = 1e-6;
/// Largest difference of a colour channel outside edges, in steps of 1/255.
const COLOR: u8 = 2;
/// If more than this fraction of the pixels are edges, the comparison is meaningless.
const EDGES: f64 = 0.5;
/// Largest part of the unproven pixels that may differ, outside edges: 62 of 2586 do on the
/// Mandelbulb, whose details are smaller than the steps.
const UNPROVEN: f64 = 0.05;
const METHOD: Method = Method::Auto;

/// Compiles a scene.
pub fn scene(name: &str, text: &str) -> Result<Scene, Failed> {
    Ok(Compiler::new().compile(name, text)?)
}

/// Compares f32 with f64 on the CPU. Returns the number of pixels with a hit, and the difference.
pub fn precisions(scene: &Scene) -> Result<(usize, Difference), Failed> {
    let Depths { single, double, limit } = Depths::of(scene)?;
    let hit = double.pixels().iter().filter(|pixel| pixel.status == HIT).count();
    if hit == 0 {
        return Err("nothing is seen".into());
    }
    Ok((hit, agree(&single, &double, "f32 and f64", limit, None)?))
}

/// Compares the GPU with the CPU in f32, and its depths with f64.
pub fn devices(scene: &Scene) -> Result<Difference, Failed> {
    let picture = |backend| {
        let method = METHOD;
        // One ray for each pixel, through its centre, as in the depth images.
        let samples = Some(1);
        let options =
            PictureOptions::new().size([SIDE; 2]).method(method).backend(backend).samples(samples);
        scene.render(&options, &mut no_progress)
    };
    let (gpu, cpu) = (picture(Backend::Gpu)?.image, picture(Backend::Cpu)?.image);
    let Depths { double, limit, .. } = Depths::of(scene)?;
    let found = agree(&gpu, &cpu, "GPU and CPU in f32", limit, Some(COLOR))?;
    agree(&gpu, &double, "GPU and CPU in f64", limit, None)?;
    Ok(found)
}

/// The depths on the CPU in f32 and in f64, and the largest difference that is allowed.
struct Depths {
    single: Image,
    double: Image,
    limit: f32,
}

impl Depths {
    fn of(scene: &Scene) -> Result<Self, Failed> {
        let frame = FrameValues::defaults(scene.params());
        let view = scene.view(&frame, [SIDE; 2])?;
        let marched = scene.marched_on_cpu(METHOD);
        let (cpu, method) = (CpuScene::new(&marched.program)?, marched.method);
        let double = cpu.depth_map::<f64>(&view, &frame, method)?;
        let hits = double.pixels().iter().filter(|pixel| pixel.status == HIT);
        let scale = view.eye.length() as f32 + hits.map(|pixel| pixel.depth).fold(0.0, f32::max);
        let limit = DEPTH.min(scale * DEPTH_PART).max(scale * ROUNDING);
        Ok(Self { single: cpu.depth_map::<f32>(&view, &frame, method)?, double, limit })
    }
}

fn agree(
    a: &Image,
    b: &Image,
    pair: &str,
    depth: f32,
    color: Option<u8>,
) -> Result<Difference, Failed> {
    let b = &without_unproven(a, b, depth).map_err(|why| format!("{pair}: {why}"))?;
    let found = compare(a, b).ok_or("the sizes differ")?;
    let edges = found.edges as f64 / f64::from(SIDE * SIDE);
    if found.depth > depth || found.status > 0 || edges > EDGES {
        return Err(format!("{pair}: {found:?}, {edges:.2} of the pixels are edges").into());
    }
    match color {
        Some(limit) if found.color > limit => Err(format!("{pair}: {found:?}").into()),
        Some(_) | None => Ok(found),
    }
}

/// Returns `b` with the pixels of `a` where one of them is unproven, if nearly all of these agree.
fn without_unproven(a: &Image, b: &Image, depth: f32) -> Result<Image, String> {
    let is_edge: Vec<bool> = edges(a).into_iter().zip(edges(b)).map(|(a, b)| a || b).collect();
    let (mut unproven, mut differing, mut other) = (0, 0, b.clone());
    for ((a, b), is_edge) in a.pixels().iter().zip(other.pixels_mut()).zip(is_edge) {
        if is_unproven(a) || is_unproven(b) {
            let is_same = a.status == b.status && (a.depth - b.depth).abs() <= depth;
            unproven += usize::from(!is_edge);
            differing += usize::from(!is_edge && !is_same);
            *b = *a;
        }
    }
    if differing as f64 > UNPROVEN * f64::from(unproven as u32) {
        return Err(format!("{differing} of {unproven} unproven pixels differ"));
    }
    Ok(other)
}
