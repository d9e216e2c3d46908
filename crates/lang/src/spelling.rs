//! What was probably meant by a name that nothing has.

use crate::synonyms;

/// What to say of a name that is none of these, if it is one of them in another spelling, has a name of its own here, or is
/// near to one.
pub fn meant<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<String> {
    let names: Vec<&str> = names.collect();
    let ask = |name: &str| format!("did you mean `{name}`?");
    synonyms::respelt(name, &names)
        .map(ask)
        .or_else(|| synonyms::here(name).map(|here| format!("that is `{here}` here")))
        .or_else(|| nearest(name, names.into_iter()).map(ask))
}

/// The name that is fewest edits away, if that is near enough to be a slip of the pen;
/// among equals the first in alphabetical order.
pub fn nearest<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let limit = (name.chars().count() / 3).clamp(1, 3);
    names
        .filter(|other| *other != name)
        .map(|other| (edits(name, other), other))
        .filter(|(distance, other)| *distance <= limit && *distance < other.chars().count())
        .min()
        .map(|(_, other)| other)
}

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment). Names longer than 64 characters are never near.
fn edits(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) =
        (a.chars().take(65).collect(), b.chars().take(65).collect());
    if a.len() > 64 || b.len() > 64 || a.len().abs_diff(b.len()) > 3 {
        return usize::MAX;
    }
    let mut rows = [vec![0; b.len() + 1], (0..=b.len()).collect(), vec![0; b.len() + 1]];
    for i in 1..=a.len() {
        let [before, last, next] = &mut rows;
        next[0] = i;
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            next[j] = replaced.min(last[j] + 1).min(next[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                next[j] = next[j].min(before[j - 2] + 1);
            }
        }
        rows.rotate_left(1);
    }
    rows[1][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_count_swaps_once() {
        assert_eq!(edits("spere", "sphere"), 1);
        assert_eq!(edits("shpere", "sphere"), 1);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
    }

    #[test]
    fn a_suggestion_is_near_or_absent() {
        let names = ["sphere", "plane", "box"];
        assert_eq!(nearest("spere", names.into_iter()), Some("sphere"));
        assert_eq!(nearest("teapot", names.into_iter()), None);
        assert_eq!(nearest("a", ["b"].into_iter()), None);
    }
}
