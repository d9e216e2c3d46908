//! The field of a scene as a tree of Fidget.

use std::collections::HashMap;

use anyhow::{Result, bail};
use fidget::context::Tree;
use sdfc::Scene;
use sdfc_graph::{Binary, FrameInput, Graph, Node, NodeId, Ternary, Unary, reachable};

/// The scene's field at its defaults. Loops, tables and noise have no counterpart in Fidget.
pub fn tree(scene: &Scene) -> Result<Tree> {
    let program = scene.program();
    let Some(field) = program.distance else { bail!("the scene draws nothing") };
    let mut lanes: HashMap<NodeId, Vec<Tree>> = HashMap::new();
    for id in reachable(&program.graph, &[field]) {
        let value = Lanes { scene, graph: &program.graph, done: &lanes }.of(id)?;
        lanes.insert(id, value);
    }
    let origin = program.origin.map(|x| Tree::constant(x as f32));
    let [x, y, z] = origin;
    let field = lanes[&field][0].clone();
    Ok(field.remap_xyz(Tree::x() - x, Tree::y() - y, Tree::z() - z))
}

struct Lanes<'a> {
    scene: &'a Scene,
    graph: &'a Graph,
    done: &'a HashMap<NodeId, Vec<Tree>>,
}

impl Lanes<'_> {
    fn get(&self, id: NodeId) -> &[Tree] {
        &self.done[&id]
    }

    /// One tree for each lane.
    fn of(&self, id: NodeId) -> Result<Vec<Tree>> {
        let width = self.graph.ty(id).width();
        let constants = |lanes: [f64; 4]| lanes[..width].iter().map(|&x| number(x)).collect();
        Ok(match self.graph.node(id) {
            Node::Const(value) => constants(value.lanes()),
            Node::Point(0, _) => vec![Tree::x(), Tree::y(), Tree::z()][..width].to_vec(),
            Node::Frame(FrameInput::Param(index), _) => {
                constants(self.scene.params()[index as usize].default)
            }
            Node::Frame(FrameInput::Time | FrameInput::Frame, _) => constants([0.0; 4]),
            Node::Unary(operation, a) => unary(operation, self.get(a))?,
            Node::Binary(operation, a, b) => binary(operation, self.get(a), self.get(b))?,
            Node::Ternary(operation, [a, b, c]) => {
                ternary(operation, self.get(a), self.get(b), self.get(c))
            }
            Node::Splat(_, scalar) => vec![self.get(scalar)[0].clone(); width],
            Node::Compose(_, parts) => {
                parts[..width].iter().map(|&part| self.get(part)[0].clone()).collect()
            }
            Node::Swizzle(_, vector, from) => {
                from[..width].iter().map(|&lane| self.get(vector)[lane as usize].clone()).collect()
            }
            Node::Transform(columns, vector) => {
                let vector = self.get(vector);
                (0..3)
                    .map(|row| {
                        (0..3).fold(number(0.0), |sum, column| {
                            sum + self.get(columns[column])[row].clone() * vector[column].clone()
                        })
                    })
                    .collect()
            }
            Node::Point(..) | Node::Variable(..) | Node::Loop(..) | Node::Element(..) => {
                bail!("the scene has a loop or a table, which Fidget has not")
            }
            Node::Sample(..) | Node::MaterialAt(..) => bail!("the field is not expanded"),
        })
    }
}

fn number(x: f64) -> Tree {
    Tree::constant(x as f32)
}

fn each(a: &[Tree], f: impl Fn(&Tree) -> Tree) -> Vec<Tree> {
    a.iter().map(f).collect()
}

fn sum(lanes: impl IntoIterator<Item = Tree>) -> Tree {
    lanes.into_iter().reduce(|a, b| a + b).unwrap_or_else(|| number(0.0))
}

fn length(a: &[Tree]) -> Tree {
    sum(each(a, Tree::square)).sqrt()
}

fn unary(operation: Unary, a: &[Tree]) -> Result<Vec<Tree>> {
    Ok(match operation {
        Unary::Neg => each(a, Tree::neg),
        Unary::Abs => each(a, Tree::abs),
        Unary::Sign => each(a, |a| a.compare(0.0)),
        Unary::Floor => each(a, Tree::floor),
        Unary::Ceil => each(a, Tree::ceil),
        Unary::Round => each(a, Tree::round),
        Unary::Trunc => each(a, |a| a.compare(0.0) * a.abs().floor()),
        Unary::Fract => each(a, |a| a.clone() - a.floor()),
        Unary::Sqrt => each(a, Tree::sqrt),
        Unary::InverseSqrt => each(a, |a| a.sqrt().recip()),
        Unary::Exp => each(a, Tree::exp),
        Unary::Exp2 => each(a, |a| (a.clone() * std::f32::consts::LN_2).exp()),
        Unary::Log => each(a, Tree::ln),
        Unary::Log2 => each(a, |a| a.ln() * std::f32::consts::LOG2_E),
        Unary::Sin => each(a, Tree::sin),
        Unary::Cos => each(a, Tree::cos),
        Unary::Tan => each(a, Tree::tan),
        Unary::Asin => each(a, Tree::asin),
        Unary::Acos => each(a, Tree::acos),
        Unary::Atan => each(a, Tree::atan),
        Unary::Sinh => each(a, |a| (a.exp() - a.neg().exp()) * 0.5),
        Unary::Cosh => each(a, |a| (a.exp() + a.neg().exp()) * 0.5),
        Unary::Tanh => each(a, |a| {
            let e = (a.clone() * 2.0).exp();
            (e.clone() - 1.0) / (e + 1.0)
        }),
        Unary::Saturate => each(a, |a| a.max(0.0).min(1.0)),
        Unary::Length => vec![length(a)],
        Unary::Normalize => {
            let length = length(a).max(1e-30);
            each(a, |a| a.clone() / length.clone())
        }
        Unary::Not => each(a, Tree::not),
    })
}

fn binary(operation: Binary, a: &[Tree], b: &[Tree]) -> Result<Vec<Tree>> {
    let lanes = |f: fn(&Tree, &Tree) -> Tree| a.iter().zip(b).map(|(a, b)| f(a, b)).collect();
    Ok(match operation {
        Binary::Add => lanes(|a, b| a.clone() + b.clone()),
        Binary::Sub => lanes(|a, b| a.clone() - b.clone()),
        Binary::Mul => lanes(|a, b| a.clone() * b.clone()),
        Binary::Div => lanes(|a, b| a.clone() / b.clone()),
        Binary::Rem => lanes(|a, b| a.clone() - b.clone() * (a.clone() / b.clone()).floor()),
        Binary::Min => lanes(|a, b| a.min(b.clone())),
        Binary::Max => lanes(|a, b| a.max(b.clone())),
        Binary::Pow => lanes(|a, b| (a.ln() * b.clone()).exp()),
        Binary::Atan2 => lanes(|a, b| a.atan2(b.clone())),
        Binary::Step => lanes(|edge, x| less(x, edge).not()),
        Binary::Alternative => b.to_vec(),
        Binary::Dot => vec![sum(a.iter().zip(b).map(|(a, b)| a.clone() * b.clone()))],
        Binary::Cross => (0..3)
            .map(|lane| {
                let (i, j) = ((lane + 1) % 3, (lane + 2) % 3);
                a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone()
            })
            .collect(),
        Binary::Lt => lanes(less),
        Binary::Le => lanes(|a, b| less(b, a).not()),
        Binary::Eq => lanes(|a, b| a.compare(b.clone()).not()),
        Binary::Ne => lanes(|a, b| a.compare(b.clone()).not().not()),
        Binary::And => lanes(|a, b| a.and(b.clone())),
        Binary::Or => lanes(|a, b| a.or(b.clone())),
        Binary::Hash => bail!("the scene has noise, which Fidget has not"),
    })
}

/// 1 where `a < b`, else 0.
fn less(a: &Tree, b: &Tree) -> Tree {
    (a.compare(b.clone()) + 1.0).not()
}

fn ternary(operation: Ternary, a: &[Tree], b: &[Tree], c: &[Tree]) -> Vec<Tree> {
    let lanes = |f: &dyn Fn(&Tree, &Tree, &Tree) -> Tree| {
        a.iter().zip(b).zip(c).map(|((a, b), c)| f(a, b, c)).collect()
    };
    match operation {
        Ternary::Mix => lanes(&|x, y, t| x.clone() * (1.0 - t.clone()) + y.clone() * t.clone()),
        Ternary::Clamp => lanes(&|x, low, high| x.max(low.clone()).min(high.clone())),
        Ternary::Smoothstep => lanes(&|low, high, x| {
            let t = (x.clone() - low.clone()) / (high.clone() - low.clone());
            let t = t.max(0.0).min(1.0);
            t.square() * (3.0 - t * 2.0)
        }),
        Ternary::Select => {
            let condition = &a[0];
            let choose = |(yes, no): (&Tree, &Tree)| {
                condition.and(yes.clone()) + condition.not().and(no.clone())
            };
            b.iter().zip(c).map(choose).collect()
        }
    }
}
