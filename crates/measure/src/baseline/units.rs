//! Encodes scenes as op units: the union of many units, each an operation on two primitives.
//!
//! Primitives and translations are recognised by the names of their definitions. Operations are
//! recognised by their values: a formula of two samples is evaluated at many pairs of distances, so
//! that `a - b`, `difference(a, b)` and a user's own operator are the same unit.

use sdfc_graph::eval::{FrameValues, Tape, evaluate_frame};
use sdfc_graph::{Arg, Dim, Graph, Node, NodeId, Scene, Shape, ShapeId, reachable};

use super::{Bytes, Encoded, Inexpressible};

/// Number of distance pairs at which an operation is evaluated.
const TRIALS: usize = 64;
/// Largest difference between the values of equal operations.
const TOLERANCE: f64 = 1e-9;
/// Bytes of a row of the largest table.
const ROW: usize = 32;

/// Returns the tables of a scene at a frame, in the order of `baseline/units.wgsl`: units, planes,
/// spheres, boxes.
///
/// # Errors
///
/// [`Inexpressible`] names the first shape that no unit can express.
pub fn units(scene: &Scene, frame: &FrameValues) -> Result<Encoded, Inexpressible> {
    let root = scene.root.ok_or_else(|| Inexpressible("the scene draws nothing".to_owned()))?;
    let mut encoder = Encoder { graph: &scene.graph, frame, tables: Tables::default() };
    // Operands of the union itself, which are paired in the end.
    let mut operands = Vec::new();
    let mut todo = vec![Placed { shape: root, offset: [0.0; 3] }];
    while let Some(placed) = todo.pop() {
        match encoder.meaning(placed)? {
            Meaning::Leaf(operand) => operands.push(operand),
            Meaning::Wrapped(inner) => todo.push(inner),
            Meaning::Nearest(parts) => todo.extend(parts.into_iter().rev()),
            Meaning::Pair(operation, [a, b]) => {
                let operands = [encoder.operand(a)?, encoder.operand(b)?];
                encoder.tables.units.push(Unit { operands, operation });
            }
        }
    }
    for pair in operands.chunks(2) {
        let operands = [pair[0], pair.last().copied().unwrap_or(pair[0])];
        encoder.tables.units.push(Unit { operands, operation: Operation::Union });
    }
    Ok(encoder.tables.encoded())
}

/// A translated shape.
#[derive(Clone, Copy)]
struct Placed {
    shape: ShapeId,
    offset: [f64; 3],
}

/// A row of a table.
#[derive(Clone, Copy)]
struct Operand {
    kind: u32,
    id: u32,
}

const PLANE: u32 = 0;
const SPHERE: u32 = 1;
const BOX: u32 = 2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Union,
    Subtraction,
    Intersection,
    SmoothUnion(f64),
}

impl Operation {
    fn code(self) -> u32 {
        match self {
            Self::Union => 0,
            Self::Subtraction => 1,
            Self::Intersection => 2,
            Self::SmoothUnion(_) => 3,
        }
    }

    /// Returns the width of the blend, or 1 without one, since shaders may compute values that they
    /// do not select.
    fn width(self) -> f64 {
        match self {
            Self::Union | Self::Subtraction | Self::Intersection => 1.0,
            Self::SmoothUnion(width) => width,
        }
    }

    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Union => a.min(b),
            Self::Subtraction => a.max(-b),
            Self::Intersection => a.max(b),
            Self::SmoothUnion(width) => {
                let h = (width - (b - a).abs()).max(0.0);
                a.min(b) - h * h * (0.25 / width)
            }
        }
    }
}

struct Unit {
    operands: [Operand; 2],
    operation: Operation,
}

/// The form of a shape in units.
enum Meaning {
    Leaf(Operand),
    /// The same field, translated or with a material.
    Wrapped(Placed),
    Nearest(Vec<Placed>),
    Pair(Operation, [Placed; 2]),
}

struct Encoder<'a> {
    graph: &'a Graph,
    frame: &'a FrameValues,
    tables: Tables,
}

impl Encoder<'_> {
    /// Returns the primitive inside of materials and translations.
    fn operand(&mut self, placed: Placed) -> Result<Operand, Inexpressible> {
        let mut inner = placed;
        loop {
            match self.meaning(inner)? {
                Meaning::Leaf(operand) => return Ok(operand),
                Meaning::Wrapped(next) => inner = next,
                Meaning::Nearest(_) | Meaning::Pair(..) => {
                    let name = &self.graph.shape(inner.shape).definition;
                    return Err(Inexpressible(format!(
                        "a unit's operands are planes, spheres and boxes; here one is `{name}`"
                    )));
                }
            }
        }
    }

    fn meaning(&mut self, placed: Placed) -> Result<Meaning, Inexpressible> {
        let shape = self.graph.shape(placed.shape);
        if shape.dim == Dim::Three {
            match shape.definition.as_str() {
                "plane" => return self.plane(shape, placed.offset).map(Meaning::Leaf),
                "sphere" => return self.sphere(shape, placed.offset).map(Meaning::Leaf),
                "box" => return self.block(shape, placed.offset).map(Meaning::Leaf),
                "translate" => return self.translated(shape, placed.offset).map(Meaning::Wrapped),
                _ => {}
            }
        }
        self.operator(shape, placed.offset)
    }

    fn plane(&mut self, shape: &Shape, offset: [f64; 3]) -> Result<Operand, Inexpressible> {
        let [height, normal] = self.arguments(shape)?;
        let [x, y, z, _] = normal;
        let length = (x * x + y * y + z * z).sqrt();
        let [x, y, z] = [x / length, y / length, z / length];
        let height = height[0] + x * offset[0] + y * offset[1] + z * offset[2];
        Ok(push(&mut self.tables.planes, PLANE, [x, y, z, height]))
    }

    fn sphere(&mut self, shape: &Shape, [x, y, z]: [f64; 3]) -> Result<Operand, Inexpressible> {
        let [radius] = self.arguments(shape)?;
        Ok(push(&mut self.tables.spheres, SPHERE, [x, y, z, radius[0]]))
    }

    fn block(&mut self, shape: &Shape, center: [f64; 3]) -> Result<Operand, Inexpressible> {
        let [size] = self.arguments(shape)?;
        let half_size = [size[0] / 2.0, size[1] / 2.0, size[2] / 2.0];
        Ok(push(&mut self.tables.boxes, BOX, [center, half_size]))
    }

    /// Returns the first arguments, which are numbers and vectors.
    fn arguments<const N: usize>(&self, shape: &Shape) -> Result<[[f64; 4]; N], Inexpressible> {
        let name = &shape.definition;
        let unknown = || Inexpressible(format!("an argument of `{name}` depends on the point"));
        let mut nodes = shape.args.iter().filter_map(|arg| match arg {
            Arg::Node(id) => Some(*id),
            Arg::Shape(_) | Arg::List(_) | Arg::Text(_) | Arg::Function(_) => None,
        });
        let mut values = [[0.0; 4]; N];
        for value in &mut values {
            let node = nodes.next().ok_or_else(unknown)?;
            let found = evaluate_frame(self.graph, &[node], self.frame);
            *value = *found.first().ok_or_else(unknown)?;
            if value.iter().any(|lane| !lane.is_finite()) {
                return Err(unknown());
            }
        }
        Ok(values)
    }

    /// Returns the translated shape. Its offset is the negative of its sample point at the origin.
    fn translated(&self, shape: &Shape, offset: [f64; 3]) -> Result<Placed, Inexpressible> {
        let unknown = || Inexpressible("a translation depends on the point".to_owned());
        let Node::Sample(inner, point) = self.graph.node(shape.formula) else {
            return Err(unknown());
        };
        let tape = Tape::new(self.graph, &[point]).map_err(|_| unknown())?;
        let mut evaluator = tape.prepare::<f64>(self.frame);
        let &[x, y, z, _] = evaluator.eval([0.0; 3]).first().ok_or_else(unknown)?;
        let offset = [offset[0] - x, offset[1] - y, offset[2] - z];
        Ok(Placed { shape: inner, offset })
    }

    /// Recognises the operation of a formula on samples that are all taken at the shape's point.
    fn operator(&self, shape: &Shape, offset: [f64; 3]) -> Result<Meaning, Inexpressible> {
        let name = &shape.definition;
        let samples = self.samples(shape).ok_or_else(|| {
            Inexpressible(format!("`{name}` is not a plane, sphere, box or translation of one"))
        })?;
        let parts: Vec<_> = shape.children.iter().map(|&shape| Placed { shape, offset }).collect();
        let probe = Probe::new(self.graph, shape.formula, &samples, self.frame)
            .ok_or_else(|| Inexpressible(format!("`{name}` is not a function of distances")))?;
        if probe.equals(1.0, |distances| distances.iter().copied().fold(f64::INFINITY, f64::min)) {
            return Ok(match parts[..] {
                [only] => Meaning::Wrapped(only),
                _ => Meaning::Nearest(parts),
            });
        }
        let pair = <[Placed; 2]>::try_from(parts).ok();
        let found = pair.and_then(|pair| Some((probe.operation()?, pair)));
        let (operation, pair) = found.ok_or_else(|| {
            let count = samples.len();
            Inexpressible(format!("`{name}` of {count} is no operation that a unit has"))
        })?;
        Ok(Meaning::Pair(operation, pair))
    }

    /// Returns the samples of the children, in their order; `None` unless each is sampled once, at
    /// the shape's point.
    fn samples(&self, shape: &Shape) -> Option<Vec<NodeId>> {
        let mut samples = vec![None; shape.children.len()];
        for id in reachable(self.graph, &[shape.formula]) {
            let Node::Sample(child, point) = self.graph.node(id) else { continue };
            let index = shape.children.iter().position(|&known| known == child)?;
            let here = self.graph.node(point) == Node::Point(shape.level, shape.dim);
            if !here || samples[index].replace(id).is_some() {
                return None;
            }
        }
        let samples: Option<Vec<_>> = samples.into_iter().collect();
        samples.filter(|samples| !samples.is_empty())
    }
}

fn push<T>(table: &mut Vec<T>, kind: u32, row: T) -> Operand {
    table.push(row);
    Operand { kind, id: table.len() as u32 - 1 }
}

/// A formula as a function of the distances that it samples.
struct Probe<'a> {
    tape: Tape,
    frame: &'a FrameValues,
    count: usize,
}

impl<'a> Probe<'a> {
    fn new(
        graph: &Graph,
        formula: NodeId,
        samples: &[NodeId],
        frame: &'a FrameValues,
    ) -> Option<Self> {
        let first = u32::try_from(frame.params.len()).ok()?;
        let tape = Tape::for_operator(graph, formula, samples, first).ok()?;
        Some(Self { tape, frame, count: samples.len() })
    }

    fn at(&self, distances: &[f64]) -> f64 {
        let mut frame = self.frame.clone();
        frame.params.extend(distances.iter().map(|&distance| [distance; 4]));
        self.tape.prepare::<f64>(&frame).scalar([f64::NAN; 3])
    }

    /// Returns true if it has the same values as another function of distances. `scale` is the unit
    /// of the distances.
    fn equals(&self, scale: f64, other: impl Fn(&[f64]) -> f64) -> bool {
        (0..TRIALS).all(|trial| {
            let distances: Vec<f64> =
                (0..self.count).map(|index| scale * trial_distance(trial, index)).collect();
            (self.at(&distances) - other(&distances)).abs() <= TOLERANCE * scale
        })
    }

    /// Returns the operation on two distances that has the same values.
    fn operation(&self) -> Option<Operation> {
        let hard = [Operation::Subtraction, Operation::Intersection].into_iter();
        // Where both distances are 0, a blend is lower by a quarter of its width.
        let width = -4.0 * self.at(&[0.0, 0.0]);
        let smooth = (width > TOLERANCE).then_some((Operation::SmoothUnion(width), width));
        let candidates = hard.map(|operation| (operation, 1.0)).chain(smooth);
        let mut fitting = candidates
            .filter(|&(operation, scale)| self.equals(scale, |d| operation.apply(d[0], d[1])));
        fitting.next().map(|(operation, _)| operation)
    }
}

/// Between -1.4 and 1.4, in steps of 0.1, so that equal distances occur too.
fn trial_distance(trial: usize, index: usize) -> f64 {
    ((trial * trial * 7 + trial * index * 13 + index * 11) % 29) as f64 / 10.0 - 1.4
}

#[derive(Default)]
struct Tables {
    units: Vec<Unit>,
    /// Unit normal, then the height along it.
    planes: Vec<[f64; 4]>,
    /// Centre, then radius.
    spheres: Vec<[f64; 4]>,
    /// Centre, then half the size.
    boxes: Vec<[[f64; 3]; 2]>,
}

impl Tables {
    fn encoded(&self) -> Encoded {
        let mut tables: [Bytes; 4] = Default::default();
        let [units, planes, spheres, boxes] = &mut tables;
        for Unit { operands: [a, b], operation } in &self.units {
            units.words(&[a.kind, a.id, b.kind, b.id, operation.code()]);
            units.floats(&[operation.width() as f32]).words(&[0, 0]);
        }
        for (rows, bytes) in [(&self.planes, planes), (&self.spheres, spheres)] {
            bytes.floats(&rows.as_flattened().iter().map(|lane| *lane as f32).collect::<Vec<_>>());
        }
        for row in self.boxes.as_flattened() {
            boxes.floats(&row.map(|lane| lane as f32)).words(&[0]);
        }
        let tables = tables.into_iter().map(|Bytes(mut bytes)| {
            // A buffer holds at least one row; nothing refers to this one.
            bytes.resize(bytes.len().max(ROW), 0);
            bytes
        });
        let iterations = self.units.len();
        Encoded { tables: tables.collect(), iterations, leaves: 2 * iterations }
    }
}
