//! What there is where no fonts are built in.

use std::marker::PhantomData;

use super::Setting;
use crate::import::Resolver;
use crate::outline::Piece;

/// No fonts.
pub struct Fonts<'r>(PhantomData<&'r dyn Resolver>);

impl<'r> Fonts<'r> {
    /// None, whatever the resolver has.
    pub fn new(_: &'r dyn Resolver) -> Self {
        Self(PhantomData)
    }

    /// # Errors
    ///
    /// That there are no fonts.
    pub fn curves(&self, _: &str, _: &str, _: Setting) -> Result<Vec<Piece>, String> {
        Err("this sdfc was built without fonts, its feature `fonts`".to_owned())
    }
}
