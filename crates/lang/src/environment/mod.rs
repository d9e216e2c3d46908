//! Pictures of the surroundings: a background, what mirrors show, and ambient light.
//!
//! [`analyze`] turns the bytes of a picture into plain numbers: maps for mirrors of six degrees of
//! roughness, and the irradiance as a polynomial of the normal. [`functions::functions`] makes
//! functions of the graph from them. Nothing behind the graph knows a picture: its texels are a
//! list of constants as any other.

pub mod functions;
mod harmonics;
mod octahedron;
mod panorama;
mod prefilter;
mod radiance;

use std::cell::RefCell;
use std::hash::{DefaultHasher, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use rustc_hash::FxHashMap;

use crate::import::{self, Resolver};
pub use harmonics::{Coefficients, irradiance_at};
pub use octahedron::{Octahedron, Vector};
pub use panorama::MAX_COLUMNS;
use panorama::Panorama;
pub use prefilter::{LEVELS, roughness};
pub use radiance::{MAX_FILE_BYTES, MAX_LIGHT, MAX_PIXELS};

/// The light of the surroundings by direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    /// What mirrors receive, by [`roughness`]; the first map is the picture.
    pub levels: Vec<Octahedron>,
    /// The irradiance over pi.
    pub irradiance: Coefficients,
}

/// Reads a Radiance picture and computes the light that surfaces receive from it.
///
/// # Errors
///
/// Returns the reason as the rest of a sentence about the picture.
pub fn analyze(bytes: &[u8]) -> Result<Surroundings, String> {
    let panorama = Panorama::read(bytes)?;
    let side = prefilter::sharp_side(panorama.size[0]);
    // Where texels are coarsest, the panorama's pixels are two thirds as wide.
    let sharp = Octahedron::averaged(side, |to| panorama.light(to));
    let irradiance = harmonics::irradiance(&sharp);
    Ok(Surroundings { levels: prefilter::levels(sharp), irradiance })
}

/// The pictures of a scene by path; each is read once.
pub struct Pictures<'r> {
    resolver: &'r dyn Resolver,
    known: RefCell<FxHashMap<String, Result<Arc<Surroundings>, String>>>,
}

impl<'r> Pictures<'r> {
    /// Pictures that a resolver reads.
    pub fn new(resolver: &'r dyn Resolver) -> Self {
        Self { resolver, known: RefCell::default() }
    }

    /// The surroundings that a picture shows. The path is relative to the scene.
    ///
    /// # Errors
    ///
    /// Returns the reason in one sentence.
    pub fn surroundings(&self, path: &str) -> Result<Arc<Surroundings>, String> {
        let known = self.known.borrow().get(path).cloned();
        known.unwrap_or_else(|| {
            let found = self.read(path);
            self.known.borrow_mut().insert(path.to_owned(), found.clone());
            found
        })
    }

    fn read(&self, written: &str) -> Result<Arc<Surroundings>, String> {
        let path = import::locate(self.resolver.scene_path(), written)?;
        let bytes = self
            .resolver
            .read_bytes(&path)
            .map_err(|why| format!("the picture `{path}` cannot be read: {why}"))?;
        remembered(&bytes).map_err(|why| format!("the picture `{path}` {why}"))
    }
}

/// The number of pictures that [`remembered`] keeps, each of up to 4 MiB.
const REMEMBERED: usize = 2;

/// As [`analyze`], but at once for the last pictures: an editor compiles a scene again after each
/// change. Their length and two hashes identify them.
fn remembered(bytes: &[u8]) -> Result<Arc<Surroundings>, String> {
    type Key = (usize, [u64; 2]);
    static LAST: Mutex<Vec<(Key, Arc<Surroundings>)>> = Mutex::new(Vec::new());
    let hash = |seed: u8| {
        let mut hasher = DefaultHasher::new();
        hasher.write_u8(seed);
        hasher.write(bytes);
        hasher.finish()
    };
    let key = (bytes.len(), [0, 1].map(hash));
    let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
    let known = last().iter().find(|(known, _)| *known == key).map(|(_, it)| Arc::clone(it));
    if let Some(known) = known {
        return Ok(known);
    }
    let found = Arc::new(analyze(bytes)?);
    let mut last = last();
    last.insert(0, (key, Arc::clone(&found)));
    last.truncate(REMEMBERED);
    Ok(found)
}
