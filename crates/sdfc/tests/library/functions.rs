//! Checks functions that state how fast they change: blends, and functions of a point.

use std::collections::HashMap;

use sdfc_graph::eval::{FrameValues, HASH_COUNT, Tape};
use sdfc_graph::{Binary, Dim, FrameInput, Node, NodeId, Scene, gradient, reachable};
use sdfc_lang::library::Entry;

use crate::contract::{self, Outcome};
use crate::geometry::{Random, mix};
use crate::variants;

const PAIRS: usize = 6000;
const VARIANTS: usize = 8;
const TRIES: usize = 80;
/// Rounding error of f64 in the compared values.
const ROUNDING: f64 = 1e-12;
const SMALLER: f64 = 0.9;
/// Searches for the hashes with the steepest slope, and steps of each.
const CLIMBS: usize = 24;
const STEPS: usize = 600;

/// Returns true if the function states a constant or returns a blend, so that there is something to
/// check.
pub fn states_something(entry: &Entry) -> bool {
    let states = entry.clauses.iter().any(|clause| clause.starts_with("lipschitz "));
    entry.kind == "fn" && (is_blend(entry) || states)
}

fn is_blend(entry: &Entry) -> bool {
    entry.signature.ends_with("-> blend")
}

/// Checks the stated constant.
///
/// # Errors
///
/// Two points between which the function changes faster, or a constant that is not tight.
pub fn check(entry: &Entry) -> Result<Outcome, String> {
    let call =
        variants::call_of(&entry.name, &entry.example).ok_or("its example lacks a call of it")?;
    let sides = ["none", "none"].map(str::to_owned);
    let mut outcome = Outcome { sides, ..Outcome::default() };
    let mut caught = false;
    let mut random = Random(5);
    let mut text = call.to_owned();
    for _ in 0..TRIES {
        if outcome.scenes >= VARIANTS {
            break;
        }
        if let Some(scene) = contract::scene(&probe(entry, &text)) {
            let (stated, steepest) = measured(&scene).ok_or("it states no constant")?;
            if steepest > stated * (1.0 + 1e-9) {
                return Err(format!("{text}: lipschitz {stated}, but {steepest}"));
            }
            caught |= steepest > SMALLER * stated;
            outcome.lipschitz = outcome.lipschitz.or(Some(stated));
            outcome.steepest = outcome.steepest.max(steepest);
            outcome.scenes += 1;
        }
        text = variants::changed(call, &mut random);
    }
    outcome.mutants.insert("lipschitz made 10 % smaller".to_owned(), caught);
    if outcome.scenes == 0 {
        return Err("no probe of it compiles".into());
    }
    if caught { Ok(outcome) } else { Err("no sample refutes a constant 10 % smaller".into()) }
}

/// Returns a scene whose formula is the function, applied to coordinates of the point.
fn probe(entry: &Entry, call: &str) -> String {
    if is_blend(entry) {
        return format!("solid probe() = {{ let f = {call}\n  f(p.x, p.y) }}\nprobe()");
    }
    let name = &entry.name;
    let parameters = entry.signature.split_once('(').map_or("", |(_, rest)| rest);
    let argument = if parameters.contains(": vec2") { "p.xy" } else { "p" };
    format!("solid probe() = {name}({argument})\nprobe()")
}

/// Returns the stated constant and the steepest slope of pairs of points. The run of a slope is
/// that of the argument that changes most.
fn measured(scene: &Scene) -> Option<(f64, f64)> {
    let graph = &scene.graph;
    let id = graph.shape_ids().find(|&id| graph.shape(id).definition == "probe")?;
    let formula = graph.shape(id).formula;
    let claim = graph.lipschitz_claim(formula)?;
    let stated = graph.as_number(claim.lipschitz)?;
    let roots: Vec<NodeId> =
        std::iter::once(formula).chain(claim.arguments.iter().copied()).collect();
    let tape = Tape::new(graph, &roots).ok()?;
    let mut field = tape.prepare::<f64>(&FrameValues::defaults(&scene.params));
    let mut random = Random(11);
    let mut steepest = 0.0f64;
    for round in 0..PAIRS {
        let p = [0; 3].map(|_| 2.0 * random.signed());
        let q = mix(p, [0; 3].map(|_| 2.0 * random.signed()), [1.0, 1e-2, 1e-3][round % 3]);
        let [at_p, at_q] = [p, q].map(|point| field.eval(point).to_vec());
        let mut changes = at_p
            .iter()
            .zip(&at_q)
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt());
        let rise = changes.next()? - ROUNDING;
        let run = changes.fold(0.0, f64::max);
        if run > 0.0 {
            steepest = steepest.max(rise / run);
        }
    }
    Some((stated, steepest.max(steepest_of_all_hashes(scene, formula)?)))
}

/// Returns the steepest slope over all values of the hashes in the formula, or 0 without hashes. A
/// constant holds for all values, but those of a few cells seldom come near it.
fn steepest_of_all_hashes(scene: &Scene, formula: NodeId) -> Option<f64> {
    let mut graph = scene.graph.clone();
    let mut new: HashMap<NodeId, NodeId> = HashMap::new();
    let mut hashes = 0;
    for id in reachable(&graph, &[formula]) {
        let rebuilt = if let Node::Binary(Binary::Hash, ..) = graph.node(id) {
            hashes += 1;
            graph.frame_input(FrameInput::Param(hashes - 1), graph.ty(id))
        } else {
            graph.rebuild(id, |old| new.get(&old).copied().unwrap_or(old))
        };
        new.insert(id, rebuilt);
    }
    if hashes == 0 {
        return Some(0.0);
    }
    let point = graph.point(0, Dim::Three);
    let slope = gradient(&mut graph, *new.get(&formula)?, point);
    let tape = Tape::new(&graph, &[slope]).ok()?;
    let slope_at = |place: [f64; 3], params: &[[f64; 4]]| {
        let frame = FrameValues { params: params.to_vec(), ..FrameValues::default() };
        tape.prepare::<f64>(&frame).eval(place)[0].iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let mut random = Random(3);
    let mut steepest = 0.0f64;
    for _ in 0..CLIMBS {
        let mut place = [0; 3].map(|_| 0.5 + 0.5 * random.signed());
        let mut params: Vec<[f64; 4]> =
            (0..hashes).map(|_| [0; 4].map(|_| any_hash(&mut random))).collect();
        let mut best = slope_at(place, &params);
        for step in 0..STEPS {
            let (old_place, old_params) = (place, params.clone());
            if step % 2 == 0 {
                let reach = 0.3 * 0.98_f64.powi(step as i32);
                place = place.map(|x| x + reach * random.signed());
            } else {
                let at = (random.signed().abs() * f64::from(hashes)) as usize % params.len();
                params[at] = [0; 4].map(|_| any_hash(&mut random));
            }
            let slope = slope_at(place, &params);
            if slope > best {
                best = slope;
            } else {
                (place, params) = (old_place, old_params);
            }
        }
        steepest = steepest.max(best);
    }
    Some(steepest)
}

/// Returns a random hash, often 0 or 1.
fn any_hash(random: &mut Random) -> f64 {
    ((0.5 + random.signed()).clamp(0.0, 1.0) * (HASH_COUNT - 1.0)).floor()
}
