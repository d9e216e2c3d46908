//! Dominator trees: which node all paths to a node lead through.

/// The tree so far, by position. The root is its own parent.
pub(crate) struct DominatorTree {
    parents: Vec<usize>,
    depths: Vec<u32>,
    /// An ancestor farther up (Myers, "An applicative random-access stack"), so that a search
    /// takes logarithmic time.
    jumps: Vec<usize>,
}

impl DominatorTree {
    /// A tree for `count` positions that holds only its root.
    pub(crate) fn new(count: usize, root: usize) -> Self {
        Self { parents: vec![root; count], depths: vec![0; count], jumps: vec![root; count] }
    }

    /// Adds a position under its parent, which must be in the tree.
    pub(crate) fn add(&mut self, position: usize, parent: usize) {
        let jump = self.jumps[parent];
        let is_even = self.depths[parent] - self.depths[jump]
            == self.depths[jump] - self.depths[self.jumps[jump]];
        self.parents[position] = parent;
        self.depths[position] = self.depths[parent] + 1;
        self.jumps[position] = if is_even { self.jumps[jump] } else { parent };
    }

    /// The parent of a position: its immediate dominator.
    pub(crate) fn parent(&self, position: usize) -> usize {
        self.parents[position]
    }

    /// The nearest common ancestor.
    pub(crate) fn common(&self, mut a: usize, mut b: usize) -> usize {
        if self.depths[a] < self.depths[b] {
            std::mem::swap(&mut a, &mut b);
        }
        while self.depths[a] > self.depths[b] {
            let far = self.jumps[a];
            a = if self.depths[far] >= self.depths[b] { far } else { self.parents[a] };
        }
        while a != b {
            let apart = self.jumps[a] != self.jumps[b];
            [a, b] = [a, b].map(|id| if apart { self.jumps[id] } else { self.parents[id] });
        }
        a
    }
}
