//! Recognises files that are finished.

use std::io::ErrorKind;
use std::path::Path;

use sdfc_render::RasterKind;

use super::provenance::{Drawing, Provenance};

/// The state of the file of a picture before the picture is drawn.
#[derive(Debug, PartialEq, Eq)]
pub enum Existing {
    /// There is no file.
    Missing,
    /// The file is complete and holds what would be drawn, with this number of unproven pixels.
    Finished(u64),
    /// The file is something else, for this reason.
    Other(String),
}

/// Returns the state of a drawing's file, which should hold pixels of this kind.
pub fn existing(path: &Path, drawing: &Drawing, kind: RasterKind) -> Existing {
    let file = match sdfc_files::read_picture(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Existing::Missing,
        Err(error) => return Existing::Other(error.to_string()),
    };
    let (raster, said) = match Provenance::read(&file) {
        Ok(read) => read,
        Err(reason) => return Existing::Other(reason),
    };
    if let Some(what) = drawing.difference(&said.drawing) {
        return Existing::Other(format!("it was drawn with {what}"));
    }
    if drawing.tile() != said.drawing.tile() {
        return Existing::Other("it is another region".to_owned());
    }
    if raster.kind() != kind {
        return Existing::Other(format!("it holds {}", raster.kind()));
    }
    Existing::Finished(said.unproven)
}
