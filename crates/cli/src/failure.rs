//! Reasons why a command fails, and their exit codes.

use std::process::ExitCode;

/// The exit status of a process that Ctrl-C ended.
pub const INTERRUPTED: u8 = 130;

/// Why a command failed. Ordered by exit code, so that the worst of several is the greatest.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Failure {
    /// Error in the scene; its diagnostics have been printed.
    Scene,
    /// Invalid command line: an unknown option, or one that does not apply.
    Call(String),
    /// The machine cannot do it: no GPU, a lost device, a file that cannot be read or written.
    Machine(String),
    /// Ctrl-C was pressed; the text says what was done before.
    Interrupted(String),
}

impl Failure {
    /// The exit code.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Scene => ExitCode::from(1),
            Self::Call(_) => ExitCode::from(2),
            Self::Machine(_) => ExitCode::from(3),
            Self::Interrupted(_) => ExitCode::from(INTERRUPTED),
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Scene => f.write_str("the scene has errors"),
            Self::Call(message) | Self::Machine(message) | Self::Interrupted(message) => {
                f.write_str(message)
            }
        }
    }
}

impl From<sdfc_files::ReadError> for Failure {
    fn from(error: sdfc_files::ReadError) -> Self {
        Self::Machine(error.to_string())
    }
}
