//! What can go wrong after a scene has compiled.

use sdfc_graph::ExpandError;
use sdfc_graph::eval::TapeError;
use sdfc_render::{RenderError, ViewError};

/// Why a compiled scene could not be lowered, evaluated or drawn.
#[derive(Debug)]
pub enum Error {
    /// The scene draws nothing.
    NothingDrawn,
    /// The field takes more nodes than there may be.
    Expand(ExpandError),
    /// The program could not be lowered or written.
    Codegen(sdfc_codegen::Error),
    /// The program could not be evaluated on the CPU.
    Evaluate(TapeError),
    /// The settings make no picture.
    View(ViewError),
    /// A baseline cannot hold the scene; why.
    Inexpressible(String),
    /// The machine cannot draw it.
    Render(RenderError),
}

impl Error {
    /// Whether the machine is the cause, not the scene or the call.
    pub fn is_machine(&self) -> bool {
        match self {
            Self::Render(error) => error.is_machine(),
            Self::NothingDrawn
            | Self::Expand(_)
            | Self::Codegen(_)
            | Self::Evaluate(_)
            | Self::View(_)
            | Self::Inexpressible(_) => false,
        }
    }

    /// Whether the call is the cause, not the scene or the machine.
    pub fn is_call(&self) -> bool {
        match self {
            Self::Codegen(error) => error.is_call(),
            Self::Render(error) => {
                matches!(error, RenderError::Size(_) | RenderError::MethodNotOnCpu(_))
            }
            Self::NothingDrawn
            | Self::Expand(_)
            | Self::Evaluate(_)
            | Self::View(_)
            | Self::Inexpressible(_) => false,
        }
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NothingDrawn => f.write_str(
                "the scene draws nothing: every solid that stands alone on a line is drawn",
            ),
            Self::Expand(error) => error.fmt(f),
            Self::Codegen(error) => error.fmt(f),
            Self::Evaluate(error) => error.fmt(f),
            Self::View(error) => error.fmt(f),
            Self::Inexpressible(why) => f.write_str(why),
            Self::Render(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Error {}

impl From<ExpandError> for Error {
    fn from(error: ExpandError) -> Self {
        Self::Expand(error)
    }
}

impl From<sdfc_codegen::Error> for Error {
    fn from(error: sdfc_codegen::Error) -> Self {
        Self::Codegen(error)
    }
}

impl From<TapeError> for Error {
    fn from(error: TapeError) -> Self {
        Self::Evaluate(error)
    }
}

impl From<RenderError> for Error {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

impl From<ViewError> for Error {
    fn from(error: ViewError) -> Self {
        Self::View(error)
    }
}
