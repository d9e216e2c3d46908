//! The difference between two versions of a source.

/// One replaced run of bytes; everything around it is the same in both versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextDiff {
    /// Byte offset where the difference begins, in both versions.
    pub start: u32,
    /// Byte offset where it ends in the old version.
    pub old_end: u32,
    /// Byte offset where it ends in the new version.
    pub new_end: u32,
}

impl TextDiff {
    /// The shortest replaced run that turns `old` into `new`.
    pub fn new(old: &str, new: &str) -> Self {
        let (old, new) = (old.as_bytes(), new.as_bytes());
        let start = old.iter().zip(new).take_while(|(a, b)| a == b).count();
        let rest = old[start..].iter().rev().zip(new[start..].iter().rev());
        let same = rest.take_while(|(a, b)| a == b).count();
        let [start, old_end, new_end] = [start, old.len() - same, new.len() - same]
            .map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        Self { start, old_end, new_end }
    }

    /// Returns true if the versions are equal.
    pub fn is_empty(self) -> bool {
        self.start == self.old_end && self.start == self.new_end
    }

    /// Maps a byte offset of the old version to the new one; an offset inside the replaced run maps
    /// to its start.
    pub fn map_offset(self, at: u32) -> u32 {
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
    fn a_diff_is_the_shortest_replaced_run() {
        let diff = TextDiff::new("sphere(1.5) | box(2)", "sphere(1.25) | box(2)");
        assert_eq!(diff, TextDiff { start: 9, old_end: 9, new_end: 10 });
        assert!(!diff.is_empty() && TextDiff::new("a", "a").is_empty());
        let diff = TextDiff::new("aa", "aaa");
        assert_eq!(diff, TextDiff { start: 2, old_end: 2, new_end: 3 });
    }

    #[test]
    fn offsets_behind_a_diff_move_with_it() {
        let diff = TextDiff::new("one two three", "one 22 three");
        assert_eq!([0, 3, 4, 5, 7, 12].map(|at| diff.map_offset(at)), [0, 3, 4, 4, 6, 11]);
    }
}
