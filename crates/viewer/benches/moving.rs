//! Measures pictures of a moving camera: copied to the CPU, or kept on the device of the window.
//!
//! ```text
//! cargo bench -p sdfc-viewer --bench moving
//! ```
//!
//! The camera turns a little for each picture. `latency` is the time from the request to the
//! report, of which `draw` is the time of the rays. A window then has to upload a copied picture as
//! a texture, which is not measured. `cpu` is the CPU time of the process: with a software driver,
//! that of the rays too.

#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a benchmark prints, and fails by panicking"
)]

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

use cpu_time::ProcessTime;
use sdfc_render::Gpu;
use sdfc_viewer::render::window_device::WindowDevice;
use sdfc_viewer::session::Session;

const SCENE: &str = "sphere(1).color(#d94f30)\nplane(y: -1)\n\
                     camera(eye: [0, 1, 5], target: [0, 0, 0], fov: 40deg)\nsun(direction: [1, 2, 1])\n";
const SIZES: [[u32; 2]; 3] = [[640, 360], [1280, 720], [1920, 1080]];
/// Pictures that are measured, after some that only set the resolution.
const PICTURES: usize = 60;
const BEFORE: usize = 10;
/// Longer than any picture takes.
const TIMEOUT: Duration = Duration::from_secs(120);

fn main() {
    println!("| picture | size | drawn at | latency, p50 | p99 | draw, p50 | cpu per picture |");
    println!("|---|---|---|---|---|---|---|");
    for size in SIZES {
        for stays in [false, true] {
            row(size, stays);
        }
    }
}

/// The picture that a request led to.
struct Seen {
    divisor: u32,
    latency: f64,
    draw: f64,
}

fn row(size: [u32; 2], stays: bool) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.sdf");
    std::fs::write(&path, SCENE).unwrap();
    let (sender, woken) = channel();
    // The receiver is gone only at the end.
    let wake = move || sender.send(()).unwrap_or_default();
    let mut session = Session::open(&path, Arc::new(wake)).unwrap();
    let device = stays.then(|| WindowDevice::new(Gpu::new().unwrap()));
    session.set_window_device(device);
    let wait = |session: &mut Session, holds: &dyn Fn(&Session) -> bool| {
        while !holds(session) {
            woken.recv_timeout(TIMEOUT).unwrap();
            session.poll();
        }
    };
    wait(&mut session, &|session| session.model.as_ref().is_some_and(|it| it.on_window == stays));
    let mut seen = Vec::new();
    let mut cpu = ProcessTime::now();
    for number in 0..BEFORE + PICTURES {
        if number == BEFORE {
            (seen, cpu) = (Vec::new(), ProcessTime::now());
        }
        session.move_camera(|camera| camera.orbit(0.003, 0.0));
        session.request_picture(size, true);
        let pose = session.camera().unwrap().pose();
        wait(&mut session, &|it| it.shown_request().is_some_and(|shown| shown.pose == pose));
        seen.push(match (&session.moving, &session.picture) {
            (Some(it), _) => {
                Seen { divisor: it.divisor, latency: it.latency, draw: it.milliseconds }
            }
            (None, Some(it)) => {
                Seen { divisor: it.divisor, latency: it.latency, draw: it.milliseconds }
            }
            (None, None) => unreachable!(),
        });
    }
    let cpu = 1000.0 * cpu.elapsed().as_secs_f64() / PICTURES as f64;
    let quantile = |of: &dyn Fn(&Seen) -> f64, fraction: f64| {
        let mut sorted: Vec<f64> = seen.iter().map(of).collect();
        sorted.sort_by(f64::total_cmp);
        sorted[((sorted.len() - 1) as f64 * fraction).round() as usize]
    };
    let latency = |fraction| quantile(&|it| it.latency, fraction);
    let (draw, divisor) = (quantile(&|it| it.draw, 0.5), quantile(&|it| it.divisor.into(), 0.5));
    let kind = if stays { "on the device" } else { "copied" };
    println!(
        "| {kind} | {}x{} | 1/{divisor} | {:.1} | {:.1} | {draw:.1} | {cpu:.1} |",
        size[0],
        size[1],
        latency(0.5),
        latency(0.99)
    );
}
