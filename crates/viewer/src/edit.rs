//! What differs between two texts.

/// One run of bytes in the place of another; all around it is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edit {
    /// Where it begins, in both texts.
    pub start: u32,
    /// Where it ends in the old text.
    pub old_end: u32,
    /// Where it ends in the new text.
    pub new_end: u32,
}

impl Edit {
    /// The shortest that makes one text of another.
    pub fn between(old: &str, new: &str) -> Self {
        let (old, new) = (old.as_bytes(), new.as_bytes());
        let start = old.iter().zip(new).take_while(|(a, b)| a == b).count();
        let rest = old[start..].iter().rev().zip(new[start..].iter().rev());
        let same = rest.take_while(|(a, b)| a == b).count();
        let [start, old_end, new_end] = [start, old.len() - same, new.len() - same]
            .map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        Self { start, old_end, new_end }
    }

    /// Whether the texts are the same.
    pub fn is_empty(self) -> bool {
        self.start == self.old_end && self.start == self.new_end
    }

    /// Where a byte of the old text is in the new one; one that is gone where the edit begins.
    pub fn moved(self, at: u32) -> u32 {
        match at {
            at if at < self.start => at,
            at if at < self.old_end => self.start,
            at => (at - self.old_end).saturating_add(self.new_end),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_is_what_differs() {
        let edit = Edit::between("sphere(1.5) | box(2)", "sphere(1.25) | box(2)");
        assert_eq!(edit, Edit { start: 9, old_end: 9, new_end: 10 });
        assert!(!edit.is_empty() && Edit::between("a", "a").is_empty());
        let edit = Edit::between("aa", "aaa");
        assert_eq!(edit, Edit { start: 2, old_end: 2, new_end: 3 });
    }

    #[test]
    fn places_behind_it_move_along() {
        let edit = Edit::between("one two three", "one 22 three");
        assert_eq!([0, 3, 4, 5, 7, 12].map(|at| edit.moved(at)), [0, 3, 4, 4, 6, 11]);
    }
}
