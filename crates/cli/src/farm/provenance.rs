//! What a picture file says about how it was drawn.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Write as _;

use sdfc::{Resolver, Tile};
use sdfc_files::Folder;
use sdfc_render::Raster;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::args::Render;
use crate::sequence::frame;

/// The version that draws.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What decides the pixels of a file, apart from the device.
///
/// Numbers that JSON would round are texts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Drawing {
    /// Version of sdfc.
    pub sdfc: String,
    /// SHA-256 of the scene and of all files that it imports.
    pub scene: String,
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// First column and row, then width and height, of the region; null for a whole picture.
    pub region: Option<[u32; 4]>,
    /// The number of the frame, which is time * fps, rounded.
    pub frame: String,
    /// Time in seconds.
    pub time: String,
    /// Frames per second.
    pub fps: String,
    /// The settings of the command line; null for those of the scene.
    pub settings: Settings,
}

/// The settings of the command line that change pixels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// Rays per pixel.
    pub samples: Option<u32>,
    /// Spacing of isolines, in scene units.
    pub isolines: Option<String>,
    /// Ray method.
    pub march: Option<String>,
    /// When parts become loops.
    pub loops: String,
    /// The camera, as the arguments of `camera(...)`.
    #[serde(default)]
    pub camera: Option<String>,
    /// True if the numbers of the scene are params.
    pub live_literals: bool,
    /// The params that were set, as written.
    pub set: BTreeMap<String, String>,
}

/// What a picture file says about how it was drawn.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// What decides the pixels.
    #[serde(flatten)]
    pub drawing: Drawing,
    /// The device, with its driver.
    pub device: String,
    /// The number of unproven pixels.
    pub unproven: u64,
    /// SHA-256 of the pixels' values.
    pub pixels: String,
}

impl Drawing {
    /// What the command line draws of a scene, whole and at `--time`.
    pub fn new(args: &Render, scene: String) -> Self {
        // Destructured so that a new option does not compile until it is decided here if it changes
        // pixels.
        let Render {
            file: _,
            output: _,
            size,
            width: _,
            march,
            backend: _,
            loops,
            camera,
            params,
            live,
            time,
            frames: _,
            fps,
            samples,
            isolines,
            depth: _,
            stats: _,
            watch: _,
            strict: _,
            farm: _,
        } = args;
        let set = params.set.iter().map(|it| (it.name.clone(), it.value.clone()));
        Self {
            sdfc: VERSION.to_owned(),
            scene,
            size: *size,
            region: None,
            frame: frame(*time, *fps).to_string(),
            time: time.to_string(),
            fps: fps.to_string(),
            settings: Settings {
                samples: *samples,
                isolines: isolines.map(|spacing| spacing.to_string()),
                march: march.map(|method| method.name().to_owned()),
                loops: format!("{:?}", loops).to_lowercase(),
                camera: camera.clone(),
                live_literals: live.live_literals,
                set: set.collect(),
            },
        }
    }

    /// The same for a frame.
    pub fn at_frame(&self, number: u32, time: f64) -> Self {
        Self { frame: number.to_string(), time: time.to_string(), ..self.clone() }
    }

    /// The same for a region.
    pub fn in_region(&self, region: Option<Tile>) -> Self {
        let numbers = |Tile { origin: [x, y], size: [w, h] }: Tile| [x, y, w, h];
        Self { region: region.map(numbers), ..self.clone() }
    }

    /// The pixels of the whole picture that the file has.
    pub fn tile(&self) -> Tile {
        match self.region {
            Some([x, y, width, height]) => Tile { origin: [x, y], size: [width, height] },
            None => Tile::whole(self.size),
        }
    }

    /// Says in what another file was drawn differently, apart from the region.
    pub fn difference(&self, other: &Self) -> Option<&'static str> {
        [
            (self.sdfc != other.sdfc, "another version of sdfc"),
            (self.scene != other.scene, "another scene"),
            (self.size != other.size, "another size of the whole picture"),
            ((&self.frame, &self.time) != (&other.frame, &other.time), "another frame or time"),
            ((&self.fps, &self.settings) != (&other.fps, &other.settings), "other settings"),
        ]
        .into_iter()
        .find(|(differs, _)| *differs)
        .map(|(_, what)| what)
    }
}

impl Provenance {
    /// The note of a picture file with these pixels.
    pub fn new(drawing: Drawing, device: &str, unproven: u64, raster: &Raster) -> Self {
        Self { drawing, device: device.to_owned(), unproven, pixels: sha256(&raster.bytes()) }
    }

    /// As the text of a file's note: JSON in ASCII.
    pub fn to_note(&self) -> String {
        // It is plain data, whose keys are strings.
        let text = serde_json::to_string(self).unwrap_or_default();
        let mut note = String::with_capacity(text.len());
        for character in text.chars() {
            if character.is_ascii() {
                note.push(character);
            } else {
                let mut units = [0; 2];
                for unit in character.encode_utf16(&mut units) {
                    // Writing to a `String` cannot fail.
                    let _ = write!(note, "\\u{unit:04x}");
                }
            }
        }
        note
    }

    /// Reads a picture file and what it says, and checks that it is whole.
    ///
    /// # Errors
    ///
    /// Returns the reason in one line, such as `the PNG file is damaged`.
    pub fn read(file: &[u8]) -> Result<(Raster, Self), String> {
        let (raster, note) = Raster::from_file(file)?;
        let unknown = "the file does not say how sdfc drew it";
        let note = note.ok_or(unknown)?;
        let said: Self = serde_json::from_str(&note).map_err(|_| unknown)?;
        let tile = said.drawing.tile();
        if tile.size != raster.size() || !tile.is_within(said.drawing.size) {
            return Err("the file is not whole: it has another size than it says".to_owned());
        }
        if said.pixels != sha256(&raster.bytes()) {
            return Err("the file is damaged: its pixels have another checksum".to_owned());
        }
        Ok((raster, said))
    }
}

/// Reads the files that a scene imports, and remembers their checksums.
pub struct Recorded<'a> {
    folder: &'a Folder,
    files: RefCell<BTreeMap<String, String>>,
}

impl<'a> Recorded<'a> {
    /// Nothing is read so far.
    pub fn new(folder: &'a Folder) -> Self {
        Self { folder, files: RefCell::default() }
    }

    /// The checksum of the scene with this source and of all files that were read: SHA-256 of one
    /// line per file, with its own SHA-256 and its path. The scene comes first and has no path,
    /// because it may be in different places on different machines.
    pub fn checksum(&self, source: &str) -> String {
        let mut lines = format!("{}\n", sha256(source.as_bytes()));
        for (path, checksum) in self.files.borrow().iter() {
            // Writing to a `String` cannot fail.
            let _ = writeln!(lines, "{checksum} {path}");
        }
        sha256(lines.as_bytes())
    }

    fn record(&self, path: &str, bytes: &[u8]) {
        self.files.borrow_mut().insert(path.to_owned(), sha256(bytes));
    }
}

impl Resolver for Recorded<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        let text = self.folder.read(path)?;
        self.record(path, text.as_bytes());
        Ok(text)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let bytes = self.folder.read_bytes(path)?;
        self.record(path, &bytes);
        Ok(bytes)
    }

    fn name_of(&self, path: &str) -> Option<String> {
        self.folder.name_of(path)
    }
}

fn sha256(bytes: &[u8]) -> String {
    let mut text = String::new();
    for byte in Sha256::digest(bytes) {
        // Writing to a `String` cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_sha256() {
        // NIST, FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), expected);
    }

    #[test]
    fn a_scene_is_its_source_and_its_imports() {
        let root = tempfile::tempdir().unwrap();
        std::fs::write(root.path().join("part.sdf"), "one").unwrap();
        let folder = Folder::of(&root.path().join("scene.sdf"));
        let alone = Recorded::new(&folder);
        let with_part = || {
            let files = Recorded::new(&folder);
            assert!(files.read("part.sdf").is_ok());
            assert!(files.read("missing.sdf").is_err());
            files.checksum("scene")
        };
        let before = with_part();
        assert_ne!(before, alone.checksum("scene"));
        assert_eq!(before, with_part());
        std::fs::write(root.path().join("part.sdf"), "two").unwrap();
        assert_ne!(before, with_part());
    }
}
