//! Prints a document as lines.
//!
//! The printer keeps its pending tasks on a stack of its own, so that its recursion depth does not
//! depend on the document. To decide if something fits, it measures up to the first position where
//! the line may end, which is at most one line width away.

use super::doc::{Below, Brackets, Chain, Doc, Equation, Kind};

/// The longest line, in characters.
const WIDTH: usize = 100;
/// One step of indentation.
const STEP: usize = 2;

/// The layout mode of a document.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Flat,
    Broken,
}

/// A pending task: something to print or to measure.
#[derive(Clone, Copy)]
enum Task<'d, 'a> {
    Doc(usize, Mode, &'d Doc<'a>),
    Text(&'static str),
    /// A line break.
    Newline(usize),
    /// The links of a chain whose head began on this line.
    Links(usize, &'d Chain<'a>, usize),
    /// The body of an equation, behind its `=`.
    Body(usize, &'d Equation<'a>),
}

struct Printer<'d, 'a> {
    out: String,
    /// The number of characters on the line so far, including pending indentation.
    column: usize,
    /// The indentation that is written before the next text.
    pending: usize,
    /// The number of lines so far.
    line: usize,
    /// True if nothing but indentation is on the line.
    fresh: bool,
    /// True if a comment has ended the previous line, so that no other line break is needed.
    after_comment: bool,
    /// True if a blank line follows that comment, provided that something follows on this level.
    blank: bool,
    stack: Vec<Task<'d, 'a>>,
}

/// Prints a document from the first column, without a line break at the end.
pub(super) fn print(doc: &Doc<'_>) -> String {
    let mut printer = Printer {
        out: String::new(),
        column: 0,
        pending: 0,
        line: 0,
        fresh: true,
        after_comment: false,
        blank: false,
        stack: vec![Task::Doc(0, Mode::Broken, doc)],
    };
    while let Some(task) = printer.stack.pop() {
        printer.step(task);
    }
    if printer.blank {
        printer.out.push('\n');
    }
    printer.out
}

impl<'d, 'a> Printer<'d, 'a> {
    fn step(&mut self, task: Task<'d, 'a>) {
        match task {
            Task::Text(text) => self.text(text),
            Task::Newline(indent) => self.newline(indent),
            Task::Links(indent, chain, line) => self.links(indent, chain, line),
            Task::Body(indent, parts) => self.body(indent, parts),
            Task::Doc(indent, mode, doc) => match &doc.kind {
                Kind::Text(text) => self.text(text),
                Kind::Line(flat) if mode == Mode::Flat => self.text(flat),
                Kind::Line(_) => self.newline(indent),
                Kind::Hard { blank } => {
                    self.newline(indent);
                    self.blank = *blank;
                }
                Kind::Comment { text, own_line, blank_after } => {
                    self.comment(text, *own_line, indent);
                    self.blank = *blank_after;
                }
                Kind::Concat(docs) => self.push(indent, mode, docs),
                Kind::Indent(docs) => self.push(indent + STEP, mode, docs),
                Kind::Group(docs) => {
                    let flat = mode == Mode::Flat || self.fits_flat(doc);
                    self.push(indent, if flat { Mode::Flat } else { Mode::Broken }, docs);
                }
                Kind::Brackets(_) | Kind::Chain(_) | Kind::Equation(_)
                    if mode == Mode::Flat || self.fits_flat(doc) =>
                {
                    let mut parts = Vec::new();
                    flat_parts(indent, &doc.kind, &mut parts);
                    self.stack.extend(parts.into_iter().rev());
                }
                Kind::Brackets(brackets) => self.brackets(indent, brackets),
                Kind::Chain(chain) => self.chain(indent, chain),
                Kind::Equation(equation) => self.equation(indent, equation),
            },
        }
    }

    fn push(&mut self, indent: usize, mode: Mode, docs: &'d [Doc<'a>]) {
        self.stack.extend(docs.iter().rev().map(|doc| Task::Doc(indent, mode, doc)));
    }

    /// Adds tasks in front of the pending ones.
    fn push_tasks(&mut self, tasks: Vec<Task<'d, 'a>>) {
        self.stack.extend(tasks.into_iter().rev());
    }

    fn text(&mut self, text: &str) {
        if text.is_empty() {
            return;
        }
        if std::mem::take(&mut self.blank) {
            self.out.push('\n');
        }
        self.after_comment = false;
        self.out.extend(std::iter::repeat_n(' ', std::mem::take(&mut self.pending)));
        self.out.push_str(text);
        self.column += text.chars().count();
        self.fresh = false;
    }

    fn newline(&mut self, indent: usize) {
        if !std::mem::take(&mut self.after_comment) {
            self.out.truncate(self.out.trim_end_matches(' ').len());
            self.out.push('\n');
            self.line += 1;
        }
        self.blank = false;
        (self.column, self.pending, self.fresh) = (indent, indent, true);
    }

    fn comment(&mut self, text: &str, own_line: bool, indent: usize) {
        if !self.fresh && own_line {
            self.newline(indent);
        } else if !self.fresh {
            self.out.truncate(self.out.trim_end_matches(' ').len());
            self.out.push_str("  ");
        }
        self.text(text);
        self.newline(indent);
        self.after_comment = true;
    }

    fn brackets(&mut self, indent: usize, parts: &'d Brackets<'a>) {
        let inner = indent + STEP;
        let mut tasks = vec![Task::Doc(indent, Mode::Broken, &parts.open)];
        if let Some(hugged) = parts.hug.filter(|&hugged| self.can_hug(indent, parts, hugged)) {
            for (at, element) in parts.elements.iter().enumerate() {
                let mode = if at == hugged { Mode::Broken } else { Mode::Flat };
                tasks.extend((at > 0).then_some(Task::Text(", ")));
                tasks.push(Task::Doc(indent, mode, element));
            }
        } else {
            for (element, note) in parts.elements.iter().zip(&parts.notes) {
                tasks.push(Task::Newline(inner));
                tasks.push(Task::Doc(inner, Mode::Broken, element));
                tasks.push(Task::Text(","));
                tasks.push(Task::Doc(inner, Mode::Broken, note));
            }
            if parts.comments.hard {
                tasks.push(Task::Newline(inner));
                tasks.push(Task::Doc(inner, Mode::Broken, &parts.comments));
            }
            tasks.push(Task::Newline(indent));
        }
        tasks.push(Task::Doc(indent, Mode::Broken, &parts.close));
        self.push_tasks(tasks);
    }

    /// Returns true if all elements but one fit on the first and the last line of that one.
    fn can_hug(&self, indent: usize, parts: &'d Brackets<'a>, hugged: usize) -> bool {
        let others = parts.elements.iter().enumerate().filter(|&(at, _)| at != hugged);
        let ends = [&parts.open, &parts.comments, &parts.close];
        if ends.into_iter().chain(&parts.notes).any(|doc| doc.hard)
            || others.clone().any(|(_, doc)| doc.hard)
        {
            return false;
        }
        let mut first = vec![Task::Doc(indent, Mode::Flat, &parts.open)];
        let mut last = vec![Task::Text("}")];
        for (at, doc) in others {
            let line = if at < hugged { &mut first } else { &mut last };
            line.extend([Task::Text(", "), Task::Doc(indent, Mode::Flat, doc)]);
        }
        first.extend(parts.elements.get(hugged).map(|doc| Task::Doc(indent, Mode::Broken, doc)));
        last.push(Task::Doc(indent, Mode::Flat, &parts.close));
        fits(WIDTH.saturating_sub(self.column), first, &[])
            && fits(WIDTH.saturating_sub(indent), last, &self.stack)
    }

    fn chain(&mut self, indent: usize, chain: &'d Chain<'a>) {
        let inline = |mode| {
            let last = chain.links.len().saturating_sub(1);
            let links = chain.links.iter().enumerate().map(move |(at, link)| {
                Task::Doc(indent, if at == last { Mode::Broken } else { mode }, link)
            });
            std::iter::once(Task::Doc(indent, mode, &chain.head)).chain(links).collect::<Vec<_>>()
        };
        let (last, others) = match chain.links.split_last() {
            Some((last, others)) => (last.hard, others),
            None => (false, &[][..]),
        };
        let only_last = last && !chain.head.hard && !others.iter().any(|link| link.hard);
        let room = WIDTH.saturating_sub(self.column);
        if !chain.breaks {
            self.push_tasks(inline(Mode::Broken));
        } else if only_last && fits(room, inline(Mode::Flat), &[]) {
            self.push_tasks(inline(Mode::Flat));
        } else {
            self.stack.push(Task::Links(indent, chain, self.line));
            self.stack.push(Task::Doc(indent, Mode::Broken, &chain.head));
        }
    }

    /// Prints the links of a chain that does not fit: beside the closing bracket of a head with
    /// several lines if they fit there, else each on a line of its own.
    fn links(&mut self, indent: usize, chain: &'d Chain<'a>, line: usize) {
        let flat: Vec<_> =
            chain.links.iter().map(|link| Task::Doc(indent, Mode::Flat, link)).collect();
        let hard = chain.links.iter().any(|link| link.hard);
        let room = WIDTH.saturating_sub(self.column);
        if self.line > line && !hard && fits(room, flat.clone(), &self.stack) {
            return self.push_tasks(flat);
        }
        let inner = indent + STEP;
        let broken = chain.links.iter();
        let broken =
            broken.flat_map(|link| [Task::Newline(inner), Task::Doc(inner, Mode::Broken, link)]);
        self.push_tasks(broken.collect());
    }

    fn equation(&mut self, indent: usize, parts: &'d Equation<'a>) {
        let inner = indent + STEP;
        let mut tasks = Vec::new();
        if self.opens_clauses(indent, parts) {
            tasks.push(Task::Doc(indent, Mode::Broken, &parts.head));
            for clause in &parts.clauses {
                tasks.extend([Task::Newline(inner), Task::Doc(inner, Mode::Broken, clause)]);
            }
            tasks.extend([Task::Newline(inner), Task::Doc(inner, Mode::Broken, &parts.equals)]);
            tasks.extend([Task::Text(" "), Task::Doc(inner, Mode::Broken, &parts.body)]);
            return self.push_tasks(tasks);
        }
        tasks.push(Task::Doc(indent, Mode::Broken, &parts.head));
        for clause in &parts.clauses {
            tasks.extend([Task::Text(" "), Task::Doc(indent, Mode::Flat, clause)]);
        }
        tasks.extend([Task::Text(" "), Task::Doc(indent, Mode::Broken, &parts.equals)]);
        tasks.push(Task::Body(indent, parts));
        self.push_tasks(tasks);
    }

    /// Prints a body beside the `=` if it fits there, else below, else over several lines.
    fn body(&mut self, indent: usize, parts: &'d Equation<'a>) {
        let inner = indent + STEP;
        let fits_at = |column: usize| {
            let flat = vec![Task::Doc(inner, Mode::Flat, &parts.body)];
            !parts.body.hard && fits(WIDTH.saturating_sub(column), flat, &self.stack)
        };
        let below = match parts.below {
            Below::Never => false,
            Below::IfItFits => !fits_at(self.column + 1) && fits_at(inner),
            Below::Always => !fits_at(self.column + 1),
        };
        self.push_tasks(if below {
            vec![Task::Newline(inner), Task::Doc(inner, Mode::Broken, &parts.body)]
        } else {
            vec![Task::Text(" "), Task::Doc(indent, Mode::Broken, &parts.body)]
        });
    }

    fn opens_clauses(&self, indent: usize, parts: &'d Equation<'a>) -> bool {
        if parts.open || parts.clauses.iter().any(|clause| clause.hard) {
            return true;
        }
        let mut head = vec![Task::Doc(indent, Mode::Flat, &parts.head)];
        for clause in &parts.clauses {
            head.extend([Task::Text(" "), Task::Doc(indent, Mode::Flat, clause)]);
        }
        head.push(Task::Text(" = {"));
        !parts.clauses.is_empty()
            && (parts.head.hard || !fits(WIDTH.saturating_sub(self.column), head, &[]))
    }

    /// Returns true if a document fits flat on the line together with the text that follows it.
    fn fits_flat(&self, doc: &'d Doc<'a>) -> bool {
        let room = WIDTH.saturating_sub(self.column);
        !doc.hard && fits(room, vec![Task::Doc(0, Mode::Flat, doc)], &self.stack)
    }
}

/// Returns true if `tasks` and the tasks of `rest` on the same line take at most `room` characters
/// up to the first position where the line may end. `rest` is a stack: its last task comes first.
fn fits<'d, 'a>(room: usize, tasks: Vec<Task<'d, 'a>>, rest: &[Task<'d, 'a>]) -> bool {
    let mut todo = tasks;
    todo.reverse();
    let mut rest = rest.iter().rev();
    let mut left = room;
    while let Some(task) = todo.pop().or_else(|| rest.next().copied()) {
        let width = match task {
            Task::Text(text) => text.len(),
            Task::Newline(_) | Task::Links(..) | Task::Body(..) => return true,
            Task::Doc(indent, mode, doc) => match &doc.kind {
                Kind::Text(text) => text.chars().count(),
                Kind::Line(flat) if mode == Mode::Flat => flat.len(),
                Kind::Line(_) | Kind::Hard { .. } | Kind::Comment { .. } => return true,
                Kind::Concat(docs) | Kind::Indent(docs) | Kind::Group(docs) => {
                    todo.extend(docs.iter().rev().map(|doc| Task::Doc(indent, mode, doc)));
                    0
                }
                Kind::Brackets(_) | Kind::Chain(_) | Kind::Equation(_) if mode == Mode::Flat => {
                    let mut parts = Vec::new();
                    flat_parts(indent, &doc.kind, &mut parts);
                    todo.extend(parts.into_iter().rev());
                    0
                }
                Kind::Brackets(parts) => {
                    if !parts.elements.is_empty() {
                        todo.push(Task::Newline(indent));
                    }
                    todo.push(Task::Doc(indent, mode, &parts.open));
                    0
                }
                Kind::Chain(parts) => {
                    if parts.breaks {
                        todo.push(Task::Newline(indent));
                    } else {
                        let links = parts.links.iter().rev();
                        todo.extend(links.map(|link| Task::Doc(indent, mode, link)));
                    }
                    todo.push(Task::Doc(indent, mode, &parts.head));
                    0
                }
                Kind::Equation(parts) => {
                    if parts.below == Below::Never && parts.clauses.is_empty() {
                        todo.push(Task::Doc(indent, mode, &parts.body));
                        todo.push(Task::Text(" = "));
                    } else {
                        todo.push(Task::Newline(indent));
                    }
                    todo.push(Task::Doc(indent, mode, &parts.head));
                    0
                }
            },
        };
        match left.checked_sub(width) {
            Some(still) => left = still,
            None => return false,
        }
    }
    true
}

/// Appends the parts of a compound document in flat layout.
fn flat_parts<'d, 'a>(indent: usize, kind: &'d Kind<'a>, parts: &mut Vec<Task<'d, 'a>>) {
    let flat = |doc| Task::Doc(indent, Mode::Flat, doc);
    match kind {
        Kind::Brackets(brackets) => {
            parts.push(flat(&brackets.open));
            for (at, element) in brackets.elements.iter().enumerate() {
                parts.extend((at > 0).then_some(Task::Text(", ")));
                parts.push(flat(element));
            }
            parts.push(flat(&brackets.close));
        }
        Kind::Chain(chain) => {
            parts.push(flat(&chain.head));
            parts.extend(chain.links.iter().map(flat));
        }
        Kind::Equation(equation) => {
            parts.push(flat(&equation.head));
            for clause in &equation.clauses {
                parts.extend([Task::Text(" "), flat(clause)]);
            }
            parts.extend([Task::Text(" "), flat(&equation.equals)]);
            parts.extend([Task::Text(" "), flat(&equation.body)]);
        }
        Kind::Text(_)
        | Kind::Line(_)
        | Kind::Hard { .. }
        | Kind::Comment { .. }
        | Kind::Concat(_)
        | Kind::Indent(_)
        | Kind::Group(_) => {}
    }
}
