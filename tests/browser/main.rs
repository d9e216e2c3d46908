//! Shaders and pages work in a real browser: Chromium without a window, with WebGPU and WebGL 2 on
//! the CPU.
//!
//! Without Chromium the tests are reported as ignored; with `SDFC_REQUIRE_CHROMIUM=1` they fail.

mod chromium;
mod compiler;
mod compiles;
mod measure;
mod pages;
mod playground;
mod server;
mod site;
mod soak;
mod survival;
mod table;
mod three;

use std::sync::{Mutex, MutexGuard, PoisonError};

use chromium::Chromium;
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::Target;
use server::Server;

/// A browser, and the server of its pages.
struct Session {
    chromium: Chromium,
    server: Server,
}

/// The sessions that no test uses. A browser has one page, so tests that run at the same time have
/// browsers of their own.
static SESSIONS: Mutex<Vec<Session>> = Mutex::new(Vec::new());

type Check = Box<dyn Fn(&mut Session) -> Result<(), Failed> + Send>;

fn main() {
    let missing = chromium::is_missing();
    let mut trials = Vec::new();
    let mut add = |name: String, check: Check| {
        let is_missing = missing
            || (name.starts_with("three") && three::is_missing())
            || (name.starts_with("the_package") && compiler::is_missing())
            || ((name.starts_with("the_playground") || name.starts_with("the_site"))
                && playground::is_missing());
        trials.push(Trial::test(name, move || in_session(&check)).with_ignored_flag(is_missing));
    };
    for target in [Target::Wgsl, Target::GlslEs, Target::Shadertoy] {
        let name = format!("every_example_compiles_as_{}", target.name());
        add(name, Box::new(move |session| compiles::every_example(session, target)));
    }
    for embedding in &pages::EMBEDDINGS {
        let name = format!("{}_shows_the_picture_of_render", embedding.name);
        add(name, Box::new(|session| pages::show_every_scene(session, embedding)));
    }
    for embedding in &pages::EMBEDDINGS[..2] {
        let name = format!("{}_follows_sliders_and_mouse", embedding.name);
        add(name, Box::new(|session| pages::follow_sliders_and_mouse(session, embedding)));
        let name = format!("{}_follows_the_clock", embedding.name);
        add(name, Box::new(|session| pages::follow_the_clock(session, embedding)));
    }
    let clock = "shadertoy_follows_clock_and_mouse".to_owned();
    add(clock, Box::new(pages::shadertoy_follows_clock_and_mouse));
    add("three_shows_every_scene".to_owned(), Box::new(three::shows_every_scene));
    add("three_hides_meshes_and_fields".to_owned(), Box::new(three::hides_meshes_and_fields));
    add("three_takes_a_scene_without_params".to_owned(), Box::new(three::takes_a_bare_scene));
    add("three_follows_the_clock".to_owned(), Box::new(three::follows_the_clock));
    let package = "the_package_compiles_the_same_in_a_browser".to_owned();
    add(package, Box::new(compiler::compiles_the_same_in_a_browser));
    add("the_package_draws_the_typed_scene".to_owned(), Box::new(compiler::draws_the_typed_scene));
    for (name, check) in playground::BY_BACKEND {
        for backend in ["webgpu", "webgl2"] {
            let name = format!("the_playground_{name}_with_{backend}");
            add(name, Box::new(move |session| check(session, backend)));
        }
    }
    add("the_playground_follows_lists".to_owned(), Box::new(playground::follows_lists));
    add("the_playground_shares_by_link".to_owned(), Box::new(playground::shares_by_link));
    let name = "the_playground_survives_a_long_compilation".to_owned();
    add(name, Box::new(survival::long_compilation));
    add("the_site_leads_to_the_playground".to_owned(), Box::new(site::leads_to_the_playground));
    add("the_site_shows_a_scene".to_owned(), Box::new(site::shows_a_scene));
    add("the_site_fits_a_phone".to_owned(), Box::new(site::fits_a_phone));
    if std::env::var_os(measure::MEASURE).is_some() {
        add("the_playground_times".to_owned(), Box::new(measure::times));
        add("the_playground_screenshots".to_owned(), Box::new(measure::screenshots));
    }
    if std::env::var_os(soak::MINUTES).is_some() {
        for backend in ["webgpu", "webgl2"] {
            let name = format!("the_playground_stays_small_with_{backend}");
            add(name, Box::new(move |session| soak::stays_small(session, backend)));
        }
    }
    let conclusion = libtest_mimic::run(&Arguments::from_args(), trials);
    // A static is not dropped, so the browsers would keep running.
    sessions().clear();
    conclusion.exit();
}

fn sessions() -> MutexGuard<'static, Vec<Session>> {
    SESSIONS.lock().unwrap_or_else(PoisonError::into_inner)
}

fn in_session(check: &Check) -> Result<(), Failed> {
    let idle = sessions().pop();
    let mut session = idle.map_or_else(Session::start, Ok)?;
    let result = check(&mut session);
    // After a failure the browser may be busy or may have crashed.
    if result.is_ok() {
        sessions().push(session);
    }
    result
}

impl Session {
    fn start() -> Result<Self, Failed> {
        let server = Server::start(&sdfc_tests::examples_folder().join("embed"))?;
        server.put("shadertoy/index.html", include_bytes!("shadertoy.html").to_vec());
        server.put("shadertoy/head.glsl", include_bytes!("../targets/shadertoy.glsl").to_vec());
        Ok(Self { chromium: Chromium::start()?, server })
    }
}
