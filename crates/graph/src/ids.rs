//! Sets and maps keyed by node ids. They are split into pages, so that they are as fast as arrays
//! and only as large as what they hold.

use crate::node::NodeId;

const SET_PAGE: usize = 1024;
const MAP_PAGE: usize = 64;

/// A set of nodes of one arena.
#[derive(Clone, Debug, Default)]
pub struct IdSet {
    pages: Vec<Option<Box<[u64; SET_PAGE / 64]>>>,
    /// Indices of the allocated pages: a small set in a large arena has few.
    used: Vec<usize>,
}

impl IdSet {
    /// Adds a node. Returns true if it was not there before.
    pub fn insert(&mut self, id: NodeId) -> bool {
        let (page, bit) = (id.index() / SET_PAGE, id.index() % SET_PAGE);
        if self.pages.len() <= page {
            self.pages.resize(page + 1, None);
        }
        let used = &mut self.used;
        let words = self.pages[page].get_or_insert_with(|| {
            used.push(page);
            Box::default()
        });
        let (word, bit) = (&mut words[bit / 64], 1 << (bit % 64));
        let new = *word & bit == 0;
        *word |= bit;
        new
    }

    /// True if the set contains the node.
    pub fn contains(&self, id: NodeId) -> bool {
        let (page, bit) = (id.index() / SET_PAGE, id.index() % SET_PAGE);
        let page = self.pages.get(page).and_then(Option::as_ref);
        page.is_some_and(|words| words[bit / 64] >> (bit % 64) & 1 == 1)
    }

    /// All members in ascending order.
    pub fn to_vec(&self) -> Vec<NodeId> {
        let mut ids = Vec::new();
        let mut used = self.used.clone();
        used.sort_unstable();
        for page in used {
            let words = self.pages[page].iter().flat_map(|words| words.iter());
            for (i, word) in words.enumerate() {
                let mut rest = *word;
                while rest != 0 {
                    let index = page * SET_PAGE + i * 64 + rest.trailing_zeros() as usize;
                    ids.push(NodeId(index as u32));
                    rest &= rest - 1;
                }
            }
        }
        ids
    }
}

impl FromIterator<NodeId> for IdSet {
    fn from_iter<I: IntoIterator<Item = NodeId>>(ids: I) -> Self {
        let mut set = Self::default();
        for id in ids {
            set.insert(id);
        }
        set
    }
}

/// A map from the nodes of one arena to values.
#[derive(Clone, Debug)]
pub struct IdMap<T> {
    pages: Vec<Option<Box<[Option<T>; MAP_PAGE]>>>,
}

impl<T> Default for IdMap<T> {
    fn default() -> Self {
        Self { pages: Vec::new() }
    }
}

impl<T: Copy> IdMap<T> {
    /// The node's value.
    pub fn get(&self, id: NodeId) -> Option<T> {
        let page = self.pages.get(id.index() / MAP_PAGE)?.as_ref()?;
        page[id.index() % MAP_PAGE]
    }

    /// Sets the node's value.
    pub fn insert(&mut self, id: NodeId, value: T) {
        *self.entry(id) = Some(value);
    }

    /// Removes the node's value.
    pub fn remove(&mut self, id: NodeId) {
        self.entry(id).take();
    }

    /// The entry of a node, `None` if it has no value yet.
    pub fn entry(&mut self, id: NodeId) -> &mut Option<T> {
        let page = id.index() / MAP_PAGE;
        if self.pages.len() <= page {
            self.pages.resize(page + 1, None);
        }
        let values = self.pages[page].get_or_insert_with(|| Box::new([None; MAP_PAGE]));
        &mut values[id.index() % MAP_PAGE]
    }
}

impl<T: Copy> FromIterator<(NodeId, T)> for IdMap<T> {
    fn from_iter<I: IntoIterator<Item = (NodeId, T)>>(pairs: I) -> Self {
        let mut map = Self::default();
        for (id, value) in pairs {
            map.insert(id, value);
        }
        map
    }
}

#[cfg(test)]
mod tests {
    use super::{IdMap, IdSet};
    use crate::node::NodeId;

    #[test]
    fn a_set_holds_what_was_put_in() {
        let ids = [5000, 3, 1024, 1023, 3, 64, 0].map(NodeId);
        let mut set = IdSet::default();
        let new: Vec<bool> = ids.into_iter().map(|id| set.insert(id)).collect();
        assert_eq!(new, [true, true, true, true, false, true, true]);
        assert_eq!(set.to_vec(), [0, 3, 64, 1023, 1024, 5000].map(NodeId));
        assert!(!set.contains(NodeId(2)) && !set.contains(NodeId(100_000)));
    }

    #[test]
    fn a_map_holds_the_last_value() {
        let map: IdMap<u8> =
            [(NodeId(7), 1), (NodeId(700), 2), (NodeId(7), 3)].into_iter().collect();
        assert_eq!(
            [7, 700, 8, 70_000].map(|id| map.get(NodeId(id))),
            [Some(3), Some(2), None, None]
        );
    }
}
