//! The panels without a window.

use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Context, Key, Modifiers, Rect, Shape, TextureId, ViewportCommand, ViewportEvent, ViewportId,
};
use egui_kittest::Harness;
use egui_kittest::kittest::{Queryable, by};
use sdfc_viewer::app::App;

/// Long enough for a busy machine; reached only if a test fails.
pub const TIMEOUT: Duration = Duration::from_secs(30);

/// The Ctrl key as a window reports it.
pub const CTRL: Modifiers = Modifiers { ctrl: true, ..Modifiers::COMMAND };

pub const SCENE: &str = "/// How thick the wall is.\nparam wall = 0.1 in 0.05..0.5\nsphere(1) - sphere(1 - wall)\n\
                     camera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)\n";

/// A text that the last frame drew.
pub struct DrawnText {
    pub text: String,
    pub rect: Rect,
    /// The part of it that is seen.
    pub seen: Rect,
}

pub struct Fixture {
    pub harness: Harness<'static, App>,
    pub folder: tempfile::TempDir,
}

impl Fixture {
    pub fn new() -> Self {
        Self::of(SCENE)
    }

    /// A scene whose text is shown, but which may have errors.
    pub fn with_text(text: &str) -> Self {
        let mut fixture = Self::new();
        fixture.write(text);
        fixture.until(|harness| **harness.state().opened().text() == *text);
        fixture.harness.run_steps(2);
        fixture
    }

    pub fn of(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.sdf");
        std::fs::write(&path, text).unwrap();
        let settings = Some(folder.path().join("view.json"));
        let mut app = App::new(&Context::default(), &path, settings).unwrap();
        app.session().update_build(|build| build.on_cpu = true);
        let mut fixture = Self::shown(app, folder);
        fixture.until(|harness| harness.state().picture_is_finished());
        fixture
    }

    pub fn shown(app: App, folder: tempfile::TempDir) -> Self {
        let show = |ui: &mut eframe::egui::Ui, app: &mut App| app.show(ui);
        let harness = Harness::builder().with_size([1000.0, 640.0]).build_ui_state(show, app);
        Self { harness, folder }
    }

    pub fn write(&self, text: &str) {
        std::fs::write(self.folder.path().join("scene.sdf"), text).unwrap();
    }

    #[track_caller]
    pub fn until(&mut self, holds: impl Fn(&Harness<'static, App>) -> bool) {
        let start = Instant::now();
        while !holds(&self.harness) {
            assert!(start.elapsed() < TIMEOUT, "{:?}", self.harness.state().opened().diagnostics);
            std::thread::sleep(Duration::from_millis(5));
            self.harness.step();
        }
    }

    pub fn click(&mut self, label: &str) {
        self.harness.get_by_label(label).click();
        self.harness.run_steps(3);
    }

    pub fn change_a_number(&mut self) {
        let session = self.harness.state_mut().session();
        let model = session.model.clone().unwrap();
        let at = SCENE.find("sphere(1)").unwrap() + 7;
        session.param_values.set_number(model.number_at(at).unwrap(), 1.25);
        self.harness.run_steps(2);
    }

    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.run_steps(3);
    }

    /// Types in the editor of the panel "Code".
    pub fn type_at_end(&mut self, text: &str) {
        self.harness.get_by_role(Role::MultilineTextInput).focus();
        self.harness.run_steps(2);
        self.harness.get_by_role(Role::MultilineTextInput).type_text(text);
        self.harness.run_steps(3);
    }

    /// Closes the window as a window manager does.
    pub fn request_close(&mut self) {
        let viewports = &mut self.harness.input_mut().viewports;
        viewports.entry(ViewportId::ROOT).or_default().events.push(ViewportEvent::Close);
        self.harness.run_steps(1);
        let viewports = &mut self.harness.input_mut().viewports;
        viewports.entry(ViewportId::ROOT).or_default().events.clear();
        self.harness.run_steps(2);
    }

    /// Draws some frames; true if the window closes in one of them.
    pub fn closes(&mut self) -> bool {
        let mut closes = false;
        for _ in 0..5 {
            self.harness.step();
            let viewports = &self.harness.output().viewport_output;
            closes |= viewports[&ViewportId::ROOT].commands.contains(&ViewportCommand::Close);
        }
        closes
    }

    /// Widgets that can be clicked, dragged or typed into and have no hover text.
    pub fn without_hover_text(&self) -> Vec<String> {
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
        let without = by().predicate(|node| {
            // The close button of egui's windows.
            let own = node.label().is_some_and(|label| label == "Close window");
            widgets.contains(&node.role()) && node.data().description().is_none() && !own
        });
        let named = |node: egui_kittest::Node<'_>| format!("{node:?}");
        self.harness.query_all(without).map(named).collect()
    }

    pub fn has(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }

    /// The texts that the last frame drew, if some of them is seen.
    pub fn drawn_texts(&self) -> Vec<DrawnText> {
        let mut texts = Vec::new();
        let mut add = |shape: &Shape, clip: Rect| {
            if let Shape::Text(text) = shape {
                let rect = text.visual_bounding_rect();
                let seen = rect.intersect(clip);
                if seen.is_positive() {
                    texts.push(DrawnText { text: text.galley.text().to_owned(), rect, seen });
                }
            }
        };
        self.for_each_shape(&mut add);
        texts
    }

    /// Returns true if the last frame drew a text, also one without a widget.
    pub fn draws_text(&self, text: &str) -> bool {
        self.drawn_texts().iter().any(|drawn| drawn.text == text)
    }

    /// Where the last frame drew the picture.
    pub fn drawn_picture(&self) -> Option<Rect> {
        let mut found = None;
        let mut find = |shape: &Shape, _: Rect| {
            if let Shape::Mesh(mesh) = shape
                && mesh.texture_id != TextureId::default()
            {
                found = Some(mesh.calc_bounds());
            }
        };
        self.for_each_shape(&mut find);
        found
    }

    /// Visits the shapes of the last frame, each with the rectangle that it is clipped to.
    fn for_each_shape(&self, visit: &mut dyn FnMut(&Shape, Rect)) {
        fn nested(shape: &Shape, clip: Rect, visit: &mut dyn FnMut(&Shape, Rect)) {
            if let Shape::Vec(shapes) = shape {
                shapes.iter().for_each(|shape| nested(shape, clip, visit));
            } else {
                visit(shape, clip);
            }
        }
        let shapes = &self.harness.output().shapes;
        shapes.iter().for_each(|it| nested(&it.shape, it.clip_rect, visit));
    }
}
