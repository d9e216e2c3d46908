//! Errors that can occur after a scene has compiled.

use sdfc_graph::ExpandError;
use sdfc_graph::eval::TapeError;
use sdfc_render::{RenderError, ViewError};

/// Why a compiled scene could not be lowered, evaluated or drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene draws nothing.
    #[error("the scene draws nothing: every solid that stands alone on a line is drawn")]
    NothingDrawn,
    /// The field has more nodes than the limit.
    #[error(transparent)]
    Expand(#[from] ExpandError),
    /// The program could not be lowered or written.
    #[error(transparent)]
    Codegen(#[from] sdfc_codegen::Error),
    /// The program could not be evaluated on the CPU.
    #[error(transparent)]
    Evaluate(#[from] TapeError),
    /// The settings give no valid view.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The scene names no such solid.
    #[cfg(feature = "mesh")]
    #[error(
        "no `let` at the top level of the scene gives the name `{name}` to a solid; {}",
        if known.is_empty() { "there are no such names".to_owned() }
        else { format!("the names are: {}", known.join(", ")) }
    )]
    UnknownSolid {
        /// The name that was asked for.
        name: String,
        /// The names of solids.
        known: Vec<String>,
    },
    /// The mesh could not be made.
    #[cfg(feature = "mesh")]
    #[error(transparent)]
    Mesh(#[from] sdfc_mesh::MeshError),
    /// The picture could not be drawn or encoded.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl Error {
    /// True if the machine is the cause: no GPU, a lost device, I/O.
    pub fn is_machine(&self) -> bool {
        match self {
            Self::Render(error) => error.is_machine(),
            Self::NothingDrawn
            | Self::Expand(_)
            | Self::Codegen(_)
            | Self::Evaluate(_)
            | Self::View(_) => false,
            #[cfg(feature = "mesh")]
            Self::Mesh(_) | Self::UnknownSolid { .. } => false,
        }
    }

    /// True if an argument of the call is the cause.
    pub fn is_call(&self) -> bool {
        match self {
            Self::Codegen(error) => error.is_call(),
            Self::Render(error) => {
                matches!(error, RenderError::Size(_) | RenderError::MethodNotOnCpu(_))
            }
            Self::NothingDrawn | Self::Expand(_) | Self::Evaluate(_) | Self::View(_) => false,
            #[cfg(feature = "mesh")]
            Self::Mesh(error) => error.is_call(),
            #[cfg(feature = "mesh")]
            Self::UnknownSolid { .. } => true,
        }
    }
}
