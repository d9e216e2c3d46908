//! Where the numbers of a source are in its next version.

use std::collections::BTreeMap;
use std::ops::Range;
use std::time::{Duration, Instant};

use sdfc_syntax::{Class, classes};
use similar::{Algorithm, DiffOp, capture_diff_slices_deadline};

/// The longest time of a comparison. What could not be compared until then counts as changed.
const TIME_LIMIT: Duration = Duration::from_millis(100);

/// Maps the start of each number token of `old` to its start in `new`. A number that was changed or
/// removed is missing.
pub fn rebase_numbers(old: &str, new: &str) -> BTreeMap<usize, usize> {
    let (old_tokens, new_tokens) = (classes(old), classes(new));
    let operations = capture_diff_slices_deadline(
        Algorithm::Myers,
        &words(old, &old_tokens),
        &words(new, &new_tokens),
        Some(Instant::now() + TIME_LIMIT),
    );
    let mut map = BTreeMap::new();
    for operation in operations {
        let DiffOp::Equal { old_index, new_index, len } = operation else { continue };
        for offset in 0..len {
            let (class, from) = &old_tokens[old_index + offset];
            if *class == Class::Number {
                map.insert(from.start, new_tokens[new_index + offset].1.start);
            }
        }
    }
    map
}

fn words<'t>(text: &'t str, tokens: &[(Class, Range<usize>)]) -> Vec<&'t str> {
    tokens.iter().map(|(_, range)| &text[range.clone()]).collect()
}

/// Maps the start of each number token of `old` to that of the number at the same place among all
/// numbers of `new`. For a `new` in which only numbers were replaced.
pub fn pair_numbers(old: &str, new: &str) -> BTreeMap<usize, usize> {
    let starts = |text| {
        let numbers = classes(text).into_iter().filter(|(class, _)| *class == Class::Number);
        numbers.map(|(_, range)| range.start)
    };
    starts(old).zip(starts(new)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text of each number of `old`, and its line in `new`.
    fn lines(old: &str, new: &str) -> Vec<(String, usize)> {
        let map = rebase_numbers(old, new);
        let number = |from: usize| old[from..].split([')', ',', ' ']).next().unwrap().to_owned();
        let line = |to: usize| new[..to].matches('\n').count() + 1;
        map.into_iter().map(|(from, to)| (number(from), line(to))).collect()
    }

    #[test]
    fn numbers_between_two_edits_keep_their_place() {
        let old = "sphere(1.5)\nbox(2.5)\ncylinder(3.5, 4.5)\n";
        let new = "// two edits\nsphere(1.75)\nbox(2.5)\n\ncylinder(3.5, 5)\n";
        assert_eq!(lines(old, new), [("2.5".to_owned(), 3), ("3.5".to_owned(), 5)]);
        assert_eq!(lines(old, "torus(1, 2)\n"), []);
    }

    #[test]
    fn numbers_that_replace_others_are_paired_in_order() {
        let map = pair_numbers("box(-1, 2)", "box(0.5, -22)");
        assert_eq!(map, BTreeMap::from([(5, 4), (8, 10)]));
    }
}
