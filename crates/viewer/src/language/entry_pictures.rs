//! Pictures of the examples of library entries, drawn on the CPU when they are first wanted.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, channel};

use sdfc::{Backend, Compiler, PictureOptions, no_progress};
use sdfc_ide::{Location, library_files};
use sdfc_lang::library::Entry;
use sdfc_lang::reference::entries;

use crate::worker_thread::WorkerThread;

/// Width and height of a picture in pixels.
pub const SIZE: [u32; 2] = [160, 120];
/// Rays per pixel.
const SAMPLES: u32 = 4;

/// A library entry: its index in the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EntryId(usize);

impl EntryId {
    /// The entry that is declared at a location in the library.
    pub fn at(location: &Location) -> Option<Self> {
        let mut files = library_files().iter();
        let (file, text) = files.find(|(name, _)| *name == location.file)?;
        let before = text.get(Range { start: 0, end: location.start })?;
        let line = u32::try_from(before.matches('\n').count() + 1).ok()?;
        let is_it = |entry: &Entry| entry.location == Some((*file, line));
        all_entries().iter().position(is_it).map(Self)
    }

    /// Draws the entry's example: red, green, blue in sRGB for each pixel. `None` if it cannot be
    /// drawn.
    fn draw(self) -> Option<Vec<u8>> {
        let entry = all_entries().get(self.0)?;
        let scene = Compiler::new().compile(&entry.name, &entry.example).ok()?;
        let options = PictureOptions::new().size(SIZE).backend(Backend::Cpu).samples(SAMPLES);
        let picture = scene.render(&options, &mut no_progress).ok()?;
        Some(picture.image.to_srgb8())
    }
}

fn all_entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(entries)
}

/// The pictures that were drawn so far, and the thread that draws them.
#[derive(Debug)]
pub struct EntryPictures {
    worker: WorkerThread<EntryId>,
    drawn: Receiver<(EntryId, Option<Vec<u8>>)>,
    /// `None` for an entry that cannot be drawn.
    pictures: BTreeMap<EntryId, Option<Vec<u8>>>,
    wanted: Option<EntryId>,
}

impl EntryPictures {
    /// Starts the thread. It calls `wake` after each picture.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (sender, drawn) = channel();
        let draw = move |entry: EntryId| {
            // Sending fails only after the session is dropped.
            let _ = sender.send((entry, entry.draw()));
            wake();
        };
        let worker = WorkerThread::start("entry pictures", |_| draw)?;
        Ok(Self { worker, drawn, pictures: BTreeMap::new(), wanted: None })
    }

    /// Receives pictures. Returns true if there are any.
    pub fn poll(&mut self) -> bool {
        let before = self.pictures.len();
        self.pictures.extend(self.drawn.try_iter());
        self.pictures.len() > before
    }

    /// The picture of an entry: red, green, blue for each pixel. If it has not been drawn, it is
    /// requested in place of any other.
    pub fn get(&mut self, entry: EntryId) -> Option<&[u8]> {
        if !self.pictures.contains_key(&entry) && self.wanted != Some(entry) {
            self.wanted = Some(entry);
            self.worker.channel().send(entry);
        }
        self.pictures.get(&entry)?.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::test_support::TIMEOUT;

    #[test]
    fn the_picture_of_a_declaration_in_the_library_is_drawn_once() {
        let (file, text) =
            library_files().iter().find(|(_, it)| it.contains("solid torus(")).unwrap();
        let start = text.find("solid torus(").unwrap() + "solid ".len();
        let location = Location { file: (*file).to_owned(), start, end: start + 5 };
        let entry = EntryId::at(&location).unwrap();
        assert_eq!(all_entries()[entry.0].name, "torus");
        assert_eq!(EntryId::at(&Location { file: "scene.sdf".to_owned(), ..location }), None);
        let mut pictures = EntryPictures::new(|| {}).unwrap();
        let start = Instant::now();
        while pictures.get(entry).is_none() {
            assert!(start.elapsed() < TIMEOUT);
            std::thread::sleep(std::time::Duration::from_millis(5));
            pictures.poll();
        }
        let picture = pictures.get(entry).unwrap();
        assert_eq!(picture.len(), 3 * 160 * 120);
        // A shape in the middle, the background at the border.
        assert_ne!(picture[..3], picture[3 * (60 * 160 + 45)..][..3]);
    }
}
