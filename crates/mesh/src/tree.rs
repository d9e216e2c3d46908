//! The octree: which cells are split, and which faces and edges its leaves have.

use rustc_hash::FxHashSet;

use crate::grid::{Cell, Corner, Edge, Face};

/// An octree without its empty leaves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    split: FxHashSet<Cell>,
    /// The cells that were split since [`Tree::take_news`] was called.
    news: Vec<Cell>,
    /// The leaves that may contain surface, in no order.
    pub(crate) leaves: Vec<Cell>,
    /// True if it is the quadtree of a flat grid: a cell is represented by its base.
    pub(crate) is_flat: bool,
}

/// A crossing of an edge, in the direction in which the sides of a face run.
#[derive(Clone, Copy, Debug)]
struct Passage {
    edge: Edge,
    is_leaving: bool,
}

/// A face whose edges are crossed in a way that no cell larger than the smallest may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tangled;

impl Tree {
    /// Returns an octree, or the quadtree of a flat grid, without cells.
    pub(crate) fn new(is_flat: bool) -> Self {
        Self { is_flat, ..Self::default() }
    }

    pub(crate) fn split(&mut self, cell: Cell) {
        self.split.insert(cell);
        self.news.push(cell);
    }

    /// Returns the cells that were split since the last call.
    pub(crate) fn take_news(&mut self) -> Vec<Cell> {
        std::mem::take(&mut self.news)
    }

    /// Returns the number of cells that are split.
    pub(crate) fn splits(&self) -> usize {
        self.split.len()
    }

    /// Returns the leaf below a cell that contains the smallest cell at a position.
    pub(crate) fn leaf_at(&self, mut cell: Cell, at: Corner) -> Cell {
        while self.split.contains(&cell) {
            let size = cell.size / 2;
            cell = Cell { at: at.map(|x| x - x % size), size };
        }
        cell
    }

    /// Calls `act` with the smallest faces that a face consists of.
    pub(crate) fn faces(&self, face: Face, act: &mut impl FnMut(Face)) {
        let is_split = |cell: &Option<Cell>| cell.is_some_and(|cell| self.split.contains(&cell));
        if face.size > 1 && face.cells().iter().any(is_split) {
            face.quarters().into_iter().for_each(|quarter| self.faces(quarter, act));
        } else {
            act(face);
        }
    }

    /// Calls `act` with the smallest faces of a leaf, with the base only in a quadtree. The flag
    /// tells if a face is on the upper side.
    pub(crate) fn faces_of(&self, cell: Cell, mut act: impl FnMut(Face, bool)) {
        if self.is_flat {
            return act(cell.base(), false);
        }
        for axis in 0..3 {
            for is_upper in [false, true] {
                self.faces(cell.side(axis, is_upper), &mut |face| act(face, is_upper));
            }
        }
    }

    /// Calls `act` with the smallest edges that an edge consists of.
    pub(crate) fn edges(&self, edge: Edge, act: &mut impl FnMut(Edge)) {
        if edge.size > 1 && edge.cells().any(|cell| self.split.contains(&cell)) {
            edge.halves().into_iter().for_each(|half| self.edges(half, act));
        } else {
            act(edge);
        }
    }

    /// Returns the chords in which the surface crosses a smallest face, each from an edge to an
    /// edge, with the inside on the left as seen from above.
    ///
    /// Where four edges are crossed, the inside is connected across the face.
    pub(crate) fn chords(
        &self,
        face: Face,
        is_inside: impl Fn(Corner) -> bool,
    ) -> Result<Chords, Tangled> {
        let mut passages = [None; 4];
        let mut count = 0;
        let mut is_tangled = false;
        for (side, is_reversed) in face.sides() {
            let before = count;
            self.edges(side, &mut |edge| {
                let [from, to] = edge.ends().map(&is_inside);
                if from != to {
                    if count == before && count < 4 {
                        passages[count] = Some(Passage { edge, is_leaving: from != is_reversed });
                        count += 1;
                    } else {
                        is_tangled = true;
                    }
                }
            });
        }
        if is_tangled {
            return Err(Tangled);
        }
        let mut chords = Chords::default();
        for i in 0..count {
            let (Some(from), Some(to)) = (passages[i], passages[(i + 1) % count]) else { continue };
            if from.is_leaving {
                chords.0[usize::from(chords.0[0].is_some())] = Some([from.edge, to.edge]);
            }
        }
        Ok(chords)
    }
}

/// At most two chords.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Chords([Option<[Edge; 2]>; 2]);

impl Chords {
    pub(crate) fn iter(&self) -> impl Iterator<Item = [Edge; 2]> {
        self.0.into_iter().flatten()
    }

    pub(crate) fn len(&self) -> usize {
        self.0.iter().flatten().count()
    }
}
