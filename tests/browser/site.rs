//! The site of the documentation, with the playground in it.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use libtest_mimic::Failed;
use sdfc_tests::repository;

use crate::Session;
use crate::playground::{Page, build, compiled};
use crate::server::Server;

const WINDOW: [u32; 2] = [1400, 700];

const PHONE: [u32; 2] = [390, 844];

fn folder() -> PathBuf {
    repository().join("target/site")
}

/// Builds the site once, which checks all links, and returns the server of its files.
fn server() -> Result<&'static Server, Failed> {
    static SERVER: OnceLock<Result<Server, String>> = OnceLock::new();
    SERVER.get_or_init(|| build("site/build.js", &folder())).as_ref().map_err(|e| e.as_str().into())
}

/// A search leads to a section, and its example opens in the playground. Nothing comes from another
/// server.
pub fn leads_to_the_playground(session: &mut Session) -> Result<(), Failed> {
    let server = server()?;
    let chromium = &mut session.chromium;
    chromium.open(&server.url("tutorial.html"), WINDOW)?;
    chromium.evaluate(LOADED)?;
    chromium.click("#search", [0.5, 0.5])?;
    chromium.insert("menger")?;
    let first = chromium.evaluate(FIRST)?;
    if !first.as_str().is_some_and(|url| url.ends_with("reference/fractals.html#menger")) {
        return Err(format!("the first result is {first}").into());
    }
    chromium.open(first.as_str().ok_or("no link")?, WINDOW)?;
    let source = chromium.evaluate(SOURCE)?;
    let source = source.as_str().ok_or("no example")?;
    only_from(chromium, server)?;

    let link = chromium.evaluate("window.example.nextElementSibling.href")?;
    chromium.open(link.as_str().ok_or("no link")?, WINDOW)?;
    let mut page = Page { chromium };
    page.expect_state("drawn")?;
    let shown = page.chromium.evaluate("document.querySelector('.cm-content').innerText")?;
    if shown != source {
        return Err(format!("the playground shows {shown}, not {source}").into());
    }
    page.expect_no_complaint()?;
    only_from(page.chromium, server)
}

/// The first page draws its scene, and its pictures lead to scenes of the playground.
pub fn shows_a_scene(session: &mut Session) -> Result<(), Failed> {
    let server = server()?;
    let chromium = &mut session.chromium;
    chromium.open(&server.url("index.html"), WINDOW)?;
    chromium.evaluate(RUNS)?;
    only_from(chromium, server)?;
    let tile = chromium.evaluate("document.querySelector('.tile').href")?;
    let tile = tile.as_str().ok_or("no picture")?.to_owned();

    chromium.open(&server.url("hero.html"), WINDOW)?;
    let mut page = Page { chromium };
    page.expect_state("drawn")?;
    let source = std::fs::read_to_string(repository().join("playground/site/hero.sdf"))?;
    page.expect_picture(&compiled(&source)?, None, "the first page")?;

    page.chromium.open(&tile, WINDOW)?;
    page.expect_state("drawn")?;
    page.expect_no_complaint()
}

/// No page is wider than the window of a phone: what is wide scrolls by itself.
pub fn fits_a_phone(session: &mut Session) -> Result<(), Failed> {
    let server = server()?;
    let mut wide = Vec::new();
    for page in pages(&folder())? {
        session.chromium.open(&server.url(&page), PHONE)?;
        let excess = session.chromium.evaluate(EXCESS)?;
        if excess != 0 {
            wide.push(format!("{page}: {excess}"));
        }
    }
    if wide.is_empty() { Ok(()) } else { Err(format!("{wide:#?}").into()) }
}

/// Returns the pages of the site without the playground.
fn pages(folder: &Path) -> Result<Vec<String>, Failed> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in std::fs::read_dir(inner)? {
            let path = entry?.path();
            let name = path.strip_prefix(folder)?.display().to_string().replace('\\', "/");
            if path.is_dir() && name != "playground" {
                folders.push(path);
            } else if name.ends_with(".html") {
                found.push(name);
            }
        }
    }
    Ok(found)
}

/// Waits for the page, and returns how much wider it is than the window.
const EXCESS: &str = "new Promise(done => {
    const look = () => {
        if (document.readyState !== 'complete') return setTimeout(look, 10);
        const { scrollWidth, clientWidth } = document.documentElement;
        done(scrollWidth - clientWidth);
    };
    look();
})";

/// Waits until the scene of the first page replaces its picture.
const RUNS: &str = "new Promise(done => {
    const look = () => document.querySelector('.live iframe.ready') ? done(true) : setTimeout(look, 20);
    look();
})";

const LOADED: &str = "new Promise(done => {
    const look = () => document.querySelector('#contents')?.open ? done(true) : setTimeout(look, 20);
    look();
})";

/// Waits for the first result of the search.
const FIRST: &str = "new Promise(done => {
    const look = () => {
        const link = document.querySelector('#found a');
        if (link) done(link.href); else setTimeout(look, 20);
    };
    look();
})";

/// Waits for the page, and returns the example below its heading.
const SOURCE: &str = "new Promise(done => {
    const look = () => {
        const links = [...document.querySelectorAll('code + a.open')];
        const example = links.map(link => link.previousElementSibling)
            .find(code => code.textContent.startsWith('menger('));
        window.example = example;
        if (example) done(example.textContent); else setTimeout(look, 20);
    };
    look();
})";

/// Fails if the page has loaded something from another server.
fn only_from(chromium: &mut crate::chromium::Chromium, server: &Server) -> Result<(), Failed> {
    let urls = chromium.evaluate(
        "performance.getEntriesByType('resource').map(it => it.name)
            .filter(it => !it.startsWith('data:'))",
    )?;
    let own = server.url("");
    let urls = urls.as_array().ok_or("no resources")?;
    let other: Vec<_> =
        urls.iter().filter(|it| !it.as_str().is_some_and(|it| it.starts_with(&own))).collect();
    if other.is_empty() { Ok(()) } else { Err(format!("loaded from elsewhere: {other:?}").into()) }
}
