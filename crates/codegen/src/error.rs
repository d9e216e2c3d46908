//! Why a program cannot become a shader.

use sdfc_graph::NodeId;
use thiserror::Error as ThisError;

use crate::options::Stage;
use crate::target::Target;

/// Why a program cannot become a shader.
#[derive(Clone, Debug, PartialEq, ThisError)]
#[non_exhaustive]
pub enum Error {
    /// The program draws nothing: it has no distance.
    #[error("the scene draws nothing, so there is no field")]
    NothingDrawn,
    /// The program is planar: its shapes are regions, which no ray meets.
    #[error(
        "the scene draws regions, which have no rays: {0} needs solids; write .extrude(0.2) after \
         the shapes, or ask for the field or the whole picture"
    )]
    Planar(&'static str),
    /// The program has no root for a function that was requested.
    #[error("the program has no {0}")]
    MissingRoot(&'static str),
    /// A prefix is not the start of a WGSL identifier.
    #[error("`{0}` cannot start a name: expected letters, digits and single `_`, no digit first")]
    BadPrefix(String),
    /// A constant is not a number, or beyond the range of f32.
    #[error(
        "the scene computes with the number {value:e}, but shaders have 32-bit floats, which end at \
         3.4e38: use smaller lengths and numbers"
    )]
    NotFinite {
        /// The constant.
        node: NodeId,
        /// The first of its lanes that does not fit.
        value: f64,
    },
    /// An operation on constants alone, which the graph should have folded, reached the shader.
    #[error("node {} has constant arguments and was not folded", .0.index())]
    NotFolded(NodeId),
    /// A node has no meaning in flat math: a sample, a material query, or a point other than the
    /// one the field is a function of.
    #[error("node {} is not flat math", .0.index())]
    NotFlat(NodeId),
    /// A per-frame input is neither in `Program::uniforms` nor a param of the program.
    #[error("node {} is a per-frame input without a uniform", .0.index())]
    UnboundInput(NodeId),
    /// The arguments of an operation have the wrong types.
    #[error("node {} has arguments of the wrong type", .0.index())]
    IllTyped(NodeId),
    /// A vector component is beyond the vector's width.
    #[error("node {} takes a component that its vector lacks", .0.index())]
    BadLane(NodeId),
    /// The target's language lacks something.
    #[error("{} has no {what}", .target.name())]
    Unsupported {
        /// The target.
        target: Target,
        /// The missing feature.
        what: &'static str,
    },
    /// The target's language lacks a stage.
    #[error("{} has no {} stage", .target.name(), .stage.name())]
    MissingStage {
        /// The target.
        target: Target,
        /// The stage.
        stage: Stage,
    },
    /// A bind group or binding is greater than the target allows.
    #[error("{} counts groups and bindings up to 255, not {number}", .target.name())]
    BindingTooLarge {
        /// The target.
        target: Target,
        /// The group or binding.
        number: u32,
    },
    /// The number of bytes of a view is not what the shader reads.
    #[error("the view has {found} bytes, not the {expected} that the shader reads")]
    ViewBytes {
        /// The number that the shader reads.
        expected: usize,
        /// The actual number.
        found: usize,
    },
    /// The shader does not validate, or a writer refused it; contains naga's message.
    #[error("the shader was refused: {0}")]
    Naga(String),
}

impl Error {
    /// Returns true if the request is the cause, not the scene.
    pub fn is_call(&self) -> bool {
        match self {
            Self::BadPrefix(_)
            | Self::Planar(_)
            | Self::Unsupported { .. }
            | Self::MissingStage { .. }
            | Self::BindingTooLarge { .. } => true,
            Self::NothingDrawn
            | Self::MissingRoot(_)
            | Self::NotFinite { .. }
            | Self::NotFolded(_)
            | Self::NotFlat(_)
            | Self::UnboundInput(_)
            | Self::IllTyped(_)
            | Self::BadLane(_)
            | Self::ViewBytes { .. }
            | Self::Naga(_) => false,
        }
    }
}
