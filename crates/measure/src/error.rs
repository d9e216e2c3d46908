//! Reasons why a measurement fails.

/// Why a scene could not be measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// The scene cannot be lowered or drawn.
    #[error(transparent)]
    Scene(#[from] sdfc::Error),
    /// A baseline cannot hold the scene; the text says why.
    #[error("{0}")]
    Inexpressible(String),
}

impl From<sdfc_codegen::Error> for MeasureError {
    fn from(error: sdfc_codegen::Error) -> Self {
        Self::Scene(error.into())
    }
}

impl From<sdfc_graph::ExpandError> for MeasureError {
    fn from(error: sdfc_graph::ExpandError) -> Self {
        Self::Scene(error.into())
    }
}

impl From<sdfc_graph::eval::TapeError> for MeasureError {
    fn from(error: sdfc_graph::eval::TapeError) -> Self {
        Self::Scene(error.into())
    }
}

impl From<sdfc_render::RenderError> for MeasureError {
    fn from(error: sdfc_render::RenderError) -> Self {
        Self::Scene(error.into())
    }
}

impl From<sdfc_render::ViewError> for MeasureError {
    fn from(error: sdfc_render::ViewError) -> Self {
        Self::Scene(error.into())
    }
}
