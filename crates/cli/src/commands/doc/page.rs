//! Formats the reference for a terminal.

use sdfc_diagnostics::CodeInfo;
use sdfc_lang::library::Entry;

/// Greatest width of a line, in columns.
const WIDTH: usize = 96;
/// Column at which the summaries of a list begin.
const COLUMN: usize = 22;

/// Text that is built up, optionally coloured.
pub struct Page {
    text: String,
    color: bool,
}

impl Page {
    /// An empty page.
    pub fn new(color: bool) -> Self {
        Self { text: String::new(), color }
    }

    /// The text of the page.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Adds one line for each entry, by topic.
    pub fn list(&mut self, entries: &[&Entry]) {
        let mut topic = None;
        for entry in entries {
            if topic != Some(entry.topic) {
                topic = Some(entry.topic);
                self.gap();
                let title = entry.topic.to_uppercase();
                self.bold(&title);
                self.text.push('\n');
            }
            self.text.push_str("  ");
            self.bold(&entry.name);
            let written = entry.name.len() + 2;
            let gap = COLUMN.saturating_sub(written).max(1);
            self.text.push_str(&" ".repeat(gap));
            self.wrapped(&entry.summary, written + gap, COLUMN);
        }
    }

    /// Adds the full descriptions of entries.
    pub fn full(&mut self, entries: &[&Entry]) {
        for entry in entries {
            self.gap();
            self.head(entry);
            self.indented(&entry.summary);
            if !entry.details.is_empty() {
                self.indented(&entry.details);
            }
            self.parameters(&entry.parameters);
            self.line("contract", &entry.contract());
            self.line("example", &entry.example);
            self.line("source", &entry.source);
            if let Some((file, line)) = entry.location {
                self.line("declared", &format!("{file}:{line}"));
            }
        }
    }

    /// Adds the description of a diagnostic code.
    pub fn code(&mut self, row: &CodeInfo) {
        self.bold(row.code.0);
        self.text.push(' ');
        self.wrapped(row.title, row.code.0.len() + 1, 2);
        self.text.push('\n');
        self.indented(row.page);
        self.text.push('\n');
        self.line("help", row.suggestion);
    }

    /// Adds a final line after a gap.
    pub fn closing(&mut self, line: &str) {
        self.gap();
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Adds the signature, such as `solid sphere(r: length = 1 in 0..inf)`, with the name in bold.
    fn head(&mut self, entry: &Entry) {
        self.dim(entry.kind);
        self.text.push(' ');
        let written = entry.kind.len() + 1;
        // Some signatures do not start with the name: `m.with(...)`.
        let rest = match entry.signature.strip_prefix(&entry.name) {
            Some(rest) => {
                self.bold(&entry.name);
                rest
            }
            None => &entry.signature,
        };
        let at = written + entry.signature.len() - rest.len();
        self.wrapped(rest, at, 4);
    }

    fn parameters(&mut self, parameters: &[(String, String)]) {
        self.text.push('\n');
        if parameters.is_empty() {
            return;
        }
        let widest = parameters.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        for (name, about) in parameters {
            self.text.push_str("  ");
            self.bold(name);
            self.text.push_str(&" ".repeat(widest + 2 - name.chars().count()));
            self.wrapped(about, widest + 4, widest + 4);
        }
        self.text.push('\n');
    }

    /// Adds `  key       text`, if there is text.
    fn line(&mut self, key: &str, text: &str) {
        const AT: usize = 12;
        if text.is_empty() {
            return;
        }
        self.text.push_str("  ");
        self.dim(key);
        self.text.push_str(&" ".repeat(AT - 2 - key.len()));
        self.wrapped(text, AT, AT);
    }

    fn indented(&mut self, text: &str) {
        self.text.push_str("  ");
        self.wrapped(text, 2, 2);
    }

    /// Adds wrapped words from column `at` on; further lines begin at column `indent`.
    fn wrapped(&mut self, text: &str, mut at: usize, indent: usize) {
        let mut first = true;
        for word in text.split(' ') {
            let width = word.chars().count();
            if !first && at + 1 + width > WIDTH {
                self.text.push('\n');
                self.text.push_str(&" ".repeat(indent));
                at = indent;
            } else if !first {
                self.text.push(' ');
                at += 1;
            }
            self.text.push_str(word);
            at += width;
            first = false;
        }
        self.text.push('\n');
    }

    /// Adds an empty line, except at the top.
    fn gap(&mut self) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
    }

    fn bold(&mut self, text: &str) {
        self.styled(text, "1");
    }

    fn dim(&mut self, text: &str) {
        self.styled(text, "36");
    }

    fn styled(&mut self, text: &str, style: &str) {
        if self.color {
            self.text.push_str(&format!("\x1b[{style}m{text}\x1b[0m"));
        } else {
            self.text.push_str(text);
        }
    }
}
