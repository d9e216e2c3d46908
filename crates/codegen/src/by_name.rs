//! Values that callers choose by name.

/// The error of a name that no value has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} `{name}`; the {what}s are {}", .known.join(", "))]
pub struct UnknownName {
    /// The kind of value, such as `target`.
    pub what: &'static str,
    /// The unknown name.
    pub name: String,
    /// All names.
    pub known: Vec<&'static str>,
}

/// Returns the value with a name.
///
/// # Errors
///
/// [`UnknownName`]: no value has the name.
pub fn by_name<T: Copy>(
    what: &'static str,
    name: &str,
    values: &[T],
    name_of: impl Fn(T) -> &'static str,
) -> Result<T, UnknownName> {
    let found = values.iter().copied().find(|value| name_of(*value) == name);
    found.ok_or_else(|| {
        let known = values.iter().map(|value| name_of(*value)).collect();
        UnknownName { what, name: name.to_owned(), known }
    })
}
