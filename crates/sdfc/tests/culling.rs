//! Rays that visit only the parts that can matter to them draw the same picture as rays that visit
//! all parts.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use std::fmt::Write;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Compiler, FrameValues, LoopStrategy, Method, PictureOptions, Scene, no_progress};
use sdfc_codegen::{FieldSource, Shader, benchmark_module, instrumented_module, render_module};
use sdfc_graph::{Program, Type};
use sdfc_march::LOOPS_ENDED;
use sdfc_render::{
    Frame, Gpu, HIT, Image, Pipeline, RenderOptions, TileSize, View, edges, testing, uniform_values,
};

const SIZE: [u32; 2] = [160, 96];
/// Number of parts, few enough for a driver that ends all loops after 65,535 iterations.
const PARTS: usize = 150;
/// Largest error of a hit's depth, as a fraction of a pixel's width.
const DEPTH: f32 = 0.1;

const OUTSIDE: &str = "camera(eye: [4, 3.5, 6], target: 0, fov: 40deg)\n";
const SUNNY: &str = "sun(direction: [1, 2, 1], shadow: hard)\nambient(strength: 0.2)\n";

const SOFT: &str = "sun(direction: [1, 2, 1], shadow: soft(6))\nambient(strength: 0.2)\n";

/// Parts whose places and sizes are linear functions of a param.
const MOVED: &str = "param gap = 0.35 in 0.2..0.6
union(for i in 0..150:
  sphere(0.1 + gap * (i % 5) / 20)
    .translate([(i % 12 - 6) * gap, (i % 7 - 3) * gap, 0.5 * gap * (i % 11 - 5)]))
";

fn main() {
    let without_gpu = testing::without_gpu();
    let scenes = [
        ("hard", hard() + OUTSIDE),
        ("hard, with shadows", format!("plane(y: -2.5)\n{}{OUTSIDE}{SUNNY}", hard())),
        (
            "hard, with materials and soft shadows",
            format!("union({})\n{OUTSIDE}{SOFT}reflections(1)\n", colored()),
        ),
        (
            "blended, with materials of several kinds",
            format!("union({}blend: smooth(0.1))\n{OUTSIDE}{SUNNY}", colored()),
        ),
        (
            "hard, from within",
            hard() + "camera(eye: [0.1, 0.2, 0.3], target: [1, 0.4, 2], fov: 80deg)\n",
        ),
        ("hard, parallel rays", hard() + "camera(eye: [4, 3.5, 6], target: 0, height: 6)\n"),
        ("blended", chain("smooth(0.15)") + OUTSIDE),
        ("blended, with shadows", chain("smooth(0.15)") + OUTSIDE + SUNNY),
        ("blended widely", chain("smooth_cubic(0.6)") + OUTSIDE),
        (
            "blended, from within",
            chain("smooth(0.1)")
                + "camera(eye: [0.1, 0.2, 0.3], target: [1, 0.4, 2], fov: 80deg)\n",
        ),
        (
            "moved by a param",
            format!(
                "param s: length = 0.2 in 0..1\n{}{OUTSIDE}",
                hard().replace("sphere(0.2)", "sphere(s)")
            ),
        ),
        ("moved and sized by a param", format!("{MOVED}{OUTSIDE}{SUNNY}")),
        ("rounded", format!("union({}).round(0.15)\n{OUTSIDE}", balls())),
        ("a shell", format!("union({}).shell(0.1)\n{OUTSIDE}", balls())),
        (
            "scaled",
            format!("union({}).scale(0.25)\ncamera(eye: [1, 0.9, 1.5], target: 0)\n", balls()),
        ),
        (
            "blended with a block",
            format!("union(union({}), box([3, 0.5, 3]), blend: smooth(0.6))\n{OUTSIDE}", balls()),
        ),
        (
            "cut from a block",
            format!("difference(box([3, 2, 3]), union({}).round(0.1))\n{OUTSIDE}", balls()),
        ),
        (
            "mirrors and open light",
            hard() + OUTSIDE + "reflections(1)\nambient_occlusion(radius: 0.5)\n",
        ),
        (
            "mirrors and open light over a floor",
            format!("plane(y: -2.2)\n{}{OUTSIDE}{SUNNY}", chain("smooth(0.15)"))
                + "reflections(2)\nambient_occlusion(radius: 1)\n",
        ),
        ("soft shadows on a floor", format!("plane(y: -2.5)\n{}{OUTSIDE}", hard()) + SOFT),
        (
            "lights on a floor",
            format!("plane(y: -2.5)\n{}{OUTSIDE}", chain("smooth(0.15)"))
                + "point_light(position: [0.3, 4, 1], strength: 20, shadow: hard)\n\
                   point_light(position: [5, 3, 3], strength: 20, shadow: soft(10))\n",
        ),
        (
            "shadows of what was cut out and rounded",
            format!(
                "plane(y: -2.5)\ndifference(box([3, 2, 3]), union({}).round(0.1))\n{OUTSIDE}{SUNNY}",
                balls()
            ),
        ),
        (
            "shadows of what a param moves",
            format!("param s: length = 0.2 in 0..1\nplane(y: -2.5)\n{}{OUTSIDE}{SUNNY}", hard())
                .replace("sphere(0.2)", "sphere(s)"),
        ),
    ];
    let mut trials = Vec::new();
    for (name, text) in scenes {
        let draw = move || same_picture(&text);
        trials.push(Trial::test(name, draw).with_ignored_flag(without_gpu));
    }
    let too_few =
        Trial::test("incomplete lists change the picture", missing_iterations_change_the_picture);
    trials.push(too_few.with_ignored_flag(without_gpu));
    let broken = Trial::test(
        "broken tiles, slices and cells change the picture",
        broken_lists_change_the_picture,
    );
    trials.push(broken.with_ignored_flag(without_gpu));
    let ended =
        Trial::test("loops that the driver ends early are reported", ended_loops_are_reported);
    trials.push(ended.with_ignored_flag(without_gpu));
    let counted = Trial::test("visited iterations are counted", visited_iterations_are_counted);
    trials.push(counted.with_ignored_flag(without_gpu));
    let leaves = Trial::test("leaves are counted if all are visited", leaves_are_counted);
    trials.push(leaves.with_ignored_flag(without_gpu));
    let kept = Trial::test("lists of cells are kept until something moves", cells_are_kept);
    trials.push(kept.with_ignored_flag(without_gpu));
    let small = Trial::test("a GPU that is too small is reported", limits_are_reported);
    trials.push(small.with_ignored_flag(without_gpu));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Returns numbers that look irregular.
fn number(seed: usize) -> f64 {
    ((seed as f64 * 12.9898).sin() * 43_758.545).fract()
}

fn place(i: usize) -> String {
    let [x, y, z] = [0, 1, 2].map(|axis| 2.0 * number(3 * i + axis));
    format!(".translate([{x:.4}, {y:.4}, {z:.4}])")
}

fn hard() -> String {
    let mut text = String::new();
    for i in 0..PARTS {
        let at = place(i);
        // Writing to a `String` cannot fail.
        let _ = match i % 3 {
            0 => writeln!(text, "sphere(0.2){at}"),
            1 => writeln!(text, "box([0.3, 0.2, 0.4]).rotate(y: {i}deg){at}"),
            _ => writeln!(text, "difference(box(0.3), sphere(0.19)){at}"),
        };
    }
    text
}

/// Returns parts with materials of two kinds as arguments of a call.
fn colored() -> String {
    let part = |i: usize| match i % 4 {
        0 => format!("sphere(0.2).color(fn(q) = normal.y * oklch(0.7, 0.1, {i}deg))"),
        1 => format!("sphere(0.25).color(checker(oklch(0.7, 0.1, {i}deg), #000000, size: 0.1))"),
        2 => format!("box(0.3).color(oklch(0.6, 0.1, {i}deg)).roughness(0.{i:03})"),
        _ => "difference(box(0.3), sphere(0.19).color(#ff0000))".to_owned(),
    };
    (0..PARTS).map(|i| format!("{}{},\n", part(i), place(i))).collect()
}

/// Returns balls as arguments of a call.
fn balls() -> String {
    (0..PARTS)
        .map(|i| format!("sphere({:.3}){},\n", 0.15 + 0.1 * number(i).abs(), place(i)))
        .collect()
}

fn chain(blend: &str) -> String {
    let mut text = "union(\n".to_owned();
    for i in 0..PARTS {
        let _ = writeln!(text, "  sphere({:.3}){},", 0.25 + 0.1 * number(i), place(i));
    }
    text + "  blend: " + blend + ")\n"
}

fn scene(text: &str) -> Scene {
    Compiler::new().loops(LoopStrategy::Looped).compile("culled.sdf", text).expect("compiles")
}

/// Draws a program in tiles that need not begin at a multiple of a culling tile.
fn picture(scene: &Scene, program: &Program) -> Result<Image, Failed> {
    Ok(frame(scene, program, render_module(program, Method::Auto)?)?.image)
}

fn frame(scene: &Scene, program: &Program, shader: Shader) -> Result<Frame, Failed> {
    let (gpu, frame) = (Gpu::new()?, FrameValues::defaults(scene.params()));
    let view = View::new(program, &frame, scene.bounds_at(&frame), SIZE)?;
    let uniforms = uniform_values(program, &frame);
    let pipeline = Pipeline::new(&gpu, shader, uniforms.len())?;
    let options = RenderOptions { tile_size: TileSize::Fixed([60, 44]), region: None };
    Ok(pipeline.render(&view, &uniforms, &options, &mut no_progress)?)
}

/// Counts the pixels that differ between the culled program and one that visits everything.
fn differing(scene: &Scene, culled: &Program) -> Result<(usize, String), Failed> {
    differ(&picture(scene, culled)?, &picture(scene, &whole(culled))?)
}

/// Returns the same program without culling.
fn whole(culled: &Program) -> Program {
    Program { cullable_loops: Vec::new(), ..culled.clone() }
}

/// Counts the pixels that are no edges and differ in colour or, by more than `DEPTH`, in depth.
fn differ(culled: &Image, whole: &Image) -> Result<(usize, String), Failed> {
    let hits = whole.pixels().iter().filter(|pixel| pixel.status == HIT).count();
    if hits < 1000 {
        return Err(format!("only {hits} pixels show something").into());
    }
    let edges = edges(culled).into_iter().zip(edges(whole)).map(|(a, b)| a || b);
    // A lower bound on the width of a pixel in any scene here, at depth 1 and beyond.
    let width = 2.0 * 0.0037;
    let pairs = culled.pixels().iter().zip(whole.pixels()).zip(edges);
    let differ = pairs.enumerate().filter(|(_, ((a, b), is_edge))| {
        let color = a.color.iter().zip(b.color).any(|(a, b)| (a - b).abs() > 1.0 / 255.0);
        let deep = (a.depth - b.depth).abs() > DEPTH * width * b.depth.min(1.0);
        !is_edge && (a.status != b.status || color || (a.status == HIT && deep))
    });
    let differ: Vec<_> = differ.collect();
    let first = differ
        .first()
        .map_or_else(String::new, |(place, ((a, b), _))| format!("at {place}, {a:?} and {b:?}"));
    Ok((differ.len(), first))
}

fn same_picture(text: &str) -> Result<(), Failed> {
    let scene = scene(text);
    if scene.program().cullable_loops.is_empty() {
        return Err("nothing is left out".into());
    }
    match differing(&scene, scene.program())? {
        (0, _) => Ok(()),
        (count, which) => Err(format!("{count} pixels differ: {which}").into()),
    }
}

/// Checks the test itself: pixels differ if iterations that matter are skipped.
fn missing_iterations_change_the_picture() -> Result<(), Failed> {
    for text in [hard() + OUTSIDE, chain("smooth(0.15)") + OUTSIDE] {
        let scene = scene(&text);
        let mut program = scene.program().clone();
        for cullable in &mut program.cullable_loops {
            let part = program.graph.number(1.0);
            let part = program.graph.splat(Type::Vec3, part);
            cullable.culling_bounds = program.graph.add(cullable.culling_bounds, part);
        }
        let (differing, _) = differing(&scene, &program)?;
        if differing == 0 {
            return Err("nothing shows".into());
        }
    }
    Ok(())
}

/// Checks the tests of pictures: pixels differ if a tile reads the wrong one of the wider tiles, if
/// slices do not end where their lists end, or if cells are left out.
fn broken_lists_change_the_picture() -> Result<(), Failed> {
    let (plain, sunny) = (hard() + OUTSIDE, format!("plane(y: -2.5)\n{}{OUTSIDE}{SUNNY}", hard()));
    let mutants = [
        ("WIDER_BITS", 2, &plain),
        ("NEAR", 2, &plain),
        ("SLICE_LENGTH", 1, &plain),
        ("GROUP_SIDE", 4, &sunny),
    ];
    for (constant, number, text) in mutants {
        let scene = scene(text);
        let program = scene.program();
        let shader = render_module(program, Method::Auto)?.with_broken_culling(constant, number);
        let shader = shader.ok_or_else(|| format!("there is no `{constant}`"))?;
        let broken = frame(&scene, program, shader)?.image;
        if differ(&broken, &picture(&scene, &whole(program))?)?.0 == 0 {
            return Err(format!("{constant} = {number} does not show").into());
        }
    }
    Ok(())
}

/// A ball whose formula has a loop of 4000 iterations without an effect. A pixel shows the ball, or
/// it says that the driver ended its loops.
fn ended_loops_are_reported() -> Result<(), Failed> {
    let slow = "length(p) - 1 + 1e-9 * iterate(4000, p.x, fn(s, i) = 0.5 * sin(s + i))";
    let eye = "camera(eye: [0, 0.1, 4], fov: 40deg)\nsun()\n";
    let draw = |text: &str| {
        let options = PictureOptions::new().size([24, 16]).method(Method::Sphere);
        scene(text).render(&options, &mut no_progress)
    };
    let expected = draw(&format!("sphere(1)\n{eye}"))?.image;
    let drawn = draw(&format!("solid slow() lipschitz 1 = {slow}\nslow()\n{eye}"))?;
    let pairs = || expected.pixels().iter().zip(drawn.image.pixels());
    if pairs().any(|(a, b)| b.unproven & LOOPS_ENDED == 0 && a.status != b.status) {
        return Err("a wrong pixel does not say so".into());
    }
    let wrong = pairs().filter(|(_, b)| b.unproven & LOOPS_ENDED != 0).count() as u64;
    let reported = drawn.unproven.is_some_and(|text| text.contains("ended their loops early"));
    if drawn.stats.pixels.loops_ended != wrong || reported != (wrong > 0) {
        return Err(format!("{wrong} pixels are wrong: {:?}", drawn.stats.pixels).into());
    }
    Ok(())
}

/// Without culling each evaluation visits all parts, those for normals too. With culling far fewer
/// are visited.
fn visited_iterations_are_counted() -> Result<(), Failed> {
    let scene = scene(&(hard() + OUTSIDE + "sun()\n"));
    let mut all = scene.program().clone();
    for cullable in &mut all.cullable_loops {
        let near = all.graph.number(-1e3);
        let near = all.graph.splat(Type::Vec3, near);
        cullable.culling_bounds = all.graph.add(cullable.culling_bounds, near);
    }
    let plain = benchmark_module(&all, Method::Sphere, FieldSource::Distance)?;
    let plain = frame(&scene, &all, plain)?.image;
    let counted = frame(&scene, &all, instrumented_module(&all, Method::Sphere)?)?;
    for (plain, counted) in plain.pixels().iter().zip(counted.image.pixels()) {
        let normals = if plain.status == HIT { 4 } else { 0 };
        let expected = PARTS as u32 * (plain.evaluations + normals);
        if counted.evaluations != expected {
            return Err(format!("{} iterations, not {expected}", counted.evaluations).into());
        }
    }
    let program = scene.program();
    let few = frame(&scene, program, instrumented_module(program, Method::Sphere)?)?;
    let sum = |image: &Image| -> u64 {
        image.pixels().iter().map(|pixel| u64::from(pixel.evaluations)).sum()
    };
    let (few_iterations, all_iterations) = (sum(&few.image), sum(&counted.image));
    // The culling pass evaluates each part at least once.
    let before = few.culling_evaluations;
    if few_iterations == 0
        || 10 * (few_iterations + before) > all_iterations
        || before < PARTS as u64
    {
        return Err(format!("{few_iterations} and {before} before of {all_iterations}").into());
    }
    Ok(())
}

/// `interval` visits all parts; `sphere` does not, and has no count of them.
fn leaves_are_counted() -> Result<(), Failed> {
    let scene = scene(&(hard() + OUTSIDE + "sun()\n"));
    let count = |method: Method| -> Result<Option<f64>, Failed> {
        let options = PictureOptions::new().size([16, 16]).method(method);
        let drawn = scene.render(&options, &mut no_progress)?;
        Ok(drawn.stats.leaf_evals_per_pixel.mean)
    };
    match (count(Method::Interval)?, count(Method::Sphere)?) {
        (Some(_), None) => Ok(()),
        counts => Err(format!("{counts:?}").into()),
    }
}

/// A second frame evaluates nothing for the cells, even if the camera moves. A frame with another
/// value of the param does, and shows the picture of that value.
fn cells_are_kept() -> Result<(), Failed> {
    let text = format!("param s: length = 0.2 in 0..1\nplane(y: -2.5)\n{}{OUTSIDE}{SUNNY}", hard());
    let scene = scene(&text.replace("sphere(0.2)", "sphere(s)"));
    let (gpu, program) = (Gpu::new()?, scene.program());
    let pipeline = || {
        let shader = instrumented_module(program, Method::Sphere)?;
        Ok::<_, Failed>(Pipeline::new(&gpu, shader, program.uniforms.len())?)
    };
    let draw = |pipeline: &Pipeline, s: f64, width: u32| {
        let mut frame = FrameValues::defaults(scene.params());
        frame.params = vec![[s, 0.0, 0.0, 0.0]];
        let view = View::new(program, &frame, scene.bounds_at(&frame), [width, SIZE[1]])?;
        let uniforms = uniform_values(program, &frame);
        let options = RenderOptions { tile_size: TileSize::Fixed(SIZE), region: None };
        Ok::<_, Failed>(pipeline.render(&view, &uniforms, &options, &mut no_progress)?)
    };
    let kept = pipeline()?;
    let first = draw(&kept, 0.2, SIZE[0])?;
    let again = draw(&kept, 0.2, SIZE[0])?;
    let narrower = draw(&kept, 0.2, SIZE[0] / 2)?;
    let moved = draw(&kept, 0.3, SIZE[0])?;
    // There are 4096 cells, each of which has many more parts than a tile.
    let [a, b, c, d] = [&first, &again, &narrower, &moved].map(|frame| frame.culling_evaluations);
    if 2 * b > a || 2 * c > a || d < a / 2 {
        return Err(format!("{a}, {b}, {c} and {d} evaluations before the rays").into());
    }
    let same = |a: &Frame, b: &Frame| a.image.pixels() == b.image.pixels();
    let fresh = draw(&pipeline()?, 0.3, SIZE[0])?;
    match (same(&first, &again), same(&moved, &fresh), same(&moved, &first)) {
        (true, true, false) => Ok(()),
        same => Err(format!("{same:?}").into()),
    }
}

/// As constants, 150 parts take 4 or 5 KiB; their lists take more.
fn limits_are_reported() -> Result<(), Failed> {
    let scene = scene(&(hard() + OUTSIDE + "sun()\n"));
    let program = scene.program();
    for (bytes, part) in [(1 << 10, "the scene's lists"), (6 << 10, "a tile of the picture")] {
        let gpu = testing::with_storage(bytes)?;
        let shader = render_module(program, Method::Auto)?;
        let made = Pipeline::new(&gpu, shader, program.uniforms.len());
        let Err(error) = made else { return Err(format!("{bytes} bytes are enough").into()) };
        let message = error.to_string();
        if !message.contains(part) || !message.contains("maxStorageBufferBindingSize") {
            return Err(message.into());
        }
    }
    let gpu = testing::with_storage(1 << 20)?;
    Pipeline::new(&gpu, render_module(program, Method::Auto)?, program.uniforms.len())?;
    Ok(())
}
