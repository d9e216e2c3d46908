//! `sdfc join`: joins the regions of a picture that were drawn separately.

use std::path::{Path, PathBuf};

use sdfc::Tile;
use sdfc_render::Raster;

use crate::args::Join;
use crate::console::Console;
use crate::failure::Failure;
use crate::farm::provenance::{Drawing, Provenance};
use crate::farm::region;
use crate::output::{self, Output};

/// What a result says if its parts come from several devices.
const SEVERAL_DEVICES: &str = "several devices";

/// Joins the parts. The result is the file that `sdfc render` writes for the whole picture.
///
/// # Errors
///
/// A part cannot be read, is damaged or is from another picture; parts overlap or are missing; the
/// result cannot be written.
pub fn run(args: &Join, console: &Console) -> Result<(), Failure> {
    let output = Output::new(&args.output);
    let parts = parts(args)?;
    if let Output::File(path) = &output {
        for part in &parts {
            output::distinct(part, &[path])?;
        }
    }
    output.check()?;
    let mut picture: Option<Joined> = None;
    for path in &parts {
        let (raster, said) = read(path)?;
        match &mut picture {
            Some(joined) => joined.add(path, &raster, &said, args.any_device)?,
            None => picture = Some(Joined::new(path, &raster, said)?),
        }
    }
    // There is at least one part.
    let Some(picture) = picture else { return Ok(()) };
    let [width, height] = picture.drawing.size;
    output.write(&picture.file(&args.output)?)?;
    if let Output::File(_) = output {
        console.note(&format!("{output}: {width}x{height}, joined from {} parts", parts.len()));
    }
    Ok(())
}

/// Returns the files of the parts: those of the command line, or those beside the result.
fn parts(args: &Join) -> Result<Vec<PathBuf>, Failure> {
    if !args.parts.is_empty() {
        return Ok(args.parts.clone());
    }
    let name = args.output.display();
    let parts = region::parts_of(&args.output).map_err(|error| {
        Failure::Machine(format!("cannot look for the parts of {name}: {error}"))
    })?;
    if parts.is_empty() {
        let message = format!("there are no parts beside {name}; name their files");
        return Err(Failure::Call(message));
    }
    Ok(parts)
}

fn read(path: &Path) -> Result<(Raster, Provenance), Failure> {
    let broken = |reason: String| Failure::Machine(format!("{}: {reason}", path.display()));
    let file = sdfc_files::read_picture(path)
        .map_err(|error| Failure::Machine(format!("cannot read {}: {error}", path.display())))?;
    Provenance::read(&file).map_err(broken)
}

/// A picture while its parts are added.
struct Joined {
    /// The name of the first part, for messages.
    first: String,
    drawing: Drawing,
    device: String,
    unproven: u64,
    raster: Raster,
    /// For each pixel of the picture, true if a part has it.
    covered: Vec<bool>,
}

impl Joined {
    fn new(path: &Path, part: &Raster, said: Provenance) -> Result<Self, Failure> {
        let size = said.drawing.size;
        let raster = part.blank(size).map_err(|error| Failure::Machine(error.to_string()))?;
        let mut joined = Self {
            first: path.display().to_string(),
            drawing: said.drawing.in_region(None),
            device: said.device.clone(),
            unproven: 0,
            raster,
            covered: vec![false; size[0] as usize * size[1] as usize],
        };
        joined.put(path, part, &said)?;
        Ok(joined)
    }

    /// Adds a part that belongs to the same picture.
    fn add(
        &mut self,
        path: &Path,
        part: &Raster,
        said: &Provenance,
        any_device: bool,
    ) -> Result<(), Failure> {
        let (name, first) = (path.display(), &self.first);
        if let Some(what) = self.drawing.difference(&said.drawing) {
            return Err(Failure::Call(format!("{name} was drawn with {what} than {first}")));
        }
        if part.kind() != self.raster.kind() {
            let (one, other) = (part.kind(), self.raster.kind());
            return Err(Failure::Call(format!("{name} holds {one}, and {first} {other}")));
        }
        if said.device != self.device {
            if !any_device {
                return Err(Failure::Call(format!(
                    "{name} was drawn on {}, and {first} on {}; borders may be visible, and \
                     --any-device joins the parts anyway",
                    said.device, self.device
                )));
            }
            self.device = SEVERAL_DEVICES.to_owned();
        }
        self.put(path, part, said)
    }

    fn put(&mut self, path: &Path, part: &Raster, said: &Provenance) -> Result<(), Failure> {
        let tile = said.drawing.tile();
        let width = self.drawing.size[0] as usize;
        let [left, top] = tile.origin.map(|first| first as usize);
        let [columns, rows] = tile.size.map(|side| side as usize);
        for row in self.covered.chunks_exact_mut(width).skip(top).take(rows) {
            for covered in row.iter_mut().skip(left).take(columns) {
                if std::mem::replace(covered, true) {
                    let (name, region) = (path.display(), region::name(tile));
                    return Err(Failure::Call(format!(
                        "{name} has pixels that another part has too; its region is {region}"
                    )));
                }
            }
        }
        self.unproven = self.unproven.saturating_add(said.unproven);
        // Both were checked when the part was read.
        let fits = self.raster.put(tile.origin, part);
        if fits { Ok(()) } else { Err(Failure::Call(format!("{} does not fit", path.display()))) }
    }

    /// The first region that no part has: as many columns and rows as are missing together.
    fn missing(&self) -> Option<Tile> {
        let width = self.drawing.size[0] as usize;
        let start = self.covered.iter().position(|covered| !covered)?;
        let (left, top) = (start % width, start / width);
        let rows: Vec<&[bool]> = self.covered.chunks_exact(width).skip(top).collect();
        let count = |row: &[bool]| row.iter().skip(left).take_while(|covered| !**covered).count();
        let columns = rows.first().map_or(0, |row| count(row));
        let height = rows.iter().take_while(|row| count(row) >= columns).count();
        let size = [columns as u32, height as u32];
        Some(Tile { origin: [left as u32, top as u32], size })
    }

    /// The file of the whole picture.
    fn file(self, output: &Path) -> Result<Vec<u8>, Failure> {
        if let Some(missing) = self.missing() {
            let name = region::name(missing);
            return Err(Failure::Call(format!(
                "a part is missing: draw it with --region {name}, or add its file"
            )));
        }
        let kind = self.raster.kind();
        let format = sdfc_files::Format::of(output).map_err(Failure::Call)?;
        let is_stdout = output.as_os_str() == "-";
        if !is_stdout && !format.holds(kind) {
            let name = output.display();
            return Err(Failure::Call(format!("{name}: the parts hold {kind}")));
        }
        let size = self.drawing.size;
        let said = Provenance::new(self.drawing, &self.device, self.unproven, &self.raster);
        let file = self.raster.to_file([0, 0], size, Some(&said.to_note()));
        file.map_err(|error| Failure::Machine(error.to_string()))
    }
}
