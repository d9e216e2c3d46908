//! The panel "Code": an editor of the scene's text.

mod color_button;
mod completion_list;
mod editor;
mod find_bar;
mod highlighting;
mod hover_text;
mod jumps;
mod markdown;
mod menu;
mod number_drag;
mod numbers;
pub mod panel;
mod tab_bar;
pub mod text_state;

pub use editor::CodeEditor;
pub use text_state::move_editors;
