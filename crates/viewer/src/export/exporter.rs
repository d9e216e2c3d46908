//! The kinds of files that can be exported, and how each is made.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use sdfc::{Code, FrameValues, PictureOptions, ShaderOptions};
use sdfc_files::{Folder, Format};
use sdfc_render::{Animation, Image, Progress};

use crate::scene::document::Document;
use crate::scene::model::Model;

/// A file to write.
#[derive(Debug)]
pub enum ExportJob {
    /// The file of the scene or of an import, unless it has another text on disk.
    SaveSource {
        /// The file.
        path: PathBuf,
        /// The source that the file must still have.
        before: String,
        /// The source that is written.
        after: String,
    },
    /// A picture, or an animation if there are several frames.
    Picture {
        /// The scene.
        model: Arc<Model>,
        /// The file; its extension selects the format.
        path: PathBuf,
        /// Size, method and samples of the picture.
        options: Box<PictureOptions>,
        /// Param values and time of each frame.
        frames: Vec<FrameValues>,
        /// The duration of each frame, in hundredths of a second.
        hundredths: u32,
    },
    /// A shader.
    Shader {
        /// The scene's file.
        scene: PathBuf,
        /// Its source with the changed numbers.
        source: String,
        /// The file that is written.
        path: PathBuf,
        /// Language and contents of the shader.
        options: ShaderOptions,
    },
    /// A screenshot of the window.
    Screenshot {
        /// The file.
        path: PathBuf,
        /// Width and height in pixels.
        size: [u32; 2],
        /// Red, green, blue, alpha of each pixel.
        rgba: Vec<u8>,
    },
}

/// The outcome of a job.
#[derive(Debug)]
pub struct ExportOutcome {
    /// The file of the scene or of an import, if the job was to save one.
    pub source: Option<PathBuf>,
    /// A message for the status line, of success or failure.
    pub result: Result<String, String>,
    /// When the job ended.
    pub ended: Instant,
}

/// The state of the current job, shared between threads.
#[derive(Debug, Default)]
pub struct ExportState {
    /// The fraction that is drawn, 0 to 1; `None` if nothing is being drawn.
    pub progress: Option<f32>,
    /// True if the job was cancelled.
    pub cancelled: bool,
}

/// Locks the shared state.
pub fn lock(state: &Mutex<ExportState>) -> MutexGuard<'_, ExportState> {
    // Each field is replaced whole, so a poisoned lock holds a valid state.
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Carries out jobs on the export worker's thread.
pub struct Exporter {
    /// Shared with the window's thread.
    pub state: Arc<Mutex<ExportState>>,
    /// Called when progress changes.
    pub wake: Box<dyn Fn() + Send>,
}

impl Exporter {
    /// Writes a file, completely or not at all.
    pub fn run(&self, job: ExportJob) -> ExportOutcome {
        let source = match &job {
            ExportJob::SaveSource { path, .. } => Some(path.clone()),
            ExportJob::Picture { .. } | ExportJob::Shader { .. } | ExportJob::Screenshot { .. } => {
                None
            }
        };
        let result = self.write_file(job);
        ExportOutcome { source, result, ended: Instant::now() }
    }

    fn write_file(&self, job: ExportJob) -> Result<String, String> {
        match job {
            ExportJob::SaveSource { path, before, after } => {
                if path.exists() {
                    let document = Document::read(&path).map_err(|error| error.to_string())?;
                    if document.source != before {
                        return Err("not saved: the file has changed on disk".to_owned());
                    }
                }
                write(&path, after.as_bytes())
            }
            ExportJob::Picture { model, path, options, frames, hundredths } => {
                let bytes = self.picture(&model, &path, &options, &frames, hundredths)?;
                write(&path, &bytes)
            }
            ExportJob::Shader { scene, source, path, options } => {
                write(&path, &shader(&scene, &source, &options)?)
            }
            ExportJob::Screenshot { path, size, rgba } => write(&path, &png(size, &rgba)?),
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
        sdfc_files::check_writable(path).map_err(|error| cannot_write(path, &error))?;
        let painter = model.scene.painter(options).map_err(|error| error.to_string())?;
        let draw = |(number, values): (usize, &FrameValues)| -> Result<Image, String> {
            let mut progress = |frame: Progress| {
                let done = frame.done as f32 / frame.total.max(1) as f32;
                self.update((number as f32 + done) / frames.len() as f32)
            };
            let picture = painter.paint(values, 1, &mut progress);
            picture.map(|picture| picture.image).map_err(|error| error.to_string())
        };
        if let [only] = frames {
            return format.encode(&draw((0, only))?).map_err(|error| error.to_string());
        }
        if format != Format::Gif {
            return Err(format!("{}: an animation must be a .gif file", path.display()));
        }
        let mut file = Vec::new();
        let mut animation = Animation::new(&mut file).map_err(|error| error.to_string())?;
        for frame in frames.iter().enumerate() {
            animation.push(&draw(frame)?, hundredths).map_err(|error| error.to_string())?;
        }
        drop(animation);
        Ok(file)
    }

    fn update(&self, progress: f32) -> ControlFlow<()> {
        let mut state = lock(&self.state);
        state.progress = Some(progress);
        (self.wake)();
        if state.cancelled { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A shader of a source compiled as from the file, without live literals: numbers are constants.
fn shader(scene: &Path, source: &str, options: &ShaderOptions) -> Result<Vec<u8>, String> {
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    let folder = Folder::of(scene);
    let compiled = sdfc::Compiler::new().resolver(&folder).compile(&name, source);
    let scene = compiled.map_err(|_| "the scene has errors")?;
    let shader = scene.write_shader(options).map_err(|error| error.to_string())?;
    Ok(match shader.code {
        Code::Text(text) => text.into_bytes(),
        Code::Words(words) => words.into_iter().flat_map(u32::to_le_bytes).collect(),
    })
}

fn png([width, height]: [u32; 2], rgba: &[u8]) -> Result<Vec<u8>, String> {
    use image::ImageEncoder as _;
    let mut file = Vec::new();
    image::codecs::png::PngEncoder::new(&mut file)
        .write_image(rgba, width, height, image::ExtendedColorType::Rgba8)
        .map_err(|error| error.to_string())?;
    Ok(file)
}

fn write(path: &Path, bytes: &[u8]) -> Result<String, String> {
    sdfc_files::write(path, bytes).map_err(|error| cannot_write(path, &error))?;
    Ok(format!("saved {}", path.display()))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> String {
    format!("cannot write {}: {error}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::model;

    fn exporter() -> Exporter {
        Exporter { state: Arc::default(), wake: Box::new(|| ()) }
    }

    #[test]
    fn a_scene_that_has_changed_on_disk_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "box(1)").unwrap();
        let save = |before: &str| {
            let (before, after) = (before.to_owned(), "box(2)".to_owned());
            exporter().run(ExportJob::SaveSource { path: path.clone(), before, after }).result
        };
        assert!(save("box(3)").is_err());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(1)");
        assert!(save("box(1)").is_ok());
        // A deleted file is written again.
        std::fs::remove_file(&path).unwrap();
        assert!(save("box(1)").is_ok());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(2)");
    }

    #[test]
    fn pictures_animations_and_shaders_are_written_and_a_cancelled_one_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let model = model("sphere(0.5 + 0.1 * sin(time))\n");
        let in_folder = |name: &str| folder.path().join(name);
        let picture = |name: &str, count: usize| {
            let options = PictureOptions::new().size([24, 16]).backend(sdfc::Backend::Cpu);
            let frames = vec![model.defaults(); count];
            let (model, path, options) = (Arc::clone(&model), in_folder(name), Box::new(options));
            ExportJob::Picture { model, path, options, frames, hundredths: 4 }
        };
        exporter().run(picture("a.png", 1)).result.unwrap();
        assert_eq!(image::open(in_folder("a.png")).unwrap().width(), 24);
        exporter().run(picture("a.gif", 3)).result.unwrap();
        assert!(std::fs::read(in_folder("a.gif")).unwrap().starts_with(b"GIF89a"));
        assert!(exporter().run(picture("b.png", 3)).result.unwrap_err().contains(".gif"));
        let cancelled = exporter();
        lock(&cancelled.state).cancelled = true;
        assert!(cancelled.run(picture("c.png", 1)).result.is_err());
        assert!(!in_folder("c.png").exists());
        let (scene, path) = (in_folder("a.sdf"), in_folder("a.wgsl"));
        let (source, options) = (model.source.clone(), ShaderOptions::default());
        exporter().run(ExportJob::Shader { scene, source, path, options }).result.unwrap();
        let shader = std::fs::read_to_string(in_folder("a.wgsl")).unwrap();
        assert!(shader.contains("fn sdf_distance"));
        let (path, rgba) = (in_folder("w.png"), vec![9; 4 * 6]);
        exporter().run(ExportJob::Screenshot { path, size: [3, 2], rgba }).result.unwrap();
        assert_eq!(image::open(in_folder("w.png")).unwrap().height(), 2);
    }
}
