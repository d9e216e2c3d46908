//! Every request at positions all over the examples and the library, and after random edits: none
//! panics, and every answer lies inside of the text.
//!
//! `SDFC_CONFORMANCE=1 cargo test --release -p sdfc-ide --test positions` asks at every position,
//! and makes 10,000 edits. Without the variable it takes a part of both.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test that cannot be set up fails")]

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use sdfc_ide::{
    Analysis, Resolver, ShapeFacts, actions, colors, complete, definition, diagnostics, folds,
    format, highlights, hints, hover, late_diagnostics, lenses, library_files, prepare_rename,
    references, rename, selection, signature_help, symbols, tokens,
};
use sdfc_test_support::{example_sources, examples_folder};

/// Positions between two that are asked about: 1 for all of them.
fn stride() -> usize {
    if is_complete() { 1 } else { 3 }
}

/// The number of random edits of all files together.
fn edits() -> usize {
    if is_complete() { 10_000 } else { 600 }
}

fn is_complete() -> bool {
    std::env::var_os("SDFC_CONFORMANCE").is_some_and(|value| value == "1")
}

struct Folder(PathBuf);

impl Resolver for Folder {
    fn read(&self, path: &str) -> Result<String, String> {
        std::fs::read_to_string(self.0.join(path)).map_err(|e| e.to_string())
    }
}

/// Name, text and folder of each example and library file.
fn scenes() -> Vec<(String, String, Folder)> {
    let examples = example_sources().unwrap().into_iter().map(|(name, text)| {
        let path = examples_folder().join(&name);
        (name, text, Folder(path.parent().unwrap_or(Path::new("")).to_owned()))
    });
    let library = library_files().iter();
    let library = library.map(|(name, text)| {
        (format!("library/{name}"), (*text).to_owned(), Folder(PathBuf::new()))
    });
    examples.chain(library).collect()
}

/// Asks everything that a check of the whole text answers.
fn ask_at(scene: &Analysis, offset: usize) {
    let text = scene.text();
    let inside = |range: &std::ops::Range<usize>| {
        assert!(text.get(range.clone()).is_some(), "{range:?} in {}", scene.name());
    };
    let mut facts = |call: std::ops::Range<usize>| {
        inside(&call);
        None
    };
    hover(scene, offset, &mut facts).iter().for_each(|it| inside(&it.range));
    definition(scene, offset);
    references(scene, &[], offset, true);
    highlights(scene, offset).iter().for_each(|it| inside(&it.0));
    signature_help(scene, offset);
    selection(scene, offset).iter().for_each(inside);
    let renamable = prepare_rename(scene, offset);
    renamable.iter().for_each(inside);
    let renamed = rename(scene, &[], offset, "quite_another_name");
    let (can, did) = (renamable.is_ok(), renamed.is_ok());
    assert_eq!(can, did, "{renamed:?} at {offset} of {}:\n{text}", scene.name());
    actions(scene, offset..offset);
}

fn ask_whole(scene: &Analysis) {
    let text = scene.text();
    let whole = 0..text.len();
    let inside = |range: &std::ops::Range<usize>| {
        assert!(text.get(range.clone()).is_some(), "{range:?} in {}", scene.name());
    };
    diagnostics(scene, false).iter().for_each(|it| inside(&it.range));
    actions(scene, whole.clone());
    hints(scene, whole, &[]).iter().for_each(|it| inside(&(it.at..it.at)));
    tokens(scene).iter().for_each(|it| inside(&it.range));
    folds(scene).iter().for_each(|it| inside(&it.range));
    symbols(scene).iter().for_each(|it| inside(&it.range));
    let mut known = |_| Some(ShapeFacts { quality: String::new(), cost: String::new() });
    lenses(scene, &mut known).iter().for_each(|it| inside(&it.range));
    colors(scene).iter().for_each(|it| inside(&it.range));
    format(text);
}

/// Checks all items on all cores.
fn check_all<T: Sync>(items: &[T], check: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            check(item);
        }
    };
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(work)));
}

#[test]
fn every_request_is_answered_everywhere() {
    check_all(&scenes(), |(name, text, folder)| {
        let scene = Analysis::new(name, text, folder);
        let found = diagnostics(&scene, false);
        assert!(
            found.iter().all(|it| it.severity < sdfc_ide::Severity::Error),
            "{name}: {found:?}"
        );
        ask_whole(&scene);
        (0..=text.len()).step_by(stride()).for_each(|offset| ask_at(&scene, offset));
        let between = if is_complete() { 1 } else { (text.len() / 12).max(1) };
        for offset in (0..=text.len()).step_by(between) {
            for it in complete(name, text, offset, folder, &[]) {
                assert!(text.get(it.replace.clone()).is_some(), "{it:?} in {name}");
            }
        }
    });
}

/// A generator of pseudo-random numbers (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

const TYPED: [&str; 24] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ".",
    ",",
    ":",
    "=",
    "\"",
    "a",
    "sphere(1)",
    " | ",
    "\n",
    "//",
    "let x = ",
    "é",
    "1",
    "deg",
    "#",
    "p",
    "if ",
    "import a from \"b.sdf\"\n",
];

#[test]
fn random_edits_break_nothing() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let scenes = scenes();
    let per_file = edits().div_ceil(scenes.len());
    for (name, original, folder) in &scenes {
        // A part of a file from its start is quick to check and as broken as any text.
        let start = || original[..boundary(original, 1500)].to_owned();
        let mut text = start();
        for edit in 0..per_file {
            // After a dozen edits little of the scene is left.
            if edit % 12 == 0 {
                text = start();
            }
            let at = boundary(&text, random.below(text.len() + 1));
            match random.below(5) {
                0 | 1 => text.insert_str(at, TYPED[random.below(TYPED.len())]),
                2 | 3 => {
                    let end = boundary(&text, at + random.below(12));
                    text.replace_range(at..end.max(at), "");
                }
                _ => {
                    let (_, other, _) = &scenes[random.below(scenes.len())];
                    let from = boundary(other, random.below(other.len() + 1));
                    let to = boundary(other, from + random.below(120));
                    text.insert_str(at, &other[from..to.max(from)]);
                }
            }
            let scene = Analysis::new(name, &text, folder);
            late_diagnostics(&scene, folder);
            ask_whole(&scene);
            (0..=text.len()).step_by(29).for_each(|offset| ask_at(&scene, offset));
            complete(name, &text, at.min(text.len()), folder, &[]);
        }
    }
}

/// The last position in a text that is at or before an offset and not inside of a character.
fn boundary(text: &str, offset: usize) -> usize {
    let last = offset.min(text.len());
    (0..=last).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}
