//! Diagnostics for programs.

use sdfc_diagnostics::Located;
use serde::Serialize;

use crate::Compiled;

/// A diagnostic for programs, as `sdfc check --json` writes it. The keys are a promise to other tools: some may be
/// added, none renamed. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DiagnosticRow {
    /// The code, `E0201`.
    pub code: &'static str,
    /// `error` or `warning`.
    pub severity: &'static str,
    /// What is wrong.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Where it begins.
    pub line: u32,
    /// Where it begins.
    pub column: u32,
    /// Where it ends.
    pub end_line: u32,
    /// Where it ends.
    pub end_column: u32,
    /// Ways to mend it, one a line.
    pub help: String,
}

impl From<Located> for DiagnosticRow {
    fn from(found: Located) -> Self {
        Self {
            code: found.code,
            severity: found.severity,
            message: found.message,
            file: found.file,
            line: found.start.line,
            column: found.start.column,
            end_line: found.end.line,
            end_column: found.end.column,
            help: found.help,
        }
    }
}

impl Compiled {
    /// The findings as programs read them.
    pub fn rows(&self) -> Vec<DiagnosticRow> {
        self.located().into_iter().map(DiagnosticRow::from).collect()
    }
}
