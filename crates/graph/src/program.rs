//! A scene ready to be lowered: flat math over one point, without shapes.

use rustc_hash::FxHashMap;

use crate::FAR;
use crate::enclose::{slope_enclosure, tight_enclosure};
use crate::formulas::FormulaChoice;
use crate::graph::Graph;
use crate::guard::{Guard, guarded_field};
use crate::loops::SkipCondition;
use crate::node::{Dim, NodeId};
use crate::scene::{Param, Settings};
use crate::uniforms::uniforms;

/// Functions of a ray: what it hits without marching, and what is left to march.
///
/// The ray's origin is `Point(0, Dim::Three)`, its direction, of unit length,
/// `Point(1, Dim::Three)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rays {
    /// Distance along the ray to the first analytic hit, [`crate::FAR`] if there is none. `None`:
    /// everything is marched.
    pub first_hit: Option<NodeId>,
    /// Signed distance to the shapes that `first_hit` covers.
    pub analytic: Option<NodeId>,
    /// Signed distance to all other shapes; `None` if there are none. Ignored without `first_hit`:
    /// then `distance` of the program is marched.
    pub marched: Option<NodeId>,
    /// `[t_enter, t_leave]` of a box around everything that is marched; `t_enter > t_leave` if the
    /// ray misses the box. `None`: there is no box.
    pub clip: Option<NodeId>,
    /// `[t_hit, t_free]`: the first hit with the copies that are sampled at the ray's origin
    /// ([`crate::FAR`] if none), and the distance within which nothing else needs marching. `None`
    /// if this is not known for everything that is marched.
    pub copies: Option<NodeId>,
}

/// A loop whose iterations can be culled: a ray runs only those that can affect it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CullableLoop {
    /// The skip condition of the loop and of the loops that carry its derivatives.
    pub skip: SkipCondition,
    /// A vec3 of functions of the point and of the iteration index at depth 0, each 1-Lipschitz in
    /// the point.
    ///
    /// `x`: a lower bound on the distance to where the iteration can affect a ray; if it is
    /// positive all along a ray, the ray hits the same without this iteration. `y`: the operand
    /// minus the blend radius; where it exceeds another iteration's `z`, the loop's result is the
    /// same without this iteration. `z`: the operand. Bounds may take the place of the operand: a
    /// lower one in `x` and `y`, an upper one in `z`.
    pub culling_bounds: NodeId,
    /// Number of iterations.
    pub iterations: u32,
    /// True if only minima and blends lie between the loop and the field.
    pub is_union_operand: bool,
}

/// Flat math of one scene.
///
/// No `Sample` and no `MaterialAt` is reachable from any of the roots. The only point is
/// `Point(0, Dim::Three)`, except in `rays`, `range`, `slope_range`, `seen_material` and the
/// environment of the settings. In a planar program, whose shapes are regions, it is
/// `Point(0, Dim::Two)`, except in `planar_pixel`.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// The arena.
    pub graph: Graph,
    /// The scene position that the math's origin stands for. Settings are in scene coordinates.
    pub origin: [f64; 3],
    /// Signed distance, already divided by Lipschitz constants where needed. `None`: nothing is
    /// drawn.
    pub distance: Option<NodeId>,
    /// What the distance is likely to be, for soft shadows and ambient occlusion: `distance`
    /// without its divisions by Lipschitz constants, but nowhere less than it. `None` if that is
    /// `distance` itself, if nothing needs it, or if similar operands are loops.
    pub estimate: Option<NodeId>,
    /// True if `distance` may fall far behind the distance outside, and soft shadows should follow
    /// its gradients. False if there is an estimate, or if similar operands are loops.
    pub falls_behind: bool,
    /// Gradient of `distance`, a vector of the point's type.
    pub gradient: Option<NodeId>,
    /// What a pixel of a planar picture shows: linear red, green and blue, and the distance. The
    /// middle of the pixel is `Point(0, Dim::Two)`, its width and height are `Point(1, Dim::Two)`.
    /// `None`: rays draw the scene, which consists of solids.
    pub planar_pixel: Option<NodeId>,
    /// True if `distance` is divided by a large Lipschitz constant, so that a small value may be
    /// far from the surface.
    pub is_loose: bool,
    /// Functions of a ray that replace or restrict marching `distance`.
    pub rays: Rays,
    /// Lower and upper bound of [`Program::marched_field`] on the segment from
    /// `Point(0, Dim::Three)` to `Point(1, Dim::Three)`, a 2-vector; [`crate::FAR`] if nothing is
    /// marched. `None` unless [`Program::with_segment_bounds`] added it.
    pub range: Option<NodeId>,
    /// Lower and upper bound of the slope of `distance` on such a segment along the direction
    /// `Point(2, Dim::Three)`, a 2-vector. `None` unless [`Program::with_segment_bounds`] added it.
    pub slope_range: Option<NodeId>,
    /// Material fields in the order of `MaterialField::ALL`; `None` without materials. A direction
    /// at the surface is that of the gradient, as if the surface were seen from straight above.
    pub material: Option<[NodeId; 6]>,
    /// The same fields as functions of a surface that is seen: its point is `Point(0, Dim::Three)`,
    /// its normal `Point(1, Dim::Three)` and the direction to the eye `Point(2, Dim::Three)`, both
    /// of unit length. `None` if no field reads the last two.
    pub seen_material: Option<[NodeId; 6]>,
    /// Operands of unions that need not be evaluated everywhere.
    pub guards: Vec<Guard>,
    /// Loops whose iterations can be culled.
    pub cullable_loops: Vec<CullableLoop>,
    /// Corners of a box around the surfaces that loops are part of, known per frame. `None` where
    /// the scene's own bounds serve.
    pub loop_bounds: Option<[NodeId; 2]>,
    /// Per-frame nodes that per-point nodes or settings use. The CPU evaluates them; each has one
    /// uniform slot, in this order. See [`crate::uniforms`]: a per-frame `Splat` has no slot, its
    /// argument has.
    pub uniforms: Vec<NodeId>,
    /// Names for the generated shader source, from the script's `let`s and definitions.
    pub names: FxHashMap<NodeId, String>,
    /// The scene's params.
    pub params: Vec<Param>,
    /// The scene's settings; their nodes live in `graph`.
    pub settings: Settings,
}

impl Program {
    /// True if the program's shapes are regions, so that its picture has no rays.
    pub fn is_planar(&self) -> bool {
        self.planar_pixel.is_some()
    }

    /// The dimension of the points that the field is a function of.
    pub fn dim(&self) -> Dim {
        if self.is_planar() { Dim::Two } else { Dim::Three }
    }

    /// Signed distance to what rays have to be marched through after their pre-intersection; `None`
    /// if that is nothing.
    pub fn marched_field(&self) -> Option<NodeId> {
        if self.rays.first_hit.is_some() { self.rays.marched } else { self.distance }
    }

    /// The program with `range` if `value` is set and with `slope_range` if `slope` is set.
    /// Unchanged if there is no distance.
    pub fn with_segment_bounds(&self, value: bool, slope: bool) -> Self {
        let mut program = self.clone();
        let Some(distance) = self.distance else { return program };
        let graph = &mut program.graph;
        let [a, b, direction] = [0, 1, 2].map(|level| graph.point(level, Dim::Three));
        if value {
            let ends = match self.marched_field() {
                Some(marched) => tight_enclosure(graph, marched, a, [a, b]),
                None => Some([graph.number(FAR); 2]),
            };
            program.range = ends.map(|ends| graph.compose(&ends));
        }
        if slope {
            let ends = slope_enclosure(graph, distance, a, [a, b], direction);
            program.slope_range = ends.map(|ends| graph.compose(&ends));
        }
        program.uniforms = uniforms(&program.graph, &program.roots());
        program
    }

    /// The program with one of the formulas wherever a value has two.
    pub fn by_formulas(&self, choice: FormulaChoice) -> Self {
        let mut program = self.clone();
        let new = program.graph.choose_formulas(&self.roots(), choice);
        program.map_nodes(|id| new.get(id).unwrap_or(id));
        program
    }

    /// Replaces all nodes that [`Self::roots`] returns, and those that belong to them.
    fn map_nodes(&mut self, new: impl Fn(NodeId) -> NodeId) {
        let map = |node: &mut NodeId| *node = new(*node);
        let Rays { first_hit, analytic, marched, clip, copies } = &mut self.rays;
        let fields = [
            &mut self.distance,
            &mut self.estimate,
            &mut self.gradient,
            &mut self.planar_pixel,
            &mut self.range,
            &mut self.slope_range,
            first_hit,
            analytic,
            marched,
            clip,
            copies,
        ];
        fields.into_iter().flatten().for_each(map);
        let materials = [&mut self.material, &mut self.seen_material];
        materials.into_iter().flatten().flatten().for_each(map);
        for guard in &mut self.guards {
            [&mut guard.operand, &mut guard.bound].into_iter().for_each(map);
        }
        for looped in &mut self.cullable_loops {
            looped.skip = looped.skip.map(&new);
            map(&mut looped.culling_bounds);
        }
        let names = std::mem::take(&mut self.names);
        self.names = names.into_iter().map(|(node, name)| (new(node), name)).collect();
    }

    /// The program with fields that have the same values, but evaluate a guarded operand only where
    /// its bound is less than all operands before it. Shaders do that by branches.
    ///
    /// The gradient and the materials stay: they are evaluated once for each ray.
    pub fn guarded(&self) -> Self {
        let mut program = self.clone();
        let graph = &mut program.graph;
        for field in [&mut program.distance, &mut program.rays.marched].into_iter().flatten() {
            *field = guarded_field(graph, *field, &self.guards);
        }
        program
    }

    /// All nodes that a shader of the program computes per point, and the exposure.
    pub fn roots(&self) -> Vec<NodeId> {
        // Destructured so that a new function does not compile until it is handled here.
        let Rays { first_hit, analytic, marched, clip, copies } = self.rays;
        let fields = [self.distance, self.estimate, self.gradient, self.range, self.slope_range];
        let rays = [first_hit, analytic, marched, clip, copies];
        let material = self.material.into_iter().chain(self.seen_material).flatten();
        let culling_bounds = self.cullable_loops.iter().map(|cullable| cullable.culling_bounds);
        let exposure = self.settings.exposure.and_then(|exposure| exposure.factor);
        let environment = self.settings.environment;
        let environment = environment.into_iter().flat_map(|it| [it.radiance, it.irradiance]);
        let singles = [exposure, self.planar_pixel];
        let single = fields.into_iter().chain(rays).chain(singles).flatten();
        let guards = self.guards.iter().map(|guard| guard.bound);
        single.chain(environment).chain(material).chain(culling_bounds).chain(guards).collect()
    }
}
