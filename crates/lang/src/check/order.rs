//! Dependencies between declarations: a shape must not depend on itself, nor a `let` on its value.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::{Checker, LetIndex};

/// A declaration in the dependency graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Node {
    Fn(u32),
    Shape(u32),
    Let(usize),
}

impl Node {
    /// The node of a `let`.
    pub(super) fn of_let(index: LetIndex) -> Self {
        Self::Let(index.0)
    }
}

/// The edges of the dependency graph: which declaration mentions which, and where.
#[derive(Debug, Default)]
pub(super) struct Order {
    mentions: Vec<(Node, Node, Span)>,
}

impl Checker<'_> {
    /// Records that the current body depends on a declaration.
    pub(super) fn needs(&mut self, what: Node, span: Span) {
        if let Some(node) = self.body.node {
            self.order.mentions.push((node, what, span));
        }
    }

    /// Reports shapes and lets that depend on themselves, directly or through others. Functions may
    /// recurse: a condition known at compile time ends the recursion.
    pub(super) fn check_order(&mut self) {
        let mentions = std::mem::take(&mut self.order.mentions);
        let circles = circles(&mentions);
        let mut reported = Vec::new();
        for (from, to, span) in &mentions {
            let (Some(circle), Some(other)) = (circles.get(from), circles.get(to)) else {
                continue;
            };
            if circle != other || reported.contains(circle) {
                continue;
            }
            let found = match *from {
                Node::Fn(_) => continue,
                Node::Shape(id) => {
                    let name = self.program.shapes.get(id as usize).map_or("", |s| &s.name);
                    let message = format!("`{name}` uses itself: a shape cannot be recursive");
                    Diagnostic::error(Code::SELF_CALL, *span, message)
                        .help("use a function, which may be recursive: fn f(n: int) -> solid = ...")
                }
                Node::Let(index) => {
                    let name = &self.lets[index].ast.name;
                    let message = format!("`{}` is used in its own definition", name.text);
                    Diagnostic::error(Code::UNKNOWN_NAME, *span, message)
                        .note_at(name.span, "it has a value only after this `let`")
                }
            };
            reported.push(*circle);
            self.report(found);
        }
    }
}

/// The strongly connected components that contain a cycle: the index of its component for each of
/// their nodes. Uses Tarjan's algorithm with an explicit stack.
fn circles(mentions: &[(Node, Node, Span)]) -> FxHashMap<Node, usize> {
    let mut nodes: Vec<Node> = mentions.iter().flat_map(|(a, b, _)| [*a, *b]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let at = |node: &Node| nodes.binary_search(node).unwrap_or(0);
    let mut next: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (from, to, _) in mentions {
        next[at(from)].push(at(to));
    }
    let mut search = Search {
        index: vec![None; nodes.len()],
        low: vec![0; nodes.len()],
        on_stack: vec![false; nodes.len()],
        stack: Vec::new(),
        seen: 0,
        component: vec![0; nodes.len()],
        sizes: Vec::new(),
    };
    for node in 0..nodes.len() {
        search.from(node, &next);
    }
    let in_circle = |&at: &usize| search.sizes[search.component[at]] > 1 || next[at].contains(&at);
    (0..nodes.len()).filter(in_circle).map(|at| (nodes[at], search.component[at])).collect()
}

/// The state of Tarjan's algorithm.
struct Search {
    index: Vec<Option<usize>>,
    low: Vec<usize>,
    on_stack: Vec<bool>,
    stack: Vec<usize>,
    seen: usize,
    /// The component of each node, and the number of nodes of each component.
    component: Vec<usize>,
    sizes: Vec<usize>,
}

impl Search {
    fn from(&mut self, root: usize, next: &[Vec<usize>]) {
        if self.index[root].is_some() {
            return;
        }
        let mut path = vec![(root, 0)];
        self.arrive(root);
        while let Some((node, edge)) = path.last_mut() {
            let (node, at) = (*node, *edge);
            *edge += 1;
            match next[node].get(at) {
                Some(&to) if self.index[to].is_none() => {
                    self.arrive(to);
                    path.push((to, 0));
                }
                Some(&to) if self.on_stack[to] => {
                    self.low[node] = self.low[node].min(self.index[to].unwrap_or(0));
                }
                Some(_) => {}
                None => {
                    path.pop();
                    if let Some((parent, _)) = path.last() {
                        self.low[*parent] = self.low[*parent].min(self.low[node]);
                    }
                    self.close(node);
                }
            }
        }
    }

    fn arrive(&mut self, node: usize) {
        self.index[node] = Some(self.seen);
        self.low[node] = self.seen;
        self.on_stack[node] = true;
        self.stack.push(node);
        self.seen += 1;
    }

    fn close(&mut self, node: usize) {
        if Some(self.low[node]) != self.index[node] {
            return;
        }
        let mut size = 0;
        while let Some(member) = self.stack.pop() {
            self.on_stack[member] = false;
            self.component[member] = self.sizes.len();
            size += 1;
            if member == node {
                break;
            }
        }
        self.sizes.push(size);
    }
}
