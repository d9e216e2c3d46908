//! The contents of the window: all panels and the picture.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui::{self, Context, Ui};
use eframe::egui_wgpu::RenderState;

use super::action::Action;
use super::canvas::Canvas;
use super::code::panel::{self as code_panel, CodeMode};
use super::code::text_state::{editor_id, record_replaced};
use super::code::{self, CodeEditor};
use super::diagnostics_overlay::DiagnosticsOverlay;
use super::examples_dialog::ExamplesDialog;
use super::export_dialog::ExportDialog;
use super::monitor::Monitor;
use super::open_panels::OpenPanels;
use super::path_dialog::{Chosen, NEW_SCENE, PathDialog};
use super::unsaved_dialog::{Exit, UnsavedDialog};
use super::{
    controls, help, hints, missing_file, path_dialog, scene_menu, shortcuts, status_bar, theme,
    toolbar,
};
use crate::render::window_device::WindowDevice;
use crate::session::Session;
use crate::settings::Settings;
use crate::unsaved_texts::{UnsavedScene, UnsavedTexts};

/// The time that a message stays in the status line.
const MESSAGE_TIME: Duration = Duration::from_secs(4);

/// The panels leave this width in points for the picture, unless the window is narrower.
const MIN_PICTURE: f32 = 240.0;

/// The application, which can move from one window to another.
pub struct App {
    session: Session,
    /// The egui context of the current window, which workers wake.
    context: Arc<Mutex<Context>>,
    monitor: Option<Monitor>,
    canvas: Canvas,
    clipboard: Option<arboard::Clipboard>,
    message: Option<(String, Instant)>,
    panels: OpenPanels,
    /// Where the panel "Code" was shown in the last frame.
    code_rect: Option<egui::Rect>,
    diagnostics_overlay: DiagnosticsOverlay,
    code_mode: CodeMode,
    code_editor: CodeEditor,
    export: ExportDialog,
    unsaved: UnsavedDialog,
    path_dialog: PathDialog,
    examples: ExamplesDialog,
    /// True once the user has confirmed that the window closes.
    may_close: bool,
    /// True if the stored texts of the scene are those that this window restored or stored.
    owns_stored_texts: bool,
    settings: Settings,
    settings_path: Option<PathBuf>,
    last_frame: Instant,
}

impl App {
    /// Opens a scene with the settings stored at `settings_path`.
    ///
    /// # Errors
    ///
    /// Those of [`Session::open`].
    pub fn new(
        ctx: &Context,
        path: &Path,
        settings_path: Option<PathBuf>,
    ) -> std::io::Result<Self> {
        let settings = settings_path.as_deref().map(Settings::read).unwrap_or_default();
        apply_theme(ctx, &settings);
        let context = Arc::new(Mutex::new(ctx.clone()));
        let shared = Arc::clone(&context);
        let wake = move || current_context(&shared).request_repaint();
        let mut session = Session::open(path, Arc::new(wake))?;
        session.format_on_save = settings.format_on_save;
        session.middle_turns = settings.middle_turns;
        let owns_stored_texts = restore(&settings, settings_path.as_deref(), &mut session);
        Ok(Self {
            session,
            context,
            monitor: None,
            canvas: Canvas::default(),
            clipboard: None,
            message: None,
            panels: OpenPanels::default(),
            code_rect: None,
            diagnostics_overlay: DiagnosticsOverlay::default(),
            code_mode: CodeMode::default(),
            code_editor: CodeEditor::default(),
            export: ExportDialog::default(),
            unsaved: UnsavedDialog::default(),
            path_dialog: PathDialog::default(),
            examples: ExamplesDialog::default(),
            may_close: false,
            owns_stored_texts,
            settings,
            settings_path,
            last_frame: Instant::now(),
        })
    }

    /// Moves to a new window because the device of the last one was lost.
    pub(super) fn move_to_window(&mut self, ctx: &Context) {
        apply_theme(ctx, &self.settings);
        // Textures were lost with the device.
        self.canvas = Canvas::default();
        self.session.set_window_device(None);
        self.code_editor.move_to_window();
        self.examples.move_to_window();
        let mut context = self.context.lock().unwrap_or_else(PoisonError::into_inner);
        code::move_editors(&context, ctx, self.session.path(), &self.session.tabs());
        *context = ctx.clone();
        drop(context);
        let text = "the GPU that showed the window was lost: this is a new window";
        self.session.messages.push(text.to_owned());
    }

    /// Shows pictures of a moving camera without a copy on the CPU, if the window's device can draw
    /// them.
    pub(super) fn draw_on_window(&mut self, state: &RenderState, device: WindowDevice) {
        self.canvas.show_device_pictures(state.clone());
        self.session.set_window_device(Some(device));
    }

    /// Stores the settings when the window closes, and the unsaved texts unless the user chose to
    /// lose them.
    pub fn close(&mut self) {
        let ctx = current_context(&self.context);
        self.store_settings(&ctx);
        let texts = match self.may_close {
            true => UnsavedScene::default(),
            false => self.session.unsaved_texts(),
        };
        self.store_texts(texts);
    }

    /// Stores the settings, and the texts that are not saved, because the program cannot go on.
    /// The next window with this scene has them.
    pub fn rescue(&mut self) {
        let ctx = current_context(&self.context);
        self.store_settings(&ctx);
        self.store_texts(self.session.unsaved_texts());
    }

    /// Stores texts of the open scene. If there are none, the stored ones are forgotten, unless
    /// they are those of another window.
    fn store_texts(&mut self, unsaved: UnsavedScene) {
        let has_texts = !unsaved.is_empty();
        if let Some(path) = &self.settings_path
            && (has_texts || self.owns_stored_texts)
        {
            UnsavedTexts::beside(path).store(self.session.path(), unsaved);
            self.owns_stored_texts = has_texts;
        }
    }

    /// The open scene, to look at.
    pub fn opened(&self) -> &Session {
        &self.session
    }

    /// The open scene.
    pub fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    /// Where the window shows the picture.
    pub fn picture_rect(&self) -> egui::Rect {
        self.canvas.rect()
    }

    /// Returns true if no finer picture follows.
    pub fn picture_is_finished(&self) -> bool {
        self.session.known_picture().is_some_and(|picture| picture.finished)
    }

    /// Draws one frame of the window.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.session.poll();
        self.open_dropped_file(&ctx);
        self.report_new_monitor(&ctx);
        let mut actions: Vec<Action> =
            self.session.messages.drain(..).map(Action::Message).collect();
        self.advance_clock(&ctx);
        shortcuts::handle(&ctx, &mut self.session, &mut self.panels, &mut actions);
        let bar = egui::Panel::top("bar").frame(bar_frame(ui));
        let (session, panels, settings) = (&mut self.session, &mut self.panels, &mut self.settings);
        let chosen = bar.show(ui, |ui| toolbar::show(ui, session, panels, settings)).inner;
        match chosen {
            Some(scene_menu::Choice::Open(path)) => self.leave(&ctx, Exit::Open(path)),
            Some(scene_menu::Choice::Ask(purpose)) => self.path_dialog.open(purpose, &self.session),
            Some(scene_menu::Choice::ShowExamples) => self.examples.open(),
            Some(scene_menu::Choice::Failed(why)) => actions.push(Action::Message(why)),
            None => {}
        }
        let message = self.message.as_ref().map(|(text, _)| text.as_str());
        let line = egui::Panel::bottom("status").frame(bar_frame(ui));
        let pointer = ctx.input(|input| input.pointer.hover_pos());
        let hint = hints::hint(&self.session, pointer, self.picture_rect(), self.code_rect.take());
        line.show(ui, |ui| status_bar::show(ui, &mut self.session, message, hint));
        self.session.handles.hovered = None;
        self.panels.keep_room_for_picture(ui.available_width());
        let most = (ui.available_width() - MIN_PICTURE).max(220.0);
        if self.panels.controls {
            let panel =
                egui::Panel::right("controls").default_size(290.0).min_size(220.0).max_size(most);
            panel.show(ui, |ui| controls::show(ui, &mut self.session, &mut actions));
        }
        if self.panels.code {
            let most = (ui.available_width() - MIN_PICTURE).max(220.0);
            let size = (ui.available_width() * 0.48).clamp(270.0, 520.0);
            let panel = egui::Panel::left("code").default_size(size).min_size(220.0).max_size(most);
            let session = &mut self.session;
            let state = (&mut self.code_mode, &mut self.code_editor);
            let shown = panel.show(ui, |ui| code_panel::show(ui, session, state, &mut actions));
            self.code_rect = Some(shown.response.rect);
        }
        let lit = self.code_editor.lit_position(&self.session).filter(|_| self.panels.code);
        self.session.select_handles(lit.as_ref());
        self.session.light_shapes(lit);
        let center = egui::CentralPanel::no_frame();
        center.show(ui, |ui| {
            if let Some(clicked) = self.canvas.show(ui, &mut self.session) {
                let code = self.session.code_at(clicked);
                self.code_editor.light(code, &mut self.session);
            }
            let overlay = &mut self.diagnostics_overlay;
            overlay.show(ui, &self.session, &mut self.panels, &mut actions);
        });
        show_drop_hint(&ctx);
        help::show(&ctx, &mut self.panels.help);
        self.export.show(&ctx, &self.session, &mut self.panels.export);
        if let Some(path) = missing_file::show(&ctx, &self.session) {
            self.create(&ctx, &path);
        }
        match self.examples.show(&ctx) {
            Some(Ok(path)) => self.leave(&ctx, Exit::Open(path)),
            Some(Err(why)) => actions.push(Action::Message(why)),
            None => {}
        }
        if let Some(exit) = self.path_dialog.show(&ctx, &self.session) {
            self.leave_for(&ctx, exit);
        }
        self.ask_before_closing(&ctx);
        if let Some(exit) = self.unsaved.show(&ctx, &mut self.session) {
            self.perform_exit(&ctx, exit);
        }
        actions.into_iter().for_each(|action| self.perform(&ctx, action));
        if let Some((_, since)) = &self.message {
            if since.elapsed() < MESSAGE_TIME {
                ctx.request_repaint_after(MESSAGE_TIME);
            } else {
                self.message = None;
            }
        }
    }

    /// Reports a move to another monitor, where the picture has another number of pixels.
    fn report_new_monitor(&mut self, ctx: &Context) {
        let now = Monitor::of(ctx);
        if let (Some(before), Some(now)) = (self.monitor, now)
            && before != now
        {
            self.session.messages.push(format!("the window is now on {now}"));
        }
        self.monitor = now.or(self.monitor);
    }

    fn advance_clock(&mut self, ctx: &Context) {
        let seconds = self.last_frame.elapsed().as_secs_f64();
        self.last_frame = Instant::now();
        if self.session.is_animated() && self.session.clock.playing {
            self.session.clock.advance(seconds);
            ctx.request_repaint();
        }
    }

    fn open_dropped_file(&mut self, ctx: &Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        if let Some(path) = dropped.first().map(|file| file.path()) {
            self.leave(ctx, Exit::Open(path.to_owned()));
        }
    }

    /// Leaves the scene, or asks first if texts or numbers would be lost.
    fn leave(&mut self, ctx: &Context, exit: Exit) {
        if let Some(exit) = self.unsaved.request(exit, &self.session) {
            self.perform_exit(ctx, exit);
        }
    }

    /// Opens a file that was chosen in the dialog for paths.
    fn leave_for(&mut self, ctx: &Context, chosen: Chosen) {
        match chosen {
            Chosen::Open(path) => self.leave(ctx, Exit::Open(path)),
            // The text of the scene and its numbers are in the new file.
            Chosen::SavedAs(path) if !self.session.has_edited_imports() => self.open(ctx, path),
            Chosen::SavedAs(path) => self.leave(ctx, Exit::Open(path)),
        }
    }

    /// Creates the missing file of the scene, which the file watcher then notices.
    fn create(&mut self, ctx: &Context, path: &Path) {
        match path_dialog::create(path, NEW_SCENE) {
            Ok(()) => self.open(ctx, path.to_owned()),
            Err(why) => self.message = Some((why, Instant::now())),
        }
    }

    fn ask_before_closing(&mut self, ctx: &Context) {
        let closing = ctx.input(|input| input.viewport().close_requested());
        if closing && !self.may_close && self.unsaved.request(Exit::Close, &self.session).is_none()
        {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
    }

    fn perform_exit(&mut self, ctx: &Context, exit: Exit) {
        match exit {
            Exit::Close => {
                self.may_close = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            Exit::Open(path) => self.open(ctx, path),
        }
    }

    /// Stores the settings of the open scene and opens another.
    fn open(&mut self, ctx: &Context, path: PathBuf) {
        self.store_settings(ctx);
        self.store_texts(UnsavedScene::default());
        ctx.send_viewport_cmd(egui::ViewportCommand::Title(title(&path)));
        self.session.open_other(path);
        self.code_editor = CodeEditor::default();
        let settings_path = self.settings_path.as_deref();
        self.owns_stored_texts = restore(&self.settings, settings_path, &mut self.session);
    }

    /// Stores the settings, together with what other windows have stored meanwhile.
    pub fn store_settings(&mut self, ctx: &Context) {
        let Some(path) = self.settings_path.clone() else { return };
        let session = &self.session;
        let (light, format_on_save) = (self.settings.light, session.format_on_save);
        let middle_turns = session.middle_turns;
        let mut settings =
            Settings { light, format_on_save, middle_turns, ..Settings::read(&path) };
        let params = session.param_values.params.clone();
        settings.record(session.path(), session.manual_camera(), params);
        let size = ctx.input(|input| input.viewport().inner_rect.map(|rect| rect.size().into()));
        settings.window = size.or(settings.window);
        settings.write(&path);
        self.settings = settings;
    }

    fn perform(&mut self, ctx: &Context, action: Action) {
        let text = match action {
            Action::Message(text) => text,
            Action::Fix(file, fix) => match self.session.apply_fix(&file, &fix) {
                Some([before, after]) => {
                    let id = editor_id(self.session.path(), self.session.shown_file());
                    record_replaced(ctx, id, [&before, &after]);
                    return;
                }
                None => "the text has changed since".to_owned(),
            },
            Action::Copy(text) => match self.copy(&text) {
                Ok(()) => format!("copied: {text}"),
                Err(error) => format!("cannot copy: {error}"),
            },
        };
        self.message = Some((text, Instant::now()));
    }

    fn copy(&mut self, text: &str) -> Result<(), arboard::Error> {
        // The clipboard is kept: on X11 its text is gone when the program that offers it drops it.
        let clipboard = match &mut self.clipboard {
            Some(clipboard) => clipboard,
            none => none.insert(arboard::Clipboard::new()?),
        };
        clipboard.set_text(text)
    }
}

/// The title of a window that shows a scene.
pub fn title(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!("{name} · sdfc")
}

fn apply_theme(ctx: &Context, settings: &Settings) {
    theme::apply(ctx);
    theme::set_light(ctx, settings.light);
}

fn current_context(shared: &Mutex<Context>) -> Context {
    // The context is replaced whole, so a poisoned lock holds a valid one.
    shared.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Restores the stored camera, params and texts of a scene. Returns true if there are texts.
fn restore(settings: &Settings, settings_path: Option<&Path>, session: &mut Session) -> bool {
    let texts = settings_path.map(UnsavedTexts::beside);
    let unsaved = texts.and_then(|texts| texts.of(session.path()));
    unsaved.iter().for_each(|unsaved| session.restore_texts(unsaved));
    if let Some(scene) = settings.scene(session.path()) {
        session.restore(scene.camera.as_ref(), &scene.params);
    }
    unsaved.is_some()
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App").field("session", &self.session).finish_non_exhaustive()
    }
}

/// Says what happens to a file that is held over the window.
fn show_drop_hint(ctx: &Context) {
    if ctx.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop"));
    let (painter, screen) = (ctx.layer_painter(layer), ctx.content_rect());
    painter.rect_filled(screen, 0.0, egui::Color32::from_black_alpha(160));
    let font = egui::FontId::proportional(18.0);
    let text = "Drop the file to open the scene";
    painter.text(screen.center(), egui::Align2::CENTER_CENTER, text, font, egui::Color32::WHITE);
}

fn bar_frame(ui: &Ui) -> egui::Frame {
    egui::Frame::new().fill(theme::of(ui).panel).inner_margin(egui::Margin::symmetric(10, 5))
}
