//! The naga types of node types.

use naga::{Handle, Scalar, Span, TypeInner, UniqueArena, VectorSize};
use sdfc_graph::Type;

/// Adds a type without a name.
pub(crate) fn add(types: &mut UniqueArena<naga::Type>, inner: TypeInner) -> Handle<naga::Type> {
    types.insert(naga::Type { name: None, inner }, Span::UNDEFINED)
}

/// The type of a node's value in functions.
pub(crate) fn value(types: &mut UniqueArena<naga::Type>, ty: Type) -> Handle<naga::Type> {
    let inner = match vector_size(ty) {
        Some(size) => TypeInner::Vector { size, scalar: Scalar::F32 },
        None if ty == Type::Bool => TypeInner::Scalar(Scalar::BOOL),
        None => TypeInner::Scalar(Scalar::F32),
    };
    add(types, inner)
}

/// The type of words with a type's width.
pub(crate) fn words(types: &mut UniqueArena<naga::Type>, ty: Type) -> Handle<naga::Type> {
    let inner = match vector_size(ty) {
        Some(size) => TypeInner::Vector { size, scalar: Scalar::U32 },
        None => TypeInner::Scalar(Scalar::U32),
    };
    add(types, inner)
}

/// A 3x3 matrix.
pub(crate) fn matrix(types: &mut UniqueArena<naga::Type>) -> Handle<naga::Type> {
    let (columns, rows) = (VectorSize::Tri, VectorSize::Tri);
    add(types, TypeInner::Matrix { columns, rows, scalar: Scalar::F32 })
}

/// The size of a vector type; `None` for scalars and truth values.
pub(crate) fn vector_size(ty: Type) -> Option<VectorSize> {
    match ty {
        Type::Bool | Type::Scalar => None,
        Type::Vec2 => Some(VectorSize::Bi),
        Type::Vec3 => Some(VectorSize::Tri),
        Type::Vec4 => Some(VectorSize::Quad),
    }
}
