//! Costly operands of a union, and costly layers of a planar picture, that are evaluated only near
//! their boxes: the bounds hold, and neither a value nor a picture changes.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{
    Backend, Compiler, FrameValues, LoopStrategy, Method, PictureOptions, Scene, no_progress,
};
use sdfc_codegen::{FieldOptions, field_module, render_module};
use sdfc_graph::eval::Tape;
use sdfc_graph::{Dim, NodeId, Program, guarded_distance, substitute};
use sdfc_render::{Gpu, HIT, Image, Pipeline, RenderOptions, View, testing, uniform_values};

const SIZE: [u32; 2] = [96, 64];
/// Points for each scene.
const POINTS: usize = 4_000;
/// Half the side of the box of points.
const REACH: f64 = 2.5;
/// How far the field of a text may be from the distance.
const PRECISION: f64 = 5e-5;

const WORD: &str = "text(\"sd\", size: 0.8, align: \"center\").extrude(0.2)";
const CAMERA: &str = "camera(eye: [1.2, 1.1, 3], target: [0, 0.2, 0], fov: 40deg)\n\
                      sun(direction: [1, 2, 1], shadow: soft(8))\n\
                      ambient(strength: 0.3)\nambient_occlusion(radius: 0.5)\n";

const PAGE: &str = "background(#123)\ncamera(eye: [0, 0.2, 1], target: [0, 0.2, 0], height: 1.6)\n";

const SWEEP: &str =
    "sweep(circle(0.25), [for i in 0..9: [cos(i * 50deg), 0.2 * i - 0.8, sin(i * 50deg)]])";
const BLENDED: &str = "union(text(\"sd\", size: 0.8, align: \"center\").extrude(0.2), \
                       box([2, 0.2, 0.4]), blend: smooth(0.1))";

/// Words with outlines of different lengths, which share loops.
const LOOP: &str = "union(for i in 0..6: text(str(37 * i + 8), size: 0.6, align: \"center\")
  .extrude(0.2).rotate(y: 7deg + 20deg * i).translate([0.8 * (i % 3) - 0.8, 0.7 * (i % 2), -0.1 * i])
  .color(hsl(40deg * i, 0.7, 0.5)))\nplane(y: -0.1)\nsphere(0.3).translate([0.2, 0.4, 0.5])\n";

/// A test of a scene.
type Test = fn(&Scene) -> Result<(), Failed>;

const DRAWN: &str = "picture";
const TESTS: [(&str, Test); 3] =
    [("values", same_values), ("code", is_in_a_branch), (DRAWN, same_picture)];

const TESTS_OF_LAYERS: [(&str, Test); 3] =
    [("values", same_pixels), ("code", layers_are_in_branches), (DRAWN, same_picture)];

fn main() {
    let outline = "polygon([for i in 0..60: (1 + 0.3 * cos(i)) * [cos(i * 6deg), sin(i * 6deg)]])";
    let scenes = [
        ("text over a floor", format!("{WORD}\nplane(y: -0.1)\n")),
        (
            "text, rotated and scaled",
            format!("{WORD}.rotate(y: 30deg).scale(0.7)\nplane(y: -0.1)\n"),
        ),
        ("rounded text and a ball", format!("{WORD}.round(0.03)\nsphere(0.5).translate(x: 1)\n")),
        ("two words", format!("{WORD}\n{WORD}.translate([0.3, 0.9, 0.2])\nplane(y: -0.1)\n")),
        ("words alone", format!("{WORD}\n{WORD}.translate(y: 0.9)\n")),
        ("an outline of many corners", format!("{outline}.extrude(0.4)\nplane(y: -1.4)\n")),
        ("a sweep, whose field is a bound", format!("{SWEEP}\nplane(y: -1.2)\n")),
        ("blended text, whose field is a bound", format!("{BLENDED}\nplane(y: -1.2)\n")),
        (
            "text that a param moves",
            format!("param s = 0.2 in -1..1\n{WORD}.translate(x: s)\nplane(y: -0.1)\n"),
        ),
    ];
    let layer = "text(\"sd\", size: 0.8, align: \"center\")";
    let pages = [
        ("words on a page", format!("rect(2.5).color(#eee)\n{layer}.color(#a20)\n")),
        (
            "layers that overlap",
            format!(
                "param s = 0.3 in -1..1\n{layer}.color(#f00)\n{layer}.rotate(20deg)\
                 .translate([s, 0.2]).color(rgb(0, 1, 0, 0.5))\n{outline}.scale(0.2).color(#00f)\n"
            ),
        ),
    ];
    let solids = scenes.into_iter().map(|(name, text)| (name, text + CAMERA, TESTS));
    let pages = pages.into_iter().map(|(name, text)| (name, text + PAGE, TESTS_OF_LAYERS));
    let mut trials = Vec::new();
    for (name, text, tests) in solids.chain(pages) {
        for (what, test) in tests {
            let scene = text.clone();
            let trial = Trial::test(format!("{what} of {name}"), move || test(&compiled(&scene)));
            trials.push(trial.with_ignored_flag(what == DRAWN && testing::without_gpu()));
        }
    }
    trials.push(Trial::test("limit of a sweep", || is_a_closer_bound(SWEEP)));
    trials.push(Trial::test("values of words in a loop", || same_values_of_loops(LOOP)));
    let drawn = Trial::test("picture of words in a loop", || same_picture_of_loops(LOOP));
    trials.push(drawn.with_ignored_flag(testing::without_gpu()));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn compiled(text: &str) -> Scene {
    Compiler::new().compile("guarded.sdf", text).expect("compiles")
}

/// Points of a box, by a Kronecker sequence: they cover it evenly.
fn points() -> impl Iterator<Item = [f64; 3]> {
    let steps = [0.819_172_513, 0.671_043_607, 0.549_700_478];
    (0..POINTS)
        .map(move |index| steps.map(|step| REACH * (2.0 * (step * index as f64).fract() - 1.0)))
}

fn values(program: &Program, roots: &[NodeId], frame: &FrameValues) -> Vec<Vec<f64>> {
    let tape = Tape::new(&program.graph, roots).expect("the field is flat");
    let mut evaluator = tape.prepare::<f64>(frame);
    points().map(|point| evaluator.eval(point).iter().map(|lanes| lanes[0]).collect()).collect()
}

fn same_values(scene: &Scene) -> Result<(), Failed> {
    let (program, frame) = (scene.program(), FrameValues::defaults(scene.params()));
    if program.guards.is_empty() {
        return Err("nothing is guarded".into());
    }
    let distance = program.distance.ok_or("nothing is drawn")?;
    for guard in &program.guards {
        let pairs = values(program, &[guard.bound, guard.operand], &frame);
        for (point, pair) in points().zip(pairs) {
            if pair[0] > pair[1] + PRECISION {
                return Err(format!("at {point:?} the box is at {pair:?}").into());
            }
        }
    }
    let guarded = program.guarded();
    let new = guarded.distance.ok_or("nothing is drawn")?;
    let [old, new] = [(program, distance), (&guarded, new)]
        .map(|(program, root)| values(program, &[root], &frame));
    for (point, (old, new)) in points().zip(old.iter().zip(new)) {
        if (old[0] - new[0]).abs() > PRECISION {
            return Err(format!("at {point:?} {} became {}", old[0], new[0]).into());
        }
    }
    Ok(())
}

/// Beside a floor, the field of a shape whose field is only a lower bound is limited from below. It
/// has the sign that it has alone, exceeds no distance to a point of the shape, and is a closer
/// bound somewhere.
fn is_a_closer_bound(shape: &str) -> Result<(), Failed> {
    let alone = compiled(shape);
    let beside = compiled(&format!("{shape}\nplane(y: -9)\n"));
    let frame = FrameValues::default();
    let distance = alone.program().distance.ok_or("nothing is drawn")?;
    let [guard] = beside.program().guards[..] else { return Err("one shape is guarded".into()) };
    let plain = values(alone.program(), &[distance], &frame);
    let limited = values(beside.program(), &[guard.operand], &frame);
    let fields = || points().zip(plain.iter().zip(&limited)).map(|(p, (a, b))| (p, a[0], b[0]));
    let inside: Vec<_> = fields().filter(|(_, plain, _)| *plain < 0.0).map(|it| it.0).collect();
    let mut closer = 0;
    for (point, plain, limited) in fields() {
        if (plain < 0.0) != (limited < 0.0) || plain > limited + PRECISION && plain > 0.0 {
            return Err(format!("at {point:?} {plain} became {limited}").into());
        }
        let away = |other: &[f64; 3]| {
            point.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
        };
        let nearest = inside.iter().map(away).fold(f64::INFINITY, f64::min);
        if limited > nearest + PRECISION {
            return Err(format!("at {point:?} {limited} exceeds {nearest}").into());
        }
        closer += u32::from(limited > plain + 0.01);
    }
    if inside.len() < 10 || closer == 0 {
        return Err(format!("{} points inside, {closer} closer", inside.len()).into());
    }
    Ok(())
}

/// The operand's loops are written in a branch, and nothing of them outside.
fn is_in_a_branch(scene: &Scene) -> Result<(), Failed> {
    let options = FieldOptions { gradient: false, material: false, ..FieldOptions::default() };
    let text = field_module(scene.program(), &options)?.wgsl()?;
    let body = text.split_once("fn sdf_distance").ok_or("there is no distance")?.1;
    let before = body.split_once("least = ").ok_or("there is no branch")?.0;
    let words = scene.program().guards.len();
    let branches = body.matches("var least").count();
    // Without another operand, the first of them is always evaluated.
    let guarded = if scene.program().rays.analytic.is_none() { words - 1 } else { words };
    if branches != guarded {
        return Err(format!("{branches} branches for {guarded} operands").into());
    }
    if guarded == words && before.contains("loop {") {
        return Err("a loop precedes the first branch".into());
    }
    Ok(())
}

/// The pixels are those of distances that are evaluated everywhere.
fn same_pixels(scene: &Scene) -> Result<(), Failed> {
    let (program, frame) = (scene.program(), FrameValues::defaults(scene.params()));
    let pixel = program.planar_pixel.ok_or("the scene is not planar")?;
    let mut graph = program.graph.clone();
    let size = graph.point(1, Dim::Two);
    let width = graph.component(size, 0);
    let mut everywhere = Vec::new();
    for &guard in &program.guards {
        everywhere.push((guarded_distance(&mut graph, guard, width), guard.operand));
        let pairs = values(program, &[guard.bound, guard.operand], &frame);
        for (point, pair) in points().zip(pairs) {
            if pair[0] > pair[1] + PRECISION {
                return Err(format!("at {point:?} the box is at {pair:?}").into());
            }
        }
    }
    let plain = substitute(&mut graph, pixel, &everywhere);
    if everywhere.is_empty() || plain == pixel {
        return Err("nothing is guarded".into());
    }
    let tape = Tape::for_rays(&graph, &[pixel, plain])?;
    let mut pixels = tape.prepare::<f64>(&frame);
    for (index, point) in points().enumerate() {
        let width = [0.003, 0.03, 0.3][index % 3];
        let [new, old] = *pixels.eval_ray(point, [width; 3]) else {
            return Err("two roots".into());
        };
        let is_same = new.iter().zip(old).take(3).all(|(a, b)| (a - b).abs() < 1e-9);
        if !is_same || (new[3] <= 0.0) != (old[3] <= 0.0) {
            return Err(format!("at {point:?} {old:?} became {new:?}").into());
        }
    }
    Ok(())
}

/// Each layer's loops are written in a branch.
fn layers_are_in_branches(scene: &Scene) -> Result<(), Failed> {
    let text = render_module(scene.program(), Method::Auto)?.wgsl()?;
    let body = text.split_once("fn planar_pixel").ok_or("there is no pixel")?.1;
    let before = body.split_once("least = ").ok_or("there is no branch")?.0;
    let (branches, layers) = (body.matches("var least").count(), scene.program().guards.len());
    if branches != layers {
        return Err(format!("{branches} branches for {layers} layers").into());
    }
    if before.contains("loop {") {
        return Err("a loop precedes the first branch".into());
    }
    Ok(())
}

fn same_picture(scene: &Scene) -> Result<(), Failed> {
    let plain = Program { guards: Vec::new(), ..scene.program().clone() };
    let [guarded, plain] = [picture(scene, scene.program())?, picture(scene, &plain)?];
    are_same(&guarded, &plain)
}

fn are_same(one: &Image, other: &Image) -> Result<(), Failed> {
    let hits = other.pixels().iter().filter(|pixel| pixel.status == HIT).count();
    if hits < 400 {
        return Err(format!("only {hits} pixels show something").into());
    }
    for (place, (a, b)) in one.pixels().iter().zip(other.pixels()).enumerate() {
        let color = a.color.iter().zip(b.color).any(|(a, b)| (a - b).abs() > 1.0 / 255.0);
        if a.status != b.status || color || (a.depth - b.depth).abs() > 1e-4 {
            return Err(format!("at {place}, {a:?} and {b:?}").into());
        }
    }
    Ok(())
}

/// A scene without and with loops over similar operands.
fn with_loops(text: &str) -> [Scene; 2] {
    [LoopStrategy::Unrolled, LoopStrategy::Looped].map(|loops| {
        let compiler = Compiler::new().loops(loops);
        compiler.compile("looped.sdf", &format!("{text}{CAMERA}")).expect("compiles")
    })
}

/// Operands of loops that are evaluated only near their boxes leave all values as they are.
fn same_values_of_loops(text: &str) -> Result<(), Failed> {
    let [_, looped] = with_loops(text);
    let (program, frame) = (looped.program(), FrameValues::default());
    let guarded = program.guarded();
    let fields = [program, &guarded].map(|it| it.distance);
    let [Some(plain), Some(new)] = fields else { return Err("nothing is drawn".into()) };
    if looped.report().loops.is_empty() || plain == new {
        return Err("no loop has guards".into());
    }
    let old = values(program, &[plain], &frame);
    for (point, (old, new)) in points().zip(old.iter().zip(values(&guarded, &[new], &frame))) {
        if (old[0] - new[0]).abs() > PRECISION {
            return Err(format!("at {point:?} {} became {}", old[0], new[0]).into());
        }
    }
    Ok(())
}

/// The same picture, although rays visit the operands alone that may matter to them.
fn same_picture_of_loops(text: &str) -> Result<(), Failed> {
    let options = PictureOptions::new().size(SIZE).backend(Backend::Gpu).samples(1);
    let [plain, looped] = with_loops(text);
    let [plain, looped] =
        [plain.render(&options, &mut no_progress)?, looped.render(&options, &mut no_progress)?];
    are_same(&looped.image, &plain.image)
}

fn picture(scene: &Scene, program: &Program) -> Result<Image, Failed> {
    let (gpu, frame) = (Gpu::new()?, FrameValues::defaults(scene.params()));
    let view = View::new(program, &frame, scene.bounds_at(&frame), SIZE)?;
    let shader = render_module(program, Method::Auto)?;
    let uniforms = uniform_values(program, &frame);
    let pipeline = Pipeline::new(&gpu, shader, uniforms.len())?;
    Ok(pipeline.render(&view, &uniforms, &RenderOptions::default(), &mut no_progress)?.image)
}
