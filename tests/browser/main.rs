//! Shaders and pages in a real browser: Chromium, without a window, WebGPU and WebGL 2 on the processor.
//!
//! Where there is no Chromium the trials are reported as ignored; with `SDFC_REQUIRE_CHROMIUM=1` they fail.

mod chromium;
mod compiler;
mod compiles;
mod pages;
mod server;
mod table;
mod three;

use std::sync::{Mutex, PoisonError};

use chromium::Chromium;
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::Target;
use server::Server;

/// One browser for all trials, and what it is served.
struct Place {
    chromium: Chromium,
    server: Server,
}

/// Trials take turns: the browser has one page.
static PLACE: Mutex<Option<Place>> = Mutex::new(None);

type Check = Box<dyn Fn(&mut Place) -> Result<(), Failed> + Send>;

fn main() {
    let missing = chromium::is_missing();
    let mut trials = Vec::new();
    let mut add = |name: String, check: Check| {
        let is_missing = missing
            || (name.starts_with("three") && three::is_missing())
            || (name.starts_with("the_package") && compiler::is_missing());
        trials.push(Trial::test(name, move || in_place(&check)).with_ignored_flag(is_missing));
    };
    for target in [Target::Wgsl, Target::GlslEs, Target::Shadertoy] {
        let name = format!("every_example_compiles_as_{}", target.name());
        add(name, Box::new(move |place| compiles::every_example(place, target)));
    }
    for embedding in &pages::EMBEDDINGS {
        let name = format!("{}_shows_what_render_draws", embedding.name);
        add(name, Box::new(|place| pages::show_every_scene(place, embedding)));
    }
    for embedding in &pages::EMBEDDINGS[..2] {
        let name = format!("{}_follows_knobs_and_mouse", embedding.name);
        add(name, Box::new(|place| pages::follow_knobs_and_mouse(place, embedding)));
        let name = format!("{}_follows_the_clock", embedding.name);
        add(name, Box::new(|place| pages::follow_the_clock(place, embedding)));
    }
    let clock = "shadertoy_follows_clock_and_mouse".to_owned();
    add(clock, Box::new(pages::shadertoy_follows_clock_and_mouse));
    add("three_shows_what_render_meets".to_owned(), Box::new(three::shows_every_scene));
    add("three_hides_meshes_and_fields".to_owned(), Box::new(three::hides_meshes_and_fields));
    add("three_takes_a_scene_without_params".to_owned(), Box::new(three::takes_a_bare_scene));
    add("three_follows_the_clock".to_owned(), Box::new(three::follows_the_clock));
    let package = "the_package_gives_the_same_in_a_browser".to_owned();
    add(package, Box::new(compiler::gives_the_same_in_a_browser));
    add("the_package_draws_what_is_typed".to_owned(), Box::new(compiler::draws_what_is_typed));
    let conclusion = libtest_mimic::run(&Arguments::from_args(), trials);
    // A static is not dropped, and the browser would stay.
    drop(PLACE.lock().unwrap_or_else(PoisonError::into_inner).take());
    conclusion.exit();
}

fn in_place(check: &Check) -> Result<(), Failed> {
    let mut place = PLACE.lock().unwrap_or_else(PoisonError::into_inner);
    if place.is_none() {
        let server = Server::start(&sdfc_tests::examples_folder().join("embed"))?;
        server.lay("shadertoy/index.html", include_bytes!("shadertoy.html").to_vec());
        server.lay("shadertoy/head.glsl", include_bytes!("../targets/shadertoy.glsl").to_vec());
        *place = Some(Place { chromium: Chromium::start()?, server });
    }
    let found = check(place.as_mut().ok_or("no browser")?);
    if found.is_err() {
        // It may be busy, or gone.
        *place = None;
    }
    found
}
