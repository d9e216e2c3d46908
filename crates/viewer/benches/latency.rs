//! Measures the time from an edit on disk to its first picture, in a session without a window.
//!
//! ```text
//! MESA_SHADER_CACHE_DIR=$(mktemp -d) cargo bench -p sdfc-viewer --bench latency [-- PART OF A ROW'S NAME]
//! ```
//!
//! A *literal* edit changes a number. A *structure* edit gives a scene that differs from all before
//! it: six more leaves are balls or blocks, by the binary digits of the edit's number, so that no
//! driver has compiled the shader before.
//!
//! The session is polled when it wakes, at most 60 times per second, as by a window. `frames`
//! counts the polls from the edit to its picture. `watch` is the time from the edit to reading the
//! file; `rest` is the time between the stages, including the wait for the next poll.

#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a benchmark prints, and fails by panicking"
)]

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use sdfc_render::milliseconds_since;
use sdfc_viewer::session::Session;

const SIZE: [u32; 2] = [640, 360];
/// Scene, name in the table, and number of edits of each kind.
const SCENES: [(&str, &str, u32); 3] = [
    ("bench/thirty.sdf", "30 leaves", 63),
    ("generated 300", "300 leaves", 15),
    (ALIKE, "300 leaves, alike", 63),
];
/// Leaves of two kinds, which loop rerolling turns into loops.
const ALIKE: &str = "alike 300";
/// Leaves that encode the number of the edit.
const MORE_LEAVES: u32 = 6;
/// The time from one frame of a window to the next.
const FRAME: Duration = Duration::from_nanos(16_666_667);
/// Longer than any edit takes.
const TIMEOUT: Duration = Duration::from_secs(600);

/// The times of one edit, in milliseconds.
struct Times {
    total: f64,
    frames: f64,
    watch: f64,
    front: f64,
    analyze: f64,
    lower: f64,
    pipeline: f64,
    frame: f64,
}

fn main() {
    // Cargo passes `--bench`.
    let wanted = std::env::args().skip(1).find(|it| !it.starts_with('-')).unwrap_or_default();
    println!(
        "| edit | edits | p50 | p99 | frames, p50 | p99 | watch | front end | analysis | lowering | pipeline | frame | rest |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut suite = sdfc_measure::suite();
    suite.push((ALIKE.to_owned(), alike(300)));
    for (scene, called, edits) in SCENES {
        let (_, text) = suite.iter().find(|(name, _)| name == scene).unwrap();
        let literal = |edit: u32| format!("{text}\nsphere(0.1{edit:03}).translate(y: 3)\n");
        let structure = |edit: u32| format!("{text}\n{}", encoded(edit));
        let rows: [(&str, &dyn Fn(u32) -> String); 2] =
            [("literal", &literal), ("structure", &structure)];
        for (kind, text) in rows {
            let name = format!("{kind}, {called}");
            if name.contains(&wanted) {
                row(&name, edits, text);
            }
        }
    }
}

/// Balls and blocks in rows of twenty, all of different sizes.
fn alike(leaves: u32) -> String {
    let mut out = String::new();
    for index in 0..leaves {
        let leaf = if index.is_multiple_of(2) { "sphere" } else { "box" };
        let [x, y] = [index % 20, index / 20].map(|it| 0.3 * f64::from(it) - 3.0);
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{leaf}(0.1{index:03}).translate([{x:.1}, {y:.1}, 0.0{index}])");
    }
    out
}

/// Leaves that encode a number in binary digits.
fn encoded(number: u32) -> String {
    let mut out = String::new();
    for digit in 0..MORE_LEAVES {
        let leaf = if number >> digit & 1 == 0 { "sphere(0.1)" } else { "box(0.15)" };
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{leaf}.translate([0.3 * {digit}, 3, 0])");
    }
    out
}

fn row(name: &str, edits: u32, text: &dyn Fn(u32) -> String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.sdf");
    std::fs::write(&path, text(0)).unwrap();
    let mut window = Window::new(&path);
    window.shown(&text(0), Instant::now());
    let mut all = Vec::new();
    for edit in 1..=edits {
        // A user looks at the finished picture before the next edit.
        window.wait(|it| it.picture.as_ref().is_some_and(|picture| picture.finished));
        let text = text(edit);
        // Typing takes longer than a frame.
        std::thread::sleep(FRAME);
        let start = Instant::now();
        std::fs::write(&path, &text).unwrap();
        all.push(window.shown(&text, start));
    }
    let quantile = |of: &dyn Fn(&Times) -> f64, fraction: f64| {
        let mut sorted: Vec<f64> = all.iter().map(of).collect();
        sorted.sort_by(f64::total_cmp);
        sorted[((sorted.len() - 1) as f64 * fraction).round() as usize]
    };
    let median = |of: &dyn Fn(&Times) -> f64| format!("{:.1}", quantile(of, 0.5));
    let rest = |it: &Times| {
        it.total - it.watch - it.front - it.analyze - it.lower - it.pipeline - it.frame
    };
    println!(
        "| {name} | {edits} | {:.1} | {:.1} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
        quantile(&|it| it.total, 0.5),
        quantile(&|it| it.total, 0.99),
        quantile(&|it| it.frames, 0.5),
        quantile(&|it| it.frames, 0.99),
        median(&|it| it.watch),
        median(&|it| it.front),
        median(&|it| it.analyze),
        median(&|it| it.lower),
        median(&|it| it.pipeline),
        median(&|it| it.frame),
        median(&rest)
    );
}

/// Polls a session as a window does.
struct Window {
    session: Session,
    woken: Receiver<()>,
    last: Instant,
}

impl Window {
    fn new(path: &Path) -> Self {
        let (sender, woken) = channel();
        let mut session =
            Session::open(path, Arc::new(move || sender.send(()).unwrap_or_default())).unwrap();
        session.samples = Some(1);
        Self { session, woken, last: Instant::now() }
    }

    /// Waits for the first picture of a source.
    fn shown(&mut self, text: &str, start: Instant) -> Times {
        let frames = self.wait(|session| {
            session.picture.as_ref().is_some_and(|it| it.request.model.source == text)
        });
        let total = milliseconds_since(start);
        let picture = self.session.picture.as_ref().unwrap();
        let model = &picture.request.model;
        let times = model.build_times;
        Times {
            total,
            frames: f64::from(frames),
            watch: 1000.0 * model.read_at.saturating_duration_since(start).as_secs_f64(),
            front: times.front,
            analyze: times.analyze,
            lower: times.lower,
            pipeline: times.pipeline.unwrap_or(0.0),
            frame: picture.latency,
        }
    }

    /// Polls frame by frame until the condition holds; returns the number of frames.
    fn wait(&mut self, holds: impl Fn(&Session) -> bool) -> u32 {
        let mut frames = 0;
        while !holds(&self.session) {
            let woken = self.woken.recv_timeout(TIMEOUT);
            assert!(woken.is_ok(), "{:?} {:?}", self.session.diagnostics, self.session.problem);
            std::thread::sleep(FRAME.saturating_sub(self.last.elapsed()));
            self.last = Instant::now();
            while self.woken.try_recv().is_ok() {}
            self.session.poll();
            self.session.request_picture(SIZE, false);
            frames += 1;
        }
        frames
    }
}
