//! Small pictures of scenes, drawn on the CPU when they are first wanted.

use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, channel};

use sdfc::{Backend, Compiler, PictureOptions, no_progress};
use sdfc_ide::ExampleScene;

use crate::worker_thread::WorkerThread;

/// Width and height of a picture in pixels.
pub const SIZE: [u32; 2] = [160, 120];
/// Rays per pixel.
const SAMPLES: u32 = 4;

/// The key of a picture, which knows the scene to draw.
pub trait PictureKey: Clone + Ord + Send + 'static {
    /// Name and source of the scene.
    fn scene(&self) -> (&str, &str);
}

impl PictureKey for ExampleScene {
    fn scene(&self) -> (&str, &str) {
        (&self.name, &self.source)
    }
}

/// The pictures that were drawn so far, and the thread that draws them, one after the other.
#[derive(Debug)]
pub struct SmallPictures<K: PictureKey> {
    worker: WorkerThread<K>,
    drawn: Receiver<(K, Option<Vec<u8>>)>,
    /// `None` for a scene that cannot be drawn.
    pictures: BTreeMap<K, Option<Vec<u8>>>,
    is_drawing: bool,
}

impl<K: PictureKey> SmallPictures<K> {
    /// Starts the thread. It calls `wake` after each picture.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (sender, drawn) = channel();
        let draw = move |key: K| {
            // Sending fails only after the session is dropped.
            let picture = draw(&key);
            let _ = sender.send((key, picture));
            wake();
        };
        let worker = WorkerThread::start("small pictures", |_| draw)?;
        Ok(Self { worker, drawn, pictures: BTreeMap::new(), is_drawing: false })
    }

    /// Receives pictures. Returns true if there are any.
    pub fn poll(&mut self) -> bool {
        let before = self.pictures.len();
        for (key, picture) in self.drawn.try_iter() {
            self.is_drawing = false;
            self.pictures.insert(key, picture);
        }
        self.pictures.len() > before
    }

    /// The picture of a scene: red, green, blue for each pixel. If it has not been drawn, it is
    /// requested, unless another one is being drawn.
    pub fn get(&mut self, key: &K) -> Option<&[u8]> {
        if !self.is_drawing && !self.pictures.contains_key(key) {
            self.is_drawing = true;
            self.worker.channel().send(key.clone());
        }
        self.pictures.get(key)?.as_deref()
    }
}

/// Draws a scene: red, green, blue in sRGB for each pixel. `None` if it cannot be drawn.
fn draw(key: &impl PictureKey) -> Option<Vec<u8>> {
    let (name, source) = key.scene();
    let scene = Compiler::new().compile(name, source).ok()?;
    let options = PictureOptions::new().size(SIZE).backend(Backend::Cpu).samples(SAMPLES);
    let picture = scene.render(&options, &mut no_progress).ok()?;
    Some(picture.image.to_srgb8())
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::test_support::TIMEOUT;

    #[test]
    fn a_picture_is_drawn_when_it_is_first_wanted() {
        let key = ExampleScene { name: "torus".to_owned(), source: "torus(1, 0.2)".to_owned() };
        let mut pictures = SmallPictures::new(|| {}).unwrap();
        let start = Instant::now();
        while pictures.get(&key).is_none() {
            assert!(start.elapsed() < TIMEOUT);
            std::thread::sleep(std::time::Duration::from_millis(5));
            pictures.poll();
        }
        let picture = pictures.get(&key).unwrap();
        assert_eq!(picture.len(), 3 * 160 * 120);
        // A shape in the middle, the background at the border.
        assert_ne!(picture[..3], picture[3 * (60 * 160 + 45)..][..3]);
    }
}
