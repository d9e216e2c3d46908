//! Checks that GPU, CPU in f32 and CPU in f64 render the same surface at 64x64. Outside edges,
//! depths differ by at most 1e-3, by less in small scenes, and far from the origin by no more than
//! the rounding of coordinates. Where a picture says that it proves nothing, rays are sampled at
//! points that depend on rounding, so a small part of these pixels may differ. Surfaces without an
//! inside have two normals, so GPU and CPU may differ there.

use std::fmt;

use glam::DVec3;
use sdfc::{
    Backend, Compiler, Diagnostics, Error, Field, FrameValues, Method, PictureOptions, Scene,
    no_progress,
};
use sdfc_graph::{Program, Rays};
use sdfc_march::PixelBlock;
use sdfc_render::{
    CpuScene, Difference, HIT, Image, RenderOptions, View, compare, edges, is_unproven,
    linear_to_srgb8,
};

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
/// Steps of Newton's method that may lead from a hit to the surface.
const NEWTON: usize = 8;
/// If more than this fraction of the pixels are edges, the comparison is meaningless.
const EDGES: f64 = 0.5;
/// Largest part of the unproven pixels that may differ, outside edges: 96 of 2586 do on the
/// Mandelbulb, whose details are smaller than the steps.
const UNPROVEN: f64 = 0.05;
const METHOD: Method = Method::Auto;
/// Ray methods are compared with a tolerance this many times finer than that of pictures, within
/// which their hits may differ.
const FINER: f64 = 64.0;

/// The reason why two pictures do not agree.
#[derive(Debug)]
pub enum Disagreement {
    /// They show too little to be compared: nothing is seen, or most pixels are edges.
    TooLittle(String),
    /// They differ.
    Differ(String),
    /// One of them cannot be drawn.
    Error(Error),
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLittle(why) | Self::Differ(why) => f.write_str(why),
            Self::Error(error) => error.fmt(f),
        }
    }
}

impl<E: Into<Error>> From<E> for Disagreement {
    fn from(error: E) -> Self {
        Self::Error(error.into())
    }
}

/// Compiles a scene.
///
/// # Errors
///
/// The errors of the scene.
pub fn scene(name: &str, text: &str) -> Result<Scene, Diagnostics> {
    Compiler::new().compile(name, text)
}

/// The pictures of a planar scene by the CPU in f32 and f64. They are compared in all pixels, those
/// at edges included, since a formula gives each of them.
fn planar_pictures(scene: &Scene) -> Result<[Image; 2], Disagreement> {
    let frame = FrameValues::defaults(scene.params());
    let view = scene.view(&frame, [SIDE; 2])?;
    let cpu = CpuScene::new(scene.drawn())?;
    let options = RenderOptions::default();
    let single = cpu.render_in::<f32>(&view, &frame, METHOD, &options, &mut no_progress)?;
    let double = cpu.render_in::<f64>(&view, &frame, METHOD, &options, &mut no_progress)?;
    Ok([single.image, double.image])
}

/// The difference of two pictures of a planar scene.
fn planar_difference(a: &Image, b: &Image, pair: &str) -> Result<Difference, Disagreement> {
    let step = |a: f32, b: f32| linear_to_srgb8(a).abs_diff(linear_to_srgb8(b));
    let colors = a.pixels().iter().zip(b.pixels()).map(|(a, b)| {
        let channels = [0, 1, 2].map(|channel| step(a.color[channel], b.color[channel]));
        channels.into_iter().max().unwrap_or(0)
    });
    let color = colors.max().unwrap_or(0);
    let found = Difference { color, compared: a.pixels().len(), ..Difference::default() };
    if color > COLOR {
        return Err(Disagreement::Differ(format!("{pair}: {found:?}")));
    }
    Ok(found)
}

/// Compares f32 with f64 on the CPU. Returns the number of pixels with a hit, and the difference.
///
/// # Errors
///
/// The pictures do not agree.
pub fn precisions(scene: &Scene) -> Result<(usize, Difference), Disagreement> {
    if scene.is_planar() {
        let [single, double] = planar_pictures(scene)?;
        let hit = double.pixels().iter().filter(|pixel| pixel.status == HIT).count();
        return Ok((hit, planar_difference(&single, &double, "f32 and f64")?));
    }
    let Depths { cpu, method, frame, view, image: double, limit } = Depths::of(scene)?;
    let single = cpu.depth_map::<f32>(&view, &frame, method)?;
    let hit = double.pixels().iter().filter(|pixel| pixel.status == HIT).count();
    if hit == 0 {
        return Err(Disagreement::TooLittle("nothing is seen".to_owned()));
    }
    Ok((hit, agree(&single, &double, "f32 and f64", limit, None)?))
}

/// Compares `auto` with `interval` on the CPU in f64. Here `interval` marches the whole field, so
/// it checks the analytic hits of `auto` and the boxes to which it clips rays: of every ray that
/// it proves, it finds the first hit.
///
/// # Errors
///
/// The pictures do not agree.
pub fn methods(scene: &Scene) -> Result<Difference, Disagreement> {
    let frame = FrameValues::defaults(scene.params());
    let view = scene.view(&frame, [SIDE; 2])?;
    let view = View { tolerance: view.tolerance / FINER, ..view };
    let marched = scene.marched_on_cpu(METHOD);
    let auto = CpuScene::new(&marched.program)?.depth_map::<f64>(&view, &frame, marched.method)?;
    let whole = Program { rays: Rays::default(), ..scene.drawn().clone() };
    let whole = CpuScene::new(&whole.with_segment_bounds(true, false))?;
    let interval = whole.depth_map::<f64>(&view, &frame, Method::Interval)?;
    let limit = depth_limit(&view, &interval);
    let pictures = [&auto, &interval];
    let interval = without_cause(scene, &view, pictures, (limit, None), is_near_surface)?;
    agree(&auto, &interval, "`auto` and `interval`", limit, None)
}

/// What may make the hits of two pictures differ: it is given the field, the earlier hit, and the
/// distance within which that hit has to be near the surface.
type Cause = fn(&mut Field<'_>, DVec3, f64) -> bool;

/// Returns `b` with the pixels of `a` where they differ for the given cause.
fn without_cause(
    scene: &Scene,
    view: &View,
    [a, b]: [&Image; 2],
    (limit, color): (f32, Option<u8>),
    is_cause: Cause,
) -> Result<Image, Error> {
    let mut b = b.clone();
    let mut field = scene.field(&scene.defaults())?;
    for (at, (a, b)) in a.pixels().iter().zip(b.pixels_mut()).enumerate() {
        if is_same(a, b, limit, color) {
            continue;
        }
        let is_first = b.status != HIT || a.status == HIT && a.depth < b.depth;
        let first = if is_first { *a } else { *b };
        let [eye, direction] = view.ray(at as u32 % SIDE, at as u32 / SIDE);
        let hit = eye + direction * f64::from(first.depth);
        let footprint = view.footprint();
        let width = footprint.radius + footprint.spread * f64::from(first.depth);
        let reach = f64::from(limit) + view.tolerance * width;
        if first.status == HIT && is_cause(&mut field, hit, reach) {
            *b = *a;
        }
    }
    Ok(b)
}

/// True if the hit is on a surface without an inside: the field is positive on both sides of it.
/// Such a surface has two normals, and rounding errors choose one, or let the ray pass.
fn is_film(field: &mut Field<'_>, hit: DVec3, reach: f64) -> bool {
    let Some(foot) = foot(field, hit, reach) else { return false };
    let slope = DVec3::from_array(field.gradient(hit.to_array()).gradient);
    let Some(up) = slope.try_normalize() else { return false };
    let up = 2.0 * reach * up;
    [foot + up, foot - up].iter().all(|side| field.distance(side.to_array()) > 0.0)
}

/// True if the hit is near the surface. A method that stops within the tolerance of the surface may
/// hit an edge that the other passes, or a surface without an inside, where the field has no change
/// of sign.
fn is_near_surface(field: &mut Field<'_>, hit: DVec3, reach: f64) -> bool {
    foot(field, hit, reach).is_some()
}

/// The point within `reach` at which Newton's method finds the field to be 0, up to a thousandth of
/// `reach`.
fn foot(field: &mut Field<'_>, start: DVec3, reach: f64) -> Option<DVec3> {
    let mut point = start;
    for _ in 0..NEWTON {
        let sample = field.gradient(point.to_array());
        if sample.distance.abs() <= 1e-3 * reach {
            return ((point - start).length() <= reach).then_some(point);
        }
        let slope = DVec3::from_array(sample.gradient);
        point -= slope * (sample.distance / slope.length_squared());
    }
    None
}

/// Compares the GPU with the CPU in f32, and its depths with f64.
///
/// # Errors
///
/// The pictures do not agree.
pub fn devices(scene: &Scene) -> Result<Difference, Disagreement> {
    let picture = |backend| {
        let method = METHOD;
        // One ray for each pixel, through its centre, as in the depth images.
        let samples = Some(1);
        let options =
            PictureOptions::new().size([SIDE; 2]).method(method).backend(backend).samples(samples);
        scene.render(&options, &mut no_progress)
    };
    let (gpu, cpu) = (picture(Backend::Gpu)?.image, picture(Backend::Cpu)?.image);
    if scene.is_planar() {
        let [_, double] = planar_pictures(scene)?;
        planar_difference(&gpu, &double, "GPU and CPU in f64")?;
        return planar_difference(&gpu, &cpu, "GPU and CPU in f32");
    }
    let Depths { view, image: double, limit, .. } = Depths::of(scene)?;
    let without_films =
        |other, color| without_cause(scene, &view, [&gpu, other], (limit, color), is_film);
    let (cpu, double) = (without_films(&cpu, Some(COLOR))?, without_films(&double, None)?);
    let found = agree(&gpu, &cpu, "GPU and CPU in f32", limit, Some(COLOR))?;
    agree(&gpu, &double, "GPU and CPU in f64", limit, None)?;
    Ok(found)
}

/// The depths on the CPU in f64, and the largest difference from them that is allowed.
struct Depths {
    cpu: CpuScene,
    method: Method,
    frame: FrameValues,
    view: View,
    image: Image,
    limit: f32,
}

impl Depths {
    fn of(scene: &Scene) -> Result<Self, Disagreement> {
        let frame = FrameValues::defaults(scene.params());
        let view = scene.view(&frame, [SIDE; 2])?;
        let marched = scene.marched_on_cpu(METHOD);
        let (cpu, method) = (CpuScene::new(&marched.program)?, marched.method);
        let image = cpu.depth_map::<f64>(&view, &frame, method)?;
        let limit = depth_limit(&view, &image);
        Ok(Self { cpu, method, frame, view, image, limit })
    }
}

/// Returns the largest difference of depth that is allowed in a picture.
fn depth_limit(view: &View, picture: &Image) -> f32 {
    let hits = picture.pixels().iter().filter(|pixel| pixel.status == HIT);
    let scale = view.eye.length() as f32 + hits.map(|pixel| pixel.depth).fold(0.0, f32::max);
    DEPTH.min(scale * DEPTH_PART).max(scale * ROUNDING)
}

fn agree(
    a: &Image,
    b: &Image,
    pair: &str,
    depth: f32,
    color: Option<u8>,
) -> Result<Difference, Disagreement> {
    let differ = |why: String| Disagreement::Differ(format!("{pair}: {why}"));
    let b = &with_unproven_of(a, b, depth, color).map_err(differ)?;
    let found = compare(a, b).ok_or_else(|| differ("the sizes differ".to_owned()))?;
    let edges = found.edges as f64 / f64::from(SIDE * SIDE);
    if found.depth > depth || found.status > 0 || color.is_some_and(|limit| found.color > limit) {
        return Err(differ(format!("{found:?}")));
    }
    if edges > EDGES {
        let why = format!("{pair}: {edges:.2} of the pixels are edges");
        return Err(Disagreement::TooLittle(why));
    }
    Ok(found)
}

/// Returns `b` with the pixels of `a` where both differ and one is unproven, if these are few.
fn with_unproven_of(a: &Image, b: &Image, depth: f32, color: Option<u8>) -> Result<Image, String> {
    let is_edge: Vec<bool> = edges(a).into_iter().zip(edges(b)).map(|(a, b)| a || b).collect();
    let (mut unproven, mut differing, mut other) = (0, 0, b.clone());
    for ((a, b), is_edge) in a.pixels().iter().zip(other.pixels_mut()).zip(is_edge) {
        if is_edge || !(is_unproven(a) || is_unproven(b)) {
            continue;
        }
        unproven += 1;
        if !is_same(a, b, depth, color) {
            differing += 1;
            *b = *a;
        }
    }
    if f64::from(differing) > UNPROVEN * f64::from(unproven) {
        return Err(format!("{differing} of {unproven} unproven pixels differ"));
    }
    Ok(other)
}

fn is_same(a: &PixelBlock, b: &PixelBlock, depth: f32, color: Option<u8>) -> bool {
    let step = |channel: usize| {
        linear_to_srgb8(a.color[channel]).abs_diff(linear_to_srgb8(b.color[channel]))
    };
    a.status == b.status
        && (a.depth - b.depth).abs() <= depth
        && color.is_none_or(|limit| (0..3).all(|channel| step(channel) <= limit))
}
