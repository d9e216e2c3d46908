//! Typed text when the window's device is lost.

use std::time::Duration;

use libtest_mimic::Failed;
use sdfc_viewer::app::LOSE_WINDOW;

use super::display::{Display, Scene, Window, differ, expect};

/// A scene whose last line is typed.
const SCENE: &str = "sphere(1).color(#d94f30)\nbackground(#203040)\n\
                     camera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)\n";
/// The panel "Code" with its text.
const CODE: [std::ops::Range<u32>; 2] = [0..430, 90..300];

/// The program ends, and the next window has the text, which can be saved.
pub fn survives_a_loss_within_a_frame(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(SCENE)?;
    let mut window = Window::open_with(&display, &scene, &[(LOSE_WINDOW, "150.5")])?;
    type_at_end(&window, "box(2)")?;
    let mut steps = 0..3000;
    while window.status()?.is_none() {
        let step = steps.next().ok_or("the window is still open")?;
        // The display starts again when its only window ends, and takes no input meanwhile.
        drop(window.input(&["mousemove", &(600 + step % 30).to_string(), "370"]));
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(window);
    expect(std::fs::read_to_string(&scene.path)? == SCENE, "the file was changed")?;
    let window = Window::open(&display, &scene)?;
    window.settled(|_| true)?;
    window.input(&["key", "ctrl+s"])?;
    let expected = format!("{SCENE}box(2)");
    window.until("the typed text is gone", || Ok(std::fs::read_to_string(&scene.path)? == expected))
}

/// Opens the panel "Code", which opening a window for a test closes, and types.
fn type_at_end(window: &Window<'_>, text: &str) -> Result<(), Failed> {
    let before = window.settled(|_| true)?;
    window.input(&["key", "t"])?;
    window.settled(|picture| differ(picture, &before, CODE) > 500)?;
    window.input(&["mousemove", "200", "500", "click", "1"])?;
    std::thread::sleep(Duration::from_millis(500));
    window.input(&["key", "ctrl+End"])?;
    window.input(&["type", "--delay", "60", text])
}
