//! The types of values.

use sdfc_graph::Dim;

/// The type of a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number; `length` is another word for it.
    Number,
    /// A number known to be whole.
    Int,
    /// An angle in radians, written with a unit.
    Angle,
    /// A bool.
    Bool,
    /// A string.
    Text,
    /// A vector of 2, 3 or 4 numbers.
    Vec(u8),
    /// Linear red, green, blue, and alpha.
    Color,
    /// A range of numbers, ints, angles or vectors.
    Range(Box<Type>),
    /// A list whose elements have the same type.
    List(Box<Type>),
    /// A record: the names and types of its fields, in order.
    Record(Vec<(String, Type)>),
    /// A function.
    Fn(Vec<Type>, Box<Type>),
    /// A solid or a region.
    Shape(Dim),
    /// A material.
    Material,
    /// The shadow of a light: `hard` or `soft(k)`.
    Shadow,
    /// Unknown, because an error was reported.
    Error,
}
