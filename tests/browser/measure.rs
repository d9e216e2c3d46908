//! Times and screenshots of the playground, for `docs/playground.md` and for a look at the page. It
//! runs only if [`MEASURE`] is set.

#![expect(clippy::print_stdout, reason = "people read the times")]

use std::fmt::Write as _;

use libtest_mimic::Failed;
use serde_json::json;

use crate::Session;
use crate::chromium::Chromium;
use crate::playground::{self, Page};

/// The environment variable that runs this.
pub const MEASURE: &str = "SDFC_PLAYGROUND_MEASURE";
/// The folder of the screenshots, within the folder for temporary files of tests.
const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");
const WINDOW: [u32; 2] = [1400, 800];
const PHONE: [u32; 2] = [390, 844];
const BACKENDS: [&str; 2] = ["webgpu", "webgl2"];
const LEAVES: [usize; 3] = [1, 30, 300];
const KEYS: usize = 5;

/// Prints the times of the first picture, and from a key to the picture.
pub fn times(_: &mut Session) -> Result<(), Failed> {
    for backend in BACKENDS {
        let query = format!("?backend={backend}");
        let mut chromium = Chromium::start()?;
        for visit in ["first", "second"] {
            Page::open_in(&mut chromium, &query, WINDOW)?;
            let drawn = chromium.evaluate("performance.getEntriesByName('drawn')[0].startTime")?;
            println!(
                "{backend}: picture of the {visit} visit: {} ms, {}",
                whole(&drawn),
                status(&mut chromium)?
            );
        }
        for leaves in LEAVES {
            let mut page = Page::open_in(&mut chromium, &query, WINDOW)?;
            page.write(&scene(leaves), "drawn")?;
            page.chromium.press("ArrowLeft", 37)?;
            let mut times = Vec::new();
            for key in ["1", "2", "3", "4", "5"].into_iter().take(KEYS) {
                page.after("drawn", |chromium| chromium.insert(key))?;
                times.push(whole(&page.chromium.evaluate(LAST)?));
            }
            times.sort_unstable();
            let status = status(page.chromium)?;
            println!("{backend}: key to picture, {leaves} leaves: {times:?} ms, {status}");
        }
    }
    Ok(())
}

/// The time from the last edit to its picture.
const LAST: &str = "performance.getEntriesByName('drawn')[0].startTime
    - performance.getEntriesByName('busy')[0].startTime";

fn whole(value: &serde_json::Value) -> u64 {
    value.as_f64().unwrap_or_default().round() as u64
}

fn status(chromium: &mut Chromium) -> Result<String, Failed> {
    let text = chromium.evaluate("document.querySelector('#status').textContent")?;
    Ok(text.as_str().unwrap_or_default().to_owned())
}

/// Returns a scene of balls. The cursor at its end is one step behind a number.
pub fn scene(leaves: usize) -> String {
    let mut text = "camera(eye: [6, 5, 9])\n".to_owned();
    for index in 1..leaves {
        let [x, y, z] = [17, 31, 43].map(|step| (index * step % 61) as f64 / 10.0 - 3.0);
        let _ = writeln!(text, "sphere(0.2{}).translate([{x}, {y}, {z}])", index % 7);
    }
    text + "sphere(0.5)"
}

/// Saves what visitors see: wide and narrow, light and dark, with an error, with the dialogs.
pub fn screenshots(session: &mut Session) -> Result<(), Failed> {
    for theme in ["light", "dark"] {
        for (width, window) in [("wide", WINDOW), ("tablet", [820, 1180]), ("phone", PHONE)] {
            let feature = json!([{ "name": "prefers-color-scheme", "value": theme }]);
            session.chromium.call("Emulation.setEmulatedMedia", json!({ "features": feature }))?;
            let mut page = Page::open_in(&mut session.chromium, "?example=gear.sdf", window)?;
            save(&mut page, &format!("{width}-{theme}"))?;
            page.chromium.click("#open-gallery", [0.5, 0.5])?;
            // The pictures are read when they are shown.
            page.chromium.evaluate("new Promise(done => setTimeout(done, 500))")?;
            save(&mut page, &format!("{width}-{theme}-examples"))?;
            page.chromium.evaluate("document.querySelector('#gallery').close()")?;
            page.chromium.click("#open-export", [0.5, 0.5])?;
            save(&mut page, &format!("{width}-{theme}-export"))?;
            page.chromium.evaluate("document.querySelector('#export').close()")?;
            page.write(playground::MISSPELT, "errors")?;
            save(&mut page, &format!("{width}-{theme}-error"))?;
        }
    }
    session.chromium.call("Emulation.setEmulatedMedia", json!({ "features": [] }))?;
    println!("{FOLDER}/playground-*.png");
    Ok(())
}

fn save(page: &mut Page, name: &str) -> Result<(), Failed> {
    let png = page.chromium.screenshot("html")?;
    std::fs::write(format!("{FOLDER}/playground-{name}.png"), png)?;
    Ok(())
}
