//! Colours and spacing of the dark and the light theme.

use eframe::egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Frame, Margin, Stroke, TextStyle, Theme,
    Ui, Visuals, vec2,
};

/// The colours of a theme.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// Background.
    pub ground: Color32,
    /// Panels.
    pub panel: Color32,
    /// Cards over the picture.
    pub card: Color32,
    /// Widgets: inactive, hovered, pressed.
    pub widgets: [Color32; 3],
    /// Lines between panels.
    pub line: Color32,
    /// Text.
    pub text: Color32,
    /// Text of hovered widgets.
    pub strong: Color32,
    /// Secondary text.
    pub weak: Color32,
    /// Selected or changed values.
    pub accent: Color32,
    /// Background of selected values.
    pub chosen: Color32,
    /// Background of the match of a search that was chosen last.
    pub found: Color32,
    /// Links.
    pub link: Color32,
    /// Functions, shapes and settings in the source.
    pub call: Color32,
    /// Errors.
    pub error: Color32,
    /// Warnings.
    pub warning: Color32,
}

const DARK: Palette = Palette {
    ground: Color32::from_rgb(18, 20, 24),
    panel: Color32::from_rgb(24, 27, 32),
    card: Color32::from_rgba_unmultiplied_const(18, 20, 24, 225),
    widgets: [
        Color32::from_rgb(38, 43, 51),
        Color32::from_rgb(50, 57, 67),
        Color32::from_rgb(60, 68, 80),
    ],
    line: Color32::from_rgb(44, 49, 58),
    text: Color32::from_rgb(206, 212, 220),
    strong: Color32::WHITE,
    weak: Color32::from_rgb(134, 143, 156),
    accent: Color32::from_rgb(232, 150, 76),
    chosen: Color32::from_rgb(110, 72, 38),
    found: Color32::from_rgb(128, 104, 20),
    link: Color32::from_rgb(122, 176, 232),
    call: Color32::from_rgb(140, 200, 160),
    error: Color32::from_rgb(240, 98, 92),
    warning: Color32::from_rgb(233, 185, 73),
};

const LIGHT: Palette = Palette {
    ground: Color32::from_rgb(226, 228, 232),
    panel: Color32::from_rgb(246, 247, 249),
    card: Color32::from_rgba_unmultiplied_const(250, 251, 252, 235),
    widgets: [
        Color32::from_rgb(226, 229, 234),
        Color32::from_rgb(213, 218, 225),
        Color32::from_rgb(198, 205, 214),
    ],
    line: Color32::from_rgb(208, 213, 220),
    text: Color32::from_rgb(40, 46, 54),
    strong: Color32::BLACK,
    weak: Color32::from_rgb(98, 107, 120),
    accent: Color32::from_rgb(176, 88, 10),
    chosen: Color32::from_rgb(255, 213, 170),
    found: Color32::from_rgb(255, 222, 80),
    link: Color32::from_rgb(22, 94, 170),
    call: Color32::from_rgb(24, 112, 66),
    error: Color32::from_rgb(194, 40, 36),
    warning: Color32::from_rgb(150, 98, 0),
};

/// The colours of the current theme.
pub fn of(ui: &Ui) -> &'static Palette {
    if ui.visuals().dark_mode { &DARK } else { &LIGHT }
}

/// A translucent card over the picture.
pub fn card(ui: &Ui) -> Frame {
    Frame::new()
        .fill(of(ui).card)
        .stroke(Stroke::new(1.0, of(ui).line))
        .corner_radius(6)
        .inner_margin(Margin::symmetric(10, 7))
}

/// Selects the theme.
pub fn set_light(ctx: &Context, light: bool) {
    ctx.set_theme(if light { Theme::Light } else { Theme::Dark });
}

/// Sets the styles of both themes.
pub fn apply(ctx: &Context) {
    ctx.set_visuals_of(Theme::Dark, visuals(Visuals::dark(), &DARK));
    ctx.set_visuals_of(Theme::Light, visuals(Visuals::light(), &LIGHT));
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
        // Scroll bars are beside the contents, not over them.
        style.spacing.scroll.floating_allocated_width = 8.0;
        style.spacing.menu_margin = Margin::same(8);
        style.interaction.selectable_labels = false;
        style.interaction.tooltip_delay = 0.4;
    });
}

fn visuals(mut visuals: Visuals, palette: &Palette) -> Visuals {
    let Palette { panel, text, line, strong, accent, .. } = *palette;
    let [inactive, hovered, pressed] = palette.widgets;
    visuals.panel_fill = panel;
    visuals.window_fill = panel;
    visuals.window_stroke = Stroke::new(1.0, line);
    visuals.extreme_bg_color = palette.ground;
    visuals.faint_bg_color = palette.card;
    visuals.selection.bg_fill = palette.chosen;
    visuals.selection.stroke = Stroke::new(1.0, accent);
    visuals.hyperlink_color = palette.link;
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    let round = CornerRadius::same(4);
    let states = [
        (&mut widgets.noninteractive, panel, text, line),
        (&mut widgets.inactive, inactive, text, Color32::TRANSPARENT),
        (&mut widgets.hovered, hovered, strong, line),
        (&mut widgets.active, pressed, strong, accent),
        (&mut widgets.open, inactive, text, line),
    ];
    for (state, fill, text, line) in states {
        (state.bg_fill, state.weak_bg_fill, state.corner_radius) = (fill, fill, round);
        state.fg_stroke = Stroke::new(1.0, text);
        state.bg_stroke = Stroke::new(1.0, line);
        state.expansion = 0.0;
    }
    visuals
}
