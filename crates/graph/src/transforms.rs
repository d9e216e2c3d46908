//! A pass that folds chains of affine maps into one map.
//!
//! A node is the *head* of a cone if an operation that is not affine, or several cones, use it. The
//! affine operations that only lead to one head form its *cone*. A cone computes a matrix times up
//! to three numbers (most often the components of one vector) plus an offset. The coefficients do
//! not depend on the point. The cheapest form of that map replaces the cone if it is cheaper:
//!
//! - selected and scaled components, and an offset: translations, scales, rotations by right
//!   angles;
//! - sums of scaled components, row by row: rotations about one axis;
//! - a `Transform` and an offset: everything else.
//!
//! Costs count scalar operations; a `Transform` counts 9, since its additions fuse with its
//! multiplications. A shared node is a head, hence computed once and never folded into its uses.

mod affine;
mod cone;
mod emit;

use rustc_hash::FxHashMap;

use self::affine::Affine;
use self::cone::Cones;
use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::{Node, NodeId, Stage};
use crate::walk::reachable;

/// The roots after a pass, and the map from old to new nodes.
#[derive(Clone, Debug, Default)]
pub struct Rewritten {
    /// The new roots, in the order of the old ones.
    pub roots: Vec<NodeId>,
    nodes: IdMap<NodeId>,
}

impl Rewritten {
    /// Names of the old nodes, transferred to the new ones. Constants and points have none.
    pub fn names(
        &self,
        graph: &Graph,
        names: &FxHashMap<NodeId, String>,
    ) -> FxHashMap<NodeId, String> {
        let mut old: Vec<(&NodeId, &String)> = names.iter().collect();
        old.sort_unstable();
        let mut renamed = FxHashMap::default();
        for (id, name) in old {
            let new = self.nodes.get(*id);
            if let Some(new) = new.filter(|&new| !matches!(graph.node(new), Node::Point(..))) {
                renamed.entry(new).or_insert_with(|| name.clone());
            }
        }
        renamed
    }
}

/// Replaces every chain of affine maps of one vector by one map, where that takes fewer operations.
/// Best done before the gradient is derived, which then uses the one map too.
///
/// ```
/// use sdfc_graph::{Dim, Graph, Type, dump, fold_transforms};
///
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let (by, two) = (graph.constant(Type::Vec3, &[1.0, 2.0, 3.0]), graph.number(2.0));
/// let moved = graph.sub(p, by);
/// let scaled = graph.mul(moved, two);
/// let back = graph.add(scaled, by);
/// let field = graph.unary(sdfc_graph::Unary::Normalize, back);
/// let folded = fold_transforms(&mut graph, &[field]);
/// assert_eq!(
///     dump(&graph, &[("field", folded.roots[0])]),
///     "%0 = point 0 : vec3\n\
///      %1 = mul %0 [2, 2, 2] : vec3\n\
///      %2 = sub %1 [1, 2, 3] : vec3\n\
///      %3 = normalize %2 : vec3\n\
///      field = %3\n"
/// );
/// ```
pub fn fold_transforms(graph: &mut Graph, roots: &[NodeId]) -> Rewritten {
    let order = reachable(graph, roots);
    let cones = Cones::new(graph, &order, roots);
    let mut pass = Pass { graph, cones, forms: FxHashMap::default(), new: IdMap::default() };
    for id in order {
        pass.visit(id);
    }
    let Pass { new, .. } = pass;
    let roots = roots.iter().map(|root| new.get(*root).unwrap_or(*root)).collect();
    Rewritten { roots, nodes: new }
}

struct Pass<'a> {
    graph: &'a mut Graph,
    cones: Cones,
    /// The forms of old nodes, over old atoms; only in cones of more than one operation.
    forms: FxHashMap<NodeId, Affine>,
    new: IdMap<NodeId>,
}

impl Pass<'_> {
    fn visit(&mut self, id: NodeId) {
        if self.graph.stage(id) < Stage::Point {
            self.new.insert(id, id);
            return;
        }
        let form = self.form(id);
        if let Some(form) = form {
            self.forms.insert(id, form);
        }
        let folded = form.filter(|_| self.cones.is_head(id)).and_then(|form| self.fold(id, form));
        let new = folded.unwrap_or_else(|| {
            let new = &self.new;
            self.graph.rebuild(id, |old| new.get(old).unwrap_or(old))
        });
        self.new.insert(id, new);
    }

    /// The affine form of a node, over the inputs of its cone; `None` if the cone is not worth
    /// folding.
    fn form(&mut self, id: NodeId) -> Option<Affine> {
        if !self.cones.is_worth_folding(id) {
            return None;
        }
        let (cones, forms) = (&self.cones, &self.forms);
        affine::form(self.graph, id, |graph, argument| {
            if cones.is_head(argument) {
                affine::base(graph, argument)
            } else {
                forms.get(&argument).copied()
            }
        })
    }

    /// Builds the cheapest form of a head, if it is cheaper than its cone.
    fn fold(&mut self, id: NodeId, form: Affine) -> Option<NodeId> {
        let form = form.sorted(self.graph)?;
        let plan = emit::plan(&form)?;
        if plan.cost >= self.cones.cost(id) {
            return None;
        }
        let atoms: Option<Vec<NodeId>> =
            form.atoms.into_iter().flatten().map(|atom| self.new_atom(atom)).collect();
        Some(plan.build(self.graph, &atoms?))
    }

    /// The new node of an atom: components are taken from the new node of their vector.
    fn new_atom(&mut self, atom: NodeId) -> Option<NodeId> {
        if let Node::Swizzle(_, vector, lanes) = self.graph.node(atom) {
            let vector = self.new.get(vector)?;
            return Some(self.graph.component(vector, lanes[0]));
        }
        self.new.get(atom)
    }
}
