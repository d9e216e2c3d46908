//! A scene ready to be lowered: flat math over one point, nothing left to look up.

use rustc_hash::FxHashMap;

use crate::{Dim, Graph, Inert, NodeId, Param, Settings, enclosure, slope_enclosure, uniforms};

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
    /// Of a ray: a vector of where it is first inside of what is sampled at its origin, [`crate::FAR`] for nowhere, and of how far
    /// from the origin nothing else is left to march. `None`: that is not known of all that is left.
    pub copies: Option<NodeId>,
}

/// A loop of which rays visit only the rounds that can matter to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Visit {
    /// What the loop, and those that carry derivatives of it, say of their rounds.
    pub inert: Inert,
    /// Three numbers over the round's variable of depth 0, none of which changes by more than the point moves. How far a point is
    /// from where the round can matter to a ray, or less: where this is above 0 all along a ray, the ray meets the same without the
    /// round. The round's operand, and before it the operand less what blends reach: where that is above the operand of another
    /// round, the loop's result is the same without this one.
    pub ends: NodeId,
    /// How many rounds there are.
    pub rounds: u32,
    /// Whether all between the loop and the field are minima and blends.
    pub is_joined: bool,
}

/// Flat math of one scene. No `Sample`, no `MaterialAt` is reachable from any of the roots;
/// the only point is `Point(0, Dim::Three)`, but for `range` and `slope_range`.
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
    /// The least and the greatest of `distance` on the stretch from `Point(0, Dim::Three)` to `Point(1, Dim::Three)`, a
    /// 2-vector; `None` unless [`Program::enclosed`].
    pub range: Option<NodeId>,
    /// The least and the greatest slope of `distance` on such a stretch along `Point(2, Dim::Three)`, a 2-vector; `None`
    /// unless [`Program::enclosed`].
    pub slope_range: Option<NodeId>,
    /// Material fields in the order of `MaterialField::ALL`; `None` without materials.
    pub material: Option<[NodeId; 6]>,
    /// Loops of which not all rounds need be visited.
    pub visits: Vec<Visit>,
    /// Corners of a box around the surfaces that loops are part of, known per frame, where the scene's own bounds are not that.
    pub within: Option<[NodeId; 2]>,
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

impl Program {
    /// The program with `range`, with `slope_range`, or with both. Nothing changes where there is no distance.
    pub fn enclosed(&self, range: bool, slope: bool) -> Self {
        let mut program = self.clone();
        let Some(distance) = self.distance else { return program };
        let graph = &mut program.graph;
        let [a, b, direction] = [0, 1, 2].map(|level| graph.point(level, Dim::Three));
        if range {
            let ends = enclosure(graph, distance, a, [a, b]);
            program.range = ends.map(|ends| graph.compose(&ends));
        }
        if slope {
            let ends = slope_enclosure(graph, distance, a, [a, b], direction);
            program.slope_range = ends.map(|ends| graph.compose(&ends));
        }
        program.uniforms = uniforms(&program.graph, &program.roots());
        program
    }

    /// Everything that a shader of the program computes at its points.
    pub fn roots(&self) -> Vec<NodeId> {
        // Taken apart so that a new function does not compile until it is thought of here.
        let Rays { hits, closed, marched, clip, copies } = self.rays;
        let fields = [self.distance, self.gradient, self.range, self.slope_range];
        let rays = [hits, closed, marched, clip, copies];
        let material = self.material.into_iter().flatten();
        let visits = self.visits.iter().map(|visit| visit.ends);
        fields.into_iter().chain(rays).flatten().chain(material).chain(visits).collect()
    }
}
