//! What of a scene rays meet without marching.
//!
//! From the root down through hard minima and maxima, sign changes and rigid or scaled samples, shapes that state
//! `intersect` are asked where the ray is inside them; the ray is carried along by the same maps as the point. What a union
//! is made of falls into two parts: operands whose intervals are known, and those that are left to march. Intersections
//! and complements are known where all that they are made of is, and where they take few intervals.
//!
//! A floor in a smooth blend is nothing but a floor where all else is farther away than the blend reaches. So an operand without
//! end is met in closed form there, and the blend as a whole is marched around the rest.
//!
//! Of copies without end only few are sampled at a place, and known in closed form as far from there as nothing else is (`repetition.rs`).
//! So what is made of them is left to march, and known there all the same.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{
    Arg, Blends, Bounds, Contract, Dim, ExpandError, Expander, Graph, MaterialRule, NodeId, Shape,
    ShapeId, SidePromise, blend_at,
};

use crate::analytic::intervals::{Known, complement, intersection, joined, scaled};
use crate::certify::conservative::conservative_field;
use crate::certify::descent::{Form, form};
use crate::certify::maps::Maps;
use crate::certify::quality::Qualities;

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
    pub known: Known,
    /// As of [`Open`].
    point: NodeId,
    scale: NodeId,
}

impl Closed {
    fn marched(self) -> Open {
        let Self { shape, value, known, point, scale } = self;
        let near = known.reach.is_some().then_some(known);
        Open { shape, value, near, around: shape, point, scale }
    }
}

impl Parts {
    /// Leaves these of what is closed, by position, to be marched after all.
    pub(crate) fn march(&mut self, positions: &[usize]) {
        let (mut position, mut closed) = (0, Vec::new());
        for part in std::mem::take(&mut self.closed) {
            if positions.binary_search(&position).is_ok() {
                self.open.push(part.marched());
            } else {
                closed.push(part);
            }
            position += 1;
        }
        self.closed = closed;
    }

    /// As it is met: what is known only as far as nothing else is near is left to march.
    fn met(self) -> Self {
        let is_near = |part: &Closed| part.known.reach.is_some();
        let (near, closed): (Vec<_>, Vec<_>) = self.closed.into_iter().partition(is_near);
        let open = self.open.into_iter().chain(near.into_iter().map(Closed::marched)).collect();
        Self { closed, open }
    }
}

/// An operand that is left to march.
#[derive(Clone, Debug)]
pub(crate) struct Open {
    /// The shape.
    pub shape: ShapeId,
    /// Its sound field.
    pub value: NodeId,
    /// Where a ray is inside, as far from the ray's origin as that is known.
    pub near: Option<Known>,
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
    let place = Place { outer: Vec::new(), point, direction, scale };
    pass.shape(root, &place).map(Parts::met)
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
        intersect: Vec::new(),
        material: MaterialRule::Weighted(formula),
        children,
        depth: depth + 1,
        name: None,
    })
}

/// Where a shape is sampled, and the ray there. Lengths are multiplied by `scale` on the way back.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// The points of the formulas around it, of copies that are built anew at each: all at the ray's origin.
    pub(super) outer: Vec<NodeId>,
    pub(super) point: NodeId,
    pub(super) direction: NodeId,
    pub(super) scale: NodeId,
}

impl Place {
    /// What points stand for in a formula there, and in the one of a ray.
    pub(super) fn points(&self) -> Vec<NodeId> {
        [&self.outer[..], &[self.point, self.direction]].concat()
    }

    /// Whether a shape of that level sees these points around it.
    pub(super) fn is_of(&self, level: u16) -> bool {
        usize::from(level) == self.outer.len()
    }
}

/// What a formula is made of.
enum Found {
    /// Operands of a union.
    Parts(Parts),
    /// Something else, of which it is known where a ray is inside.
    Known(Known),
}

/// A formula being looked at, in its own point, and the ray there.
struct Formula {
    maps: Maps,
    place: Place,
    /// Where a ray is inside a node, or inside its complement; `None` where that is not known.
    known: FxHashMap<(NodeId, bool), Option<Known>>,
}

pub(super) struct Pass<'a> {
    pub(super) graph: &'a mut Graph,
    pub(super) expander: &'a mut Expander,
    qualities: &'a Qualities,
    bounds: &'a mut Bounds,
    blends: Blends,
}

impl Pass<'_> {
    pub(super) fn shape(&mut self, shape: ShapeId, place: &Place) -> Result<Parts, ExpandError> {
        // Depth is the scene's nesting of shapes, which elaboration limits.
        stacker::maybe_grow(64 * 1024, 1024 * 1024, || self.shape_here(shape, place))
    }

    fn shape_here(&mut self, shape: ShapeId, place: &Place) -> Result<Parts, ExpandError> {
        if let Some(known) = self.stated(shape, place)? {
            return self.closed(shape, place, known);
        }
        if let Some(known) = self.copies(shape, place)? {
            return self.closed(shape, place, known);
        }
        let found = self.formula(shape, place)?;
        match found {
            Some(Found::Known(known)) => self.closed(shape, place, known),
            Some(Found::Parts(parts)) if parts.open.is_empty() || self.is_free(shape) => Ok(parts),
            Some(Found::Parts(_)) | None => {
                let value = self.value(shape, place)?;
                let Place { point, scale, .. } = *place;
                let (closed, around) = self.blended(shape, place)?.unwrap_or((Vec::new(), shape));
                let open = vec![Open { shape, value, near: None, around, point, scale }];
                Ok(Parts { closed, open })
            }
        }
    }

    /// Of a chain of blends with an operand without end whose intervals are known: that operand, and a shape outside of which
    /// the blend is nothing else.
    fn blended(
        &mut self,
        shape: ShapeId,
        place: &Place,
    ) -> Result<Option<(Vec<Closed>, ShapeId)>, ExpandError> {
        let Shape { formula: root, dim, level, .. } = *self.graph.shape(shape);
        let is_own = level == 0 && place.is_of(level);
        if dim != Dim::Three || !is_own || has_end(self.graph, self.bounds, shape) {
            return Ok(None);
        }
        let mut formula =
            Formula { maps: Maps::new(level), place: place.clone(), known: FxHashMap::default() };
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
            let [before, operand] = blend.ordered_values(self.graph, &mut self.blends);
            chain.push((node, blend, operand));
            node = before;
        };
        let mut beside = Vec::with_capacity(chain.len());
        for (node, blend, operand) in chain {
            // Nearer than the blend is wide and deep it may be something else.
            let Some(depth) = blend.depth(self.graph, node) else { return Ok(None) };
            let reach = self.graph.add(blend.width, depth);
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
            && closed.iter().all(|part| part.known.reach.is_none())
            && !closed.iter().all(|part| has_end(self.graph, self.bounds, part.shape));
        Ok(is_endless.then_some(closed))
    }

    fn closed(
        &mut self,
        shape: ShapeId,
        place: &Place,
        known: Known,
    ) -> Result<Parts, ExpandError> {
        let value = self.value(shape, place)?;
        let Place { point, scale, .. } = *place;
        let closed = vec![Closed { shape, value, known, point, scale }];
        Ok(Parts { closed, open: Vec::new() })
    }

    /// The sound field of a shape where it is sampled; of what is built anew at each point no one asks it, and it is nothing.
    fn value(&mut self, shape: ShapeId, place: &Place) -> Result<NodeId, ExpandError> {
        if !place.outer.is_empty() {
            return Ok(place.scale);
        }
        let field =
            conservative_field(self.graph, self.expander, self.qualities, shape, place.point)?;
        Ok(self.graph.mul(place.scale, field.distance))
    }

    /// The intervals that a shape states.
    fn stated(&mut self, shape: ShapeId, place: &Place) -> Result<Option<Known>, ExpandError> {
        let Shape { intersect: stated, level, .. } = self.graph.shape(shape);
        if stated.is_empty() || !place.is_of(*level) {
            return Ok(None);
        }
        let (stated, ray) = (stated.clone(), place.points());
        let mut spans = Vec::with_capacity(stated.len());
        for [enter, exit] in stated {
            let enter = self.expander.node(self.graph, enter, &ray)?;
            let exit = self.expander.node(self.graph, exit, &ray)?;
            spans.push([enter, exit]);
        }
        let spans = scaled(self.graph, &spans, place.scale);
        Ok(Some(Known { spans, reach: None }))
    }

    /// Whether the parts of a union may be marched apart: nothing is stated that only holds of the whole.
    fn is_free(&self, shape: ShapeId) -> bool {
        let Contract { outside, inside, lipschitz, .. } = self.graph.shape(shape).contract;
        [outside, inside] == [SidePromise::default(); 2] && lipschitz.is_none()
    }

    /// What a shape's formula is made of; `None` if that is not known.
    fn formula(&mut self, shape: ShapeId, place: &Place) -> Result<Option<Found>, ExpandError> {
        let Shape { formula: root, dim, level, .. } = *self.graph.shape(shape);
        if dim != Dim::Three || !place.is_of(level) {
            return Ok(None);
        }
        let mut formula =
            Formula { maps: Maps::new(level), place: place.clone(), known: FxHashMap::default() };
        let (mut parts, mut others) = (Parts::default(), Vec::new());
        let (mut seen, mut pending) = (FxHashSet::default(), vec![root]);
        while let Some(node) = pending.pop() {
            if !seen.insert(node) {
                continue;
            }
            if let Form::Least(a, b) = form(self.graph, node, &mut formula.maps) {
                pending.extend([b, a]);
            } else if let Some(found) = self.sampled(&mut formula, node)? {
                parts.closed.extend(found.closed);
                parts.open.extend(found.open);
            } else if let Some(known) = self.spans(&mut formula, node, false)? {
                others.push(known);
            } else {
                return Ok(None);
            }
        }
        if others.is_empty() {
            return Ok(Some(Found::Parts(parts)));
        }
        others.extend(parts.closed.into_iter().map(|part| part.known));
        Ok(parts.open.is_empty().then(|| Found::Known(joined(self.graph, others))))
    }

    /// Where a ray is inside a node of a formula, or inside its complement, in few intervals.
    fn spans(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
        negated: bool,
    ) -> Result<Option<Known>, ExpandError> {
        if let Some(known) = formula.known.get(&(node, negated)) {
            return Ok(known.clone());
        }
        let spans = stacker::maybe_grow(64 * 1024, 1024 * 1024, || {
            self.spans_here(formula, node, negated)
        })?;
        let spans = spans.filter(Known::is_short);
        formula.known.insert((node, negated), spans.clone());
        Ok(spans)
    }

    fn spans_here(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
        negated: bool,
    ) -> Result<Option<Known>, ExpandError> {
        let (a, b, is_union) = match form(self.graph, node, &mut formula.maps) {
            Form::Least(a, b) => (a, b, !negated),
            Form::Greatest(a, b) => (a, b, negated),
            Form::Negative(a) => return self.spans(formula, a, !negated),
            Form::Sampled(..) | Form::Scaled(..) => {
                let parts = self.sampled(formula, node)?.filter(|parts| parts.open.is_empty());
                let Some(parts) = parts else { return Ok(None) };
                let known = parts.closed.into_iter().map(|part| part.known).collect();
                let known = joined(self.graph, known);
                return Ok(if negated { complement(self.graph, &known) } else { Some(known) });
            }
            Form::Chosen(..) | Form::Whole => return Ok(None),
        };
        let Some(a) = self.spans(formula, a, negated)? else { return Ok(None) };
        let Some(b) = self.spans(formula, b, negated)? else { return Ok(None) };
        if !is_union {
            return Ok(intersection(self.graph, &a, &b));
        }
        Ok(Some(joined(self.graph, vec![a, b])))
    }

    /// What a sample of a child at a rigid map of the point, or a scaled one, is made of; `None` for anything else.
    fn sampled(
        &mut self,
        formula: &mut Formula,
        node: NodeId,
    ) -> Result<Option<Parts>, ExpandError> {
        let Formula { maps, place, .. } = formula;
        let (child, q, factor) = match form(self.graph, node, maps) {
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
        let level = usize::from(self.graph.shape(child).level);
        if level > place.outer.len() {
            return Ok(None);
        }
        let own_direction = self.graph.point(maps.level() + 1, Dim::Three);
        let direction = maps.direction(self.graph, q, own_direction);
        let points = place.points();
        let mut inner = Place {
            outer: place.outer[..level].to_vec(),
            point: self.expander.node(self.graph, q, &points)?,
            direction: self.expander.node(self.graph, direction, &points)?,
            scale: place.scale,
        };
        if let Some(factor) = factor {
            let factor = self.expander.node(self.graph, factor, &points)?;
            inner.direction = self.graph.mul(inner.direction, factor);
            inner.scale = self.graph.mul(place.scale, factor);
        }
        self.shape(child, &inner).map(Some)
    }
}
