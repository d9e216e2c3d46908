//! Selections without branches, for GLSL ES.
//!
//! naga writes a selection as `(c ? a : b)`. ANGLE, through which browsers run GLSL ES, makes a
//! branch of each. Drivers take long for hundreds of branches in a row: SwiftShader takes 20 s for
//! the picture of 16 balls, and loses the context with 24. `mix` with a truth value is one
//! instruction.

/// The name of the functions that select, to which the prefix is added.
pub(crate) const NAME: &str = "SelectValue";

/// One function for each type. There is no `mix` for whole numbers and truth values.
const FUNCTIONS: &str = "
float SelectValue(bool c, float a, float b) { return mix(b, a, c); }
vec2 SelectValue(bool c, vec2 a, vec2 b) { return mix(b, a, bvec2(c)); }
vec3 SelectValue(bool c, vec3 a, vec3 b) { return mix(b, a, bvec3(c)); }
vec4 SelectValue(bool c, vec4 a, vec4 b) { return mix(b, a, bvec4(c)); }
uint SelectValue(bool c, uint a, uint b) { return c ? a : b; }
int SelectValue(bool c, int a, int b) { return c ? a : b; }
bool SelectValue(bool c, bool a, bool b) { return c ? a : b; }
";

/// Writes all selections of a source as calls, and adds the functions before its first declaration.
pub(super) fn without_branches(text: &str) -> String {
    let head = text.rfind("\nprecision ").and_then(|at| Some(at + 1 + text[at + 1..].find('\n')?));
    let (head, body) = text.split_at(head.unwrap_or(0));
    match with_calls(body) {
        Some(body) => format!("{head}\n{}{body}", FUNCTIONS.trim_end()),
        None => text.to_owned(),
    }
}

/// Writes `(c ? a : b)` as `SelectValue(c, a, b)`; `None` if there is nothing to write.
fn with_calls(text: &str) -> Option<String> {
    // Where each open parenthesis is, and whether it holds a selection.
    let mut open: Vec<(usize, bool)> = Vec::new();
    let mut written = String::with_capacity(text.len());
    let mut is_changed = false;
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let mut length = next.len_utf8();
        match (next, open.last_mut()) {
            ('(', _) => {
                open.push((written.len(), false));
                written.push('(');
            }
            (')', _) => {
                open.pop();
                written.push(')');
            }
            (' ', Some((start, selects))) if rest.starts_with(" ? ") => {
                written.insert_str(*start, NAME);
                (*selects, is_changed, length) = (true, true, 3);
                written.push_str(", ");
            }
            (' ', Some((_, true))) if rest.starts_with(" : ") => {
                length = 3;
                written.push_str(", ");
            }
            _ => written.push(next),
        }
        rest = &rest[length..];
    }
    is_changed.then_some(written)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_selections_become_calls() {
        let text = "    x = min((a ? b : c), ((d ? f(1.0) : 2.0) < y ? z : w));\n";
        let calls = "    x = min(SelectValue(a, b, c), \
                     SelectValue(SelectValue(d, f(1.0), 2.0) < y, z, w));\n";
        assert_eq!(with_calls(text).as_deref(), Some(calls));
    }

    #[test]
    fn labels_and_other_code_stay() {
        assert_eq!(with_calls("switch (kind) {\n    case 1u : {\n        break;\n    }\n}"), None);
    }
}
