//! Constant lists in HLSL.
//!
//! naga's writer initialises a list by a function that returns an array, `static float list[2] =
//! Constructarray2_float_(1.0, 2.0);`. glslang and its users refuse that, and two sources in one
//! file would both declare the function.

/// Rewrites such lists as HLSL initialisers: `static const float list[2] = { 1.0, 2.0 };`.
pub(super) fn with_plain_lists(text: &str) -> String {
    let lines = text.split_inclusive('\n');
    let plain: String = lines.map(|line| plain(line).unwrap_or_else(|| line.to_owned())).collect();
    without_uncalled(plain)
}

fn plain(line: &str) -> Option<String> {
    let (declared, made) = line.strip_prefix("static ")?.split_once(" = Constructarray")?;
    let elements = made.split_once('(')?.1.trim_end().strip_suffix(");")?;
    Some(format!("static const {declared} = {{ {elements} }};\n"))
}

/// Removes constructors that nothing calls, and the types that they return.
fn without_uncalled(mut text: String) -> String {
    let mut from = 0;
    while let Some(found) = text[from..].find("typedef ") {
        let start = from + found;
        from = start + 1;
        let line = text[start..].lines().next().unwrap_or_default();
        let name = line.split_once(" ret_").and_then(|(_, rest)| rest.split_once('['));
        let Some((name, _)) = name else { continue };
        // The single match is the declaration.
        if text.matches(&format!(" {name}(")).count() == 1
            && let Some(length) = text[start..].find("\n}\n\n")
        {
            text.replace_range(start..start + length + "\n}\n\n".len(), "");
            from = start;
        }
    }
    text
}
