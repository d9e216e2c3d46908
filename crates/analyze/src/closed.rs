//! What of a scene rays meet without marching.
//!
//! From the root down through hard minima and maxima, sign changes and rigid or scaled samples, shapes that state
//! `hits` are asked where the ray is inside them; the ray is carried along by the same maps as the point. What a union
//! is made of falls into two parts: operands whose intervals are known, and those that are left to march. Intersections
//! and complements are known where all that they are made of is, and where they take few intervals.
//!
//! A floor in a smooth blend is nothing but a floor where all else is farther away than the blend reaches. So an operand without
//! end is met in closed form there, and the blend as a whole is marched around the rest.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{
    Arg, Blends, Bounds, Contract, Dim, ExpandError, Expander, Graph, MaterialRule, NodeId, Shape,
    ShapeId, SidePromise, blend_at,
};

use crate::fault::Rule;
use crate::form::{self, Form};
use crate::maps::Maps;
use crate::quality::Qualities;
use crate::sound::sound_field;
use crate::spans::{MOST, Span, complement, intersection, scaled};

/// A scene, taken apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    /// What rays meet without marching.
    pub closed: Vec<Closed>,
    /// What is left to march.
    pub open: Vec<Open>,
}

/// An operand of the union that the scene is, whose intervals are known.
#[derive(Clone, Debug)]
pub(crate) struct Closed {
    /// The shape.
    pub shape: ShapeId,
    /// Its sound field.
    pub value: NodeId,
    /// Where a ray is inside.
    pub spans: Vec<Span>,
    /// As of [`Open`].
    point: NodeId,
    scale: NodeId,
}

impl Parts {
    /// Leaves these of what is closed, by position, to be marched after all.
    pub(crate) fn march(&mut self, positions: &[usize]) {
        let (mut position, mut closed) = (0, Vec::new());
        for part in std::mem::take(&mut self.closed) {
            if positions.binary_search(&position).is_ok() {
                let Closed { shape, value, point, scale, .. } = part;
                self.open.push(Open { shape, value, around: shape, point, scale });
            } else {
                closed.push(part);
            }
            position += 1;
        }
        self.closed = closed;
    }
}

/// An operand that is left to march.
#[derive(Clone, Debug)]
pub(crate) struct Open {
    /// The shape.
    pub shape: ShapeId,
    /// Its sound field.
    pub value: NodeId,
    /// Outside of this it is nothing that is not closed.
    around: ShapeId,
    /// Where in the scene it is sampled, and by what its distance is multiplied.
    point: NodeId,
    scale: NodeId,
}

/// Takes a scene apart whose point is `point`, in terms of that of level 0, which is the origin of rays; their
/// direction is that of level 1.
pub(crate) fn parts(
    graph: &mut Graph,
    expander: &mut Expander,
    qualities: &Qualities,
    bounds: &mut Bounds,
    root: ShapeId,
    point: NodeId,
) -> Result<Parts, ExpandError> {
    let direction = graph.point(1, Dim::Three);
    let scale = graph.number(1.0);
    let mut pass = Pass { graph, expander, qualities, bounds, blends: Blends::default() };
    pass.shape(root, Place { point, direction, scale })
}

/// A shape outside of which nothing of some operands is left to march.
pub(crate) fn around(graph: &mut Graph, open: &[Open]) -> Option<ShapeId> {
    let mut values = Vec::with_capacity(open.len());
    for part in open {
        let sample = graph.sample(part.around, part.point);
        values.push(graph.mul(part.scale, sample));
    }
    let formula = least(graph, values)?;
    let children = open.iter().map(|part| part.around).collect();
    Some(unnamed(graph, formula, children))
}

/// The least of some values.
pub(crate) fn least(graph: &mut Graph, values: impl IntoIterator<Item = NodeId>) -> Option<NodeId> {
    values.into_iter().reduce(|a, b| graph.min(a, b))
}

/// Whether a shape's bounds are known on all sides.
pub(crate) fn has_end(graph: &mut Graph, bounds: &mut Bounds, shape: ShapeId) -> bool {
    let corners = bounds.of(graph, shape);
    corners.into_iter().all(|corner| graph.is_finite(corner))
}

/// A shape of the scene's own point that no one will see.
pub(crate) fn unnamed(graph: &mut Graph, formula: NodeId, mut children: Vec<ShapeId>) -> ShapeId {
    children.sort_unstable();
    children.dedup();
    let depth = children.iter().map(|&child| graph.shape(child).depth).max().unwrap_or(0);
    graph.add_shape(Shape {
        definition: "unnamed".to_owned(),
        dim: Dim::Three,
        level: 0,
        args: vec![Arg::Node(formula)],
        formula,
        contract: Contract::default(),
        hits: Vec::new(),
        material: MaterialRule::Shares(formula),
        children,
        depth: depth + 1,
        name: None,
    })
}

/// Where a shape is sampled, and the ray there. Lengths are multiplied by `scale` on the way back.
#[derive(Clone, Copy, Debug)]
struct Place {
    point: NodeId,
    direction: NodeId,
    scale: NodeId,
}

/// What a formula is made of.
enum Found {
    /// Operands of a union.
    Parts(Parts),
    /// Something else, of which it is known where a ray is inside.
    Spans(Vec<Span>),
}

/// A formula being looked at, in its own point, and the ray there.
struct Formula {
    maps: Maps,
    place: Place,
    /// Where a ray is inside a node, or inside its complement; `None` where that is not known.
    known: FxHashMap<(NodeId, bool), Option<Vec<Span>>>,
}

struct Pass<'a> {
    graph: &'a mut Graph,
    expander: &'a mut Expander,
    qualities: &'a Qualities,
    bounds: &'a mut Bounds,
    blends: Blends,
}

impl Pass<'_> {
    fn shape(&mut self, shape: ShapeId, place: Place) -> Result<Parts, ExpandError> {
        // Depth is the scene's nesting of shapes, which elaboration limits.
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.shape_here(shape, place))
    }

    fn shape_here(&mut self, shape: ShapeId, place: Place) -> Result<Parts, ExpandError> {
        if let Some(spans) = self.stated(shape, place)? {
            return self.closed(shape, place, spans);
        }
        let found = self.formula(shape, place)?;
        match found {
            Some(Found::Spans(spans)) => self.closed(shape, place, spans),
            Some(Found::Parts(parts)) if parts.open.is_empty() || self.is_free(shape) => Ok(parts),
            Some(Found::Parts(_)) | None => {
                let value = self.value(shape, place)?;
                let Place { point, scale, .. } = place;
                let (closed, around) = self.blended(shape, place)?.unwrap_or((Vec::new(), shape));
                Ok(Parts { closed, open: vec![Open { shape, value, around, point, scale }] })
            }
        }
    }

    /// Of a chain of blends with an operand without end whose intervals are known: that operand, and a shape outside of which
    /// the blend is nothing else.
    fn blended(
        &mut self,
        shape: ShapeId,
        place: Place,
    ) -> Result<Option<(Vec<Closed>, ShapeId)>, ExpandError> {
        let Shape { formula: root, dim, level, .. } = *self.graph.shape(shape);
        if dim != Dim::Three || level > 0 || has_end(self.graph, self.bounds, shape) {
            return Ok(None);
        }
        let mut formula = Formula { maps: Maps::new(level), place, known: FxHashMap::default() };
        let (mut node, mut chain) = (root, Vec::new());
        let closed = loop {
            let Some(blend) = blend_at(self.graph, &mut self.blends, node) else { return Ok(None) };
            let [a, b] = blend.values;
            if let Some(closed) = self.endless(&mut formula, a)? {
                chain.push((node, blend, b));
                break closed;
            }
            if let Some(closed) = self.endless(&mut formula, b)? {
                chain.push((node, blend, a));
                break closed;
            }
            let [before, operand] = blend.in_order(self.graph, &mut self.blends);
            chain.push((node, blend, operand));
            node = before;
        };
        let mut beside = Vec::with_capacity(chain.len());
        for (node, blend, operand) in chain {
            // Nearer than the blend is wide and deep it may be something else.
            let Some(depth) = blend.depth(self.graph, node) else { return Ok(None) };
            let reach = self.graph.add(blend.width, depth);
            let reach = if Rule::Reach.is_broken() { self.graph.number(0.0) } else { reach };
            beside.push(self.graph.sub(operand, reach));
        }
        let children = self.graph.shape(shape).children.clone();
        let around = least(self.graph, beside).map(|value| unnamed(self.graph, value, children));
        Ok(around.map(|around| (closed, around)))
    }

    /// A sample of what has no end, and is met without marching.
    fn endless(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
    ) -> Result<Option<Vec<Closed>>, ExpandError> {
        let Some(Parts { closed, open }) = self.sampled(formula, node)? else { return Ok(None) };
        let is_endless = open.is_empty()
            && !closed.iter().all(|part| has_end(self.graph, self.bounds, part.shape));
        Ok(is_endless.then_some(closed))
    }

    fn closed(
        &mut self,
        shape: ShapeId,
        place: Place,
        spans: Vec<Span>,
    ) -> Result<Parts, ExpandError> {
        let value = self.value(shape, place)?;
        let Place { point, scale, .. } = place;
        let closed = vec![Closed { shape, value, spans, point, scale }];
        Ok(Parts { closed, open: Vec::new() })
    }

    /// The sound field of a shape where it is sampled.
    fn value(&mut self, shape: ShapeId, place: Place) -> Result<NodeId, ExpandError> {
        let field = sound_field(self.graph, self.expander, self.qualities, shape, place.point)?;
        Ok(self.graph.mul(place.scale, field.distance))
    }

    /// The intervals that a shape states.
    fn stated(&mut self, shape: ShapeId, place: Place) -> Result<Option<Vec<Span>>, ExpandError> {
        let stated = self.graph.shape(shape).hits.clone();
        if stated.is_empty() {
            return Ok(None);
        }
        let mut spans = Vec::with_capacity(stated.len());
        for [enter, exit] in stated {
            let ray = [place.point, place.direction];
            let enter = self.expander.node(self.graph, enter, &ray)?;
            let exit = self.expander.node(self.graph, exit, &ray)?;
            spans.push([enter, exit]);
        }
        Ok(Some(scaled(self.graph, &spans, place.scale)))
    }

    /// Whether the parts of a union may be marched apart: nothing is stated that only holds of the whole.
    fn is_free(&self, shape: ShapeId) -> bool {
        let Contract { outside, inside, lipschitz, .. } = self.graph.shape(shape).contract;
        [outside, inside] == [SidePromise::default(); 2] && lipschitz.is_none()
    }

    /// What a shape's formula is made of; `None` if that is not known.
    fn formula(&mut self, shape: ShapeId, place: Place) -> Result<Option<Found>, ExpandError> {
        let Shape { formula: root, dim, level, .. } = *self.graph.shape(shape);
        if dim != Dim::Three || level > 0 {
            return Ok(None);
        }
        let mut formula = Formula { maps: Maps::new(level), place, known: FxHashMap::default() };
        let (mut parts, mut others) = (Parts::default(), Vec::new());
        let (mut seen, mut pending) = (FxHashSet::default(), vec![root]);
        while let Some(node) = pending.pop() {
            if !seen.insert(node) {
                continue;
            }
            if let Form::Least(a, b) = form::form(self.graph, node, &mut formula.maps) {
                pending.extend([b, a]);
            } else if let Some(found) = self.sampled(&mut formula, node)? {
                parts.closed.extend(found.closed);
                parts.open.extend(found.open);
            } else if let Some(spans) = self.spans(&mut formula, node, false)? {
                others.extend(spans);
            } else {
                return Ok(None);
            }
        }
        if others.is_empty() {
            return Ok(Some(Found::Parts(parts)));
        }
        others.extend(parts.closed.into_iter().flat_map(|part| part.spans));
        Ok(parts.open.is_empty().then_some(Found::Spans(others)))
    }

    /// Where a ray is inside a node of a formula, or inside its complement, in few intervals.
    fn spans(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
        negated: bool,
    ) -> Result<Option<Vec<Span>>, ExpandError> {
        if let Some(known) = formula.known.get(&(node, negated)) {
            return Ok(known.clone());
        }
        let spans = stacker::maybe_grow(64 * 1024, 1024 * 1024, || {
            self.spans_here(formula, node, negated)
        })?;
        let spans = spans.filter(|spans| spans.len() <= MOST);
        formula.known.insert((node, negated), spans.clone());
        Ok(spans)
    }

    fn spans_here(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
        negated: bool,
    ) -> Result<Option<Vec<Span>>, ExpandError> {
        let (a, b, is_union) = match form::form(self.graph, node, &mut formula.maps) {
            Form::Least(a, b) => (a, b, !negated),
            Form::Greatest(a, b) => (a, b, negated),
            Form::Negative(a) => return self.spans(formula, a, !negated),
            Form::Sampled(..) | Form::Scaled(..) => {
                let parts = self.sampled(formula, node)?.filter(|parts| parts.open.is_empty());
                let spans = parts.map(|parts| parts.closed.into_iter().flat_map(|part| part.spans));
                let Some(spans) = spans.map(Iterator::collect::<Vec<_>>) else { return Ok(None) };
                return Ok(if negated { complement(self.graph, &spans) } else { Some(spans) });
            }
            Form::Chosen(..) | Form::Whole => return Ok(None),
        };
        let Some(mut a) = self.spans(formula, a, negated)? else { return Ok(None) };
        let Some(b) = self.spans(formula, b, negated)? else { return Ok(None) };
        if !is_union {
            return Ok(intersection(self.graph, &a, &b));
        }
        a.extend(b);
        Ok(Some(a))
    }

    /// What a sample of a child at a rigid map of the point, or a scaled one, is made of; `None` for anything else.
    fn sampled(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
    ) -> Result<Option<Parts>, ExpandError> {
        let Formula { maps, place, .. } = formula;
        let (child, q, factor) = match form::form(self.graph, node, maps) {
            Form::Sampled(child, q) => (child, q, None),
            Form::Scaled(factor, child, q) if self.graph.range(factor).lo > 0.0 => {
                (child, q, Some(factor))
            }
            Form::Scaled(..)
            | Form::Least(..)
            | Form::Greatest(..)
            | Form::Negative(_)
            | Form::Chosen(..)
            | Form::Whole => return Ok(None),
        };
        // One that is built inside this formula sees this point too, not only the one where it is sampled.
        if self.graph.shape(child).level > 0 {
            return Ok(None);
        }
        let own_direction = self.graph.point(1, Dim::Three);
        let direction = maps.direction(self.graph, q, own_direction);
        let ray = [place.point, place.direction];
        let mut inner = Place {
            point: self.expander.node(self.graph, q, &ray)?,
            direction: self.expander.node(self.graph, direction, &ray)?,
            scale: place.scale,
        };
        if let Some(factor) = factor {
            let factor = self.expander.node(self.graph, factor, &ray)?;
            inner.direction = self.graph.mul(inner.direction, factor);
            inner.scale = self.graph.mul(place.scale, factor);
        }
        self.shape(child, inner).map(Some)
    }
}
