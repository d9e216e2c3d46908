//! The binary files beside a scene: fonts and pictures, each read once.

use crate::environment::Pictures;
use crate::font::Fonts;
use crate::import::Resolver;

/// The fonts and pictures of a scene.
pub struct Assets<'r> {
    /// The fonts of its texts.
    pub fonts: Fonts<'r>,
    /// The pictures of its surroundings.
    pub pictures: Pictures<'r>,
}

impl<'r> Assets<'r> {
    /// Files that a resolver reads.
    pub fn new(resolver: &'r dyn Resolver) -> Self {
        Self { fonts: Fonts::new(resolver), pictures: Pictures::new(resolver) }
    }
}
