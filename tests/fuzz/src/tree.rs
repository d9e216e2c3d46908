//! Programs as trees of typed expressions. A tree is printed to text, and its parts can be
//! replaced, so that a program can be shrunk without being parsed.

use std::fmt::Write;
use std::ops::Range;

use crate::types::Ty;

/// An expression or a statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tree {
    /// The type.
    pub ty: Ty,
    /// The pieces of its text, in order.
    pub pieces: Vec<Piece>,
}

/// A piece of a tree's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// Text without parts.
    Text(String),
    /// A part.
    Part(Tree),
    /// Arguments or elements between brackets that the text around them writes.
    List(Layout, Vec<Element>),
}

/// The white space in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// All on one line.
    Line,
    /// Each element on a line of its own, with a comma after the last.
    Lines,
    /// The same, with a comment after each element.
    Comments,
}

/// An argument or an element of a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    /// The text before it, such as `r: `.
    pub label: String,
    /// True if the list may do without it.
    pub optional: bool,
    /// The value.
    pub value: Tree,
}

/// The way from a tree to one of its parts: the number of the child at each level.
pub type Path = Vec<usize>;

impl Tree {
    /// A tree without parts.
    pub fn text(ty: Ty, text: impl Into<String>) -> Self {
        Self { ty, pieces: vec![Piece::Text(text.into())] }
    }

    /// A tree that is printed as `format`, with one part for each `{}`.
    pub fn new(ty: Ty, format: &str, parts: impl IntoIterator<Item = Tree>) -> Self {
        let mut pieces = Vec::new();
        let mut parts = parts.into_iter();
        for (at, text) in format.split("{}").enumerate() {
            if at > 0 {
                pieces.extend(parts.next().map(Piece::Part));
            }
            pieces.push(Piece::Text(text.to_owned()));
        }
        Self { ty, pieces }
    }

    /// A tree that is printed as text, a list and text.
    pub fn list(ty: Ty, open: &str, layout: Layout, list: Vec<Element>, close: &str) -> Self {
        let [open, close] = [open, close].map(|text| Piece::Text(text.to_owned()));
        Self { ty, pieces: vec![open, Piece::List(layout, list), close] }
    }

    /// The parts, in order.
    pub fn children(&self) -> impl Iterator<Item = &Tree> {
        self.pieces.iter().flat_map(|piece| -> Box<dyn Iterator<Item = &Tree>> {
            match piece {
                Piece::Text(_) => Box::new(std::iter::empty()),
                Piece::Part(tree) => Box::new(std::iter::once(tree)),
                Piece::List(_, list) => Box::new(list.iter().map(|element| &element.value)),
            }
        })
    }

    fn children_mut(&mut self) -> impl Iterator<Item = &mut Tree> {
        self.pieces.iter_mut().flat_map(|piece| -> Box<dyn Iterator<Item = &mut Tree>> {
            match piece {
                Piece::Text(_) => Box::new(std::iter::empty()),
                Piece::Part(tree) => Box::new(std::iter::once(tree)),
                Piece::List(_, list) => Box::new(list.iter_mut().map(|element| &mut element.value)),
            }
        })
    }

    /// Returns the part at a path.
    pub fn at(&self, path: &[usize]) -> Option<&Tree> {
        match path {
            [] => Some(self),
            [first, rest @ ..] => self.children().nth(*first)?.at(rest),
        }
    }

    /// Returns the part at a path, to change it.
    pub fn at_mut(&mut self, path: &[usize]) -> Option<&mut Tree> {
        match path {
            [] => Some(self),
            [first, rest @ ..] => self.children_mut().nth(*first)?.at_mut(rest),
        }
    }

    /// Returns the number of trees in this one, itself included.
    pub fn size(&self) -> usize {
        1 + self.children().map(Tree::size).sum::<usize>()
    }

    /// Appends the paths of all parts, each before its own parts.
    pub fn paths(&self, prefix: &mut Path, found: &mut Vec<Path>) {
        found.push(prefix.clone());
        for (at, child) in self.children().enumerate() {
            prefix.push(at);
            child.paths(prefix, found);
            prefix.pop();
        }
    }

    fn print(&self, out: &mut Printed, path: &mut Path) {
        let start = out.text.len();
        let mut child = 0;
        let mut part = |tree: &Tree, out: &mut Printed, path: &mut Path| {
            path.push(child);
            tree.print(out, path);
            path.pop();
            child += 1;
        };
        for piece in &self.pieces {
            match piece {
                Piece::Text(text) => out.text += text,
                Piece::Part(tree) => part(tree, out, path),
                Piece::List(layout, list) => {
                    for (at, element) in list.iter().enumerate() {
                        out.text += match (layout, at) {
                            (Layout::Line, 0) => "",
                            (Layout::Line, _) => ", ",
                            (Layout::Lines | Layout::Comments, _) => "\n  ",
                        };
                        out.text += &element.label;
                        part(&element.value, out, path);
                        match layout {
                            Layout::Line => {}
                            Layout::Lines => out.text += ",",
                            Layout::Comments => {
                                let _ = write!(out.text, ", // {at}");
                            }
                        }
                    }
                    if *layout != Layout::Line && !list.is_empty() {
                        out.text += "\n";
                    }
                }
            }
        }
        out.parts.push((path.clone(), start..out.text.len()));
    }
}

/// A program: one statement per line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Program {
    /// The statements, in order.
    pub statements: Vec<Tree>,
}

/// The text of a program, and where each part stands in it.
#[derive(Clone, Debug, Default)]
pub struct Printed {
    /// The text.
    pub text: String,
    /// For each part the path, whose first number is that of the statement, and the bytes. Parts
    /// stand before the tree that they belong to.
    pub parts: Vec<(Path, Range<usize>)>,
}

impl Program {
    /// Prints the program.
    pub fn print(&self) -> Printed {
        let mut out = Printed::default();
        for (at, statement) in self.statements.iter().enumerate() {
            statement.print(&mut out, &mut vec![at]);
            out.text.push('\n');
        }
        out
    }

    /// Returns the text.
    pub fn text(&self) -> String {
        self.print().text
    }

    /// Returns the part at a path.
    pub fn at(&self, path: &[usize]) -> Option<&Tree> {
        let (first, rest) = path.split_first()?;
        self.statements.get(*first)?.at(rest)
    }

    /// Returns the program with another part at a path.
    #[must_use]
    pub fn with(&self, path: &[usize], part: Tree) -> Self {
        let mut program = self.clone();
        if let Some((first, rest)) = path.split_first()
            && let Some(statement) = program.statements.get_mut(*first)
            && let Some(place) = statement.at_mut(rest)
        {
            *place = part;
        }
        program
    }

    /// Returns the number of trees.
    pub fn size(&self) -> usize {
        self.statements.iter().map(Tree::size).sum()
    }

    /// Returns the paths of all parts, statements first and each part before its own parts.
    pub fn paths(&self) -> Vec<Path> {
        let mut found = Vec::new();
        for (at, statement) in self.statements.iter().enumerate() {
            statement.paths(&mut vec![at], &mut found);
        }
        found
    }
}
