//! The panels, laid out and clicked without a window, in front of the CPU renderer.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Context, DroppedFile, Key, ViewportEvent, ViewportId};
use egui_kittest::Harness;
use egui_kittest::kittest::{Queryable, by};
use sdfc_viewer::app::App;
use sdfc_viewer::mode::Mode;

/// Long enough for a busy machine; reached only where a test fails.
const PATIENCE: Duration = Duration::from_secs(120);

const SCENE: &str = "/// How thick the wall is.\nparam wall = 0.1 in 0.05..0.5\nsphere(1) - sphere(1 - wall)\n\
                     camera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)\n";

struct Fixture {
    harness: Harness<'static, App>,
    folder: tempfile::TempDir,
}

impl Fixture {
    fn new() -> Self {
        Self::of(SCENE)
    }

    fn of(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.sdf");
        std::fs::write(&path, text).unwrap();
        let place = Some(folder.path().join("view.json"));
        let mut app = App::new(&Context::default(), &path, place).unwrap();
        app.session().set_build(|build| build.on_cpu = true);
        let show = |ui: &mut eframe::egui::Ui, app: &mut App| app.show(ui);
        let harness = Harness::builder().with_size([1000.0, 640.0]).build_ui_state(show, app);
        let mut fixture = Self { harness, folder };
        fixture.until(|harness| harness.state().picture_is_finished());
        fixture
    }

    fn write(&self, text: &str) {
        std::fs::write(self.folder.path().join("scene.sdf"), text).unwrap();
    }

    fn until(&mut self, holds: impl Fn(&Harness<'static, App>) -> bool) {
        let start = Instant::now();
        while !holds(&self.harness) {
            assert!(start.elapsed() < PATIENCE);
            std::thread::sleep(Duration::from_millis(5));
            self.harness.step();
        }
    }

    fn click(&mut self, label: &str) {
        self.harness.get_by_label(label).click();
        self.harness.run_steps(3);
    }

    fn move_a_number(&mut self) {
        let session = self.harness.state_mut().session();
        let model = session.model.clone().unwrap();
        let at = SCENE.find("sphere(1)").unwrap() as u32 + 7;
        let (slot, _) = model.literals().find(|(slot, _)| slot.span.start == at).unwrap();
        session.knobs.set_literal(slot, 1.25);
        self.harness.run_steps(2);
    }

    /// As a window manager does.
    fn request_close(&mut self) {
        let viewports = &mut self.harness.input_mut().viewports;
        viewports.entry(ViewportId::ROOT).or_default().events.push(ViewportEvent::Close);
        self.harness.run_steps(1);
        let viewports = &mut self.harness.input_mut().viewports;
        viewports.entry(ViewportId::ROOT).or_default().events.clear();
        self.harness.run_steps(2);
    }

    /// What can be clicked, dragged or typed into and says nothing where the pointer rests on it.
    fn unexplained(&self) -> Vec<String> {
        let widgets = [
            Role::Button,
            Role::CheckBox,
            Role::ColorWell,
            Role::ComboBox,
            Role::Link,
            Role::RadioButton,
            Role::Slider,
            Role::SpinButton,
            Role::TextInput,
        ];
        let silent = by().predicate(|node| {
            // What egui puts there itself.
            let own = node.label().is_some_and(|label| label == "Close window");
            widgets.contains(&node.role()) && node.data().description().is_none() && !own
        });
        let named = |node: egui_kittest::Node<'_>| format!("{node:?}");
        self.harness.query_all(silent).map(named).collect()
    }

    fn has(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }
}

#[test]
fn the_camera_is_the_scenes_until_it_is_moved() {
    let mut fixture = Fixture::new();
    assert!(fixture.has("wall"));
    assert!(fixture.harness.state_mut().session().follows());
    fixture.click("Top");
    assert!(!fixture.harness.state_mut().session().follows());
    fixture.click("Scene's own");
    assert!(fixture.harness.state_mut().session().follows());
}

#[test]
fn errors_are_told_in_the_terminals_words_and_go_when_mended() {
    let mut fixture = Fixture::new();
    fixture.write("spere(1)\n");
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_some());
    assert!(fixture.has("did you mean `sphere`?"));
    assert!(fixture.has("scene.sdf:1:1"));
    assert!(fixture.has("showing the last good scene"));
    fixture.write(SCENE);
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_none());
}

#[test]
fn the_text_opens_and_params_can_be_reset() {
    let mut fixture = Fixture::new();
    fixture.click("Text");
    assert!(fixture.has("drag a number"));
    let moved = [0.4, 0.0, 0.0, 0.0];
    fixture.harness.state_mut().session().knobs.params.insert("wall".to_owned(), moved);
    fixture.harness.run_steps(2);
    // The last is that of the numbers in the text, which is not to be clicked.
    let reset = fixture.harness.get_all_by_label("Reset").next();
    reset.unwrap().click();
    fixture.harness.run_steps(3);
    assert!(fixture.harness.state_mut().session().knobs.params.is_empty());
}

#[test]
fn a_number_that_a_let_names_has_a_slider() {
    let mut fixture = Fixture::of("let k = 0.4\nsphere(k)\n");
    let slider = fixture.harness.get_by_role_and_label(Role::Slider, "k");
    slider.set_value_accesskit(0.6);
    fixture.harness.run_steps(3);
    fixture.click("Write");
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == "let k = 0.6\nsphere(k)\n");
}

#[test]
fn moved_numbers_are_written_into_the_file() {
    let mut fixture = Fixture::new();
    fixture.click("Text");
    fixture.move_a_number();
    fixture.click("Write");
    let text = SCENE.replace("sphere(1) ", "sphere(1.25) ");
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == text);
}

#[test]
fn a_window_with_moved_numbers_asks_before_it_goes() {
    let mut fixture = Fixture::new();
    fixture.move_a_number();
    fixture.request_close();
    assert!(fixture.has("A moved number is not in the file"));
    fixture.click("Stay");
    assert!(!fixture.has("A moved number is not in the file"));
    fixture.request_close();
    fixture.click("Write and close");
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap().contains("sphere(1.25) "));
}

#[test]
fn a_picture_and_a_shader_are_saved_beside_the_scene() {
    let mut fixture = Fixture::new();
    let place = |name: &str| fixture.folder.path().join(name);
    let (picture, shader) = (place("scene.png"), place("scene.wgsl"));
    fixture.click("Save");
    fixture.click("square");
    fixture.harness.get_all_by_label("1").last().unwrap().click();
    fixture.harness.run_steps(3);
    fixture.harness.get_all_by_label("Save").last().unwrap().click();
    fixture.until(|_| picture.exists());
    assert_eq!(image::open(&picture).unwrap().width(), 2048);
    fixture.click("Shader");
    fixture.harness.get_all_by_label("Save").last().unwrap().click();
    fixture.until(|_| shader.exists());
    assert!(std::fs::read_to_string(&shader).unwrap().contains("fn sdf_distance"));
}

#[test]
fn the_picture_is_compared_with_the_oracle() {
    let mut fixture = Fixture::new();
    assert!(fixture.has("proven ray by ray"));
    fixture.click("Compare");
    fixture.until(|harness| harness.query_by_label("99 of 100").is_some());
    fixture.until(|harness| harness.query_by_label("Compare").is_some());
    let session = fixture.harness.state_mut().session();
    assert!(session.judgement_is_of_this());
    assert_eq!(session.comparing.judgement.as_ref().unwrap().shown.failed(), 0);
    fixture.click("Top");
    assert!(fixture.has("of another picture than this"));
    // Compared anew of its own accord.
    fixture.click("at rest");
    fixture.until(|harness| harness.query_by_label_contains("of another picture").is_none());
}

/// Params of all kinds, a number with a name, and time.
const ALL_KINDS: &str = "param width = 0.5 in 0..1\nparam count: int = 2 in 1..5\nparam lean = 10deg\n\
                         param red: color = #d94f30\nparam whole = true\nparam kind = \"ball\" in [\"ball\", \"box\"]\n\
                         let k = 0.25\nsphere(width + k + 0.1 * sin(time)).color(red)\n";

#[test]
fn every_widget_explains_itself() {
    let mut fixture = Fixture::of(ALL_KINDS);
    fixture.click("Text");
    fixture.click("Save");
    fixture.harness.state_mut().session().mode = Mode::Slice;
    let mut unexplained = BTreeSet::new();
    for what in ["Picture", "Animation", "Shader", "render", "Window"] {
        fixture.click(what);
        unexplained.extend(fixture.unexplained());
    }
    for menu in ["scene.sdf", "Examples"] {
        fixture.click(menu);
        unexplained.extend(fixture.unexplained());
    }
    fixture.harness.key_press(Key::Escape);
    for list in ["What is shown. V for the next.", "How rays are marched."] {
        fixture.harness.get_by_role_and_label(Role::ComboBox, list).click();
        fixture.harness.run_steps(3);
        assert!(fixture.has(if list.starts_with("What") { "Overshoot" } else { "auto-relaxed" }));
        unexplained.extend(fixture.unexplained());
    }
    assert_eq!(unexplained, BTreeSet::new());
}

#[test]
fn escape_closes_what_is_open_before_it_stops_refining() {
    let mut fixture = Fixture::new();
    let refines = |fixture: &mut Fixture| fixture.harness.state_mut().session().refine;
    let escape = |fixture: &mut Fixture| {
        fixture.harness.key_press(Key::Escape);
        fixture.harness.run_steps(3);
    };
    fixture.click("scene.sdf");
    assert!(fixture.has("Examples"));
    escape(&mut fixture);
    assert!(!fixture.has("Examples") && refines(&mut fixture));
    fixture.move_a_number();
    fixture.request_close();
    escape(&mut fixture);
    assert!(!fixture.has("A moved number is not in the file") && refines(&mut fixture));
    fixture.click("Save");
    escape(&mut fixture);
    assert!(refines(&mut fixture));
    escape(&mut fixture);
    assert!(!refines(&mut fixture));
}

#[test]
fn another_monitor_is_told() {
    let mut fixture = Fixture::new();
    for (width, scale) in [(1920.0, 1.0), (3840.0, 2.0)] {
        let viewports = &mut fixture.harness.input_mut().viewports;
        let viewport = viewports.entry(ViewportId::ROOT).or_default();
        viewport.monitor_size = Some([width / scale, 1080.0].into());
        viewport.native_pixels_per_point = Some(scale);
        fixture.harness.run_steps(2);
    }
    assert!(fixture.has("the window is on a monitor of 3840 × 2160 pixels, 2 to a point"));
}

/// A file that is let go over the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn a_dropped_scene_is_shown_and_the_one_before_is_in_the_menu() {
    let mut fixture = Fixture::new();
    let other = fixture.folder.path().join("other.sdf");
    std::fs::write(&other, SCENE.replace("param wall", "param rind").replace("- wall", "- rind"))
        .unwrap();
    fixture.harness.input_mut().dropped_files.push(Arc::new(Dropped(other)));
    fixture.until(|harness| harness.query_all_by_label("rind").next().is_some());
    fixture.click("other.sdf");
    fixture.click("Open before");
    fixture.click("scene.sdf");
    fixture.until(|harness| harness.query_all_by_label("wall").next().is_some());
}

#[test]
fn a_scene_is_opened_as_it_was_left() {
    let mut fixture = Fixture::new();
    fixture.click("Top");
    let session = fixture.harness.state_mut().session();
    session.knobs.params.insert("wall".to_owned(), [0.4, 0.0, 0.0, 0.0]);
    let left = session.moved_camera().unwrap();
    let context = fixture.harness.ctx.clone();
    fixture.harness.state_mut().remember(&context);
    let folder = fixture.folder.path();
    let place = Some(folder.join("view.json"));
    let mut again =
        App::new(&Context::default(), &folder.join("scene.sdf"), place.clone()).unwrap();
    let session = again.session();
    session.set_build(|build| build.on_cpu = true);
    let start = Instant::now();
    while session.model.is_none() {
        assert!(start.elapsed() < PATIENCE);
        std::thread::sleep(Duration::from_millis(5));
        session.poll();
        session.ask([30, 20], false);
    }
    session.ask([30, 20], false);
    let camera = session.moved_camera().unwrap();
    let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9;
    assert!(camera.eye.iter().zip(&left.eye).all(near), "{camera:?}, not {left:?}");
    assert_eq!(session.knobs.params["wall"][0], 0.4);
    // Another scene knows nothing of it.
    let other = folder.join("other.sdf");
    std::fs::write(&other, SCENE).unwrap();
    let mut other = App::new(&Context::default(), &other, place).unwrap();
    assert_eq!(other.session().moved_camera(), None);
}

#[test]
fn a_scene_from_stdin_and_two_files_are_refused() {
    for arguments in [&["-"][..], &["a.sdf", "b.sdf"], &["missing.sdf"]] {
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_sdfc-view"));
        let output = program.args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    }
}
