//! Changes of texts that no person makes: bytes, copies in large numbers, deep nesting.

use fastrand::Rng;

use super::mutations::mutated;

/// Texts to insert: characters of several bytes, characters that look like separators but are none,
/// and numbers at the limits of their types.
const INSERTED: [&str; 18] = [
    "\u{0}",
    "\u{feff}",
    "\u{202e}",
    "\u{2028}",
    "é",
    "𝔸",
    "\r",
    "\r\n",
    "\t",
    "\\",
    "\"",
    "1e308",
    "1e-320",
    "-0.0",
    "9007199254740993",
    "4294967296",
    "1/0",
    "0/0",
];

/// Texts to repeat, each with the text that ends it.
const NESTED: [(&str, &str); 8] = [
    ("(", ")"),
    ("[", "]"),
    ("{ let a = 1; ", " }"),
    ("-", ""),
    ("!", ""),
    ("sphere(1) | ", ""),
    ("union(", ")"),
    ("if true { ", " } else { 1 }"),
];

/// Texts beyond this length are not made longer.
const MOST_BYTES: usize = 16_384;

/// Returns one of the files, changed. Half of the texts are what [`mutated`] makes.
///
/// # Panics
///
/// There are no files.
pub fn damaged(files: &[(String, String)], random: &mut Rng) -> String {
    let mut text = mutated(files, random);
    if random.bool() {
        return text;
    }
    for _ in 0..random.usize(1..=4) {
        change(&mut text, files, random);
    }
    text
}

fn change(text: &mut String, files: &[(String, String)], random: &mut Rng) {
    let (from, to) = (place(text, random), place(text, random));
    let range = from.min(to)..from.max(to);
    let grows = text.len() < MOST_BYTES;
    match random.u8(0..6) {
        0 => text.insert_str(from, INSERTED[random.usize(..INSERTED.len())]),
        1 => text.replace_range(range, ""),
        2 if grows => {
            let copied = text[range].to_owned();
            text.insert_str(to, &copied);
        }
        3 => *text = flipped(text, random),
        4 if grows => {
            let (open, close) = NESTED[random.usize(..NESTED.len())];
            let depth = 1 << random.u32(0..10);
            text.insert_str(from, &format!("{}1{}", open.repeat(depth), close.repeat(depth)));
        }
        // A part of another file.
        _ => {
            let other = &files[random.usize(..files.len())].1;
            let (a, b) = (place(other, random), place(other, random));
            text.insert_str(from, &other[a.min(b)..a.max(b)]);
        }
    }
}

/// A place between two characters.
fn place(text: &str, random: &mut Rng) -> usize {
    let at = random.usize(..=text.len());
    (0..=at).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// The text with one bit changed. Bytes that are no text any more become the replacement character,
/// as when a file is read.
fn flipped(text: &str, random: &mut Rng) -> String {
    let mut bytes = text.as_bytes().to_vec();
    if !bytes.is_empty() {
        let at = random.usize(..bytes.len());
        bytes[at] ^= 1 << random.u8(0..8);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
