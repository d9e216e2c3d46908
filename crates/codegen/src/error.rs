//! Why a program cannot become a shader.

use std::fmt;

use sdfc_graph::NodeId;

use crate::Target;

/// Why a program cannot become a shader.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The program draws nothing: it has no distance.
    NothingDrawn,
    /// A function was asked for that the program has no root for.
    MissingRoot(&'static str),
    /// No ray method has this name.
    UnknownMethod(String),
    /// A prefix is not the start of a WGSL identifier.
    BadPrefix(String),
    /// A constant is infinite, not a number, or beyond the range of f32.
    NotFinite {
        /// The constant.
        node: NodeId,
        /// Its offending lane.
        value: f64,
    },
    /// An operation on constants alone was left to the shader; the graph folds those.
    NotFolded(NodeId),
    /// A node has no meaning in flat math: a sample, a material query, or a point other than the
    /// one the field is a function of.
    NotFlat(NodeId),
    /// A per-frame input is neither in `Program::uniforms` nor a param of the program.
    UnboundInput(NodeId),
    /// An operation got arguments of types that it does not take.
    IllTyped(NodeId),
    /// A vector component beyond the vector's width.
    BadLane(NodeId),
    /// Constant limits whose lanes are not in the same order.
    MixedLimits(NodeId),
    /// A target's language has no such thing.
    Unsupported {
        /// The target.
        target: Target,
        /// What it lacks.
        what: &'static str,
    },
    /// A bind group or a binding beyond what a target's numbers can say.
    BindingTooLarge {
        /// The target.
        target: Target,
        /// The number.
        number: u32,
    },
    /// The bytes of a view are not as many as the shader reads.
    ViewBytes {
        /// How many it reads.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// The shader does not validate, or a writer refused it; naga's own words.
    Naga(String),
}

impl Error {
    /// Whether what was asked for is the cause, not the scene.
    pub fn is_call(&self) -> bool {
        match self {
            Self::UnknownMethod(_)
            | Self::BadPrefix(_)
            | Self::Unsupported { .. }
            | Self::BindingTooLarge { .. } => true,
            Self::NothingDrawn
            | Self::MissingRoot(_)
            | Self::NotFinite { .. }
            | Self::NotFolded(_)
            | Self::NotFlat(_)
            | Self::UnboundInput(_)
            | Self::IllTyped(_)
            | Self::BadLane(_)
            | Self::MixedLimits(_)
            | Self::ViewBytes { .. }
            | Self::Naga(_) => false,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingDrawn => write!(f, "the scene draws nothing, so there is no field"),
            Self::MissingRoot(role) => write!(f, "the program has no {role}"),
            Self::UnknownMethod(name) => {
                let names: Vec<_> = sdfc_march::METHODS.iter().map(|method| method.name).collect();
                write!(f, "unknown ray method `{name}`; there are {}", names.join(", "))
            }
            Self::BadPrefix(prefix) => write!(
                f,
                "`{prefix}` cannot start a name: expected letters, digits and single `_`, \
                 no digit first"
            ),
            Self::NotFinite { node, value } => {
                write!(f, "node {} is {value}, which 32-bit floats cannot hold", node.index())
            }
            Self::NotFolded(node) => {
                write!(f, "node {} has constant arguments and was not folded", node.index())
            }
            Self::NotFlat(node) => write!(f, "node {} is not flat math", node.index()),
            Self::UnboundInput(node) => {
                write!(f, "node {} is a per-frame input without a uniform", node.index())
            }
            Self::IllTyped(node) => {
                write!(f, "node {} has arguments of the wrong type", node.index())
            }
            Self::BadLane(node) => {
                write!(f, "node {} takes a component that its vector lacks", node.index())
            }
            Self::MixedLimits(node) => {
                write!(f, "node {} has limits that ascend in some lanes only", node.index())
            }
            Self::Unsupported { target, what } => {
                write!(f, "{} has no {what}", target.name())
            }
            Self::BindingTooLarge { target, number } => {
                write!(f, "{} counts groups and bindings up to 255, not {number}", target.name())
            }
            Self::ViewBytes { expected, found } => {
                write!(f, "the view has {found} bytes, not the {expected} that the shader reads")
            }
            Self::Naga(text) => write!(f, "the shader was refused: {text}"),
        }
    }
}

impl std::error::Error for Error {}
