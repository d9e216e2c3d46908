//! Makes a program small while a fault stays.

use crate::tree::{Path, Piece, Program, Tree};
use crate::types::Ty;

/// Returns a smaller program that still fails. `fails` is asked at most `most` times.
///
/// First whole statements go, then parts are replaced by parts of their own and by the simplest
/// values, and arguments are left out, until nothing more can go.
pub fn shrink(program: &Program, most: usize, fails: &mut dyn FnMut(&Program) -> bool) -> Program {
    let mut best = program.clone();
    let mut tries = 0;
    loop {
        let before = best.clone();
        let mut keep = |candidate: Program, best: &mut Program| {
            let is_new = tries < most && weight(&candidate) < weight(best);
            tries += usize::from(is_new);
            if is_new && fails(&candidate) {
                *best = candidate;
                return true;
            }
            false
        };
        without_statements(&mut best, &mut keep);
        simpler_parts(&mut best, &mut keep);
        if best == before || tries >= most {
            return best;
        }
    }
}

/// Tries a candidate. If it still fails it becomes the best, and the result is true.
type Keep<'k> = dyn FnMut(Program, &mut Program) -> bool + 'k;

/// The order of programs: fewer parts first, then fewer characters.
fn weight(program: &Program) -> (usize, usize) {
    (program.size(), program.text().len())
}

fn without_statements(best: &mut Program, keep: &mut Keep<'_>) {
    let mut chunk = best.statements.len().div_ceil(2);
    while chunk > 0 {
        // From the end, because later statements use earlier ones.
        let mut end = best.statements.len();
        while end > 0 {
            let start = end.saturating_sub(chunk);
            let mut candidate = best.clone();
            candidate.statements.drain(start..end);
            keep(candidate, best);
            end = start;
        }
        chunk /= 2;
    }
}

fn simpler_parts(best: &mut Program, keep: &mut Keep<'_>) {
    let mut at = 0;
    // Large parts come first. After a success the same place is tried again.
    while let Some(path) = best.paths().get(at).cloned() {
        let found = candidates(best, &path).into_iter().any(|candidate| keep(candidate, best));
        at += usize::from(!found);
    }
}

/// Returns simpler programs that differ in one part, the simplest first.
fn candidates(program: &Program, path: &Path) -> Vec<Program> {
    let Some(part) = program.at(path) else { return Vec::new() };
    let simplest = part.ty.simplest().map(|text| Tree::text(part.ty.clone(), text));
    let mut parts: Vec<Tree> = simplest.into_iter().collect();
    let mut inner = Vec::new();
    part.paths(&mut Vec::new(), &mut inner);
    let inner = inner.iter().filter_map(|path| part.at(path)).skip(1);
    let in_place = |tree: &Tree| match (&part.ty, &tree.ty) {
        // A solid within a declaration is drawn instead.
        (Ty::Statement, Ty::Solid) => Some(Tree::new(Ty::Statement, "{}", [tree.clone()])),
        (whole, ty) => (whole == ty).then(|| tree.clone()),
    };
    let mut inner: Vec<Tree> = inner.filter_map(in_place).collect();
    inner.sort_by_key(Tree::size);
    parts.extend(inner);
    parts.extend(shorter_lists(part));
    parts.extend(rounder(part));
    parts.into_iter().map(|part| program.with(path, part)).collect()
}

/// Returns the part with one line for each list, and without one optional element.
fn shorter_lists(part: &Tree) -> Vec<Tree> {
    let mut shorter = Vec::new();
    for (at, piece) in part.pieces.iter().enumerate() {
        let Piece::List(_, list) = piece else { continue };
        let with = |list| {
            let mut part = part.clone();
            part.pieces[at] = Piece::List(crate::tree::Layout::Line, list);
            part
        };
        let optional = (0..list.len()).filter(|index| list[*index].optional);
        shorter.extend(optional.map(|index| {
            let mut list = list.clone();
            list.remove(index);
            with(list)
        }));
        shorter.push(with(list.clone()));
    }
    shorter
}

/// Returns a number with fewer digits.
fn rounder(part: &Tree) -> Option<Tree> {
    let [Piece::Text(text)] = &part.pieces[..] else { return None };
    let value: f64 = text.parse().ok()?;
    let rounded = (value * 10.0).round() / 10.0;
    Some(Tree::text(part.ty.clone(), format!("{}", rounded + 0.0)))
}
