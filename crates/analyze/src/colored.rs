//! Which part of a region has a colour of its own.
//!
//! The coverage of a material is the weight of its colours: 0 where nothing states a colour, and
//! the alpha of a colour that is not opaque. In a planar picture these differ: a region without a
//! colour has the default one, and through a colour that is not opaque the layers below show.

use sdfc_graph::{
    ExpandError, Expander, Graph, MaterialField, MaterialRule, Node, NodeId, ShapeId,
};

/// Returns the weight of the parts of each shape that have a colour, whatever its alpha, at a
/// point. Returns nothing if all colours of the graph are opaque: then it is the coverage.
pub(crate) fn colored(
    graph: &mut Graph,
    shapes: &[ShapeId],
    point: NodeId,
) -> Result<Vec<NodeId>, ExpandError> {
    let ids: Vec<ShapeId> = graph.shape_ids().collect();
    let translucent: Vec<(ShapeId, [NodeId; 6])> =
        ids.into_iter().filter_map(|id| Some((id, translucent(graph, id)?))).collect();
    if translucent.is_empty() {
        return Ok(Vec::new());
    }
    let one = graph.number(1.0);
    for &(id, mut fields) in &translucent {
        fields[MaterialField::Coverage.index()] = one;
        graph.set_material(id, MaterialRule::Explicit(fields));
    }
    let mut expander = Expander::new();
    let mut weight = |graph: &mut Graph, &shape: &ShapeId| {
        let material = expander.material(graph, shape, point)?;
        Ok(material[MaterialField::Coverage.index()])
    };
    let weights = shapes.iter().map(|shape| weight(graph, shape)).collect();
    for (id, fields) in translucent {
        graph.set_material(id, MaterialRule::Explicit(fields));
    }
    weights
}

/// The material of a shape that states a colour which may not be opaque.
fn translucent(graph: &Graph, id: ShapeId) -> Option<[NodeId; 6]> {
    let MaterialRule::Explicit(fields) = graph.shape(id).material else { return None };
    let is_kept = matches!(graph.node(fields[MaterialField::Color.index()]), Node::MaterialAt(..));
    let is_opaque = graph.as_number(fields[MaterialField::Coverage.index()]) == Some(1.0);
    (!is_kept && !is_opaque).then_some(fields)
}
