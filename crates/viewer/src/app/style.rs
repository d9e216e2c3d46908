//! Colours and spacing: dark and calm, so that the picture is what one sees.

use eframe::egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, Theme, Visuals,
    vec2,
};

/// Behind everything.
pub const GROUND: Color32 = Color32::from_rgb(18, 20, 24);
/// Panels.
pub const PANEL: Color32 = Color32::from_rgb(24, 27, 32);
/// Widgets.
pub const WIDGET: Color32 = Color32::from_rgb(38, 43, 51);
/// Lines between panels.
pub const LINE: Color32 = Color32::from_rgb(44, 49, 58);
/// Text.
pub const TEXT: Color32 = Color32::from_rgb(206, 212, 220);
/// Text of less weight.
pub const WEAK: Color32 = Color32::from_rgb(134, 143, 156);
/// What is chosen or moved.
pub const ACCENT: Color32 = Color32::from_rgb(232, 150, 76);
/// Errors.
pub const ERROR: Color32 = Color32::from_rgb(240, 98, 92);
/// Warnings.
pub const WARNING: Color32 = Color32::from_rgb(233, 185, 73);

/// Sets the look of all windows.
pub fn apply(ctx: &Context) {
    ctx.set_theme(Theme::Dark);
    ctx.set_visuals_of(Theme::Dark, visuals());
    ctx.all_styles_mut(|style| {
        let sans = |size| FontId::new(size, FontFamily::Proportional);
        style.text_styles = [
            (TextStyle::Small, sans(11.5)),
            (TextStyle::Body, sans(13.0)),
            (TextStyle::Button, sans(13.0)),
            (TextStyle::Heading, sans(15.0)),
            (TextStyle::Monospace, FontId::new(12.5, FontFamily::Monospace)),
        ]
        .into();
        style.spacing.item_spacing = vec2(8.0, 6.0);
        style.spacing.button_padding = vec2(8.0, 3.0);
        style.spacing.slider_width = 120.0;
        style.spacing.menu_margin = Margin::same(8);
        style.interaction.selectable_labels = false;
        style.interaction.tooltip_delay = 0.4;
    });
}

fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = PANEL;
    visuals.window_fill = PANEL;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.extreme_bg_color = GROUND;
    visuals.faint_bg_color = Color32::from_rgb(28, 32, 38);
    visuals.selection.bg_fill = Color32::from_rgb(110, 72, 38);
    visuals.selection.stroke = Stroke::new(1.0, ACCENT);
    visuals.hyperlink_color = Color32::from_rgb(122, 176, 232);
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    let round = CornerRadius::same(4);
    let states = [
        (&mut widgets.noninteractive, PANEL, TEXT, LINE),
        (&mut widgets.inactive, WIDGET, TEXT, Color32::TRANSPARENT),
        (&mut widgets.hovered, Color32::from_rgb(50, 57, 67), Color32::WHITE, LINE),
        (&mut widgets.active, Color32::from_rgb(60, 68, 80), Color32::WHITE, ACCENT),
        (&mut widgets.open, WIDGET, TEXT, LINE),
    ];
    for (state, fill, text, line) in states {
        (state.bg_fill, state.weak_bg_fill, state.corner_radius) = (fill, fill, round);
        state.fg_stroke = Stroke::new(1.0, text);
        state.bg_stroke = Stroke::new(1.0, line);
        state.expansion = 0.0;
    }
    visuals
}
