//! Random changes of files, as typing, deleting and pasting make them.

use fastrand::Rng;

/// Words and signs that are typed.
const TYPED: [&str; 52] = [
    "let",
    "param",
    "fn",
    "solid",
    "region",
    "shape",
    "import",
    "if",
    "else",
    "for",
    "in",
    "true",
    "from",
    "as",
    "exact",
    "bounds",
    "everywhere",
    "p",
    "a",
    "sphere",
    "1",
    "0.5",
    "90deg",
    "3mm",
    "#fff",
    "\"a\"",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    ";",
    ".",
    "..",
    "...",
    "|",
    "&",
    "-",
    "+",
    "*",
    "/",
    "!",
    "=",
    "==",
    "<",
    "->",
    "\n",
    " ",
    "// c\n",
];

/// Returns one of the files, changed in one to three places.
///
/// # Panics
///
/// There are no files.
pub fn mutated(files: &[(String, String)], random: &mut Rng) -> String {
    let mut text = files[random.usize(..files.len())].1.clone();
    for _ in 0..random.usize(1..=3) {
        let tokens = sdfc_syntax::classes(&text);
        if tokens.is_empty() {
            text.push_str(TYPED[random.usize(..TYPED.len())]);
            continue;
        }
        let token = tokens[random.usize(..tokens.len())].1.clone();
        let other = tokens[random.usize(..tokens.len())].1.clone();
        match random.u8(0..8) {
            0 => text.replace_range(token, ""),
            1 => text.insert_str(token.start, TYPED[random.usize(..TYPED.len())]),
            2 => text.replace_range(token, TYPED[random.usize(..TYPED.len())]),
            3 => {
                let copied = text[token].to_owned();
                text.insert_str(other.end, &copied);
            }
            4 => {
                // A selection that begins and ends between tokens.
                let (from, to) = (token.start.min(other.start), token.start.max(other.start));
                let to =
                    tokens.iter().map(|it| it.1.start).find(|at| *at > from + 20).unwrap_or(to);
                text.replace_range(from..to.max(from), "");
            }
            5 => text = without_a_letter(&text, random),
            6 => text.insert_str(token.end, ["\n", " ", "\n\n", ";"][random.usize(..4)]),
            _ => text = without_a_space(&text, random),
        }
    }
    text
}

fn without_a_letter(text: &str, random: &mut Rng) -> String {
    let letters: Vec<char> = text.chars().collect();
    let at = random.usize(..letters.len());
    letters.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, letter)| letter).collect()
}

/// The text without one run of spaces or line breaks.
fn without_a_space(text: &str, random: &mut Rng) -> String {
    let starts: Vec<usize> = text.match_indices([' ', '\n']).map(|(at, _)| at).collect();
    if starts.is_empty() {
        return text.to_owned();
    }
    let at = starts[random.usize(..starts.len())];
    format!("{}{}", &text[..at], text[at..].trim_start_matches([' ', '\n']))
}
