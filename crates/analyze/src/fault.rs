//! Rules of the analysis that a test can break, one at a time, to see that some scene notices. Without the feature
//! `faults`, which tests alone turn on, nothing can be broken and nothing is left of this.

use sdfc_graph::{Binary, Graph, Node, NodeId, Ternary, Unary};

use crate::certify::lipschitz::{Constant, Reason};

/// A broken rule of an operation gives this part of the constant.
const PART: f64 = 0.125;

/// A rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// The stretch of a linear map.
    Affine,
    /// The slope of a sum.
    Sum,
    /// The slope of a product, also with the inverse of what does not vary.
    Product,
    /// The slope of a dot or cross product.
    Dot,
    /// The slope of minima and maxima.
    Extreme,
    /// The slope of maps that stretch nothing.
    Map,
    /// The slope of a vector.
    Compose,
    /// The slope of some lanes of a vector.
    Swizzle,
    /// The slope of a sample.
    Sample,
    /// The slope of a mixture.
    Mix,
    /// The slope of a choice.
    Select,
    /// The slope of a loop.
    Loop,
    /// What a function states.
    Claim,
    /// Parts that look at different components add up as those do.
    Apart,
    /// What jumps has no slope.
    Jump,
    /// What is steep somewhere has no slope.
    Unbounded,
    /// An operator's constant counts its children's.
    Children,
    /// What a shape states.
    Stated,
    /// `exact` and `bound` hold of children that are.
    Premise,
    /// A field is divided by its constant.
    Division,
    /// A constant within bounds is used within them.
    Continuation,
    /// What looks past a child's bounds cannot use its constant.
    Within,
    /// A sample at a point that is not moved rigidly is not the child's field.
    Similarity,
    /// A floor in a blend is nothing else where all else is farther away than the blend reaches.
    Reach,
    /// What is not sampled at a place is no nearer to it than the formula says.
    Copies,
}

#[cfg(feature = "faults")]
mod broken {
    use std::cell::Cell;

    use super::Rule;

    thread_local! {
        static BROKEN: Cell<Option<Rule>> = const { Cell::new(None) };
    }

    impl Rule {
        /// Does something on this thread with the rule broken.
        pub fn while_broken<T>(self, work: impl FnOnce() -> T) -> T {
            BROKEN.set(Some(self));
            let result = work();
            BROKEN.set(None);
            result
        }

        pub(crate) fn is_broken(self) -> bool {
            BROKEN.get() == Some(self)
        }
    }
}

#[cfg(not(feature = "faults"))]
impl Rule {
    pub(crate) fn is_broken(self) -> bool {
        false
    }
}

/// A node's constant, or what is left of it where its rule is broken. `affine`: it was taken for a linear map.
pub(crate) fn weakened(
    graph: &mut Graph,
    node: NodeId,
    affine: bool,
    constant: Constant,
) -> Constant {
    let broken = match &constant {
        Ok(_) => rule_of(graph, node, affine).is_some_and(Rule::is_broken),
        Err(Reason::Jump(_)) => Rule::Jump.is_broken(),
        Err(Reason::Unbounded(_)) => Rule::Unbounded.is_broken(),
        Err(_) => false,
    };
    match constant {
        Ok(constant) if broken => {
            let part = graph.number(PART);
            Ok(graph.mul(part, constant))
        }
        // As its derivative says.
        Err(Reason::Jump(_)) if broken => Ok(graph.number(0.0)),
        Err(_) if broken => Ok(graph.number(1.0)),
        whole => whole,
    }
}

/// Whose rule gives a node's constant.
fn rule_of(graph: &Graph, node: NodeId, affine: bool) -> Option<Rule> {
    if graph.claim_of(node).is_some() {
        return Some(Rule::Claim);
    }
    if affine {
        return Some(Rule::Affine);
    }
    match graph.node(node) {
        Node::Unary(op, _) => (op != Unary::Neg).then_some(Rule::Map),
        Node::Binary(op, ..) => match op {
            Binary::Add | Binary::Sub => Some(Rule::Sum),
            Binary::Mul | Binary::Div => Some(Rule::Product),
            Binary::Dot | Binary::Cross => Some(Rule::Dot),
            Binary::Min | Binary::Max => Some(Rule::Extreme),
            Binary::Rem
            | Binary::Step
            | Binary::Hash
            | Binary::Pow
            | Binary::Atan2
            | Binary::Lt
            | Binary::Le
            | Binary::Eq
            | Binary::Ne
            | Binary::And
            | Binary::Or => None,
        },
        Node::Ternary(op, _) => match op {
            Ternary::Mix => Some(Rule::Mix),
            Ternary::Select => Some(Rule::Select),
            Ternary::Clamp | Ternary::Smoothstep => None,
        },
        Node::Compose(..) => Some(Rule::Compose),
        Node::Swizzle(..) => Some(Rule::Swizzle),
        Node::Sample(..) => Some(Rule::Sample),
        Node::Loop(..) => Some(Rule::Loop),
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Splat(..)
        | Node::Transform(..)
        | Node::Variable(..)
        | Node::Element(..)
        | Node::MaterialAt(..) => None,
    }
}
