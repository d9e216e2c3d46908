//! Measures the time that the window needs for a frame in which a character is typed, while the
//! scene is compiled after each character.
//!
//! ```text
//! cargo bench -p sdfc-viewer --bench typing
//! ```
//!
//! A frame is the work of the window's thread: the layout of all panels, and the triangles that the
//! GPU then paints. `cpu` is the CPU time of that thread, which other work on the machine does not
//! change. Every character changes the structure of the scene, so that the compiler, the driver and
//! the language service are busy.

#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a benchmark prints, and fails by panicking"
)]

use std::fmt::Write;
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use eframe::egui::{Context, Event, Key, Modifiers, PointerButton, RawInput, Rect, pos2, vec2};
use sdfc_render::milliseconds_since;
use sdfc_viewer::app::App;

/// The characters that are typed.
const TYPED: &str = " | box(0.3).translate(x: 2)";
/// The time from one character to the next, as of a fast typist.
const PAUSE: Duration = Duration::from_millis(80);

fn main() {
    println!("| leaves | bytes | | p50 | p99 | most | cpu, p50 | p99 | most |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for leaves in [30, 300, 3000] {
        row(leaves);
    }
}

/// Balls and blocks in rows of twenty, all of different sizes.
fn scene(leaves: u32) -> String {
    let mut out = String::new();
    for index in 0..leaves {
        let leaf = if index.is_multiple_of(2) { "sphere" } else { "box" };
        let [x, y] = [index % 20, index / 20].map(|it| 0.3 * f64::from(it) - 3.0);
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{leaf}(0.1{index:03}).translate([{x:.1}, {y:.1}, 0.0{index}])");
    }
    out + "sphere(1)"
}

fn row(leaves: u32) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.sdf");
    let text = scene(leaves);
    std::fs::write(&path, &text).unwrap();
    let mut window = Window::new(&path);
    while window.app.opened().picture.is_none() {
        std::thread::sleep(Duration::from_millis(5));
        window.frame(Vec::new());
    }
    // A click below the text puts the cursor at its end.
    let (pos, button, modifiers) = (pos2(200.0, 700.0), PointerButton::Primary, Modifiers::NONE);
    window.frame(vec![Event::PointerMoved(pos)]);
    for pressed in [true, false] {
        window.frame(vec![Event::PointerButton { pos, button, pressed, modifiers }]);
    }
    let modifiers = Modifiers { ctrl: true, ..Modifiers::COMMAND };
    let (pressed, repeat, physical_key) = (true, false, None);
    window.frame(vec![Event::Key { key: Key::End, physical_key, pressed, repeat, modifiers }]);
    while !window.app.picture_is_finished() {
        std::thread::sleep(Duration::from_millis(5));
        window.frame(Vec::new());
    }
    let mut rest = Vec::new();
    for _ in 0..40 {
        rest.push(window.frame(Vec::new()));
        std::thread::sleep(Duration::from_millis(20));
    }
    let (mut keys, mut typing) = (Vec::new(), Vec::new());
    for _ in 0..4 {
        for character in TYPED.chars() {
            let start = Instant::now();
            keys.push(window.frame(vec![Event::Text(character.to_string())]));
            while start.elapsed() < PAUSE {
                std::thread::sleep(Duration::from_millis(10));
                typing.push(window.frame(Vec::new()));
            }
        }
    }
    assert_eq!(window.app.opened().text().len(), text.len() + 4 * TYPED.len());
    for (name, frames) in [("at rest", rest), ("while a key is handled", keys), ("typing", typing)]
    {
        let quantile = |of: &dyn Fn(&[f64; 2]) -> f64, fraction: f64| {
            let mut sorted: Vec<f64> = frames.iter().map(of).collect();
            sorted.sort_by(f64::total_cmp);
            sorted[((sorted.len() - 1) as f64 * fraction).round() as usize]
        };
        let [wall, cpu] = [0, 1].map(|column| {
            [0.5, 0.99, 1.0].map(|fraction| {
                format!("{:.1}", quantile(&|times: &[f64; 2]| times[column], fraction))
            })
        });
        let (wall, cpu) = (wall.join(" | "), cpu.join(" | "));
        println!("| {leaves} | {} | {name} | {wall} | {cpu} |", text.len());
    }
}

/// The app in a window that nobody sees.
struct Window {
    context: Context,
    app: App,
    start: Instant,
}

impl Window {
    fn new(path: &std::path::Path) -> Self {
        let context = Context::default();
        let app = App::new(&context, path, None).unwrap();
        Self { context, app, start: Instant::now() }
    }

    /// Draws a frame. Returns how long that took, and the CPU time of this thread, in
    /// milliseconds.
    fn frame(&mut self, events: Vec<Event>) -> [f64; 2] {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(1200.0, 760.0))),
            time: Some(self.start.elapsed().as_secs_f64()),
            focused: true,
            events,
            ..RawInput::default()
        };
        let (start, cpu) = (Instant::now(), ThreadTime::now());
        let mut output = self.context.run_ui(input, |ui| self.app.show(ui));
        output.textures_delta.clear();
        drop(self.context.tessellate(output.shapes, output.pixels_per_point));
        [milliseconds_since(start), 1000.0 * cpu.elapsed().as_secs_f64()]
    }
}
