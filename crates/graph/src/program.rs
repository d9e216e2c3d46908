//! A scene ready to be lowered: flat math over one point, nothing left to look up.

use rustc_hash::FxHashMap;

use crate::{Graph, NodeId, Param, Settings};

/// What of a scene rays meet without marching, and what is left to march. Functions of a ray have its origin as
/// `Point(0, Dim::Three)` and its direction, of unit length, as `Point(1, Dim::Three)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rays {
    /// Of a ray: where it is first inside what needs no march, [`crate::FAR`] for nowhere. `None`: all is marched.
    pub hits: Option<NodeId>,
    /// Signed distance to what `hits` is about.
    pub closed: Option<NodeId>,
    /// Signed distance to all else; `None`: nothing is left. Without `hits` that is `distance`, whatever stands here.
    pub marched: Option<NodeId>,
    /// Of a ray: a vector of where it enters and leaves a box around what is left to march, the first above
    /// the second where it misses the box. `None`: there is no box.
    pub clip: Option<NodeId>,
}

/// Flat math of one scene. No `Sample`, no `MaterialAt` is reachable from any of the roots;
/// the only point is `Point(0, Dim::Three)`.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// The arena.
    pub graph: Graph,
    /// Where in the scene the point of its math is 0. Settings are in the scene's own coordinates.
    pub origin: [f64; 3],
    /// Signed distance, already divided where it must be. `None`: nothing is drawn.
    pub distance: Option<NodeId>,
    /// Spatial gradient of `distance`, a 3-vector.
    pub gradient: Option<NodeId>,
    /// How rays meet it other than by marching `distance`.
    pub rays: Rays,
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
