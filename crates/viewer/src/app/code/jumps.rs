//! Jumps to definitions, and back.

use std::ops::Range;

use sdfc_ide::definition;

use crate::session::Session;
use crate::session::tabs::TabFile;

/// The most jumps that can be gone back.
const MAX_JUMPS: usize = 100;

/// The range that a jump leads to, and where earlier jumps began.
#[derive(Debug, Default)]
pub struct Jumps {
    target: Option<(TabFile, Range<usize>)>,
    from: Vec<(TabFile, usize)>,
}

impl Jumps {
    /// Goes to the definition of the name at an offset of the shown text. `from` is the offset to
    /// which [`back`](Self::back) returns.
    pub fn go_to_definition(&mut self, session: &mut Session, offset: usize, from: usize) {
        let Some(target) = target(session, offset) else {
            let text = "there is no name with a definition at the cursor";
            return session.messages.push(text.to_owned());
        };
        if self.from.len() == MAX_JUMPS {
            self.from.remove(0);
        }
        self.from.push((session.shown_file().clone(), from));
        session.show_file(target.0.clone());
        self.target = Some(target);
    }

    /// Goes back to where the last jump began.
    pub fn back(&mut self, session: &mut Session) {
        if let Some((file, offset)) = self.from.pop() {
            session.show_file(file.clone());
            self.target = Some((file, offset..offset));
        }
    }

    /// True if there is a jump to go back from.
    pub fn can_go_back(&self) -> bool {
        !self.from.is_empty()
    }

    /// The range of a file that a jump leads to, once. `None` until that file is shown.
    pub fn take_target(&mut self, shown: &TabFile) -> Option<Range<usize>> {
        self.target.take_if(|(file, _)| file == shown).map(|(_, range)| range)
    }
}

/// The definition of the name at an offset of the shown text.
pub fn target(session: &Session, offset: usize) -> Option<(TabFile, Range<usize>)> {
    let location = definition(&session.answer_about_text()?.analysis, offset)?;
    Some((TabFile::of(&location, session.path()), location.range()))
}
