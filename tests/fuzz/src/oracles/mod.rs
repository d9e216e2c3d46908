//! What must hold of every program: a list of free functions.

mod claims;
mod surfaces;

use sdfc::{Compiler, Emit, Scene, Target};
use sdfc_render::testing;
use sdfc_tests::agree::{self, Disagreement};
use sdfc_tests::validators::{PARTS, Part, TOOLS, is_written, write};

use serde::{Deserialize, Serialize};

use crate::repair::NAME;
use crate::texts;

/// A program that the checker accepts.
#[derive(Debug)]
pub struct Subject {
    /// The source.
    pub text: String,
    /// The scene.
    pub scene: Scene,
}

/// A program and what does not hold of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// The fault in a word or two. While a program is shrunk, its fault stays the same.
    pub kind: String,
    /// The fault in full.
    pub message: String,
}

/// The answer of an oracle that finds no fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The statement holds.
    Holds,
    /// The program is none that the statement is about.
    LeftOut,
}

/// The answer of an oracle.
pub type Outcome = Result<Verdict, Finding>;

/// A statement about programs.
#[derive(Clone, Copy, Debug)]
pub struct Oracle {
    /// The name on the command line.
    pub name: &'static str,
    /// The statement.
    pub summary: &'static str,
    /// The function that decides it.
    pub holds: fn(&Subject) -> Outcome,
}

/// All oracles, the quick ones first.
pub const ORACLES: [Oracle; 15] = [
    Oracle {
        name: "format",
        summary: "formatting twice is formatting once, and compiles to the same shader",
        holds: format,
    },
    Oracle { name: "compile", summary: "every part is written for every target", holds: compile },
    Oracle {
        name: "number",
        summary: "the field is a number, not NaN, wherever it is sampled",
        holds: number,
    },
    Oracle {
        name: "live",
        summary: "with live literals the camera is the same, and no point changes its side",
        holds: live,
    },
    Oracle {
        name: "gradient",
        summary: "the gradient is the slope of the field where it is smooth",
        holds: claims::gradient,
    },
    Oracle {
        name: "certificate",
        summary: "a certified field is no more than the distance to the surface",
        holds: claims::certificate,
    },
    Oracle {
        name: "bounds",
        summary: "nothing is inside outside of the bounds",
        holds: claims::bounds,
    },
    Oracle {
        name: "loops",
        summary: "loops over lists and plain formulas are one field",
        holds: claims::loops,
    },
    Oracle {
        name: "service",
        summary: "the language service answers everywhere, with the errors of the compiler",
        holds: service,
    },
    Oracle {
        name: "mesh",
        summary: "a mesh is closed, on the surface, and has the inside of the field",
        holds: surfaces::mesh,
    },
    Oracle {
        name: "regions",
        summary: "a region of a picture has the pixels of the picture",
        holds: surfaces::regions,
    },
    Oracle { name: "clauses", summary: "no clause is refuted by samples", holds: clauses },
    Oracle {
        name: "targets",
        summary: "the installed validators accept every shader",
        holds: targets,
    },
    Oracle {
        name: "methods",
        summary: "`auto` and `interval` find the same hits of a certified scene",
        holds: methods,
    },
    Oracle {
        name: "devices",
        summary: "GPU, CPU in f32 and CPU in f64 draw the same picture",
        holds: devices,
    },
];

/// Names for several oracles: those that only compile and evaluate, those that write shaders, and
/// those that draw.
pub const GROUPS: [(&str, &[&str]); 3] = [
    (
        "quick",
        &[
            "format",
            "number",
            "live",
            "gradient",
            "certificate",
            "bounds",
            "loops",
            "service",
            "clauses",
        ],
    ),
    ("shaders", &["compile", "targets"]),
    ("pictures", &["mesh", "regions", "methods", "devices"]),
];

/// Pictures are drawn of scenes with at most this many operations per evaluation: software drivers
/// take minutes to compile more. Of other scenes only the field is written, because the ray method
/// of an uncertified scene is chosen by tracing rays on the CPU.
const OPERATIONS: usize = 400;
/// The number of points at which a field is sampled.
const POINTS: u32 = 200;
/// The largest difference of a camera with live literals, and the distance from which on a point
/// is off the surface. Both are computed in f64.
const ROUNDING: f64 = 1e-9;

pub(crate) fn finding(kind: &str, message: impl ToString) -> Finding {
    Finding { kind: kind.to_owned(), message: message.to_string() }
}

fn format(subject: &Subject) -> Outcome {
    let once = sdfc::format(NAME, &subject.text).map_err(|e| finding("refused", e))?;
    let twice = sdfc::format(NAME, &once).map_err(|e| finding("refused again", e))?;
    if once != twice {
        return Err(finding("not idempotent", format!("{once}\nbecomes\n{twice}")));
    }
    let scene = Compiler::new().compile(NAME, &once).map_err(|e| finding("other errors", e))?;
    let [before, after] = [&subject.scene, &scene].map(|scene| {
        let written = write(scene, Target::Wgsl, PARTS[0]);
        written.map(|code| String::from_utf8_lossy(&code.into_bytes()).into_owned())
    });
    // The first line names the source.
    let code = |text: &str| text.split_once('\n').map(|(_, code)| code.to_owned());
    match (before, after) {
        (Ok(before), Ok(after)) if code(&before) != code(&after) => {
            Err(finding("another shader", once))
        }
        _ => Ok(Verdict::Holds),
    }
}

fn compile(subject: &Subject) -> Outcome {
    for target in Target::ALL {
        for part in parts(&subject.scene, target) {
            let written = write(&subject.scene, target, part);
            let place = format!("{} as {}", part.name, target.name());
            written.map_err(|error| finding("not written", format!("{place}: {error}")))?;
        }
    }
    Ok(Verdict::Holds)
}

/// Points all around the origin, near and far.
fn points() -> impl Iterator<Item = [f64; 3]> {
    (0..POINTS).map(|at| [0.0, 1.0, 2.0].map(|axis| 4.0 * (f64::from(at) * (1.7 + axis)).sin()))
}

fn number(subject: &Subject) -> Outcome {
    let Subject { scene, .. } = subject;
    let mut field = scene.field(&scene.defaults()).map_err(|e| finding("no field", e))?;
    for point in points() {
        let distance = field.distance(point);
        if distance.is_nan() {
            return Err(finding("not a number", format!("at {point:?}")));
        }
    }
    Ok(Verdict::Holds)
}

fn live(subject: &Subject) -> Outcome {
    let Subject { scene, text } = subject;
    let live = Compiler::new().live_literals(None).compile(NAME, text);
    let live = live.map_err(|e| finding("refused", e))?;
    if live.live_literals().is_empty() {
        return Ok(Verdict::LeftOut);
    }
    let pose = |scene: &Scene| scene.pose(&scene.defaults(), 1.0);
    match (pose(scene), pose(&live)) {
        (Ok(a), Ok(b)) => {
            let distance = (a.eye - b.eye).length().max((a.target - b.target).length());
            if distance > ROUNDING * (1.0 + a.eye.length()) {
                return Err(finding("another camera", format!("{a:?}\nand live {b:?}")));
            }
        }
        (Err(_), Err(_)) => {}
        (a, b) => return Err(finding("one camera", format!("{a:?}\nand live {b:?}"))),
    }
    let field = |scene: &Scene| -> Result<Vec<f64>, sdfc::Error> {
        let mut field = scene.field(&scene.defaults())?;
        Ok(points().map(|point| field.distance(point)).collect())
    };
    let (Ok(a), Ok(b)) = (field(scene), field(&live)) else { return Ok(Verdict::LeftOut) };
    for ((a, b), point) in a.iter().zip(&b).zip(points()) {
        // The field is divided by a larger constant if the compiler knows less of a param.
        let is_off = |a: &f64| a.abs() > ROUNDING;
        if is_off(a) && is_off(b) && (*a < 0.0) != (*b < 0.0) {
            return Err(finding("another side", format!("at {point:?}: {a}, and live {b}")));
        }
    }
    Ok(Verdict::Holds)
}

fn service(subject: &Subject) -> Outcome {
    texts::oracles::service(&subject.text)
}

fn clauses(subject: &Subject) -> Outcome {
    let checked = Compiler::new().verify(true).compile(NAME, &subject.text);
    checked.map(|_| Verdict::Holds).map_err(|errors| finding("refuted", errors.without_warnings()))
}

fn targets(subject: &Subject) -> Outcome {
    for tool in TOOLS.iter().filter(|tool| tool.is_installed()) {
        for part in parts(&subject.scene, tool.target) {
            // A part that is not written is a finding of another oracle.
            let Ok(code) = write(&subject.scene, tool.target, part) else { continue };
            let kind = format!("{} refuses {}", tool.program, tool.target.name());
            let place = format!("{}: ", part.name);
            tool.check(part, &code).map_err(|error| finding(&kind, place + &error))?;
        }
    }
    Ok(Verdict::Holds)
}

fn methods(subject: &Subject) -> Outcome {
    // The methods need different numbers of steps, so a limit ends different rays.
    let has_limit = subject.scene.program().settings.march.steps.is_some();
    let has_rays = !subject.scene.is_planar() && is_drawn(&subject.scene);
    if has_limit || !has_rays || !subject.scene.is_certified() {
        return Ok(Verdict::LeftOut);
    }
    agreed(agree::methods(&subject.scene).map(drop))
}

fn devices(subject: &Subject) -> Outcome {
    if testing::without_gpu() || !is_drawn(&subject.scene) {
        return Ok(Verdict::LeftOut);
    }
    agreed(agree::devices(&subject.scene).map(drop))
}

fn is_drawn(scene: &Scene) -> bool {
    scene.report().distance_cost.operations <= OPERATIONS
}

/// The parts of a scene's shader that a target supports.
fn parts(scene: &Scene, target: Target) -> impl Iterator<Item = Part> + '_ {
    let is_drawn = is_drawn(scene);
    let is_asked = move |part: &Part| is_drawn || part.emit == Emit::Field;
    PARTS.into_iter().filter(move |part| is_asked(part) && is_written(scene, target, *part))
}

fn agreed(compared: Result<(), Disagreement>) -> Outcome {
    match compared {
        Ok(()) => Ok(Verdict::Holds),
        Err(Disagreement::TooLittle(_)) => Ok(Verdict::LeftOut),
        Err(Disagreement::Differ(why)) => Err(finding("pictures differ", why)),
        Err(Disagreement::Error(error)) => Err(finding("not drawn", error)),
    }
}
