//! From an edit on disk to its first picture, as a session without a window shows it, with the stages apart.
//!
//! ```text
//! MESA_SHADER_CACHE_DIR=$(mktemp -d) cargo bench -p sdfc-viewer --bench latency [-- PART OF A ROW'S NAME]
//! ```
//!
//! A *literal* is another number of the same text. A *structure* differs from all before it: of six more leaves, each is
//! a ball or a block as the digits of the edit's number say, so that no driver has met the shader.
//!
//! The session is looked at when it asks to be, and at most 60 times a second, as a window looks at it. `frames` counts
//! those looks from the edit to the one that has its picture. `watch` goes from the edit to where its text is read; `rest` is what lies between the
//! stages, waiting for the next look among it.

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

use sdfc::render::milliseconds_since;
use sdfc_viewer::session::Session;

const SIZE: [u32; 2] = [640, 360];
/// Scenes, what they are called here, and how often each is edited in either way.
const SCENES: [(&str, &str, u32); 3] = [
    ("bench/thirty.sdf", "30 leaves", 63),
    ("generated 300", "300 leaves", 15),
    (ALIKE, "300 leaves, alike", 63),
];
/// Of two kinds, so that they become loops.
const ALIKE: &str = "alike 300";
/// They spell the numbers of the edits.
const MORE_LEAVES: u32 = 6;
/// From one frame of a window to the next.
const FRAME: Duration = Duration::from_nanos(16_666_667);
/// Longer than any edit takes.
const PATIENCE: Duration = Duration::from_secs(600);

/// Milliseconds of one edit.
struct Spent {
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
    // Cargo's own flag is no part of a name.
    let wanted = std::env::args().skip(1).find(|it| !it.starts_with('-')).unwrap_or_default();
    println!(
        "| edit | edits | p50 | p99 | frames, p50 | p99 | watch | front end | analysis | lowering | pipeline | frame | rest |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut suite = sdfc::suite();
    suite.push((ALIKE.to_owned(), alike(300)));
    for (scene, called, edits) in SCENES {
        let (_, text) = suite.iter().find(|(name, _)| name == scene).unwrap();
        let literal = |edit: u32| format!("{text}\nsphere(0.1{edit:03}).translate(y: 3)\n");
        let structure = |edit: u32| format!("{text}\n{}", spelt(edit));
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

/// Balls and blocks in rows of twenty, no two of one size.
fn alike(leaves: u32) -> String {
    let mut out = String::new();
    for place in 0..leaves {
        let leaf = if place.is_multiple_of(2) { "sphere" } else { "box" };
        let [x, y] = [place % 20, place / 20].map(|it| 0.3 * f64::from(it) - 3.0);
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{leaf}(0.1{place:03}).translate([{x:.1}, {y:.1}, 0.0{place}])");
    }
    out
}

/// Six leaves that are a number in binary digits.
fn spelt(number: u32) -> String {
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
        // What refines the last picture is over, as it is for someone who looks before he types.
        window.wait(|it| it.picture.as_ref().is_some_and(|picture| picture.finished));
        let text = text(edit);
        // Whoever types has not looked for a while.
        std::thread::sleep(FRAME);
        let start = Instant::now();
        std::fs::write(&path, &text).unwrap();
        all.push(window.shown(&text, start));
    }
    let figure = |of: &dyn Fn(&Spent) -> f64, share: f64| {
        let mut sorted: Vec<f64> = all.iter().map(of).collect();
        sorted.sort_by(f64::total_cmp);
        sorted[((sorted.len() - 1) as f64 * share).round() as usize]
    };
    let median = |of: &dyn Fn(&Spent) -> f64| format!("{:.1}", figure(of, 0.5));
    let rest = |it: &Spent| {
        it.total - it.watch - it.front - it.analyze - it.lower - it.pipeline - it.frame
    };
    println!(
        "| {name} | {edits} | {:.1} | {:.1} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
        figure(&|it| it.total, 0.5),
        figure(&|it| it.total, 0.99),
        figure(&|it| it.frames, 0.5),
        figure(&|it| it.frames, 0.99),
        median(&|it| it.watch),
        median(&|it| it.front),
        median(&|it| it.analyze),
        median(&|it| it.lower),
        median(&|it| it.pipeline),
        median(&|it| it.frame),
        median(&rest)
    );
}

/// A window without one.
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

    /// Waits for the first picture of a text.
    fn shown(&mut self, text: &str, start: Instant) -> Spent {
        let frames = self.wait(|session| {
            session.picture.as_ref().is_some_and(|it| it.request.model.text == text)
        });
        let total = milliseconds_since(start);
        let picture = self.session.picture.as_ref().unwrap();
        let model = &picture.request.model;
        let stages = model.stages;
        Spent {
            total,
            frames: f64::from(frames),
            watch: 1000.0 * model.begun.saturating_duration_since(start).as_secs_f64(),
            front: stages.front,
            analyze: stages.analyze,
            lower: stages.lower,
            pipeline: stages.pipeline.unwrap_or(0.0),
            frame: picture.latency,
        }
    }

    /// Frame by frame, until it is so; gives how many that took.
    fn wait(&mut self, holds: impl Fn(&Session) -> bool) -> u32 {
        let mut frames = 0;
        while !holds(&self.session) {
            let woken = self.woken.recv_timeout(PATIENCE);
            assert!(woken.is_ok(), "{:?} {:?}", self.session.findings, self.session.trouble);
            std::thread::sleep(FRAME.saturating_sub(self.last.elapsed()));
            self.last = Instant::now();
            while self.woken.try_recv().is_ok() {}
            self.session.poll();
            self.session.ask(SIZE, false);
            frames += 1;
        }
        frames
    }
}
