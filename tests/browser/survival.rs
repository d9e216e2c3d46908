//! What the playground survives: a lost GPU, a refused shader, scenes that take very long.

use libtest_mimic::Failed;

use crate::Session;
use crate::chromium::Chromium;
use crate::pages::Pixels;
use crate::playground::{BALL, NOTICE, PARAMS, Page, SPELT, compiled, replace_text};

/// The compiler tries some rays of this scene, with a million iterations at each of their points.
const HOSTILE: &str = "camera(eye: [3, 2, 4])
solid slow(k: number) = length(p) - 1 +
  iterate(256, 0, fn(a) = iterate(256, a, fn(b) = b * 0.5 + sin(b + k * p.x) * 0.001))
union(for i in 0..16: slow(i + 1).translate(x: i / 10))";
/// The most iterations of one loop, for each evaluation of the field. It compiles at once, because
/// the clause needs no trial.
const SLOW: &str = "camera(eye: [3, 2, 4])
solid slow() lipschitz 2 = length(p) - 1 +
  iterate(256, 0, fn(a) = iterate(256, a, fn(b) = b * 0.5 + sin(b + p.x) * 0.001))
slow()";

/// A GPU that is lost is reported. The last picture stays until a button draws again.
pub fn lost_gpu(_: &mut Session, backend: &str) -> Result<(), Failed> {
    // A browser gives pages no GPU after some crashes, so this one is used for nothing else.
    let mut chromium = Chromium::start()?;
    let mut page = Page::open(&mut chromium, &format!("?backend={backend}"))?;
    page.write(BALL, "drawn")?;
    let before = page.picture()?;
    page.chromium.evaluate(KEPT)?;
    page.after("failed", Chromium::crash_gpu)?;
    page.chromium.evaluate(RESTORED)?;
    keeps(&mut page, &before, "The GPU was lost")?;
    page.after("drawn", |chromium| chromium.click("#again", [0.5, 0.5]))?;
    page.expect_picture(&compiled(BALL)?, None, "the picture of another GPU")?;
    page.write(SPELT, "drawn")?;
    page.expect_picture(&compiled(SPELT)?, None, "the next scene")
}

/// Waits until the page has a copy of the picture.
const KEPT: &str = "new Promise(done => {
    const look = () =>
        'kept' in document.querySelector('#picture').dataset ? done(true) : setTimeout(look, 20);
    look();
    document.querySelector('#picture').addEventListener('contextrestored', () => {
        window.restored = true;
    });
})";

/// Waits until the browser has given the canvas its content again.
const RESTORED: &str = "new Promise(done => {
    const look = () => window.restored && 'kept' in document.querySelector('#picture').dataset
        ? done(true) : setTimeout(look, 20);
    look();
})";

/// A shader that the browser refuses is reported. The last picture stays until the next edit.
pub fn refused_shader(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}"))?;
    page.write(BALL, "drawn")?;
    let before = page.picture()?;
    page.chromium.evaluate(SPOIL)?;
    page.write(SPELT, "failed")?;
    keeps(&mut page, &before, "The browser refused the shader")?;
    page.chromium.evaluate("window.spoils = false")?;
    page.write(PARAMS, "drawn")?;
    page.expect_picture(&compiled(PARAMS)?, None, "the next scene")?;
    let notice = page.chromium.evaluate(NOTICE)?;
    if notice == "" { Ok(()) } else { Err(format!("the notice stays: {notice}").into()) }
}

/// Writes an unknown type into every shader on its way to the worker that draws.
const SPOIL: &str = "window.spoils = true;
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function(message, ...rest) {
        const spoilt = window.spoils && message.type === 'scene';
        const text = spoilt ? message.text + '\\nunknown nothing;' : message.text;
        return post.call(this, { ...message, text }, ...rest);
    };";

fn keeps(page: &mut Page, before: &([u32; 2], Pixels), expected: &str) -> Result<(), Failed> {
    let notice = page.chromium.evaluate(NOTICE)?;
    if !notice.as_str().is_some_and(|notice| notice.starts_with(expected)) {
        return Err(format!("the notice is {notice}").into());
    }
    if page.picture()? != *before {
        return Err("the last picture is gone".into());
    }
    Ok(())
}

/// While a scene is drawn that takes very long, the page answers, and can stop the drawing.
pub fn slow_scene(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}"))?;
    page.write(BALL, "drawn")?;
    let before = page.picture()?;
    page.after("stopped", |chromium| {
        replace_text(chromium, SLOW)?;
        if chromium.evaluate(OFFERS_STOP)? != true {
            return Err("the page does not offer to stop".into());
        }
        chromium.click("#stop", [0.5, 0.5])
    })?;
    keeps(&mut page, &before, "Drawing was stopped")?;
    page.write(SPELT, "drawn")?;
    page.expect_picture(&compiled(SPELT)?, None, "the next scene")
}

/// While a scene is compiled that takes very long, the page answers, and the next edit ends the
/// compilation.
pub fn long_compilation(session: &mut Session) -> Result<(), Failed> {
    let mut page = Page::open(&mut session.chromium, "")?;
    page.write(BALL, "drawn")?;
    let before = page.picture()?;
    page.after("busy", |chromium| replace_text(chromium, HOSTILE))?;
    if page.picture()? != before {
        return Err("the last picture is gone".into());
    }
    page.write(SPELT, "drawn")?;
    page.expect_picture(&compiled(SPELT)?, None, "the next scene")?;
    page.expect_no_complaint()
}

/// Waits for the button that stops the drawing, or for the end of the drawing.
const OFFERS_STOP: &str = "new Promise(done => {
    const look = () => {
        if (!document.querySelector('#stop').hidden) return done(true);
        if (!['waiting', 'busy'].includes(document.body.dataset.state)) return done(false);
        setTimeout(look, 20);
    };
    look();
})";
