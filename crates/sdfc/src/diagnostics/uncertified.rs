//! The help about shapes without a Lipschitz constant (W0602): what to write, and where.

use sdfc_analyze::{
    Lipschitz, Reason, Report, SampledSlope, SuggestedClauses, Uncertified, rounded_up,
    suggested_clauses,
};
use sdfc_graph::{Arg, Dim, ShapeId};
use sdfc_lang::Elaborated;

const SLOWER: &str = "leave it: `auto` then draws the scene by interval tracing, which is slower";

/// Beyond this constant, rays by a divided field take too many steps.
const MOST_DIVIDED: f64 = 100.0;
/// Above this constant, the help offers `bound` as well.
const MODEST: f64 = 4.0;

const FROM_SAMPLES: &str =
    "the constant is 1.2 times the largest slope of some samples, so make sure that it holds";

/// The help for one part of a scene.
pub(super) fn help(elaborated: &Elaborated, report: &Report, part: &Uncertified) -> String {
    let graph = &elaborated.scene.graph;
    let shape = graph.shape(part.shape);
    let takes_function = shape.args.iter().any(|arg| matches!(arg, Arg::Function(_)));
    match &part.reason {
        Reason::Within(name) => within(elaborated, report, part.shape, name),
        Reason::Child(name) => match child(elaborated, report, part.shape, name) {
            Some(child) => format!("`{name}`: {}", help(elaborated, report, &child)),
            None => SLOWER.to_owned(),
        },
        Reason::Varying(_) => format!(
            "make the shape before the formula, with arguments that do not depend on `p`; or \
             {SLOWER}"
        ),
        Reason::Jump(what) if is_own(elaborated, part.shape) => {
            format!("{}; or {}; or {SLOWER}", without_jump(what), as_bound(&shape.definition))
        }
        Reason::Jump(what) if takes_function => format!("{}; or {SLOWER}", without_jump(what)),
        Reason::Jump(_) => SLOWER.to_owned(),
        Reason::Unbounded(_) | Reason::SteepInPlaces(_) | Reason::Infinite | Reason::NoBounds => {
            if is_own(elaborated, part.shape) {
                clauses(elaborated, part.shape)
            } else if takes_function && !matches!(part.reason, Reason::Infinite) {
                "state how steep the function is: `fn(q) lipschitz 1 = ...`, with the most by \
                 which its value changes when `q` moves by 1"
                    .to_owned()
            } else {
                let (name, limit) = (&shape.definition, limit(shape.dim));
                format!(
                    "limit the shape first, for example `(a & {limit}).{name}(...)` for \
                     `a.{name}(...)`"
                )
            }
        }
    }
}

/// The clause for a field that needs no constant.
fn as_bound(name: &str) -> String {
    format!(
        "write `bound` before the `=` of `{name}` if the value never exceeds the distance to the \
         surface"
    )
}

/// A shape that limits another one.
fn limit(dim: Dim) -> &'static str {
    match dim {
        Dim::Two => "rect(4)",
        Dim::Three => "box(4)",
    }
}

/// True if a file of the scene declares the shape.
fn is_own(elaborated: &Elaborated, shape: ShapeId) -> bool {
    let definition = &elaborated.scene.graph.shape(shape).definition;
    elaborated.declared.iter().any(|declared| declared.definition == *definition)
}

/// The child of a shape that has no constant, with the reason.
fn child(
    elaborated: &Elaborated,
    report: &Report,
    shape: ShapeId,
    name: &str,
) -> Option<Uncertified> {
    let graph = &elaborated.scene.graph;
    let children = &graph.shape(shape).children;
    let mut found = report.shapes.iter().filter(|found| children.contains(&found.shape));
    found.find_map(|found| match &found.lipschitz {
        Lipschitz::Unknown(reason) if graph.shape(found.shape).definition == name => {
            Some(Uncertified { shape: found.shape, reason: reason.clone() })
        }
        Lipschitz::Unknown(_) | Lipschitz::Number(_) | Lipschitz::PerFrame => None,
    })
}

/// The clauses to write in the declaration of a shape.
fn clauses(elaborated: &Elaborated, shape: ShapeId) -> String {
    let scene = &elaborated.scene;
    let name = &scene.graph.shape(shape).definition;
    let Some(SuggestedClauses { bounds, lipschitz }) =
        suggested_clauses(&scene.graph, shape, &scene.params)
    else {
        return format!(
            "write `bounds` and `lipschitz` before the `=` of `{name}`: limits that contain the \
             shape, and the most by which the value changes when `p` moves by 1"
        );
    };
    let constant = match lipschitz {
        Some(SampledSlope::Unlimited(at)) => {
            // Adding 0 turns -0 into 0.
            let at = at.map(|x| format!("{}", (x * 1e3).round() / 1e3 + 0.0)).join(", ");
            return format!(
                "no constant is right for `{name}`: its slope grows without limit near p = [{at}]; \
                 if the picture is right, leave it so, or try `--march sphere`, which is faster"
            );
        }
        Some(SampledSlope::Constant(constant)) if constant > MOST_DIVIDED => {
            return format!(
                "{}; a constant of about {constant} would do, but rays take so many more steps \
                 then that they may not arrive; or {SLOWER}",
                as_bound(name)
            );
        }
        Some(SampledSlope::Constant(constant)) => Some(constant),
        None => None,
    };
    let bounds = bounds.map(|reach| format!("bounds -{reach} .. {reach}"));
    let with_limits = bounds.as_ref().map(|_| ", with limits that contain the shape");
    let from_samples = constant.map(|constant| {
        let instead =
            if constant > MODEST { format!("; or {}", as_bound(name)) } else { String::new() };
        format!("; {FROM_SAMPLES}{instead}")
    });
    let constant = constant.map(|constant| format!("lipschitz {constant}"));
    let clauses: Vec<String> = bounds.into_iter().chain(constant).collect();
    format!(
        "write `{}` before the `=` of `{name}`{}{}",
        clauses.join(" "),
        with_limits.unwrap_or_default(),
        from_samples.unwrap_or_default(),
    )
}

/// The help for a constant of a child that holds only within the child's bounds.
fn within(elaborated: &Elaborated, report: &Report, shape: ShapeId, name: &str) -> String {
    let graph = &elaborated.scene.graph;
    let is_child = |id: ShapeId| graph.shape(id).definition == name && is_own(elaborated, id);
    let child = report.shapes.iter().find(|found| is_child(found.shape));
    let constant = child.and_then(|child| match child.lipschitz {
        Lipschitz::Number(constant) => Some(constant),
        Lipschitz::PerFrame | Lipschitz::Unknown(_) => None,
    });
    match constant {
        Some(constant) => format!(
            "write `lipschitz {} everywhere` before the `=` of `{name}`, if the constant holds \
             beyond its bounds too",
            rounded_up(constant)
        ),
        None => format!(
            "apply `{}` to shapes whose constant holds everywhere; or {SLOWER}",
            graph.shape(shape).definition
        ),
    }
}

/// Which function without jumps to use.
fn without_jump(what: &str) -> String {
    match what {
        "fract" | "%" | "floor" | "round" | "ceil" | "trunc" => format!(
            "use a function without jumps, such as `sin`, in place of `{what}`, or `repeat` for \
             copies"
        ),
        "hash" => {
            "use a function without jumps, such as `gradient_noise`, in place of `hash`".to_owned()
        }
        "sign" | "step" => {
            format!("use a function without jumps, such as `smoothstep`, in place of `{what}`")
        }
        _ => "use `min`, `max`, `mix` or `smoothstep`, which do not jump".to_owned(),
    }
}
