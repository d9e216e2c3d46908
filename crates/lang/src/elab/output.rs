//! The result of elaboration.

use sdfc_diagnostics::Span;
use sdfc_graph::{LipschitzClaim, NodeId, Scene, ShapeId};

/// A scene's graph, and where its parts are in the source.
#[derive(Clone, Debug, Default)]
pub struct Elaborated {
    /// Shapes, formulas, params and settings.
    pub scene: Scene,
    /// The calls that built shapes, in the order of elaboration. Equal shapes share an instance, so
    /// an instance can have several sites.
    pub sites: Vec<Site>,
    /// Literals that are params: none unless [`crate::Options::live_literals`] is set.
    pub live_literals: Vec<LiveLiteral>,
    /// The scene with its literals as constants, if there are live literals. Its params come first
    /// in `scene`.
    pub as_written: Option<Box<Scene>>,
    /// The shapes that the scene and its imports declare, with the spans of their clauses.
    pub declared: Vec<Declared>,
    /// The Lipschitz constants that the scene's functions state, by call.
    pub claims: Vec<Claimed>,
}

/// The result of a call of a function that states a Lipschitz constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claimed {
    /// The span of the clause.
    pub span: Span,
    /// The result of the call.
    pub value: NodeId,
    /// The stated constant and the arguments it is about.
    pub claim: LipschitzClaim,
}

/// A declared shape and the spans of its clauses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declared {
    /// The name of its definition, which its instances have in the graph.
    pub definition: String,
    /// The clauses `exact` and `bound`.
    pub promises: Vec<DeclaredPromise>,
    /// The clause `lipschitz`.
    pub lipschitz: Option<Span>,
    /// The clause `bounds`.
    pub bounds: Option<Span>,
    /// The clause `intersect`.
    pub intersect: Option<Span>,
    /// The clause `copies`.
    pub copies: Option<Span>,
}

/// A clause `exact` or `bound`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredPromise {
    /// True for `exact`, false for `bound`.
    pub exact: bool,
    /// True if it is about the outside.
    pub outside: bool,
    /// True if it is about the inside.
    pub inside: bool,
    /// The span of the clause.
    pub span: Span,
}

/// A literal of the scene that became a param, see [`crate::live_literals`].
#[derive(Clone, Debug, PartialEq)]
pub struct LiveLiteral {
    /// The span of the literal.
    pub span: Span,
    /// Its value in the source.
    pub value: f64,
    /// The index of its param.
    pub param: usize,
}

/// A call in the scene's own files that built a shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Site {
    /// The instance.
    pub shape: ShapeId,
    /// The span of the call. For a shape that the library builds, it is the scene's call of the
    /// library entry.
    pub span: Span,
    /// The name of the definition.
    pub name: String,
}
