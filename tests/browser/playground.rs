//! The playground: a page in which scenes are written and drawn.

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use libtest_mimic::Failed;
use sdfc::{CompileValues, Compiler, FrameValues, Scene};
use sdfc_tests::repository;

use crate::chromium::{self, Chromium};
use crate::measure::scene;
use crate::pages::{Pixels, check_at, drawn_at};
use crate::server::Server;
use crate::{Session, compiler, survival};

/// A window in which the picture is wider than high, so that the page does not widen its view.
const WINDOW: [u32; 2] = [1400, 560];
/// The most examples that are opened one after the other, or the value of this variable.
const EXAMPLES: &str = "SDFC_PLAYGROUND_EXAMPLES";
const FEW_EXAMPLES: usize = 4;

pub const BALL: &str = "camera(eye: [3, 2, 4])\nsphere(1).color(#c04a6a)\nplane(y: -1)";
/// A scene in which a misspelt name is the only error, and the name that the compiler suggests.
pub const MISSPELT: &str = "camera(eye: [3, 2, 4])\ntorsu(major: 1, minor: 0.4)";
pub const SPELT: &str = "camera(eye: [3, 2, 4])\ntorus(major: 1, minor: 0.4)";
pub const PARAMS: &str = "param r = 0.6 in 0.2..1
param n: int = 2 in 1..5
param tint = #2f7f86
camera(eye: [3, 2, 7])
union(for i in 0..n: sphere(r).translate(x: 1.5 * i - 2)).color(tint)";
/// A star with an inner radius. Its corners are a list, which is no part of a WGSL shader.
const STAR: &str = "camera(eye: [1, 2, 3])
let corner = fn(i) = (if i % 2 == 0 { 1 } else { 0.6 }) * [cos(4deg * i), sin(4deg * i)]
polygon([for i in 0..90: corner(i)]).extrude(0.5)";
/// A check of the page with one backend, `webgpu` or `webgl2`.
type Check = fn(&mut Session, &str) -> Result<(), Failed>;

/// What the page does with either backend.
pub const BY_BACKEND: [(&str, Check); 7] = [
    ("follows_the_text", follows_the_text),
    ("draws_many_parts", draws_many_parts),
    ("follows_sliders", follows_sliders),
    ("survives_a_lost_gpu", survival::lost_gpu),
    ("survives_a_refused_shader", survival::refused_shader),
    ("survives_a_slow_scene", survival::slow_scene),
    ("opens_examples", opens_examples),
];

/// Returns true if the page cannot be built and is not required.
pub fn is_missing() -> bool {
    compiler::is_missing()
        || !chromium::is_required() && !repository().join("playground/node_modules").exists()
}

/// Runs a build script of the folder `playground`, and serves what it writes into `folder`.
pub fn build(script: &str, folder: &Path) -> Result<Server, String> {
    let source = repository().join("playground");
    let built = Command::new("node").arg(script).current_dir(source).output();
    let built = built.map_err(|e| format!("node: {e}"))?;
    if !built.status.success() {
        return Err(String::from_utf8_lossy(&built.stderr).into_owned());
    }
    Server::start(folder).map_err(|e| e.to_string())
}

/// Builds the page once, and returns the server of its files.
fn server() -> Result<&'static Server, Failed> {
    static SERVER: OnceLock<Result<Server, String>> = OnceLock::new();
    let start = || build("build.js", &repository().join("target/playground"));
    SERVER.get_or_init(start).as_ref().map_err(|e| e.as_str().into())
}

/// The page, driven as a visitor does.
pub struct Page<'c> {
    pub chromium: &'c mut Chromium,
}

impl<'c> Page<'c> {
    /// Opens the page with a query or a fragment, and waits for the picture of its first scene.
    pub fn open(chromium: &'c mut Chromium, rest: &str) -> Result<Self, Failed> {
        Self::open_in(chromium, rest, WINDOW)
    }

    pub fn open_in(
        chromium: &'c mut Chromium,
        rest: &str,
        window: [u32; 2],
    ) -> Result<Self, Failed> {
        // An address that differs in its fragment alone would not load the page again.
        chromium.open("about:blank", window)?;
        // The page would show the scene of the test before, and not draw if it is written again.
        chromium.forget_texts_of(&server()?.url(""))?;
        chromium.open(&server()?.url(&format!("index.html{rest}")), window)?;
        let mut page = Self { chromium };
        page.expect_state("drawn")?;
        Ok(page)
    }

    /// Does something that changes the page, and waits until the page is `drawn`, or in another
    /// final state.
    pub fn after(
        &mut self,
        state: &str,
        act: impl FnOnce(&mut Chromium) -> Result<(), Failed>,
    ) -> Result<(), Failed> {
        self.chromium.evaluate("document.body.dataset.state = 'waiting'")?;
        act(self.chromium)?;
        self.expect_state(state)
    }

    pub fn expect_state(&mut self, state: &str) -> Result<(), Failed> {
        let found = self.chromium.apply(SETTLED, &(state == "busy").into())?;
        if found == state {
            return Ok(());
        }
        let said = self.chromium.evaluate("document.body.innerText")?;
        let errors = self.chromium.errors();
        Err(format!("the page is {found}, not {state}: {said}, {errors:?}").into())
    }

    /// Replaces the text of the editor as a visitor does: by the keyboard.
    pub fn write(&mut self, text: &str, state: &str) -> Result<(), Failed> {
        self.after(state, |chromium| replace_text(chromium, text))
    }

    /// The pixels of the canvas, with its size.
    pub fn picture(&mut self) -> Result<([u32; 2], Pixels), Failed> {
        let url = self.chromium.evaluate("document.querySelector('#picture').toDataURL()")?;
        let text = url.as_str().and_then(|url| url.split_once(',')).ok_or("no picture")?.1;
        let png = data_encoding::BASE64.decode(text.as_bytes())?;
        let image = image::load_from_memory(&png)?.into_rgb8();
        let size = [image.width(), image.height()];
        Ok((size, image.pixels().map(|pixel| pixel.0).collect()))
    }

    /// Fails unless the canvas shows the picture of `sdfc render`.
    pub fn expect_picture(
        &mut self,
        scene: &Scene,
        frame: Option<FrameValues>,
        what: &str,
    ) -> Result<(), Failed> {
        let (size, shown) = self.picture()?;
        check_at(size, &shown, &drawn_at(size, scene, frame, None)?, what)?;
        Ok(())
    }

    /// Fails if an error is in the console of the page, or a notice lies over the picture.
    pub fn expect_no_complaint(&mut self) -> Result<(), Failed> {
        let notice = self.chromium.evaluate(NOTICE)?;
        let errors = self.chromium.errors();
        if notice != "" || !errors.is_empty() {
            return Err(format!("{notice}, {errors:?}").into());
        }
        Ok(())
    }

    fn value(&mut self, name: &str) -> Result<f64, Failed> {
        let found = self.chromium.apply(VALUE, &name.into())?;
        Ok(found.as_f64().ok_or_else(|| format!("no input for {name}"))?)
    }
}

pub fn replace_text(chromium: &mut Chromium, text: &str) -> Result<(), Failed> {
    // The text may be wider than the part of it that is in sight.
    chromium.click(".cm-scroller", [0.5, 0.5])?;
    chromium.select_all()?;
    chromium.insert(text)
}

/// Waits until the page is neither at work nor waiting for the answer to an action.
const SETTLED: &str = "isFinalBusy => new Promise(done => {
    const look = () => {
        const state = document.body?.dataset.state ?? 'waiting';
        if (state === 'waiting' || (state === 'busy' && !isFinalBusy)) setTimeout(look, 20);
        else done(state);
    };
    look();
})";

/// The notice over the picture.
pub const NOTICE: &str = "(notice => notice.hidden ? '' : notice.firstElementChild.textContent)\
                      (document.querySelector('#notice'))";

const VALUE: &str = "name => Number(document.querySelector(`#params [name=${name}]`)?.value)";

pub fn compiled(text: &str) -> Result<Scene, Failed> {
    Ok(Compiler::new().compile("typed.sdf", text)?)
}

/// A typed scene is shown; an error is shown with its fix, which corrects the scene.
pub fn follows_the_text(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}"))?;
    page.write(BALL, "drawn")?;
    page.expect_picture(&compiled(BALL)?, None, "what is typed")?;
    let before = page.picture()?;

    page.write(MISSPELT, "errors")?;
    let said = page.chromium.evaluate("document.querySelector('#problems .error').innerText")?;
    let said = said.as_str().unwrap_or_default();
    if !["E0201", "line 2", "torsu", "torus"].iter().all(|word| said.contains(word)) {
        return Err(format!("an error is shown as {said}").into());
    }
    if page.picture()? != before {
        return Err("an error changes the picture".into());
    }
    page.after("drawn", |chromium| chromium.click("#problems .fix", [0.5, 0.5]))?;
    page.expect_picture(&compiled(SPELT)?, None, "the fixed scene")?;
    let left = page.chromium.evaluate("document.querySelectorAll('#problems li').length")?;
    if left != 0 {
        return Err(format!("{left} problems are left").into());
    }
    page.expect_no_complaint()
}

/// A scene of thirty parts is drawn: browsers once took minutes for its GLSL.
pub fn draws_many_parts(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}"))?;
    let text = scene(30);
    page.write(&text, "drawn")?;
    page.expect_picture(&compiled(&text)?, None, "thirty parts")?;
    page.expect_no_complaint()
}

/// An edit that changes nothing but a list of the shader is drawn.
pub fn follows_lists(session: &mut Session) -> Result<(), Failed> {
    let window = [900, 420];
    let mut page = Page::open_in(&mut session.chromium, "?backend=webgpu", window)?;
    for text in [STAR, &STAR.replace("0.6", "0.8")] {
        page.write(text, "drawn")?;
        page.expect_picture(&compiled(text)?, None, "a list")?;
    }
    page.expect_no_complaint()
}

/// Sliders set params, also those that decide how many parts a scene has.
pub fn follows_sliders(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}"))?;
    page.write(PARAMS, "drawn")?;
    page.after("drawn", |chromium| chromium.click("#params [name=r]", [0.8, 0.5]))?;
    let r = page.value("r")?;
    if r < 0.7 {
        return Err(format!("the slider is at {r}").into());
    }
    let scene = compiled(PARAMS)?;
    let mut frame = scene.defaults();
    scene.set(&mut frame, "r", r)?;
    page.expect_picture(&scene, Some(frame), "the slider of a param")?;

    page.after("drawn", |chromium| chromium.click("#params [name=n]", [0.75, 0.5]))?;
    if page.value("n")? != 4.0 {
        return Err("the slider of a count is not at 4".into());
    }
    let values = CompileValues::from([("n".to_owned(), [4.0, 0.0, 0.0, 0.0])]);
    let scene = Compiler::new().values(&values).compile("typed.sdf", PARAMS)?;
    let mut frame = scene.defaults();
    scene.set(&mut frame, "r", r)?;
    page.expect_picture(&scene, Some(frame.clone()), "the slider of a fixed param")?;

    // Values stay when the scene is edited, and a double click restores the default.
    let edited = PARAMS.replace("2, 7", "-2, 7").replace("[3, -2", "[3, 2.5");
    page.write(&edited, "drawn")?;
    let scene = Compiler::new().values(&values).compile("typed.sdf", &edited)?;
    page.expect_picture(&scene, Some(frame), "the edited scene")?;
    for name in ["n", "r"] {
        page.after("drawn", |chromium| {
            chromium.apply(DOUBLE_CLICK, &name.into())?;
            Ok(())
        })?;
    }
    page.expect_picture(&compiled(&edited)?, None, "the restored defaults")?;
    if [page.value("n")?, page.value("r")?] != [2.0, 0.6] {
        return Err("the inputs do not show the restored defaults".into());
    }
    page.expect_no_complaint()
}

const DOUBLE_CLICK: &str = "name => document.querySelector(`#params [name=${name}]`).parentElement
    .querySelector('span').dispatchEvent(new MouseEvent('dblclick', { bubbles: true }))";

/// A copied link shows the same picture in another browser.
pub fn shares_by_link(session: &mut Session) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, "?backend=webgpu")?;
    page.write(PARAMS, "drawn")?;
    for (name, at) in [("r", 0.2), ("n", 1.0)] {
        let input = format!("#params [name={name}]");
        page.after("drawn", |chromium| chromium.click(&input, [at, 0.5]))?;
    }
    page.after("drawn", |chromium| chromium.drag([900.0, 200.0], [960.0, 220.0]))?;
    let expected = page.picture()?;
    page.chromium.allow_clipboard()?;
    page.chromium.click("#share", [0.5, 0.5])?;
    let link = page.chromium.evaluate(COPIED)?;
    let (_, fragment) = link.as_str().and_then(|link| link.split_once('#')).ok_or("no link")?;

    let mut other = Chromium::start()?;
    let mut page = Page::open(&mut other, &format!("?backend=webgpu#{fragment}"))?;
    if page.picture()? != expected {
        return Err("the link shows another picture".into());
    }
    page.expect_no_complaint()?;
    // A damaged link is refused in words, and the page works.
    let damaged = &fragment[..fragment.len() / 2];
    let mut page = Page::open(&mut other, &format!("#{damaged}"))?;
    let notice = page.chromium.evaluate(NOTICE)?;
    if !notice.as_str().is_some_and(|notice| notice.contains("the link is damaged")) {
        return Err(format!("of a damaged link the page says {notice}").into());
    }
    page.write(BALL, "drawn")?;
    page.expect_no_complaint()
}

/// Waits for a link in the clipboard.
const COPIED: &str = "new Promise(done => {
    const look = async () => {
        const text = await navigator.clipboard.readText();
        if (text.includes('#1.')) return done(text);
        setTimeout(look, 20);
    };
    look();
})";

/// Examples are opened one after the other, all in one page. The page does not grow, and no context
/// is lost. The last ones come first: without a GPU, the first ones take minutes to compile.
#[expect(clippy::print_stdout, reason = "people read the sizes of the page")]
pub fn opens_examples(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let most = std::env::var(EXAMPLES).ok().and_then(|value| value.parse().ok());
    let most: usize = most.unwrap_or(FEW_EXAMPLES);
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}&time=0"))?;
    page.chromium.click("#open-gallery", [0.5, 0.5])?;
    let all = page.chromium.evaluate("document.querySelectorAll('#pictures button').length")?;
    let all = all.as_u64().ok_or("no examples")? as usize;
    page.chromium.evaluate("document.querySelector('#gallery').close()")?;
    let mut sizes = Vec::new();
    let last = all.saturating_sub(1);
    for place in (0..all).rev().take(most).chain([last]) {
        open_example(&mut page, place)
            .map_err(|e| format!("example {place}: {}", e.message().unwrap_or_default()))?;
        page.expect_no_complaint()?;
        if place == last {
            sizes.push(page.chromium.size()?);
        }
        if most > FEW_EXAMPLES {
            println!("{place}: {:?}", page.chromium.size()?);
        }
    }
    let [first, .., last] = &sizes[..] else { return Err("no examples".into()) };
    if last.nodes > first.nodes + SPARE_NODES || last.workers != first.workers {
        return Err(format!("the page grew from {first:?} to {last:?}").into());
    }
    Ok(())
}

/// Opens an example of the gallery by its place there.
pub fn open_example(page: &mut Page, place: usize) -> Result<(), Failed> {
    page.after("drawn", |chromium| {
        chromium.click("#open-gallery", [0.5, 0.5])?;
        chromium.apply(CHOOSE, &place.into())?;
        Ok(())
    })
}

/// Nodes that the editor keeps for its cursor and its lines.
const SPARE_NODES: u64 = 50;

const CHOOSE: &str = "place => document.querySelectorAll('#pictures button')[place].click()";
