//! Why a command ended without doing all that it was asked to.

use std::process::ExitCode;

/// Ordered by exit status, so that the worst of several is the greatest.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Failure {
    /// The scene is wrong; its diagnostics have been shown.
    Scene,
    /// The call is wrong: a missing or unreadable input, an option that does not fit.
    Call(String),
    /// The machine cannot: no adapter, device lost, output not writable, disk full.
    Machine(String),
    /// Ctrl-C was pressed; what is done so far.
    Interrupted(String),
}

impl Failure {
    /// The exit status for it.
    pub fn status(&self) -> ExitCode {
        match self {
            Self::Scene => ExitCode::from(1),
            Self::Call(_) => ExitCode::from(2),
            Self::Machine(_) => ExitCode::from(3),
            Self::Interrupted(_) => ExitCode::from(130),
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
        Self::Call(error.to_string())
    }
}
