//! What the mouse and the keys do where the pointer is.

use eframe::egui::{Pos2, Rect};

use crate::session::Session;
use crate::session::tabs::TabFile;

const PICTURE: &str = "drag turns · right drag moves · wheel zooms · click finds the code";
const PLANAR: &str = "drag moves · wheel zooms · click finds the code";
const CODE: &str = "Ctrl+S saves · F12 goes to a definition · Alt+drag changes a number";
const LIBRARY: &str = "Alt+Left goes back · Ctrl+F finds text";
const ELSEWHERE: &str = "F1 lists the keys";

/// Returns a line about what the pointer is over: the picture or the panel "Code", whose rectangles
/// are given, or anything else.
pub fn hint(
    session: &Session,
    pointer: Option<Pos2>,
    picture: Rect,
    code: Option<Rect>,
) -> &'static str {
    let is_over = |rect: Rect| pointer.is_some_and(|at| rect.contains(at));
    let is_planar = session.model.as_ref().is_some_and(|model| model.scene.is_planar());
    let is_library = matches!(session.shown_file(), TabFile::Library(_));
    match (is_over(picture), code.is_some_and(is_over)) {
        (true, _) if is_planar => PLANAR,
        (true, _) => PICTURE,
        (false, true) if is_library => LIBRARY,
        (false, true) => CODE,
        (false, false) => ELSEWHERE,
    }
}
