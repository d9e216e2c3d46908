//! Random expressions built twice: as nodes, through the simplifying builders, and as plain f64
//! arithmetic.

use proptest::prelude::*;
use sdfc_graph::eval::{FrameValues, Number};
use sdfc_graph::{Binary, Dim, FrameInput, Graph, NodeId, Ternary, Type, Unary};

/// The choices that make one expression.
pub type Step = (u8, [u8; 4]);

/// Up to `size` steps.
pub fn steps(size: usize) -> impl Strategy<Value = Vec<Step>> {
    prop::collection::vec((0_u8..20, any::<[u8; 4]>()), 1..size)
}

/// Only maps of vectors: affine maps, and a rotation that depends on the point.
pub fn maps(size: usize) -> impl Strategy<Value = Vec<Step>> {
    let kind = prop_oneof![
        4 => Just(20_u8), 4 => Just(21), 2 => Just(22), 2 => Just(23), 2 => Just(24), 1 => Just(25),
    ];
    prop::collection::vec((kind, any::<[u8; 4]>()), 1..size)
}

type Function = fn(f64) -> f64;

const CONSTANTS: [f64; 12] =
    [0.0, 1.0, -1.0, 0.5, 2.0, -2.5, 3.7, 1.0 / 3.0, -0.3, 10.0, 1.57, 0.1];

#[derive(Clone, Copy)]
struct Twin<const N: usize> {
    id: NodeId,
    value: [f64; N],
}

/// Expressions with their values at one point.
pub struct Case {
    pub graph: Graph,
    pub point: NodeId,
    scalars: Vec<Twin<1>>,
    vectors: Vec<Twin<3>>,
    /// True if two compared values are so close that rounding decides.
    fragile: bool,
}

impl Case {
    /// All nodes with their values; `None` where rounding decides one of them, or one is too large
    /// to compare.
    pub fn expected(&self) -> Option<Vec<(NodeId, Vec<f64>)>> {
        let scalars = self.scalars.iter().map(|twin| (twin.id, twin.value.to_vec()));
        let vectors = self.vectors.iter().map(|twin| (twin.id, twin.value.to_vec()));
        let all: Vec<_> = scalars.chain(vectors).collect();
        let tame = all.iter().flat_map(|(_, lanes)| lanes).all(|lane| lane.abs() < 1e6);
        (tame && !self.fragile).then_some(all)
    }

    /// The last number.
    pub fn scalar(&self) -> NodeId {
        self.scalars[self.scalars.len() - 1].id
    }

    /// The last vector.
    pub fn vector(&self) -> NodeId {
        self.vectors[self.vectors.len() - 1].id
    }

    pub fn replay(&mut self, steps: &[Step]) {
        self.scalars.truncate(4 + CONSTANTS.len());
        self.vectors.truncate(1);
        steps.iter().for_each(|&step| self.step(step));
    }

    fn step(&mut self, (kind, picks): Step) {
        let [op, ..] = picks.map(usize::from);
        let s = [1, 2, 3].map(|i| self.scalars[pick(self.scalars.len(), picks[i])]);
        let v = [1, 2, 3].map(|i| self.vectors[pick(self.vectors.len(), picks[i])]);
        let lanes = [1, 2, 3].map(|i| picks[i] % 3);
        match kind {
            0..=2 => self.unary(op, s[0]),
            3..=6 => self.binary(op, s[0], s[1]),
            7 => self.ternary(op, s),
            8 => self.select(s, self.scalars[pick(self.scalars.len(), picks[0])]),
            9 => {
                let value = s.map(|s| s.value[0]);
                let id = self.graph.compose(&s.map(|s| s.id));
                self.vectors.push(Twin { id, value });
            }
            10 | 11 => {
                let id = self.graph.component(v[0].id, lanes[1]);
                self.scalar_of(id, v[0].value[usize::from(lanes[1])]);
            }
            12 => {
                let id = self.graph.swizzle(v[0].id, &lanes);
                let value = lanes.map(|lane| v[0].value[usize::from(lane)]);
                self.vectors.push(Twin { id, value });
            }
            13 | 14 => self.vector_binary(op, v[0], v[1]),
            15 | 16 => {
                let filled = self.graph.splat(Type::Vec3, s[1].id);
                let value = [s[1].value[0]; 3];
                self.vector_binary(op, v[0], Twin { id: filled, value });
            }
            17 => self.vector_unary(op, v[0]),
            18 => {
                let [x, y] = [v[0].value, v[1].value];
                let id = self.graph.dot(v[0].id, v[1].id);
                self.scalar_of(id, (0..3).map(|i| x[i] * y[i]).sum());
            }
            19 => {
                let id = self.graph.length(v[0].id);
                self.scalar_of(id, v[0].value.iter().map(|x| x * x).sum::<f64>().sqrt());
            }
            _ => self.map(kind, picks),
        }
    }

    fn scalar_of(&mut self, id: NodeId, value: f64) {
        self.scalars.push(Twin { id, value: [value] });
    }

    fn unary(&mut self, op: usize, a: Twin<1>) {
        const OPS: &[(Unary, Function)] = &[
            (Unary::Neg, Number::neg),
            (Unary::Neg, Number::neg),
            (Unary::Abs, Number::abs),
            (Unary::Sin, Number::sin),
            (Unary::Cos, Number::cos),
            (Unary::Tanh, Number::tanh),
            (Unary::Saturate, Number::saturate),
            (Unary::Atan, Number::atan),
        ];
        let (op, f) = OPS[op % OPS.len()];
        let id = self.graph.unary(op, a.id);
        self.scalar_of(id, f(a.value[0]));
    }

    fn binary(&mut self, op: usize, a: Twin<1>, b: Twin<1>) {
        let (x, y) = (a.value[0], b.value[0]);
        let graph = &mut self.graph;
        let (id, value) = match op % 8 {
            0 | 1 => (graph.add(a.id, b.id), x + y),
            2 | 3 => (graph.sub(a.id, b.id), x - y),
            4 | 5 => (graph.mul(a.id, b.id), x * y),
            6 => {
                self.fragile |= y.abs() < 1e-3;
                (graph.div(a.id, b.id), if y == 0.0 { 0.0 } else { x / y })
            }
            _ if picks_max(op) => (graph.max(a.id, b.id), Number::max(x, y)),
            _ => (graph.min(a.id, b.id), Number::min(x, y)),
        };
        self.scalar_of(id, value);
    }

    fn ternary(&mut self, op: usize, [a, b, c]: [Twin<1>; 3]) {
        let (x, y, z) = (a.value[0], b.value[0], c.value[0]);
        let graph = &mut self.graph;
        let (id, value) = match op % 3 {
            0 => (graph.ternary(Ternary::Mix, a.id, b.id, c.id), x.mix(y, z)),
            1 => {
                let (lo, hi) = (graph.min(b.id, c.id), graph.max(b.id, c.id));
                (graph.ternary(Ternary::Clamp, a.id, lo, hi), x.clamp(y.min(z), y.max(z)))
            }
            _ => {
                let exponent = [0.0, 1.0, 2.0, 3.0, 4.0, 0.5][op / 3 % 6];
                let (base, power) = (graph.abs(a.id), graph.number(exponent));
                self.fragile |= x.abs() < 1e-6;
                (graph.binary(Binary::Pow, base, power), x.abs().powf(exponent))
            }
        };
        self.scalar_of(id, value);
    }

    fn select(&mut self, [a, b, c]: [Twin<1>; 3], d: Twin<1>) {
        let (x, y) = (a.value[0], b.value[0]);
        self.fragile |= (x - y).abs() < 1e-7 && (a.id != b.id || x != y);
        let condition = self.graph.lt(a.id, b.id);
        let id = self.graph.select(condition, c.id, d.id);
        self.scalar_of(id, if x < y { c.value[0] } else { d.value[0] });
    }

    fn vector_unary(&mut self, op: usize, a: Twin<3>) {
        let (id, value) = match op % 3 {
            0 => (self.graph.neg(a.id), a.value.map(|x| -x)),
            1 => (self.graph.abs(a.id), a.value.map(f64::abs)),
            _ => {
                let length = a.value.iter().map(|x| x * x).sum::<f64>().sqrt();
                self.fragile |= length < 1e-3;
                (self.graph.unary(Unary::Normalize, a.id), a.value.map(|x| x / length.max(1e-9)))
            }
        };
        self.vectors.push(Twin { id, value });
    }

    fn vector_binary(&mut self, op: usize, a: Twin<3>, b: Twin<3>) {
        let each = |f: fn(f64, f64) -> f64| [0, 1, 2].map(|i| f(a.value[i], b.value[i]));
        let [p, q] = [a.value, b.value];
        let graph = &mut self.graph;
        let (id, value) = match op % 6 {
            0 => (graph.add(a.id, b.id), each(|x, y| x + y)),
            1 => (graph.sub(a.id, b.id), each(|x, y| x - y)),
            2 => (graph.mul(a.id, b.id), each(|x, y| x * y)),
            3 => (graph.min(a.id, b.id), each(Number::min)),
            4 => (graph.max(a.id, b.id), each(Number::max)),
            _ => (
                graph.binary(Binary::Cross, a.id, b.id),
                [0, 1, 2].map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    p[j] * q[k] - p[k] * q[j]
                }),
            ),
        };
        self.vectors.push(Twin { id, value });
    }

    /// A map of the last vector or of an earlier one.
    fn map(&mut self, kind: u8, picks: [u8; 4]) {
        let last = self.vectors.len() - 1;
        let v =
            self.vectors[if picks[0].is_multiple_of(8) { pick(last + 1, picks[1]) } else { last }];
        let constants = [1, 2, 3].map(|i| CONSTANTS[usize::from(picks[i]) % CONSTANTS.len()]);
        match kind {
            20 => {
                let id = self.graph.constant(Type::Vec3, &constants);
                self.vector_binary(1, v, Twin { id, value: constants });
            }
            21 => {
                let quarter = self.graph.number(f64::from(picks[2] % 4) * 90.0_f64.to_radians());
                let [id, value] = [self.graph.as_number(quarter), Some(constants[0])];
                let angle = if picks[1].is_multiple_of(3) { id } else { value }.unwrap_or(0.0);
                let id = self.graph.number(angle);
                self.turn(v, picks[3], Twin { id, value: [angle] });
            }
            22 => {
                let param = self.scalars[3];
                self.turn(v, picks[3], param);
            }
            23 => {
                let factor = constants[0];
                let id = self.graph.number(factor);
                let id = self.graph.splat(Type::Vec3, id);
                self.vector_binary(2, v, Twin { id, value: [factor; 3] });
            }
            24 => self.vector_unary(0, v),
            _ => {
                let id = self.graph.component(v.id, picks[1] % 3);
                let value = [v.value[usize::from(picks[1] % 3)]];
                self.turn(v, picks[3], Twin { id, value });
            }
        }
    }

    /// A rotation about one axis.
    fn turn(&mut self, v: Twin<3>, axis: u8, angle: Twin<1>) {
        let (i, j) = (usize::from(axis % 3), usize::from((axis % 3 + 1) % 3));
        let graph = &mut self.graph;
        let (c, s) = (graph.unary(Unary::Cos, angle.id), graph.unary(Unary::Sin, angle.id));
        let (x, y) = (graph.component(v.id, i as u8), graph.component(v.id, j as u8));
        let [xc, xs, yc, ys] = [(x, c), (x, s), (y, c), (y, s)].map(|(a, b)| graph.mul(a, b));
        let mut parts = [0, 1, 2].map(|lane| graph.component(v.id, lane));
        (parts[i], parts[j]) = (graph.sub(xc, ys), graph.add(xs, yc));
        let id = graph.compose(&parts);
        let (s, c) = angle.value[0].sin_cos();
        let mut value = v.value;
        (value[i], value[j]) = (v.value[i] * c - v.value[j] * s, v.value[i] * s + v.value[j] * c);
        self.vectors.push(Twin { id, value });
    }
}

fn picks_max(op: usize) -> bool {
    (op / 8).is_multiple_of(2)
}

/// Mostly recent values, so that expressions grow deep.
fn pick(len: usize, by: u8) -> usize {
    len - 1 - usize::from(by) % len.min(if by.is_multiple_of(3) { len } else { 6 })
}

/// Expressions over a point, a param and constants.
pub fn case(steps: &[Step], point: [f64; 3], param: f64) -> Case {
    let mut graph = Graph::new();
    let p = graph.point(0, Dim::Three);
    let mut scalars: Vec<Twin<1>> = (0..3_u8)
        .map(|lane| {
            let id = graph.component(p, lane);
            Twin { id, value: [point[usize::from(lane)]] }
        })
        .collect();
    scalars
        .push(Twin { id: graph.frame_input(FrameInput::Param(0), Type::Scalar), value: [param] });
    scalars.extend(CONSTANTS.map(|value| Twin { id: graph.number(value), value: [value] }));
    let vectors = vec![Twin { id: p, value: point }];
    let mut case = Case { graph, point: p, scalars, vectors, fragile: false };
    case.replay(steps);
    case
}

/// The param.
pub fn frame(param: f64) -> FrameValues {
    FrameValues { params: vec![[param; 4]], ..FrameValues::default() }
}
