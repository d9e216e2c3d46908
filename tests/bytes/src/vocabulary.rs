//! Bytes as tokens of the language.

use std::sync::OnceLock;

/// Tokens that are no names of the reference. A token that is listed twice is twice as frequent.
#[rustfmt::skip]
const TOKENS: &[&str] = &[
    "(", ")", "(", ")", "[", "]", "{", "}", ",", ",", ":", ".", "=", "\n", "\n", "\n",
    "+", "-", "*", "/", "%", "|", "&", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "!", "->",
    "=>", "..", "//", "/**",
    "in", "for", "if", "else", "let", "param", "fn", "shape", "solid", "region", "import", "from",
    "as", "material", "iterate", "while", "require", "exact", "lipschitz", "bounds", "intersect",
    "copies", "solid", "number", "length", "angle", "vec2", "vec3", "vec4", "color", "int", "bool",
    "p", "q", "a", "b", "x", "y", "z", "r", "time", "inf", "pi", "true", "false",
    "0", "1", "0.5", "2", "-1", "1e30", "90deg", "0.25turn", "1rad", "#f80", "#12345678",
    "\"a\"", "\"", "\u{e9}",
];

/// Returns a text in which each pair of bytes is a token: the first byte says which table the
/// second one counts in.
pub fn text(bytes: &[u8]) -> String {
    let pairs = bytes.as_chunks().0;
    let tokens: Vec<&str> = pairs.iter().map(|pair| token(*pair)).collect();
    tokens.join(" ")
}

fn token([table, index]: [u8; 2]) -> &'static str {
    if table % 2 == 0 {
        return TOKENS[usize::from(index) % TOKENS.len()];
    }
    let names = names();
    &names[(usize::from(table / 2) * 256 + usize::from(index)) % names.len()]
}

/// The names of the reference.
fn names() -> &'static [String] {
    static NAMES: OnceLock<Vec<String>> = OnceLock::new();
    NAMES.get_or_init(|| {
        sdfc_lang::reference::entries().into_iter().map(|entry| entry.name).collect()
    })
}
