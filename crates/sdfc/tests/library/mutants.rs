//! Mutants: claims with one fault each, made from what an entry states. The samples of some variant
//! of its example must refute each of them. Otherwise the clause promises less than it could, or
//! the checks see too little.

use sdfc_analyze::Promise;

use crate::claims::{Claims, PROMISES, SIDES, Stated};

/// The factor by which a constant is reduced, and the fraction of the extent by which each end of
/// the bounds is moved inward.
const SMALLER: f64 = 0.9;
const DRAWN_IN: f64 = 0.05;

/// A faulty claim.
pub struct Mutant {
    /// The fault, named the same in all variants.
    pub label: String,
    pub claims: Claims,
}

/// Returns all mutants of the clauses of this instance whose dependencies hold.
pub fn of(stated: &Stated, derived: &Claims, axes: usize) -> Vec<Mutant> {
    let mut mutants = Vec::new();
    let mut add = |label: String, claims: Claims| mutants.push(Mutant { label, claims });
    for (side, name) in SIDES.iter().enumerate() {
        for (at, promise) in PROMISES.into_iter().enumerate() {
            if stated.promises[side][at] == Some(false) && stated.children[at] {
                add(without_condition(promise, name), one_side(side, promise));
            }
        }
        if let Some(promise) = raised(stated, derived, side) {
            add(format!("{promise} {name}"), one_side(side, promise));
        }
    }
    if let Some(constant) = stated.lipschitz.or(derived.lipschitz.filter(|_| stated.is_silent())) {
        let claims = Claims { lipschitz: Some(SMALLER * constant), ..Claims::NONE };
        add("lipschitz made 10 % smaller".to_owned(), claims);
    }
    if let Some(bounds) = stated.bounds {
        for axis in 0..axes {
            for (end, word) in ["lower", "upper"].into_iter().enumerate() {
                if !bounds[end][axis].is_finite() {
                    continue;
                }
                let extent = bounds[1][axis] - bounds[0][axis];
                let extent = if extent.is_finite() { extent } else { 1.0 };
                let mut drawn_in = bounds;
                drawn_in[end][axis] += DRAWN_IN * extent * [1.0, -1.0][end];
                let axis = ["x", "y", "z"][axis];
                let label = format!("{word} end of {axis} drawn in by 5 %");
                add(label, Claims { bounds: Some(drawn_in), ..Claims::NONE });
            }
        }
    }
    mutants
}

/// Returns the label of a clause whose condition was dropped.
pub fn without_condition(promise: Promise, side: &str) -> String {
    format!("{promise} {side} without its condition")
}

fn one_side(side: usize, promise: Promise) -> Claims {
    let mut claims = Claims::NONE;
    claims.sides[side] = promise;
    claims
}

/// Returns the promise one level above what clauses and derivation give, for entries that state
/// anything.
fn raised(stated: &Stated, derived: &Claims, side: usize) -> Option<Promise> {
    if stated.is_silent() || stated.promises[side][0].is_some() {
        return None;
    }
    match derived.sides[side] {
        Promise::None if stated.children[1] => Some(Promise::Bound),
        Promise::Bound if stated.children[0] => Some(Promise::Exact),
        Promise::None | Promise::Bound | Promise::Exact => None,
    }
}
