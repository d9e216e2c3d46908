//! Why a program cannot become a shader.

use std::fmt;

use sdfc_graph::NodeId;

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
    /// The shader does not validate, or a writer refused it; naga's own words.
    Naga(String),
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
            Self::Naga(text) => write!(f, "the shader was refused: {text}"),
        }
    }
}

impl std::error::Error for Error {}
