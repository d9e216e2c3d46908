//! A scene ready to be lowered: flat math over one point, nothing left to look up.

use rustc_hash::FxHashMap;

use crate::{Graph, NodeId, Param, Settings};

/// Flat math of one scene. No `Sample`, no `MaterialAt` is reachable from any of the roots;
/// the only point is `Point(0, Dim::Three)`.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// The arena.
    pub graph: Graph,
    /// Signed distance, already divided where it must be. `None`: nothing is drawn.
    pub distance: Option<NodeId>,
    /// Spatial gradient of `distance`, a 3-vector.
    pub gradient: Option<NodeId>,
    /// Material fields in the order of `MaterialField::ALL`; `None` without materials.
    pub material: Option<[NodeId; 6]>,
    /// Per-frame nodes that per-point nodes or settings use: evaluated on the CPU, one uniform slot each,
    /// in this order. As [`crate::uniforms`] lists them: a per-frame `Splat` has none, its argument has.
    pub uniforms: Vec<NodeId>,
    /// Names for the generated text, from the script's `let`s and definitions.
    pub names: FxHashMap<NodeId, String>,
    /// The scene's params.
    pub params: Vec<Param>,
    /// The scene's settings; their nodes live in `graph`.
    pub settings: Settings,
}
