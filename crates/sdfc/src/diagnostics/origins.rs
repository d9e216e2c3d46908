//! Which call in a source made which shape.

use std::collections::VecDeque;

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::ShapeId;
use sdfc_lang::{Elaborated, Site};

/// Maps shapes to the calls that made them.
pub(super) struct Origins<'e> {
    calls: FxHashMap<ShapeId, &'e Site>,
    parents: FxHashMap<ShapeId, Vec<ShapeId>>,
}

impl<'e> Origins<'e> {
    pub(super) fn new(elaborated: &'e Elaborated) -> Self {
        let mut calls = FxHashMap::default();
        for site in &elaborated.sites {
            calls.entry(site.shape).or_insert(site);
        }
        let mut parents: FxHashMap<ShapeId, Vec<ShapeId>> = FxHashMap::default();
        let graph = &elaborated.scene.graph;
        for shape in graph.shape_ids() {
            for &child in &graph.shape(shape).children {
                parents.entry(child).or_default().push(shape);
            }
        }
        Self { calls, parents }
    }

    /// Returns the first call in the scene that made the shape itself.
    pub(super) fn call(&self, shape: ShapeId) -> Option<&'e Site> {
        self.calls.get(&shape).copied()
    }

    /// Returns the call that made the shape. For a shape that the library built, this is the call
    /// in the scene that made its nearest ancestor.
    pub(super) fn nearest_call(&self, shape: ShapeId) -> Option<&'e Site> {
        let mut seen = FxHashSet::default();
        let mut pending = VecDeque::from([shape]);
        while let Some(shape) = pending.pop_front() {
            if let Some(site) = self.call(shape) {
                return Some(site);
            }
            let parents = self.parents.get(&shape).into_iter().flatten();
            pending.extend(parents.copied().filter(|&parent| seen.insert(parent)));
        }
        None
    }
}
