//! Diagnostics of elaboration: their positions, and the limits that end it.

use std::collections::BTreeSet;

use rustc_hash::FxHashSet;
use sdfc_diagnostics::{Code, Diagnostic, Note, Span};
use sdfc_graph::{FrameInput, Node, NodeId, Stage};

use super::elaborator::{Elaborator, Outcome, Poison, Within};
use super::limits::{MAX_NODES, MAX_STEPS};

/// The number of enclosing calls that a message shows.
const SHOWN_CALLS: usize = 3;

/// A saved state, see [`Elaborator::attempt`].
pub(super) struct Attempt {
    diagnostics: usize,
    reported: FxHashSet<Span>,
    sites: usize,
    within: Within,
    structural: BTreeSet<usize>,
}

impl<'p> Elaborator<'p> {
    /// Reports an error; see [`Self::report`].
    pub(super) fn fail(&mut self, code: Code, span: Span, message: impl Into<String>) -> Poison {
        self.report(Diagnostic::error(code, span, message))
    }

    /// Reports a diagnostic. If its position is in the library, it is shown at the innermost call
    /// in the scene, with the library's line as a note. Each position is reported once.
    pub(super) fn report(&mut self, mut found: Diagnostic) -> Poison {
        let origin = found.span;
        let mut calls = self.frames.iter().rev().filter(|frame| !self.is_library(frame.span));
        if self.is_library(origin)
            && let Some(call) = calls.next()
        {
            found.span = call.span;
            let explained = |note: &Note| note.span.is_some_and(|at| at.file == origin.file);
            if !found.notes.iter().any(explained) {
                found = found.note_at(origin, "in the library, here");
            }
        }
        let position = found.span;
        // A call around the position is visible anyway. With recursion, one call occurs many times.
        let mut shown = vec![position];
        let outer: Vec<Note> = calls
            .filter(|call| {
                let fresh = !call.span.contains(position) && !shown.contains(&call.span);
                shown.push(call.span);
                fresh
            })
            .take(SHOWN_CALLS)
            .map(|call| Note {
                span: Some(call.span),
                message: format!("in this call of `{}`", call.name),
            })
            .collect();
        found.notes.extend(outer);
        if self.reported.insert(position) {
            self.diagnostics.push(found);
        }
        Poison
    }

    /// Saves the state before an elaboration that may fail silently, for [`Self::take_back`].
    pub(super) fn attempt(&self) -> Attempt {
        Attempt {
            diagnostics: self.diagnostics.len(),
            reported: self.reported.clone(),
            sites: self.sites.len(),
            within: self.within,
            structural: self.structural.clone(),
        }
    }

    /// Discards what was reported and recorded since a saved state.
    pub(super) fn take_back(&mut self, attempt: Attempt) {
        self.diagnostics.truncate(attempt.diagnostics);
        self.reported = attempt.reported;
        for site in self.sites.drain(attempt.sites..) {
            self.seen_sites.remove(&(site.shape, site.span));
        }
        self.within = attempt.within;
        self.structural = attempt.structural;
    }

    /// Reports that a limit is exceeded and ends elaboration. If the params of the conditions
    /// around it were constants, only one branch of each would be elaborated.
    pub(super) fn stop(&mut self, found: Diagnostic) -> Poison {
        for condition in std::mem::take(&mut self.conditions) {
            self.decides_structure(condition);
        }
        if !self.stopped {
            self.report(found);
        }
        self.stopped = true;
        Poison
    }

    /// Reports a missing value without an error. This is a fault of the checker, but an error is
    /// better than an image without the value.
    pub(super) fn explain_silence(&mut self) {
        if let Some(span) = self.missing
            && !sdfc_diagnostics::has_errors(&self.diagnostics)
        {
            let message =
                "this has no value, and the checker did not find the reason: please report this";
            self.fail(Code::TYPE_MISMATCH, span, message);
        }
    }

    pub(super) fn is_library(&self, span: Span) -> bool {
        self.program.library.contains(&span.file)
    }

    /// Counts one step of work.
    pub(super) fn tick(&mut self, span: Span) -> Outcome<()> {
        if self.stopped {
            return Err(Poison);
        }
        self.steps += 1;
        let (what, limit) = if self.graph.len() > MAX_NODES {
            ("graph nodes", MAX_NODES as u64)
        } else if self.steps > MAX_STEPS {
            ("evaluation steps", MAX_STEPS)
        } else {
            return Ok(());
        };
        let message = format!("this scene needs more than {limit} {what}");
        let help = "functions and lists are expanded: nested lists and recursion multiply";
        Err(self.stop(Diagnostic::error(Code::TOO_MANY_NODES, span, message).help(help)))
    }

    /// Reports a value that must be known at compile time, and why it is not.
    pub(super) fn not_constant(&mut self, span: Span, what: &str, node: NodeId) -> Poison {
        self.must_stay_constant(node);
        self.decides_structure(node);
        let why = self.why_not_constant(node);
        let message = format!("{what} must be known at compile time; {why}");
        let help = "write the value here, or define it with `let` or `param`";
        self.report(Diagnostic::error(Code::NOT_COMPILE_TIME, span, message).help(help))
    }

    fn why_not_constant(&self, root: NodeId) -> String {
        if self.graph.stage(root) == Stage::Point {
            return "this depends on the point".to_owned();
        }
        let mut stack = vec![root];
        while let Some(node) = stack.pop() {
            if let Node::Frame(input, _) = self.graph.node(node) {
                return match input {
                    FrameInput::Param(index) => {
                        let name = self.params.get(index as usize).map_or("", |param| &param.name);
                        format!("`{name}` changes without a recompile")
                    }
                    FrameInput::Time => "`time` changes from frame to frame".to_owned(),
                    FrameInput::Frame => "`frame` changes from frame to frame".to_owned(),
                };
            }
            // A per-frame node has a per-frame argument, so this follows one path.
            let arguments = self.graph.arguments(node);
            stack.extend(arguments.filter(|&a| self.graph.stage(a) == Stage::Frame).take(1));
        }
        "this value is not constant".to_owned()
    }
}

/// A number for messages, with at most six digits after the decimal point, or with six significant
/// digits and an exponent if it is very small.
pub(super) fn show_number(value: f64) -> String {
    if value.is_nan() {
        return "not a number".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "inf" } else { "-inf" }.to_owned();
    }
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 && value != 0.0 {
        // Parsing drops the zeros at the end.
        let short: f64 = format!("{value:.5e}").parse().unwrap_or(value);
        return format!("{short:e}");
    }
    // Adding 0 turns -0 into 0.
    format!("{}", rounded + 0.0)
}

/// A number or vector for messages.
pub(super) fn show_lanes(lanes: &[f64]) -> String {
    if let [one] = lanes {
        return show_number(*one);
    }
    let parts: Vec<String> = lanes.iter().map(|&lane| show_number(lane)).collect();
    format!("[{}]", parts.join(", "))
}
