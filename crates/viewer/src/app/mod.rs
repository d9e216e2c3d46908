//! The window: shows a [`Session`] and hands input to it.

mod accuracy;
mod canvas;
mod editor;
mod guides;
mod help;
mod leave;
mod menu;
mod overlay;
mod panels;
mod params;
mod save;
mod shell;
mod source;
mod status;
mod style;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui::{self, Context, Key, Ui};

use crate::memory::Memory;
use crate::session::Session;
use canvas::Canvas;
use leave::Leaving;
use save::Save;
use shell::Monitor;
pub use shell::{LOSE_WINDOW, NoWindow, run};

/// So long a remark stays in the status line.
const REMARK: Duration = Duration::from_secs(4);

/// What is shown and chosen, whichever window it is in.
pub struct App {
    session: Session,
    /// The window that is woken when there is something to show.
    context: Arc<Mutex<Context>>,
    monitor: Option<Monitor>,
    canvas: Canvas,
    clipboard: Option<arboard::Clipboard>,
    remark: Option<(String, Instant)>,
    shows: Shows,
    save: Save,
    leaving: Leaving,
    memory: Memory,
    /// Where that is kept.
    place: Option<PathBuf>,
    last_frame: Instant,
}

/// What is open.
#[derive(Clone, Copy, Debug)]
struct Shows {
    knobs: bool,
    source: bool,
    save: bool,
    help: bool,
    warnings: bool,
}

/// What a panel wants done that is not its own business.
enum Wish {
    /// Into the clipboard.
    Copy(String),
    /// Into the status line.
    Remark(String),
}

impl App {
    /// With a scene open, as it was left if the file at `place` remembers it.
    ///
    /// # Errors
    ///
    /// As [`Session::open`].
    pub fn new(ctx: &Context, path: &Path, place: Option<PathBuf>) -> std::io::Result<Self> {
        let memory = place.as_deref().map(Memory::read).unwrap_or_default();
        dress(ctx, &memory);
        let context = Arc::new(Mutex::new(ctx.clone()));
        let woken = Arc::clone(&context);
        let wake = move || context_of(&woken).request_repaint();
        let mut session = Session::open(path, Arc::new(wake))?;
        recall(&memory, &mut session);
        Ok(Self {
            session,
            context,
            monitor: None,
            canvas: Canvas::default(),
            clipboard: None,
            remark: None,
            shows: Shows { knobs: true, source: false, save: false, help: false, warnings: false },
            save: Save::default(),
            leaving: Leaving::default(),
            memory,
            place,
            last_frame: Instant::now(),
        })
    }

    /// Goes on in another window, since the device of the one before was lost.
    fn enter(&mut self, ctx: &Context) {
        dress(ctx, &self.memory);
        // What had been handed to the device is gone with it.
        self.canvas = Canvas::default();
        *self.context.lock().unwrap_or_else(PoisonError::into_inner) = ctx.clone();
        self.session
            .remarks
            .push("the window's device was lost: this is another window".to_owned());
    }

    /// Remembers what there is to remember.
    fn leave(&mut self) {
        let ctx = context_of(&self.context);
        self.remember(&ctx);
    }

    /// The scene.
    pub fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    /// Whether the picture is as fine as it will be.
    pub fn picture_is_finished(&self) -> bool {
        self.session.picture.as_ref().is_some_and(|picture| picture.finished)
    }

    /// Draws the whole window once.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.session.poll();
        self.take_dropped(&ctx);
        self.note_monitor(&ctx);
        let mut wishes: Vec<Wish> = self.session.remarks.drain(..).map(Wish::Remark).collect();
        self.pass_time(&ctx);
        self.keys(&ctx, &mut wishes);
        let bar = egui::Panel::top("bar").frame(bar_frame(ui));
        let (session, shows, memory) = (&mut self.session, &mut self.shows, &mut self.memory);
        let chosen = bar.show(ui, |ui| panels::bar(ui, session, shows, memory)).inner;
        match chosen {
            Some(menu::Choice::Open(path)) => self.open(&ctx, path),
            Some(menu::Choice::Failed(why)) => wishes.push(Wish::Remark(why)),
            None => {}
        }
        let remark = self.remark.as_ref().map(|(text, _)| text.as_str());
        let line = egui::Panel::bottom("status").frame(bar_frame(ui));
        line.show(ui, |ui| status::show(ui, &mut self.session, remark));
        if self.shows.knobs {
            let panel = egui::Panel::right("knobs").default_size(290.0).min_size(220.0);
            panel.show(ui, |ui| panels::knobs(ui, &mut self.session, &mut wishes));
        }
        if self.shows.source {
            let size = (ui.available_width() * 0.42).clamp(270.0, 400.0);
            let panel = egui::Panel::left("source").default_size(size).min_size(220.0);
            panel.show(ui, |ui| source::show(ui, &mut self.session, &mut wishes));
        }
        let center = egui::CentralPanel::no_frame();
        center.show(ui, |ui| {
            self.canvas.show(ui, &mut self.session);
            overlay::show(ui, &self.session, &mut self.shows.warnings, &mut wishes);
        });
        drop_hint(&ctx);
        help::show(&ctx, &mut self.shows.help);
        self.save.open = self.shows.save;
        self.save.show(&ctx, &self.session);
        self.shows.save = self.save.open;
        self.leaving.show(&ctx, &self.session);
        wishes.into_iter().for_each(|wish| self.grant(wish));
        if let Some((_, since)) = &self.remark {
            if since.elapsed() < REMARK {
                ctx.request_repaint_after(REMARK);
            } else {
                self.remark = None;
            }
        }
    }

    /// Says so where the window has come to another monitor: its picture has another number of pixels there.
    fn note_monitor(&mut self, ctx: &Context) {
        let now = Monitor::of(ctx);
        if let (Some(before), Some(now)) = (self.monitor, now)
            && before != now
        {
            self.session.remarks.push(format!("the window is on {now}"));
        }
        self.monitor = now.or(self.monitor);
    }

    fn pass_time(&mut self, ctx: &Context) {
        let seconds = self.last_frame.elapsed().as_secs_f64();
        self.last_frame = Instant::now();
        if self.session.moves() && self.session.clock.playing {
            self.session.clock.advance(seconds);
            ctx.request_repaint();
        }
    }

    fn take_dropped(&mut self, ctx: &Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        if let Some(path) = dropped.first().map(|file| file.path()) {
            self.open(ctx, path.to_owned());
        }
    }

    /// Shows another scene, and remembers this one.
    fn open(&mut self, ctx: &Context, path: PathBuf) {
        self.remember(ctx);
        ctx.send_viewport_cmd(egui::ViewportCommand::Title(shell::title(&path)));
        self.session.open_other(path);
        recall(&self.memory, &mut self.session);
    }

    /// Keeps what is to be there the next time. Another window may have kept something since this one was opened.
    pub fn remember(&mut self, ctx: &Context) {
        let Some(place) = self.place.clone() else { return };
        let mut memory = Memory { light: self.memory.light, ..Memory::read(&place) };
        let session = &self.session;
        memory.note(session.path(), session.moved_camera(), session.knobs.params.clone());
        let size = ctx.input(|input| input.viewport().inner_rect.map(|rect| rect.size().into()));
        memory.window = size.or(memory.window);
        memory.write(&place);
        self.memory = memory;
    }

    /// Keys that work wherever the pointer is, unless a text is being typed.
    fn keys(&mut self, ctx: &Context, wishes: &mut Vec<Wish>) {
        if ctx.text_edit_focused() {
            return;
        }
        let pressed = |key| ctx.input(|input| input.modifiers.is_none() && input.key_pressed(key));
        let session = &mut self.session;
        for (key, side) in help::SIDES {
            if pressed(key) {
                session.move_camera(|orbit| orbit.look_from(side));
            }
        }
        if pressed(Key::F) {
            session.frame_all();
        }
        if pressed(Key::Home) || pressed(Key::H) {
            session.go_home();
        }
        if pressed(Key::P) {
            session.move_camera(|orbit| orbit.set_parallel(!orbit.is_parallel()));
        }
        if pressed(Key::B) {
            session.guides = !session.guides;
        }
        if pressed(Key::C)
            && let Some(orbit) = session.orbit()
        {
            wishes.push(Wish::Copy(orbit.text()));
        }
        // It also presses the button that Tab has come to.
        if pressed(Key::Space) && !ctx.egui_wants_keyboard_input() && session.moves() {
            session.clock.toggle();
        }
        if pressed(Key::V) {
            session.mode = panels::next_mode(session.mode);
        }
        if ctx.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, Key::S)) {
            self.shows.save = !self.shows.save;
        }
        if ctx.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, Key::Q)) {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if pressed(Key::K) {
            self.shows.knobs = !self.shows.knobs;
        }
        if pressed(Key::T) {
            self.shows.source = !self.shows.source;
        }
        if ctx.input(|input| input.key_pressed(Key::Questionmark)) || pressed(Key::F1) {
            self.shows.help = !self.shows.help;
        }
        // What is open over the window is closed by it, and nothing else is meant.
        let over = egui::Popup::is_any_open(ctx)
            || ctx.memory(|memory| memory.top_modal_layer().is_some());
        if pressed(Key::Escape) && !over {
            if self.shows.help || self.shows.save {
                (self.shows.help, self.shows.save) = (false, false);
            } else {
                session.refine = !session.refine;
            }
        }
    }

    fn grant(&mut self, wish: Wish) {
        let text = match wish {
            Wish::Remark(text) => text,
            Wish::Copy(text) => match self.copy(&text) {
                Ok(()) => format!("copied: {text}"),
                Err(error) => format!("cannot copy: {error}"),
            },
        };
        self.remark = Some((text, Instant::now()));
    }

    fn copy(&mut self, text: &str) -> Result<(), arboard::Error> {
        // Kept, because on X11 the text is gone with the one who offers it.
        let clipboard = match &mut self.clipboard {
            Some(clipboard) => clipboard,
            none => none.insert(arboard::Clipboard::new()?),
        };
        clipboard.set_text(text)
    }
}

/// The look, in the theme that was chosen.
fn dress(ctx: &Context, memory: &Memory) {
    style::apply(ctx);
    style::set_light(ctx, memory.light);
}

fn context_of(shared: &Mutex<Context>) -> Context {
    // Replaced whole or not at all.
    shared.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Puts a scene as it was left.
fn recall(memory: &Memory, session: &mut Session) {
    if let Some(scene) = memory.scene(session.path()) {
        session.recall(scene.camera.as_ref(), &scene.params);
    }
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App").field("session", &self.session).finish_non_exhaustive()
    }
}

/// Says what becomes of a file that is held over the window.
fn drop_hint(ctx: &Context) {
    if ctx.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop"));
    let (painter, screen) = (ctx.layer_painter(layer), ctx.content_rect());
    painter.rect_filled(screen, 0.0, egui::Color32::from_black_alpha(160));
    let font = egui::FontId::proportional(18.0);
    let text = "Drop it to show that scene";
    painter.text(screen.center(), egui::Align2::CENTER_CENTER, text, font, egui::Color32::WHITE);
}

fn bar_frame(ui: &Ui) -> egui::Frame {
    egui::Frame::new().fill(style::of(ui).panel).inner_margin(egui::Margin::symmetric(10, 5))
}
