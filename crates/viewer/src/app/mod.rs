//! The window: shows a [`Session`](crate::session::Session) and passes input to it.

mod accuracy_chart;
mod accuracy_panel;
mod action;
mod bounds_overlay;
mod canvas;
mod code;
mod controls;
mod diagnostics_overlay;
mod examples_dialog;
mod export_dialog;
mod external_editor;
mod handle_overlay;
mod help;
mod hints;
mod legend_card;
mod missing_file;
mod monitor;
mod number_buttons;
mod number_widget;
mod open_panels;
mod param_sliders;
mod path_dialog;
mod picture_textures;
mod root;
mod scene_menu;
mod shape_outline;
mod shortcuts;
mod status_bar;
mod theme;
mod toolbar;
mod unsaved_dialog;
mod view_gizmo;
mod window;
mod window_events;

pub use root::App;
pub use window::{LOSE_WINDOW, WindowError, run};
