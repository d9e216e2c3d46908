//! The site of the documentation, with the playground in it.

use std::process::Command;

use libtest_mimic::Failed;
use sdfc_tests::repository;

use crate::Session;
use crate::playground::Page;
use crate::server::Server;

const WINDOW: [u32; 2] = [1400, 700];

/// The build succeeds, which checks all links. A search leads to a section, and a scene of the page
/// opens in the playground. Nothing comes from another server.
pub fn leads_to_the_playground(session: &mut Session) -> Result<(), Failed> {
    let folder = repository().join("playground");
    let built = Command::new("node").arg("site/build.js").current_dir(folder).output()?;
    if !built.status.success() {
        return Err(String::from_utf8_lossy(&built.stderr).into_owned().into());
    }
    let server = Server::start(&repository().join("target/site"))?;
    let chromium = &mut session.chromium;
    chromium.open(&server.url("index.html"), WINDOW)?;
    chromium.evaluate(LOADED)?;
    chromium.click("#search", [0.5, 0.5])?;
    chromium.insert("menger")?;
    let first = chromium.evaluate(FIRST)?;
    if !first.as_str().is_some_and(|url| url.ends_with("reference/fractals.html#menger")) {
        return Err(format!("the first result is {first}").into());
    }
    chromium.evaluate("void document.querySelector('#found a').click()")?;
    let source = chromium.evaluate(SOURCE)?;
    let source = source.as_str().ok_or("no example")?;
    only_from(chromium, &server)?;

    let link = chromium.evaluate("window.example.nextElementSibling.href")?;
    chromium.open(link.as_str().ok_or("no link")?, WINDOW)?;
    let mut page = Page { chromium };
    page.expect_state("drawn")?;
    let shown = page.chromium.evaluate("document.querySelector('.cm-content').innerText")?;
    if shown != source {
        return Err(format!("the playground shows {shown}, not {source}").into());
    }
    page.expect_no_complaint()?;
    only_from(page.chromium, &server)
}

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
