//! The requests to the compile worker, and its reports.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use sdfc::CompileValues;

use crate::compile::diagnostics::SceneDiagnostics;
use crate::render::window_device::WindowDevice;
use crate::scene::document::TextsByPath;
use crate::scene::model::Model;

/// Which scene is built, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildRequest {
    /// The scene's file.
    pub path: PathBuf,
    /// The text that is compiled in place of the file's, if it was edited in the window.
    pub draft: Option<Arc<str>>,
    /// The texts that are compiled in place of imported files, if they were edited in the window.
    pub imports: TextsByPath,
    /// The ray method; `None` takes the scene's.
    pub method: Option<sdfc::Method>,
    /// True if the scene's numbers become live literals, which change without a recompile.
    pub live_literals: bool,
    /// Changed params, for those that are constants of the compiled scene.
    pub values: CompileValues,
    /// True for an orthographic camera; `None` takes that of the scene's camera.
    pub parallel: Option<bool>,
    /// True if the CPU draws even though there may be a GPU.
    pub on_cpu: bool,
    /// The device of the window, if it draws the scene too.
    pub window_device: Option<WindowDevice>,
    /// The number of times that new devices were opened because one was lost.
    pub device_generation: u32,
}

impl BuildRequest {
    /// A request for a file with everything else at its default.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            draft: None,
            imports: TextsByPath::new(),
            method: None,
            live_literals: true,
            values: CompileValues::new(),
            parallel: None,
            on_cpu: false,
            window_device: None,
            device_generation: 0,
        }
    }
}

/// The texts of a scene's files as they are on disk.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileTexts {
    /// That of the scene; `None` if it cannot be read.
    pub scene: Option<Arc<str>>,
    /// Those of imported files by their path beside the scene; `None` for those that cannot be
    /// read.
    pub imports: BTreeMap<String, Option<Arc<str>>>,
}

/// A report of the compile worker.
#[derive(Debug)]
pub struct CompileReport {
    /// The scene's file.
    pub path: PathBuf,
    /// When the build began, before any file was read.
    pub began: Instant,
    /// What happened.
    pub event: CompileEvent,
}

/// What happened during a build.
#[derive(Debug)]
pub enum CompileEvent {
    /// The file cannot be read; why.
    Unreadable(String),
    /// A file has another text, but a draft is compiled in place of it.
    FilesChanged(FileTexts),
    /// The source was compiled, with or without errors.
    Compiled {
        /// The text that was compiled.
        text: Arc<str>,
        /// The texts of the imported files that were compiled.
        imports: TextsByPath,
        /// The texts of all files as they are on disk.
        files: FileTexts,
        /// Errors and warnings.
        diagnostics: SceneDiagnostics,
        /// The folders to watch: a change in one of them can change the scene.
        folders: BTreeSet<PathBuf>,
        /// True if the scene can be drawn, so that more events follow.
        draws: bool,
    },
    /// A pipeline is being made for the scene, which may take seconds.
    BuildingPipeline,
    /// The scene draws nothing.
    Empty,
    /// The scene can be drawn.
    Ready(Arc<Model>),
    /// The scene compiles but cannot be drawn; why.
    Failed(String),
}
