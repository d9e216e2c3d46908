//! Hundreds of edits, half of them broken. The file is written in every way that editors use, some
//! edits one by one, others faster than they can be compiled. At the end the last one is shown, and
//! memory, threads and open files have not grown.
//!
//! ```text
//! SDFC_SOAK=10000 cargo test -p sdfc-viewer --test soak -- --nocapture
//! ```

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use sdfc_test_support::Resources;
use sdfc_viewer::session::Session;
use sdfc_viewer::views::mode::ViewMode;

/// Long enough for a busy machine and a software GPU; reached only if the test fails.
const TIMEOUT: Duration = Duration::from_secs(300);
const SIZE: [u32; 2] = [64, 48];
/// The number of edits if `SDFC_SOAK` is not set.
const DEFAULT_EDITS: usize = 240;
/// Edits between two measurements. Every second batch is faster than it can be compiled.
const BATCH: usize = 40;
const BROKEN: [&str; 8] = [
    "sphere(",
    "spere(1)",
    "sphere(1).",
    "\u{0}",
    "box(1) |",
    "sphere(1, 2, 3, 4)",
    "import a from \"missing.sdf\"\na()",
    "sphere(1) - ",
];

#[test]
fn many_edits_leak_no_memory_threads_or_files() {
    let count =
        std::env::var("SDFC_SOAK").ok().and_then(|it| it.parse().ok()).unwrap_or(DEFAULT_EDITS);
    let folder = tempfile::tempdir().unwrap();
    let mut soak = Soak::new(folder.path().join("scene.sdf"));
    let mut samples = Vec::new();
    let start = Instant::now();
    for batch in 0..count.div_ceil(BATCH).max(2) {
        for edit in batch * BATCH..(batch + 1) * BATCH {
            let text = soak.write(edit);
            if batch % 2 == 0 {
                soak.follow(edit, &text);
            } else {
                soak.step();
                std::thread::sleep(Duration::from_micros(edit as u64 * 37 % 4000));
            }
        }
        let text = format!("sphere(0.{})\n", batch % 8 + 1);
        std::fs::write(&soak.path, &text).unwrap();
        soak.until(|session| is_shown(session, &text));
        samples.push(Resources::of("self"));
        if batch % 25 == 0 {
            println!("{} edits, {:?}", (batch + 1) * BATCH, samples[batch]);
        }
    }
    let (half, end) = (samples[samples.len() / 2], samples[samples.len() - 1]);
    println!(
        "{} edits in {:.0} s, {} pipelines, {} pictures: {:?} after the first batch, {half:?} at half, \
         {end:?} at the end",
        samples.len() * BATCH,
        start.elapsed().as_secs_f64(),
        soak.session.model.as_ref().unwrap().pipelines,
        soak.session.picture_count,
        samples[0],
    );
    Resources::have_not_grown(&samples).unwrap();
}

/// Returns true if the source is the one that is drawn, completely.
fn is_shown(session: &Session, text: &str) -> bool {
    let Some((model, picture)) = session.model.as_ref().zip(session.picture.as_ref()) else {
        return false;
    };
    model.source == text && picture.finished && picture.request.model.serial == model.serial
}

struct Soak {
    session: Session,
    path: PathBuf,
}

impl Soak {
    fn new(path: PathBuf) -> Self {
        std::fs::write(&path, "sphere(1)\n").unwrap();
        let mut session = Session::open(&path, Arc::new(|| ())).unwrap();
        session.samples = Some(1);
        let mut soak = Self { session, path };
        soak.until(|session| session.picture_count > 0);
        soak
    }

    /// Writes an edit in one of the ways that editors use. Every second edit is broken.
    fn write(&self, edit: usize) -> String {
        let number = edit / 2;
        let text = match edit % 2 {
            0 => format!("{} // {edit}\n", BROKEN[number % BROKEN.len()]),
            _ => good(number),
        };
        let path = &self.path;
        match number % 5 {
            0 => {
                let temporary = path.with_extension("new");
                std::fs::write(&temporary, &text).unwrap();
                std::fs::rename(&temporary, path).unwrap();
            }
            1 => {
                let _ = std::fs::remove_file(path);
                std::fs::write(path, &text).unwrap();
            }
            2 => std::fs::write(path, format!("\u{feff}{}", text.replace('\n', "\r\n"))).unwrap(),
            _ => std::fs::write(path, &text).unwrap(),
        }
        text
    }

    /// Does what the window does in a frame.
    fn step(&mut self) {
        self.session.poll();
        let frame = self.session.picture_count;
        self.session.mode = ViewMode::ALL[frame as usize / 16 % ViewMode::ALL.len()];
        self.session.move_camera(|camera| camera.orbit(0.01, 0.0));
        self.session.request_picture(SIZE, frame.is_multiple_of(3));
    }

    /// Waits for the errors of the edit, or its model.
    fn follow(&mut self, edit: usize, text: &str) {
        self.step();
        let mark = format!("// {edit}");
        let text = text.trim_end().to_owned();
        self.until(|session| match edit % 2 {
            0 => session.diagnostics.errors() > 0 && is_reported(session, &mark),
            _ => session.model.as_ref().is_some_and(|model| trimmed(&model.source) == text),
        });
    }

    fn until(&mut self, holds: impl Fn(&Session) -> bool) {
        let start = Instant::now();
        while !holds(&self.session) {
            let session = &self.session;
            assert!(start.elapsed() < TIMEOUT, "{:?} {:?}", session.problem, session.diagnostics);
            std::thread::sleep(Duration::from_micros(200));
            self.session.poll();
            self.session.request_picture(SIZE, false);
        }
    }
}

/// The source without byte-order mark and carriage returns.
fn trimmed(text: &str) -> String {
    text.trim_start_matches('\u{feff}').trim_end().replace('\r', "")
}

/// Returns true if there are errors and the file contains the mark.
fn is_reported(session: &Session, mark: &str) -> bool {
    read(session.path()).contains(mark) && session.diagnostics.all.iter().any(|it| it.is_error)
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

/// A scene: usually a changed number, sometimes another structure.
fn good(number: usize) -> String {
    let size = 0.5 + (number % 97) as f64 / 200.0;
    let leaves = ["sphere(0.3)", "box(0.2)", "torus(0.3, 0.1)", "cylinder(0.2, 0.4)"];
    let structure = number / 8;
    let more = |digit: usize| {
        let leaf = leaves[structure / leaves.len().pow(digit as u32) % leaves.len()];
        format!("{leaf}.translate(x: {digit})\n")
    };
    format!("sphere({size})\n{}{}{}", more(0), more(1), more(2))
}
