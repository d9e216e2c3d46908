//! The description of what is under the pointer in the editor.

use eframe::egui::Response;
use sdfc_ide::hover;

use crate::compile::diagnostics::ShownDiagnostic;
use crate::session::Session;

/// Shows the errors at an offset of the shown text, else the description of the name there.
pub fn describe(response: &Response, session: &Session, found: &[ShownDiagnostic], at: usize) {
    if let Some(under) = found.iter().find(|found| found.range.contains(&at)) {
        let lines = std::iter::once(&under.message).chain(&under.help);
        let lines: Vec<&str> = lines.map(String::as_str).filter(|line| !line.is_empty()).collect();
        response.clone().on_hover_text_at_pointer(lines.join("\n"));
        return;
    }
    let answer = session.answer_about_text();
    if let Some(shown) = answer.and_then(|it| hover(&it.analysis, at, &mut |_| None)) {
        let lines = shown.markdown.lines().filter(|line| !line.starts_with("```"));
        let text = lines.collect::<Vec<_>>().join("\n");
        response.clone().on_hover_text_at_pointer(text.trim());
    }
}
