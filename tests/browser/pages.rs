//! The pages of `examples/embed`, and what shadertoy.com does: screenshots against the picture of `sdfc render`.

use libtest_mimic::Failed;
use sdfc::render::Pose;
use sdfc::{
    Code, Emit, FrameValues, PictureOptions, Scene, ShaderOptions, Stage, Target, VIEW_SIZE,
    no_progress,
};
use sdfc_tests::compiled_example;

use crate::{Place, table};

/// Largest difference of a colour channel that does not count, in steps of 1/255.
const COLOR: u8 = 1;
/// At most so many pixels in a thousand may differ by more: drivers round differently, and at an edge that shows.
pub const EDGES: f64 = 5.0;
/// A scene that moves shows it sooner.
const MOST_PICTURES: usize = 100;
/// Room for knobs below the picture.
const WINDOW: [u32; 2] = [VIEW_SIZE[0], VIEW_SIZE[1] + 240];

/// A page, and what is compiled for it.
pub struct Embedding {
    /// Its folder.
    pub name: &'static str,
    target: Target,
    emit: Emit,
    file: &'static str,
}

/// Pages that draw what `sdfc render` draws.
pub const EMBEDDINGS: [Embedding; 3] = [
    Embedding { name: "webgpu", target: Target::Wgsl, emit: Emit::Render, file: "scene.wgsl" },
    Embedding { name: "webgl2", target: Target::GlslEs, emit: Emit::Render, file: "scene.glsl" },
    Embedding {
        name: "shadertoy",
        target: Target::Shadertoy,
        emit: Emit::Render,
        file: "scene.glsl",
    },
];

/// Marches in a scene of its own.
pub const THREE: Embedding =
    Embedding { name: "three", target: Target::GlslEs, emit: Emit::March, file: "scene.glsl" };

/// Scenes with knobs, loops, mirrors, soft shadows, lamps.
pub const SCENES: [&str; 6] = [
    "params.sdf",
    "gyroid_lattice.sdf",
    "mandelbulb.sdf",
    "settings/reflections.sdf",
    "settings/soft_shadow.sdf",
    "settings/spot_light.sdf",
];

/// Red, green, blue; rows from the top.
pub type Pixels = Vec<[u8; 3]>;

impl Embedding {
    /// Puts what is compiled for the page beside it.
    fn lay(&self, place: &Place, scene: &Scene) -> Result<(), Failed> {
        let Self { name, target, emit, file } = *self;
        let options =
            ShaderOptions { target, emit, stage: Stage::Fragment, ..ShaderOptions::default() };
        let written = scene.write_shader(&options)?;
        let reflection = scene.reflect(&options, &written);
        let Code::Text(text) = written.code else { return Err("no text".into()) };
        place.server.lay(&format!("{name}/{file}"), text.into_bytes());
        let json = serde_json::to_vec(&reflection)?;
        place.server.lay(&format!("{name}/scene.json"), json);
        Ok(())
    }

    /// Opens the page and waits until it has drawn.
    pub fn open(&self, place: &mut Place, scene: &Scene, query: &str) -> Result<(), Failed> {
        self.lay(place, scene)?;
        let url = place.server.url(&format!("{}/index.html{query}", self.name));
        place.chromium.open(&url, WINDOW)?;
        let state = place.chromium.evaluate(STATE)?;
        let complaints = place.chromium.complaints();
        if state != "drawn" || !complaints.is_empty() {
            return Err(format!("{}: {state}, {complaints:?}", self.name).into());
        }
        Ok(())
    }
}

/// What the page says of itself, once it does.
pub const STATE: &str = "new Promise(done => {
    const look = () => {
        const state = document.body?.dataset.state;
        if (!state) return setTimeout(look, 20);
        done(state === 'drawn' ? state : document.querySelector('p').textContent);
    };
    look();
})";

/// Each scene at its defaults; the differences are a row of the documentation's table.
pub fn show_every_scene(place: &mut Place, embedding: &Embedding) -> Result<(), Failed> {
    let mut found = Vec::new();
    for name in SCENES {
        let scene = compiled_example(name)?;
        embedding.open(place, &scene, "")?;
        found.push(check(&shown(place)?, &drawn(&scene, None, None)?, name)?);
    }
    table::check(embedding.name, &found)
}

/// A knob is turned and the mouse is dragged over the picture.
pub fn follow_knobs_and_mouse(place: &mut Place, embedding: &Embedding) -> Result<(), Failed> {
    let scene = compiled_example("params.sdf")?;
    embedding.open(place, &scene, "")?;
    place.chromium.evaluate(
        "for (const [name, value] of [['wall', 0.25], ['opening', 1.5], ['glaze', '#c04a6a']]) {
            const input = document.querySelector(`[name=${name}]`);
            input.value = value;
            input.dispatchEvent(new Event('input'));
        }",
    )?;
    let mut frame = FrameValues::defaults(scene.params());
    for (name, value) in [("wall", "0.25"), ("opening", "1.5rad"), ("glaze", "#c04a6a")] {
        scene.set_param(&mut frame, name, value)?;
    }
    let expected = drawn(&scene, Some(frame.clone()), None)?;
    check(&shown(place)?, &expected, "the knobs")?;

    place.chromium.drag([200.0, 100.0], [250.0, 100.0])?;
    // A hundred pixels turn the camera by one radian about the origin.
    let pose = turned(pose(&scene)?, [0.0; 3], -0.5);
    check(&shown(place)?, &drawn(&scene, Some(frame), Some(pose))?, "the mouse")?;
    Ok(())
}

/// A scene with `time` is at the time that the page is told, and moves where it is told none.
pub fn follow_the_clock(place: &mut Place, embedding: &Embedding) -> Result<(), Failed> {
    let scene = compiled_example("time.sdf")?;
    embedding.open(place, &scene, "?time=0.75")?;
    let frame = FrameValues { time: 0.75, ..FrameValues::defaults(scene.params()) };
    check(&shown(place)?, &drawn(&scene, Some(frame), None)?, "the clock")?;
    embedding.open(place, &scene, "")?;
    moves(place)
}

/// Whether the canvas shows something else within some pictures of the screen.
pub fn moves(place: &mut Place) -> Result<(), Failed> {
    let first = shown(place)?;
    for _ in 0..MOST_PICTURES {
        if shown(place)? != first {
            return Ok(());
        }
    }
    Err("the picture stands still".into())
}

/// The clock moves the scene, and the mouse turns the camera: by a turn over the width of the picture.
pub fn shadertoy_follows_clock_and_mouse(place: &mut Place) -> Result<(), Failed> {
    let [_, _, shadertoy] = &EMBEDDINGS;
    let scene = compiled_example("time.sdf")?;
    shadertoy.open(place, &scene, "?time=0.75")?;
    let frame = FrameValues { time: 0.75, ..FrameValues::defaults(scene.params()) };
    check(&shown(place)?, &drawn(&scene, Some(frame), None)?, "the clock")?;

    let scene = compiled_example("params.sdf")?;
    // From the middle of the picture a quarter of its width to the right.
    shadertoy.open(place, &scene, "?x=480&y=180")?;
    let pose = pose(&scene)?;
    let pose = turned(pose, pose.target.to_array(), -std::f64::consts::FRAC_PI_2);
    check(&shown(place)?, &drawn(&scene, None, Some(pose))?, "the mouse")?;
    Ok(())
}

/// The scene's own camera.
pub fn pose(scene: &Scene) -> Result<Pose, Failed> {
    let frame = FrameValues::defaults(scene.params());
    let [width, height] = VIEW_SIZE.map(f64::from);
    Ok(Pose::new(scene.program(), &frame, scene.bounds_at(&frame), width / height)?)
}

/// A camera turned about the vertical axis through a place. `up` stays upright.
fn turned(pose: Pose, middle: [f64; 3], angle: f64) -> Pose {
    let (sine, cosine) = angle.sin_cos();
    let turn = |mut place: [f64; 3]| {
        let [x, z] = [0, 2].map(|axis| place[axis] - middle[axis]);
        place[0] = middle[0] + cosine * x + sine * z;
        place[2] = middle[2] + cosine * z - sine * x;
        place
    };
    let [eye, target] = [pose.eye, pose.target].map(|place| turn(place.to_array()).into());
    Pose { eye, target, ..pose }
}

/// What the canvas shows.
pub fn shown(place: &mut Place) -> Result<Pixels, Failed> {
    let png = place.chromium.screenshot("canvas")?;
    let image = image::load_from_memory(&png)?.into_rgb8();
    if [image.width(), image.height()] != VIEW_SIZE {
        return Err(format!("a screenshot of {} by {}", image.width(), image.height()).into());
    }
    Ok(image.pixels().map(|pixel| pixel.0).collect())
}

/// What `sdfc render` draws.
pub fn drawn(
    scene: &Scene,
    frame: Option<FrameValues>,
    pose: Option<Pose>,
) -> Result<Pixels, Failed> {
    let options =
        PictureOptions { size: VIEW_SIZE, samples: Some(1), frame, pose, ..Default::default() };
    let image = scene.render(&options, &mut no_progress)?.image;
    Ok(image.to_srgb8().as_chunks().0.to_vec())
}

/// Pixels in a thousand that differ by more than [`COLOR`].
pub fn check(shown: &Pixels, expected: &Pixels, what: &str) -> Result<f64, Failed> {
    if shown.len() != expected.len() {
        return Err("pictures of two sizes".into());
    }
    let is_far =
        |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > COLOR);
    let count = shown.iter().zip(expected).filter(is_far).count();
    let share = 1000.0 * count as f64 / shown.len() as f64;
    if share > EDGES {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("shown.png");
        let [width, height] = VIEW_SIZE;
        image::save_buffer(&path, shown.as_flattened(), width, height, image::ColorType::Rgb8)?;
        return Err(format!(
            "{what}: {share:.1} pixels in a thousand differ by more than {COLOR}; see {}",
            path.display()
        )
        .into());
    }
    Ok(share)
}
