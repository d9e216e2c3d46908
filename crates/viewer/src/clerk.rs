//! The thread that writes files, one after the other: the scene with other numbers, pictures of any size, animations,
//! shaders, the window as it is.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use sdfc::render::{Animation, Image, Progress};
use sdfc::{Code, FrameValues, PictureOptions, ShaderOptions};
use sdfc_files::{Folder, Format};

use crate::document::Document;
use crate::model::Model;

/// Room for what the compiler does in depth.
const STACK: usize = 16 << 20;

/// Something to be written.
#[derive(Debug)]
pub enum Errand {
    /// The scene's own file, unless it is not what it was.
    Rewrite {
        /// The file.
        path: PathBuf,
        /// What it held.
        before: String,
        /// What it is to hold.
        after: String,
    },
    /// A picture, or an animation where there are several frames.
    Picture {
        /// The scene.
        model: Arc<Model>,
        /// The file; its ending says the format.
        path: PathBuf,
        /// How it is drawn.
        options: Box<PictureOptions>,
        /// The values of each frame.
        frames: Vec<FrameValues>,
        /// How long a frame is shown, in hundredths of a second.
        hundredths: u32,
    },
    /// A shader.
    Shader {
        /// The scene's file.
        scene: PathBuf,
        /// Its text, in which numbers may have been moved.
        text: String,
        /// The file.
        path: PathBuf,
        /// How it is written.
        options: ShaderOptions,
    },
    /// A picture as it is on the screen.
    Screen {
        /// The file.
        path: PathBuf,
        /// Width and height in pixels.
        size: [u32; 2],
        /// Red, green, blue, alpha.
        rgba: Vec<u8>,
    },
}

/// What came of an errand, in one line.
pub type Outcome = Result<String, String>;

/// The thread, as others see it.
#[derive(Debug)]
pub struct Clerk {
    errands: Option<Sender<Errand>>,
    state: Arc<Mutex<State>>,
    thread: Option<JoinHandle<()>>,
}

/// How far it is.
#[derive(Debug, Default)]
struct State {
    /// Of what is being drawn.
    share: Option<f32>,
    cancelled: bool,
}

impl Clerk {
    /// Starts it. `wake` is called when there is something to tell.
    pub fn new(
        outcomes: Sender<Outcome>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (errands, waiting) = channel();
        let state = Arc::new(Mutex::new(State::default()));
        let desk = Desk { state: Arc::clone(&state), wake: Box::new(wake) };
        let run = move || {
            for errand in waiting {
                *lock(&desk.state) = State::default();
                let outcome = desk.done(errand);
                lock(&desk.state).share = None;
                // The receiver is gone only where the window is.
                let _ = outcomes.send(outcome);
                (desk.wake)();
            }
        };
        let thread = std::thread::Builder::new().name("clerk".into()).stack_size(STACK);
        Ok(Self { errands: Some(errands), state, thread: Some(thread.spawn(run)?) })
    }

    /// Hands it an errand, to be done after those before it.
    pub fn send(&self, errand: Errand) {
        if let Some(errands) = &self.errands {
            let _ = errands.send(errand);
        }
    }

    /// The way in for what comes later, from another thread.
    pub fn errands(&self) -> impl Fn(Errand) + Send + 'static {
        let errands = self.errands.clone();
        move |errand| {
            if let Some(errands) = &errands {
                let _ = errands.send(errand);
            }
        }
    }

    /// The share of what is being drawn that is done, 0 to 1; `None` where nothing is.
    pub fn progress(&self) -> Option<f32> {
        lock(&self.state).share
    }

    /// Ends what is being drawn; no file comes of it.
    pub fn cancel(&self) {
        lock(&self.state).cancelled = true;
    }
}

impl Drop for Clerk {
    /// Waits: a file that is being written is written, although the window is closed. A drawing is ended.
    fn drop(&mut self) {
        drop(self.errands.take());
        self.cancel();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The thread, as it sees itself.
struct Desk {
    state: Arc<Mutex<State>>,
    wake: Box<dyn Fn() + Send>,
}

impl Desk {
    fn done(&self, errand: Errand) -> Outcome {
        match errand {
            Errand::Rewrite { path, before, after } => {
                let document = Document::read(&path).map_err(|error| error.to_string())?;
                if document.text != before {
                    return Err("the file has changed; nothing is written".to_owned());
                }
                written(&path, after.as_bytes())
            }
            Errand::Picture { model, path, options, frames, hundredths } => {
                let bytes = self.picture(&model, &path, &options, &frames, hundredths)?;
                written(&path, &bytes)
            }
            Errand::Shader { scene, text, path, options } => {
                written(&path, &shader(&scene, &text, &options)?)
            }
            Errand::Screen { path, size, rgba } => written(&path, &screen(size, &rgba)?),
        }
    }

    fn picture(
        &self,
        model: &Model,
        path: &Path,
        options: &PictureOptions,
        frames: &[FrameValues],
        hundredths: u32,
    ) -> Result<Vec<u8>, String> {
        let format = Format::of(path)?;
        sdfc_files::check_writable(path).map_err(|error| unwritable(path, &error))?;
        let painter = model.scene.painter(options).map_err(|error| error.to_string())?;
        let draw = |(number, values): (usize, &FrameValues)| -> Result<Image, String> {
            let mut progress = |part: Progress| {
                let done = part.done as f32 / part.total.max(1) as f32;
                self.reached((number as f32 + done) / frames.len() as f32)
            };
            let picture = painter.paint(values, 1, &mut progress);
            picture.map(|picture| picture.image).map_err(|error| error.to_string())
        };
        if let [only] = frames {
            return format.encode(&draw((0, only))?).map_err(|error| error.to_string());
        }
        if format != Format::Gif {
            return Err(format!("{}: frames that move are written as .gif", path.display()));
        }
        let mut file = Vec::new();
        let mut animation = Animation::new(&mut file).map_err(|error| error.to_string())?;
        for frame in frames.iter().enumerate() {
            animation.push(&draw(frame)?, hundredths).map_err(|error| error.to_string())?;
        }
        drop(animation);
        Ok(file)
    }

    fn reached(&self, share: f32) -> ControlFlow<()> {
        let mut state = lock(&self.state);
        state.share = Some(share);
        (self.wake)();
        if state.cancelled { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Of the text as it would be read from the file: its numbers are constants again.
fn shader(scene: &Path, text: &str, options: &ShaderOptions) -> Result<Vec<u8>, String> {
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    let compiled = sdfc::compile_with_imports(&name, text, &Folder::of(scene));
    let scene = compiled.scene.ok_or("the scene has errors")?;
    let shader = scene.write_shader(options).map_err(|error| error.to_string())?;
    Ok(match shader.code {
        Code::Text(text) => text.into_bytes(),
        Code::Words(words) => words.into_iter().flat_map(u32::to_le_bytes).collect(),
    })
}

fn screen([width, height]: [u32; 2], rgba: &[u8]) -> Result<Vec<u8>, String> {
    use image::ImageEncoder as _;
    let mut file = Vec::new();
    image::codecs::png::PngEncoder::new(&mut file)
        .write_image(rgba, width, height, image::ExtendedColorType::Rgba8)
        .map_err(|error| error.to_string())?;
    Ok(file)
}

fn written(path: &Path, bytes: &[u8]) -> Outcome {
    sdfc_files::write(path, bytes).map_err(|error| unwritable(path, &error))?;
    Ok(format!("wrote {}", path.display()))
}

fn unwritable(path: &Path, error: &std::io::Error) -> String {
    format!("cannot write {}: {error}", path.display())
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // Numbers, each replaced whole.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worker::tests::model;

    fn desk() -> Desk {
        Desk { state: Arc::default(), wake: Box::new(|| ()) }
    }

    #[test]
    fn a_file_that_has_changed_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "box(1)").unwrap();
        let rewrite = |before: &str| {
            let (before, after) = (before.to_owned(), "box(2)".to_owned());
            desk().done(Errand::Rewrite { path: path.clone(), before, after })
        };
        assert!(rewrite("box(3)").is_err());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(1)");
        assert!(rewrite("box(1)").is_ok());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(2)");
    }

    #[test]
    fn pictures_animations_and_shaders_are_written_and_a_cancelled_one_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let model = model("sphere(0.5 + 0.1 * sin(time))\n");
        let place = |name: &str| folder.path().join(name);
        let picture = |name: &str, count: usize| {
            let options = PictureOptions {
                size: [24, 16],
                backend: sdfc::Backend::Cpu,
                ..PictureOptions::default()
            };
            let frames = vec![model.defaults(); count];
            let (model, path, options) = (Arc::clone(&model), place(name), Box::new(options));
            Errand::Picture { model, path, options, frames, hundredths: 4 }
        };
        desk().done(picture("a.png", 1)).unwrap();
        assert_eq!(image::open(place("a.png")).unwrap().width(), 24);
        desk().done(picture("a.gif", 3)).unwrap();
        assert!(std::fs::read(place("a.gif")).unwrap().starts_with(b"GIF89a"));
        assert!(desk().done(picture("b.png", 3)).unwrap_err().contains(".gif"));
        let busy = desk();
        lock(&busy.state).cancelled = true;
        assert!(busy.done(picture("c.png", 1)).is_err());
        assert!(!place("c.png").exists());
        let (scene, path, options) = (place("a.sdf"), place("a.wgsl"), ShaderOptions::default());
        desk().done(Errand::Shader { scene, text: model.text.clone(), path, options }).unwrap();
        assert!(std::fs::read_to_string(place("a.wgsl")).unwrap().contains("fn sdf_distance"));
        let (path, rgba) = (place("w.png"), vec![9; 4 * 6]);
        desk().done(Errand::Screen { path, size: [3, 2], rgba }).unwrap();
        assert_eq!(image::open(place("w.png")).unwrap().height(), 2);
    }
}
