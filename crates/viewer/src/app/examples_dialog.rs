//! The example scenes with their pictures.

use std::path::{Path, PathBuf};
use std::time::Duration;

use eframe::egui::{self, Align2, Context, FontId, Rect, Sense, StrokeKind, Ui, vec2};

use super::picture_textures::PictureTextures;
use super::theme;
use crate::examples::{EXAMPLES, ExampleId};
use crate::settings::examples_folder;
use crate::small_pictures::{SIZE, SmallPictures};

/// The height of an example's name in points.
const NAME_HEIGHT: f32 = 22.0;
/// How often the dialog looks for the next picture.
const POLL: Duration = Duration::from_millis(30);

/// The dialog. Its pictures are drawn when it is first shown.
#[derive(Debug, Default)]
pub struct ExamplesDialog {
    is_open: bool,
    pictures: Option<SmallPictures<ExampleId>>,
    textures: PictureTextures<ExampleId>,
}

impl ExamplesDialog {
    /// Opens the dialog.
    pub fn open(&mut self) {
        self.is_open = true;
    }

    /// Forgets what was lost with a window.
    pub fn move_to_window(&mut self) {
        self.textures = PictureTextures::default();
    }

    /// Shows the dialog. Returns the example that was chosen, copied to a file of the user, or why
    /// it could not be copied.
    pub fn show(&mut self, ctx: &Context) -> Option<Result<PathBuf, String>> {
        if !self.is_open {
            return None;
        }
        let modal = egui::Modal::new(egui::Id::unique("examples"));
        let modal = modal.show(ctx, |ui| self.contents(ui));
        self.is_open = modal.inner.is_none() && !modal.should_close();
        modal.inner
    }

    fn contents(&mut self, ui: &mut Ui) -> Option<Result<PathBuf, String>> {
        let Some(folder) = examples_folder() else {
            ui.label("There is no home folder to copy the examples to.");
            return None;
        };
        let window = ui.ctx().content_rect().size();
        let [width, height] = SIZE.map(|side| side as f32);
        let gap = ui.spacing().item_spacing;
        let columns = ((window.x - 80.0) / (width + gap.x)).floor().clamp(1.0, 5.0);
        ui.set_width(columns * (width + gap.x) + ui.spacing().scroll.bar_width);
        ui.horizontal(|ui| {
            ui.label(egui::RichText::new("Examples").strong());
            let text = format!("A click opens a copy in {}.", folder.display());
            ui.label(egui::RichText::new(text).small().color(theme::of(ui).weak));
        });
        let rows = EXAMPLES.len().div_ceil(columns as usize);
        let row_height = height + NAME_HEIGHT;
        let height = (window.y - 140.0).max(row_height);
        let scroll = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        let scroll = scroll.show_rows(ui, row_height, rows, |ui, visible| {
            let mut chosen = None;
            for row in visible {
                ui.horizontal(|ui| {
                    let first = row * columns as usize;
                    for id in ExampleId::all().skip(first).take(columns as usize) {
                        chosen = self.card(ui, id, &folder).or(chosen.take());
                    }
                });
            }
            chosen
        });
        scroll.inner
    }

    /// Shows an example. Returns its file if it was clicked.
    fn card(
        &mut self,
        ui: &mut Ui,
        id: ExampleId,
        folder: &Path,
    ) -> Option<Result<PathBuf, String>> {
        let example = id.example();
        let picture_size = vec2(SIZE[0] as f32, SIZE[1] as f32);
        let size = picture_size + vec2(0.0, NAME_HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let info = || egui::WidgetInfo::labeled(egui::Role::Button, true, example.name);
        response.widget_info(info);
        let picture = Rect::from_min_size(rect.min, picture_size);
        ui.painter().rect_filled(picture, 4.0, theme::of(ui).ground);
        match self.texture(ui.ctx(), id) {
            Some(texture) => {
                egui::Image::new(texture).corner_radius(4).paint_at(ui, picture);
            }
            None => ui.ctx().request_repaint_after(POLL),
        }
        let [color, line] = match response.hovered() || response.has_focus() {
            true => [theme::of(ui).strong, theme::of(ui).accent],
            false => [theme::of(ui).text, theme::of(ui).line],
        };
        ui.painter().rect_stroke(picture, 4.0, (1.0, line), StrokeKind::Inside);
        let at = picture.center_bottom() + vec2(0.0, 3.0);
        let font = FontId::proportional(12.5);
        ui.painter().text(at, Align2::CENTER_TOP, example.name, font, color);
        response.on_hover_text(example.summary()).clicked().then(|| example.file_in(folder))
    }

    fn texture(&mut self, ctx: &Context, id: ExampleId) -> Option<&egui::TextureHandle> {
        if self.pictures.is_none() {
            // A card without its picture polls, also in a window that replaces this one.
            self.pictures = SmallPictures::new(|| {}).ok();
        }
        let pictures = self.pictures.as_mut()?;
        pictures.poll();
        self.textures.get(ctx, pictures, &id)
    }
}
