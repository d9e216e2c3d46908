//! Errors that can occur after a scene has compiled.

use sdfc_graph::ExpandError;
use sdfc_graph::eval::TapeError;
use sdfc_render::{RenderError, ViewError};

/// Why a compiled scene could not be lowered, evaluated or drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene draws nothing.
    #[error("the scene draws nothing: every shape that stands alone on a line is drawn")]
    NothingDrawn,
    /// The scene draws regions, and the request needs solids.
    #[error(
        "the scene draws regions (2D), and {0} needs solids (3D): write .extrude(0.2) or \
         .revolve() after the regions"
    )]
    Planar(&'static str),
    /// The scene draws solids, and the request needs regions.
    #[error("the scene draws solids (3D), and isolines are drawn in pictures of regions (2D) only")]
    NotPlanar,
    /// The spacing of isolines is not above 0 and finite.
    #[error("a spacing of isolines of {0}: it must be above 0 and finite")]
    Spacing(f64),
    /// A bind group or binding is greater than [`MAX_BINDING`](crate::MAX_BINDING).
    #[error("a group or binding of {number}: it must be at most {limit}")]
    Binding {
        /// The group or binding.
        number: u32,
        /// The limit.
        limit: u32,
    },
    /// A contour of regions in another plane than z = 0.
    #[cfg(feature = "mesh")]
    #[error("the scene draws regions, which lie in the plane z=0: state no other plane")]
    PlaneOfRegions,
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
        if known.is_empty() {
            "there are no such names; a region becomes a solid by .extrude(0.2)".to_owned()
        } else { format!("the names are: {}", known.join(", ")) }
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
            | Self::Planar(_)
            | Self::NotPlanar
            | Self::Spacing(_)
            | Self::Binding { .. }
            | Self::Expand(_)
            | Self::Codegen(_)
            | Self::Evaluate(_)
            | Self::View(_) => false,
            #[cfg(feature = "mesh")]
            Self::Mesh(error) => matches!(error, sdfc_mesh::MeshError::OutOfMemory(_)),
            #[cfg(feature = "mesh")]
            Self::UnknownSolid { .. } | Self::PlaneOfRegions => false,
        }
    }

    /// True if an argument of the call is the cause.
    pub fn is_call(&self) -> bool {
        match self {
            Self::Codegen(error) => error.is_call(),
            Self::Render(error) => matches!(
                error,
                RenderError::Size(_)
                    | RenderError::Region { .. }
                    | RenderError::Samples(_)
                    | RenderError::MethodNotOnCpu(_)
            ),
            Self::Planar(_) | Self::NotPlanar | Self::Spacing(_) | Self::Binding { .. } => true,
            Self::NothingDrawn | Self::Expand(_) | Self::Evaluate(_) | Self::View(_) => false,
            #[cfg(feature = "mesh")]
            Self::Mesh(error) => error.is_call(),
            #[cfg(feature = "mesh")]
            Self::UnknownSolid { .. } | Self::PlaneOfRegions => true,
        }
    }
}
