//! Suggestions for unknown names.

use sdfc_diagnostics::Diagnostic;

use crate::synonyms;

/// A suggestion for an unknown name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Meant {
    /// The suggestion as a sentence.
    pub message: String,
    /// The expression to write instead.
    pub instead: String,
}

impl Meant {
    /// Adds the suggestion to the diagnostic of a name, and the change if it is another name.
    pub fn add_to(self, found: Diagnostic) -> Diagnostic {
        let span = found.span;
        let is_name = self.instead.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let found = found.help(self.message);
        if !is_name {
            return found;
        }
        found.fix(format!("replace by `{}`", self.instead), span, self.instead)
    }
}

/// A suggestion for a name that is not among `names`: one of them in another spelling, its name in
/// this language, or one with a similar spelling.
pub fn meant<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<Meant> {
    let names: Vec<&str> = names.collect();
    let here = |here: &str| Meant { message: sentence_for(here), instead: here.to_owned() };
    synonyms::of_quilez(name)
        .map(here)
        .or_else(|| synonyms::respelt(name, &names).map(ask))
        .or_else(|| synonyms::here(name).map(here))
        .or_else(|| {
            let [message, instead] = synonyms::absent(name)?.map(str::to_owned);
            Some(Meant { message, instead })
        })
        .or_else(|| nearest(name, names.into_iter()).map(ask))
}

/// The sentence with the expression to write here. Other tools blend distances, which are numbers,
/// by the functions that blend shapes.
fn sentence_for(here: &str) -> String {
    let sentence = format!("that is `{here}` here");
    let blend = here.strip_prefix("union(a, b, blend: ").and_then(|rest| rest.strip_suffix(')'));
    match blend {
        None if here == "quadratic_bezier" => {
            format!("{sentence}, in the plane; in space, write sweep(circle(0.1), points)")
        }
        Some(blend) => format!("{sentence}; of two numbers, it is `{blend}(a, b)`"),
        None => sentence,
    }
}

/// The suggestion of a name.
pub fn ask(name: &str) -> Meant {
    Meant { message: format!("did you mean `{name}`?"), instead: name.to_owned() }
}

/// The name with the smallest edit distance, if that is small enough for a spelling mistake. Among
/// equals it is the first in alphabetical order.
pub fn nearest<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let limit = (name.chars().count() / 3).clamp(1, 3);
    names
        .filter(|other| *other != name)
        .map(|other| (edits(name, other), other))
        .filter(|(distance, other)| *distance <= limit && *distance < other.chars().count())
        .min()
        .map(|(_, other)| other)
}

/// The edit distance of two names (optimal string alignment: swapping two neighbours is one edit).
/// It is `usize::MAX` if a name has more than 64 characters or the lengths differ by more than 3.
fn edits(a: &str, b: &str) -> usize {
    let [long, other] = [a, b].map(|name| name.chars().take(65).count());
    if long > 64 || other > 64 || long.abs_diff(other) > 3 {
        return usize::MAX;
    }
    strsim::osa_distance(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swap_is_one_edit() {
        assert_eq!(edits("spere", "sphere"), 1);
        assert_eq!(edits("shpere", "sphere"), 1);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
    }

    #[test]
    fn only_similar_names_are_suggested() {
        let names = ["sphere", "plane", "box"];
        assert_eq!(nearest("spere", names.into_iter()), Some("sphere"));
        assert_eq!(nearest("teapot", names.into_iter()), None);
        assert_eq!(nearest("a", ["b"].into_iter()), None);
    }
}
