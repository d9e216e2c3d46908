//! `normal` and `view`: directions at a surface, which only materials can read.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::{Node, NodeId, SurfaceVector, reachable};

use super::elaborator::{Elaborator, Outcome};

impl Elaborator<'_> {
    /// Reports values outside of materials that depend on a direction at the surface: there is no
    /// surface yet where they are computed.
    pub(super) fn refuse_surface_vectors(&mut self, nodes: &[NodeId], span: Span) -> Outcome<()> {
        if !self.has_surface_vectors {
            return Ok(());
        }
        let vector = |id: NodeId| match self.graph.node(id) {
            Node::Point(level, _) => SurfaceVector::of_level(level),
            _ => None,
        };
        let Some(vector) = reachable(&self.graph, nodes).into_iter().find_map(vector) else {
            return Ok(());
        };
        let message = format!(
            "`{}` is known only in materials: in colours and the other properties of a surface",
            vector.name()
        );
        let help = match vector {
            SurfaceVector::Normal => {
                "in a formula, `gradient(a, p)` is the direction in which the distance of the shape `a` grows"
            }
            SurfaceVector::View => "the form of a shape cannot depend on where it is seen from",
        };
        Err(self.report(Diagnostic::error(Code::NOT_IN_MATERIAL, span, message).help(help)))
    }
}
