//! The monitor that the window is on.

use eframe::egui::{Context, Vec2};

/// The monitor that the window is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monitor {
    /// Width and height in pixels.
    size: Vec2,
    /// Pixels per point.
    scale: f32,
}

impl Monitor {
    /// `None` if the system does not say.
    pub fn of(ctx: &Context) -> Option<Self> {
        let points = ctx.pixels_per_point();
        ctx.input(|input| {
            let viewport = input.viewport();
            let size = (viewport.monitor_size? * points).round();
            Some(Self { size, scale: viewport.native_pixels_per_point? })
        })
    }
}

impl std::fmt::Display for Monitor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { size, scale } = self;
        write!(f, "a monitor of {} × {} pixels, scale {scale}", size.x, size.y)
    }
}
