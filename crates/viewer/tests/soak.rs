//! Edits without end, half of them broken: with a file that is written in every way that editors know, with every edit
//! followed and with edits faster than they can be. At the end the last one is shown, and neither memory nor threads
//! nor open files have grown.
//!
//! ```text
//! SDFC_SOAK=10000 cargo test -p sdfc-viewer --test soak -- --nocapture
//! ```

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use sdfc_viewer::mode::Mode;
use sdfc_viewer::session::Session;

/// Long enough for a busy machine and a software adapter; reached only where the test fails.
const PATIENCE: Duration = Duration::from_secs(300);
const SIZE: [u32; 2] = [64, 48];
/// Edits without `SDFC_SOAK`.
const FEW: usize = 240;
/// Edits between two looks at the memory. Every second lot is faster than it can be followed.
const LOT: usize = 40;
/// Growth of the memory from the first half to the end that is no leak, in MiB: allocators keep what they had.
const SLACK: u64 = 48;
/// Threads and files that are open for a moment.
const FEW_MORE: u64 = 8;

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
fn edits_without_end() {
    let count = std::env::var("SDFC_SOAK").ok().and_then(|it| it.parse().ok()).unwrap_or(FEW);
    let folder = tempfile::tempdir().unwrap();
    let mut soak = Soak::new(folder.path().join("scene.sdf"));
    let mut samples = Vec::new();
    let start = Instant::now();
    for lot in 0..count.div_ceil(LOT).max(2) {
        for edit in lot * LOT..(lot + 1) * LOT {
            let text = soak.write(edit);
            if lot % 2 == 0 {
                soak.follow(edit, &text);
            } else {
                soak.step();
                std::thread::sleep(Duration::from_micros(edit as u64 * 37 % 4000));
            }
        }
        let text = format!("sphere(0.{})\n", lot % 8 + 1);
        std::fs::write(&soak.path, &text).unwrap();
        soak.until(|session| is_shown(session, &text));
        samples.push(Held::now());
        if lot % 25 == 0 {
            println!("{} edits, {:?}", (lot + 1) * LOT, samples[lot]);
        }
    }
    let (half, end) = (samples[samples.len() / 2], samples[samples.len() - 1]);
    println!(
        "{} edits in {:.0} s, {} pipelines, {} pictures: {:?} after the first lot, {half:?} at half, {end:?} at the end",
        samples.len() * LOT,
        start.elapsed().as_secs_f64(),
        soak.session.model.as_ref().unwrap().pipelines,
        soak.session.pictures,
        samples[0],
    );
    let most = |of: fn(&Held) -> u64| samples[..=samples.len() / 2].iter().map(of).max().unwrap();
    assert!(end.threads <= most(|held| held.threads) + FEW_MORE, "threads: {samples:?}");
    assert!(end.files <= most(|held| held.files) + FEW_MORE, "open files: {samples:?}");
    assert!(end.memory <= most(|held| held.memory) + SLACK, "memory: {samples:?}");
}

/// What the process holds; all 0 where the system does not say.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    /// MiB of memory.
    memory: u64,
    threads: u64,
    files: u64,
}

impl Held {
    fn now() -> Self {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let of = |name: &str| -> u64 {
            let line = status.lines().find_map(|line| line.strip_prefix(name));
            line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
        };
        let files = std::fs::read_dir("/proc/self/fd").map_or(0, |files| files.count() as u64);
        Self { memory: of("VmRSS:") / 1024, threads: of("Threads:"), files }
    }
}

/// Whether the text is the one that is drawn.
fn is_shown(session: &Session, text: &str) -> bool {
    let Some((model, picture)) = session.model.as_ref().zip(session.picture.as_ref()) else {
        return false;
    };
    model.text == text && picture.finished && picture.request.model.serial == model.serial
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
        soak.until(|session| session.pictures > 0);
        soak
    }

    /// The text of an edit, and one of the ways to write it. Every second one is broken.
    fn write(&self, edit: usize) -> String {
        let number = edit / 2;
        let text = match edit % 2 {
            0 => format!("{} // {edit}\n", BROKEN[number % BROKEN.len()]),
            _ => good(number),
        };
        let place = &self.path;
        match number % 5 {
            0 => {
                let aside = place.with_extension("new");
                std::fs::write(&aside, &text).unwrap();
                std::fs::rename(&aside, place).unwrap();
            }
            1 => {
                let _ = std::fs::remove_file(place);
                std::fs::write(place, &text).unwrap();
            }
            2 => std::fs::write(place, format!("\u{feff}{}", text.replace('\n', "\r\n"))).unwrap(),
            _ => std::fs::write(place, &text).unwrap(),
        }
        text
    }

    /// Does as the window does.
    fn step(&mut self) {
        self.session.poll();
        let turn = self.session.pictures;
        self.session.mode = Mode::ALL[turn as usize / 16 % Mode::ALL.len()];
        self.session.move_camera(|orbit| orbit.turn(0.01, 0.0));
        self.session.ask(SIZE, turn.is_multiple_of(3));
    }

    /// Until it is told what comes of the edit.
    fn follow(&mut self, edit: usize, text: &str) {
        self.step();
        let mark = format!("// {edit}");
        let text = text.trim_end().to_owned();
        self.until(|session| match edit % 2 {
            0 => session.findings.errors() > 0 && is_told(session, &mark),
            _ => session.model.as_ref().is_some_and(|model| trimmed(&model.text) == text),
        });
    }

    fn until(&mut self, holds: impl Fn(&Session) -> bool) {
        let start = Instant::now();
        while !holds(&self.session) {
            let session = &self.session;
            assert!(start.elapsed() < PATIENCE, "{:?} {:?}", session.trouble, session.findings);
            std::thread::sleep(Duration::from_micros(200));
            self.session.poll();
            self.session.ask(SIZE, false);
        }
    }
}

/// However the lines of the file end.
fn trimmed(text: &str) -> String {
    text.trim_start_matches('\u{feff}').trim_end().replace('\r', "")
}

/// Whether the findings are those of the text with the mark.
fn is_told(session: &Session, mark: &str) -> bool {
    read(session.path()).contains(mark) && session.findings.all.iter().any(|it| it.is_error)
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

/// Mostly another number, at times another structure.
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
