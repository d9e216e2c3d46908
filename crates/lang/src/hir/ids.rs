//! Ids: indices of items and variables.

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);
    )*};
}
ids! {
    /// A `fn` of [`Program::functions`](super::Program::functions).
    FnId
    /// A `solid` or `region` of [`Program::shapes`](super::Program::shapes). A `shape` declaration
    /// makes two.
    ShapeDefId
    /// A `param` of [`Program::params`](super::Program::params).
    ParamId
    /// A file-level `let` of [`Program::globals`](super::Program::globals).
    GlobalId
    /// A variable of the innermost function, shape or lambda body, dense from 0.
    LocalId
}
