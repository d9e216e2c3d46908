//! The stand-in for [`Fonts`] in builds without the feature `fonts`.

use std::marker::PhantomData;

use super::Setting;
use crate::import::Resolver;
use crate::outline::Piece;

/// A set of fonts that is always empty.
pub struct Fonts<'r>(PhantomData<&'r dyn Resolver>);

impl<'r> Fonts<'r> {
    /// Ignores the resolver.
    pub fn new(_: &'r dyn Resolver) -> Self {
        Self(PhantomData)
    }

    /// # Errors
    ///
    /// Always: there are no fonts.
    pub fn curves(&self, _: &str, _: &str, _: Setting) -> Result<Vec<Piece>, String> {
        Err("this sdfc was built without fonts (the feature `fonts`)".to_owned())
    }
}
