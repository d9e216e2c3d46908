//! Typed builders. Other crates make every node here, so folding and simplification happen as the
//! graph grows, and equal values share one node.
//!
//! A scalar operand of a vector operation is splatted to the vector's width.

use std::sync::Arc;

use crate::graph::Graph;
use crate::loops::{Loop, Table};
use crate::node::{
    Binary, Const, Dim, FrameInput, LoopId, LoopVar, MaterialField, Node, NodeId, ShapeId,
    SurfaceVector, TableId, Ternary, Type, Unary,
};

impl Graph {
    /// A constant number.
    pub fn number(&mut self, value: f64) -> NodeId {
        self.constant(Type::Scalar, &[value])
    }

    /// A constant truth value.
    pub fn boolean(&mut self, value: bool) -> NodeId {
        self.constant(Type::Bool, &[f64::from(u8::from(value))])
    }

    /// A constant of any type.
    pub fn constant(&mut self, ty: Type, lanes: &[f64]) -> NodeId {
        self.intern(Node::Const(Const::new(ty, lanes)))
    }

    /// The point of the formula at a level.
    pub fn point(&mut self, level: u16, dim: Dim) -> NodeId {
        self.intern(Node::Point(level, dim))
    }

    /// A direction at the surface.
    pub fn surface_vector(&mut self, vector: SurfaceVector) -> NodeId {
        self.point(vector.level(), Dim::Three)
    }

    /// A per-frame input.
    pub fn frame_input(&mut self, input: FrameInput, ty: Type) -> NodeId {
        self.intern(Node::Frame(input, ty))
    }

    /// An operation on one argument.
    pub fn unary(&mut self, op: Unary, a: NodeId) -> NodeId {
        self.make(Node::Unary(op, a))
    }

    /// An operation on two arguments.
    pub fn binary(&mut self, op: Binary, a: NodeId, b: NodeId) -> NodeId {
        let [a, b] = self.widened([a, b]);
        self.make(Node::Binary(op, a, b))
    }

    /// `Mix`, `Clamp` or `Smoothstep`; `Select` has its own builder.
    pub fn ternary(&mut self, op: Ternary, a: NodeId, b: NodeId, c: NodeId) -> NodeId {
        let arguments = self.widened([a, b, c]);
        self.make(Node::Ternary(op, arguments))
    }

    /// `yes` where the condition is true, else `no`.
    pub fn select(&mut self, condition: NodeId, yes: NodeId, no: NodeId) -> NodeId {
        let [yes, no] = self.widened([yes, no]);
        self.make(Node::Ternary(Ternary::Select, [condition, yes, no]))
    }

    /// A vector whose lanes are all equal to one scalar.
    pub fn splat(&mut self, ty: Type, a: NodeId) -> NodeId {
        if self.ty(a) == ty {
            return a;
        }
        self.make(Node::Splat(ty, a))
    }

    /// A vector of 2 to 4 scalars; a single scalar is returned as it is.
    pub fn compose(&mut self, parts: &[NodeId]) -> NodeId {
        let Some(ty) = Type::of_width(parts.len()).filter(|_| parts.len() > 1) else {
            return parts.first().copied().unwrap_or_else(|| self.number(0.0));
        };
        let mut list = [parts[0]; 4];
        list[..parts.len()].copy_from_slice(parts);
        self.make(Node::Compose(ty, list))
    }

    /// Components of a vector by index.
    pub fn swizzle(&mut self, a: NodeId, lanes: &[u8]) -> NodeId {
        let ty = Type::of_width(lanes.len()).unwrap_or(Type::Scalar);
        let mut list = [0; 4];
        for (entry, lane) in list.iter_mut().zip(lanes) {
            *entry = *lane;
        }
        self.make(Node::Swizzle(ty, a, list))
    }

    /// One component of a vector; a scalar is its own component.
    pub fn component(&mut self, a: NodeId, lane: u8) -> NodeId {
        if self.ty(a).width() == 1 { a } else { self.swizzle(a, &[lane]) }
    }

    /// `c0 * v.x + c1 * v.y + c2 * v.z`
    pub fn transform(&mut self, columns: [NodeId; 3], v: NodeId) -> NodeId {
        self.make(Node::Transform(columns, v))
    }

    /// Distance of a shape at a point.
    pub fn sample(&mut self, shape: ShapeId, point: NodeId) -> NodeId {
        self.intern(Node::Sample(shape, point))
    }

    /// Material of a shape at a point.
    pub fn material_at(&mut self, shape: ShapeId, point: NodeId, field: MaterialField) -> NodeId {
        self.intern(Node::MaterialAt(shape, point, field))
    }

    /// A variable of the loop that is nested in `depth` others.
    pub fn variable(&mut self, depth: u8, var: LoopVar, ty: Type) -> NodeId {
        self.intern(Node::Variable(depth, var, ty))
    }

    /// Adds a loop and returns the parts of its state after the last iteration.
    ///
    /// A part that no iteration changes is its initial value.
    pub fn add_loop(&mut self, loop_: Loop) -> Vec<NodeId> {
        let types: Vec<Type> = loop_.init.iter().map(|&id| self.ty(id)).collect();
        let unchanged: Vec<bool> = (0..)
            .zip(loop_.step.iter().zip(&types))
            .map(|(i, (&step, &ty))| {
                self.node(step) == Node::Variable(loop_.depth, LoopVar::State(i), ty)
            })
            .collect();
        if loop_.max_iterations == 0 || unchanged.iter().all(|unchanged| *unchanged) {
            return loop_.init;
        }
        let init = loop_.init.clone();
        let id = self.intern_loop(loop_);
        let mut results = Vec::with_capacity(types.len());
        for (position, ty) in (0..).zip(types) {
            results.push(if unchanged[usize::from(position)] {
                init[usize::from(position)]
            } else {
                self.intern(Node::Loop(id, position, ty))
            });
        }
        results
    }

    /// One part of the state after a loop like this one over other nodes, with `around` more loops
    /// around it.
    pub(crate) fn rebuild_loop(
        &mut self,
        id: LoopId,
        position: u16,
        around: u8,
        map: impl FnMut(NodeId) -> NodeId,
    ) -> NodeId {
        let mut loop_ = self.loop_at(id).map(map);
        loop_.depth += around;
        self.add_loop(loop_)[usize::from(position)]
    }

    /// The element of a table of constants at an index, which is rounded down and clamped to the
    /// table.
    pub fn element(&mut self, table: Table, at: NodeId) -> NodeId {
        match self.constant_element(&table, at) {
            Some(element) => self.constant(element.ty(), &element.lanes()),
            None => {
                let id = self.add_table(table);
                self.element_of(id, at)
            }
        }
    }

    /// Adds a table, for several lookups with [`Self::element_of`].
    pub fn add_table(&mut self, table: Table) -> TableId {
        self.intern_table(Arc::new(table))
    }

    /// As [`Self::element`], of a table that was added.
    pub fn element_of(&mut self, table: TableId, at: NodeId) -> NodeId {
        match self.constant_element(self.table(table), at) {
            Some(element) => self.constant(element.ty(), &element.lanes()),
            None => self.intern(Node::Element(table, at, self.table(table).ty)),
        }
    }

    /// The element at an index that is a constant.
    fn constant_element(&self, table: &Table, at: NodeId) -> Option<Const> {
        let at = self.as_number(at)?;
        let last = table.elements.len().saturating_sub(1);
        Some(table.elements[(at.max(0.0) as usize).min(last)])
    }

    fn widened<const N: usize>(&mut self, arguments: [NodeId; N]) -> [NodeId; N] {
        let widest = arguments.map(|a| self.ty(a)).into_iter().max().unwrap_or(Type::Scalar);
        if widest.width() == 1 {
            return arguments;
        }
        arguments.map(|a| self.splat(widest, a))
    }
}

macro_rules! shorthand {
    ($($(#[$doc:meta])* $name:ident = $method:ident($op:expr; $($arg:ident),*);)*) => {
        impl Graph {$(
            $(#[$doc])*
            pub fn $name(&mut self, $($arg: NodeId),*) -> NodeId {
                self.$method($op, $($arg),*)
            }
        )*}
    };
}

shorthand! {
    /// `-a`
    neg = unary(Unary::Neg; a);
    /// `|a|`, componentwise
    abs = unary(Unary::Abs; a);
    /// Euclidean length
    length = unary(Unary::Length; a);
    /// `a + b`
    add = binary(Binary::Add; a, b);
    /// `a - b`
    sub = binary(Binary::Sub; a, b);
    /// `a * b`
    mul = binary(Binary::Mul; a, b);
    /// `a / b`
    div = binary(Binary::Div; a, b);
    /// The lesser, componentwise
    min = binary(Binary::Min; a, b);
    /// The greater, componentwise
    max = binary(Binary::Max; a, b);
    /// Scalar product
    dot = binary(Binary::Dot; a, b);
    /// `a < b`
    lt = binary(Binary::Lt; a, b);
    /// `a <= b`
    le = binary(Binary::Le; a, b);
}
