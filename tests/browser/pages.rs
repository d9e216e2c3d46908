//! The pages of `examples/embed`, and one that works like shadertoy.com, show the picture of `sdfc
//! render`.

use libtest_mimic::Failed;
use sdfc::{
    Code, Emit, FrameValues, PictureOptions, Scene, ShaderOptions, Stage, Target, VIEW_SIZE,
    no_progress,
};
use sdfc_render::Pose;
use sdfc_tests::compiled_example;

use crate::{Session, table};

/// The largest difference of a colour channel that does not count, in steps of 1/255.
const COLOR: u8 = 1;
/// The most pixels in a thousand that may differ by more, because drivers round differently at
/// edges.
pub const EDGES: f64 = 5.0;
/// The number of screenshots within which a moving scene must change.
const MAX_SCREENSHOTS: usize = 100;
/// The size of the window, with space for sliders below the picture.
const WINDOW: [u32; 2] = [VIEW_SIZE[0], VIEW_SIZE[1] + 240];

/// A page, and the shader that is compiled for it.
pub struct Embedding {
    /// The folder of the page.
    pub name: &'static str,
    target: Target,
    emit: Emit,
    file: &'static str,
}

/// The pages that draw the picture of `sdfc render`.
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

/// The page with three.js, which marches a field in a scene of its own.
pub const THREE: Embedding =
    Embedding { name: "three", target: Target::GlslEs, emit: Emit::March, file: "scene.glsl" };

/// Scenes with params, loops, mirrors, soft shadows and lights.
pub const SCENES: [&str; 6] = [
    "params.sdf",
    "gyroid_lattice.sdf",
    "mandelbulb.sdf",
    "settings/reflections.sdf",
    "settings/soft_shadow.sdf",
    "settings/spot_light.sdf",
];

/// Pixels with red, green and blue; rows from the top.
pub type Pixels = Vec<[u8; 3]>;

impl Embedding {
    /// Serves the compiled shader beside the page.
    fn put(&self, session: &Session, scene: &Scene) -> Result<(), Failed> {
        let Self { name, target, emit, file } = *self;
        let options = ShaderOptions::new().target(target).emit(emit).stage(Stage::Fragment);
        let written = scene.write_shader(&options)?;
        let reflection = scene.reflect(&options, &written);
        let Code::Text(text) = written.code else { return Err("no text".into()) };
        session.server.put(&format!("{name}/{file}"), text.into_bytes());
        let json = serde_json::to_vec(&reflection)?;
        session.server.put(&format!("{name}/scene.json"), json);
        Ok(())
    }

    /// Opens the page and waits until it has drawn.
    pub fn open(&self, session: &mut Session, scene: &Scene, query: &str) -> Result<(), Failed> {
        self.put(session, scene)?;
        let url = session.server.url(&format!("{}/index.html{query}", self.name));
        session.chromium.open(&url, WINDOW)?;
        let state = session.chromium.evaluate(STATE)?;
        let errors = session.chromium.errors();
        if state != "drawn" || !errors.is_empty() {
            return Err(format!("{}: {state}, {errors:?}", self.name).into());
        }
        Ok(())
    }
}

/// Waits for the state that the page reports.
pub const STATE: &str = "new Promise(done => {
    const look = () => {
        const state = document.body?.dataset.state;
        if (!state) return setTimeout(look, 20);
        done(state === 'drawn' ? state : document.querySelector('p').textContent);
    };
    look();
})";

/// Shows each scene at its defaults. The differences are a row of a table in the documentation.
pub fn show_every_scene(session: &mut Session, embedding: &Embedding) -> Result<(), Failed> {
    let mut found = Vec::new();
    for name in SCENES {
        let scene = compiled_example(name)?;
        embedding.open(session, &scene, "")?;
        found.push(check(&shown(session)?, &drawn(&scene, None, None)?, name)?);
    }
    table::check(embedding.name, &found)
}

/// Moves sliders and drags the mouse over the picture.
pub fn follow_sliders_and_mouse(
    session: &mut Session,
    embedding: &Embedding,
) -> Result<(), Failed> {
    let scene = compiled_example("params.sdf")?;
    embedding.open(session, &scene, "")?;
    session.chromium.evaluate(
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
    check(&shown(session)?, &expected, "the sliders")?;

    session.chromium.drag([200.0, 100.0], [250.0, 100.0])?;
    // A hundred pixels rotate the camera by one radian about the origin.
    let pose = rotated(pose(&scene)?, [0.0; 3], -0.5);
    check(&shown(session)?, &drawn(&scene, Some(frame), Some(pose))?, "the mouse")?;
    Ok(())
}

/// A scene with `time` is shown at the time in the URL, and moves without one.
pub fn follow_the_clock(session: &mut Session, embedding: &Embedding) -> Result<(), Failed> {
    let scene = compiled_example("time.sdf")?;
    embedding.open(session, &scene, "?time=0.75")?;
    let frame = FrameValues { time: 0.75, ..FrameValues::defaults(scene.params()) };
    check(&shown(session)?, &drawn(&scene, Some(frame), None)?, "the clock")?;
    embedding.open(session, &scene, "")?;
    moves(session)
}

/// Fails unless the canvas changes within some screenshots.
pub fn moves(session: &mut Session) -> Result<(), Failed> {
    let first = shown(session)?;
    for _ in 0..MAX_SCREENSHOTS {
        if shown(session)? != first {
            return Ok(());
        }
    }
    Err("the picture does not move".into())
}

/// The clock moves the scene, and the mouse rotates the camera: once around over the width of the
/// picture.
pub fn shadertoy_follows_clock_and_mouse(session: &mut Session) -> Result<(), Failed> {
    let [_, _, shadertoy] = &EMBEDDINGS;
    let scene = compiled_example("time.sdf")?;
    shadertoy.open(session, &scene, "?time=0.75")?;
    let frame = FrameValues { time: 0.75, ..FrameValues::defaults(scene.params()) };
    check(&shown(session)?, &drawn(&scene, Some(frame), None)?, "the clock")?;

    let scene = compiled_example("params.sdf")?;
    // A quarter of the width to the right of the middle of the picture.
    shadertoy.open(session, &scene, "?x=480&y=180")?;
    let pose = pose(&scene)?;
    let pose = rotated(pose, pose.target.to_array(), -std::f64::consts::FRAC_PI_2);
    check(&shown(session)?, &drawn(&scene, None, Some(pose))?, "the mouse")?;
    Ok(())
}

/// Returns the scene's own camera.
pub fn pose(scene: &Scene) -> Result<Pose, Failed> {
    let frame = FrameValues::defaults(scene.params());
    let [width, height] = VIEW_SIZE.map(f64::from);
    Ok(Pose::new(scene.program(), &frame, scene.bounds_at(&frame), width / height)?)
}

/// Rotates a camera about the vertical axis through `center`. `up` stays upright.
fn rotated(pose: Pose, center: [f64; 3], angle: f64) -> Pose {
    let (sine, cosine) = angle.sin_cos();
    let rotate = |mut point: [f64; 3]| {
        let [x, z] = [0, 2].map(|axis| point[axis] - center[axis]);
        point[0] = center[0] + cosine * x + sine * z;
        point[2] = center[2] + cosine * z - sine * x;
        point
    };
    let [eye, target] = [pose.eye, pose.target].map(|point| rotate(point.to_array()).into());
    Pose { eye, target, ..pose }
}

/// Returns the pixels of the canvas.
pub fn shown(session: &mut Session) -> Result<Pixels, Failed> {
    let png = session.chromium.screenshot("canvas")?;
    let image = image::load_from_memory(&png)?.into_rgb8();
    if [image.width(), image.height()] != VIEW_SIZE {
        return Err(format!("a screenshot of {} by {}", image.width(), image.height()).into());
    }
    Ok(image.pixels().map(|pixel| pixel.0).collect())
}

/// Returns the picture of `sdfc render`.
pub fn drawn(
    scene: &Scene,
    frame: Option<FrameValues>,
    pose: Option<Pose>,
) -> Result<Pixels, Failed> {
    drawn_at(VIEW_SIZE, scene, frame, pose)
}

/// Returns the picture of `sdfc render` with another size.
pub fn drawn_at(
    size: [u32; 2],
    scene: &Scene,
    frame: Option<FrameValues>,
    pose: Option<Pose>,
) -> Result<Pixels, Failed> {
    let options = PictureOptions::new().size(size).samples(Some(1)).frame(frame).pose(pose);
    let image = scene.render(&options, &mut no_progress)?.image;
    Ok(image.to_srgb8().as_chunks().0.to_vec())
}

/// Returns how many pixels in a thousand differ by more than [`COLOR`]. Fails above [`EDGES`].
pub fn check(shown: &Pixels, expected: &Pixels, what: &str) -> Result<f64, Failed> {
    check_at(VIEW_SIZE, shown, expected, what)
}

/// As [`check`], for pictures of another size.
pub fn check_at(
    [width, height]: [u32; 2],
    shown: &Pixels,
    expected: &Pixels,
    what: &str,
) -> Result<f64, Failed> {
    if shown.len() != expected.len() {
        return Err("pictures of two sizes".into());
    }
    let is_far =
        |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > COLOR);
    let count = shown.iter().zip(expected).filter(is_far).count();
    let per_thousand = 1000.0 * count as f64 / shown.len() as f64;
    if per_thousand > EDGES {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("shown.png");
        image::save_buffer(&path, shown.as_flattened(), width, height, image::ColorType::Rgb8)?;
        return Err(format!(
            "{what}: {per_thousand:.1} pixels in a thousand differ by more than {COLOR}; see {}",
            path.display()
        )
        .into());
    }
    Ok(per_thousand)
}
