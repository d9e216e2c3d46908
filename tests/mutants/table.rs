//! The reader of `table.txt`. The head of that file describes the format.

/// One rule that is broken on purpose, and the scene that shows it.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// The name of the rule, in words that can be part of a test's name.
    pub name: String,
    /// The path of the changed file from the root of the repository.
    pub file: String,
    /// The path of the scene under `tests`, without its extension.
    pub scene: String,
    /// The ray method that draws the scene.
    pub method: String,
    /// What the picture of the unchanged compiler is like.
    pub expected: Expected,
    /// The text to replace. It occurs exactly once in the file.
    pub original: String,
}

/// How good the picture of a scene is, as long as no rule is broken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// Right in every pixel, if the scene is certified.
    Right,
    /// As good as measured before.
    Measured {
        /// Pixels that are missed, false hits, not a number, or capped.
        wrong: u64,
        /// The 99th percentile of the depth error in pixel widths.
        p99: f64,
    },
}

/// Reads the whole table.
pub fn read(text: &str) -> Result<Vec<Mutant>, String> {
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let blocks = lines.split(|line| line.is_empty()).filter(|block| !block.is_empty());
    blocks.map(mutant).collect()
}

fn mutant(block: &[&str]) -> Result<Mutant, String> {
    let field = |key: &str| {
        let value = block.iter().find_map(|line| line.strip_prefix(key)?.strip_prefix(' '));
        value.ok_or_else(|| format!("no `{key}` in {block:?}"))
    };
    let original: Vec<&str> = block.iter().filter_map(|line| line.strip_prefix("- ")).collect();
    if original.is_empty() || !block.iter().any(|line| line.starts_with("+ ")) {
        return Err(format!("no text or no replacement in {block:?}"));
    }
    Ok(Mutant {
        name: field("mutant")?.to_owned(),
        file: field("file")?.to_owned(),
        scene: field("scene")?.to_owned(),
        method: field("method")?.to_owned(),
        expected: expected(field("expected")?)?,
        original: original.join("\n"),
    })
}

fn expected(text: &str) -> Result<Expected, String> {
    if text == "right" {
        return Ok(Expected::Right);
    }
    let measured = || {
        let (wrong, p99) = text.strip_prefix("wrong ")?.split_once(" p99 ")?;
        Some(Expected::Measured { wrong: wrong.parse().ok()?, p99: p99.parse().ok()? })
    };
    measured().ok_or_else(|| format!("`{text}` is no expectation"))
}
