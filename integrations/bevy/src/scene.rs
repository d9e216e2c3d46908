//! Compiled scenes as assets.

use std::sync::atomic::{AtomicU64, Ordering};

use bevy::asset::Asset;
use bevy::pbr::MATERIAL_BIND_GROUP_INDEX;
use bevy::reflect::TypePath;
use bevy::shader::{Shader, ShaderDefVal};
use sdfc::{
    Code, Compiler, Diagnostics, Emit, FrameValues, NoFiles, Reflection, Resolver, Scene,
    ShaderOptions, uniform_bytes,
};

use crate::material::SCENE_BINDING;

/// The part of the fragment shader that is the same for all scenes.
const SURFACE: &str = include_str!("surface.wgsl");
/// The start of all names that the shader of a scene declares.
const PREFIX: &str = "sdfc_";

/// Counts the scenes of the program, so that a scene that replaced another one is noticed.
static REVISION: AtomicU64 = AtomicU64::new(0);

/// Why a scene cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SdfcError {
    /// The scene has errors. The message shows each with its source line.
    #[error("{0}")]
    Compile(Diagnostics),
    /// The scene compiled, but its shader cannot be written: it draws nothing, or regions only.
    #[error("{name}: {source}")]
    Shader {
        /// The scene.
        name: String,
        /// The reason.
        source: Box<sdfc::Error>,
    },
    /// A `.sdf` file could not be read.
    #[error("cannot read the scene: {0}")]
    Read(#[from] std::io::Error),
    /// A `.sdf` file is not UTF-8.
    #[error("the scene is not UTF-8 text: {0}")]
    Text(#[from] std::string::FromUtf8Error),
}

/// A compiled scene. Loaded from a `.sdf` file by the `AssetServer`, or made by
/// [`SdfcScene::compile`].
#[derive(Asset, TypePath, Debug)]
pub struct SdfcScene {
    name: String,
    scene: Scene,
    reflection: Reflection,
    source: String,
    revision: u64,
}

impl SdfcScene {
    /// Compiles the source of a scene that imports no files. Errors call the scene `name`.
    ///
    /// ```
    /// use sdfc_bevy::SdfcScene;
    ///
    /// let scene = SdfcScene::compile("ball.sdf", "param r = 0.5 in 0.1..1\nsphere(r)")?;
    /// assert_eq!(scene.scene().params().len(), 1);
    ///
    /// let error = SdfcScene::compile("bad.sdf", "spere(1)").unwrap_err().to_string();
    /// assert!(error.contains("did you mean `sphere`?"));
    /// # Ok::<(), sdfc_bevy::SdfcError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SdfcError::Compile`], [`SdfcError::Shader`].
    pub fn compile(name: &str, text: &str) -> Result<Self, SdfcError> {
        Self::compile_with_files(name, text, &NoFiles)
    }

    /// Compiles the source of a scene, and reads the files that it imports through `files`.
    ///
    /// # Errors
    ///
    /// As [`SdfcScene::compile`].
    pub fn compile_with_files(
        name: &str,
        text: &str,
        files: &dyn Resolver,
    ) -> Result<Self, SdfcError> {
        let scene =
            Compiler::new().resolver(files).compile(name, text).map_err(SdfcError::Compile)?;
        Self::from_scene(name, scene)
    }

    /// Takes a scene that was compiled with options of your own.
    ///
    /// # Errors
    ///
    /// [`SdfcError::Shader`].
    pub fn from_scene(name: &str, scene: Scene) -> Result<Self, SdfcError> {
        let failed = |source| SdfcError::Shader { name: name.to_owned(), source: Box::new(source) };
        let options = ShaderOptions::new()
            .emit(Emit::March)
            .prefix(PREFIX)
            .group(MATERIAL_BIND_GROUP_INDEX as u32)
            .binding(SCENE_BINDING);
        let written = scene.write_shader(&options).map_err(failed)?;
        let source = match written.code {
            Code::Text(text) => text,
            // WGSL is text.
            Code::Words(_) => String::new(),
        };
        let revision = REVISION.fetch_add(1, Ordering::Relaxed);
        let reflection = written.reflection;
        Ok(Self { name: name.to_owned(), scene, reflection, source, revision })
    }

    /// The compiled scene: its params, its bounds, and its field on the CPU.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The name that the scene was compiled with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A number that no other scene of the program has.
    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// The fragment shader that draws the scene, in the main pass and in prepasses.
    pub(crate) fn shader(&self) -> Shader {
        let source = format!("{SURFACE}\n{}", self.source);
        let has_material =
            self.reflection.functions.iter().any(|row| row.name == format!("{PREFIX}material"));
        let defs = if has_material { vec![ShaderDefVal::from("SDFC_MATERIAL")] } else { vec![] };
        Shader::from_wgsl_with_defs(source, format!("sdfc/{}/{}", self.revision, self.name), defs)
    }

    /// The bytes of the uniform buffer of params.
    pub(crate) fn uniform(&self, frame: &FrameValues) -> Vec<u8> {
        uniform_bytes(&self.reflection, frame)
    }

    /// The bytes of the buffer of lists.
    pub(crate) fn lists(&self) -> Vec<u8> {
        let numbers = self.reflection.lists.as_flattened().iter();
        numbers.flat_map(|number| number.to_le_bytes()).collect()
    }

    /// True if the picture changes with the time or the number of the frame.
    pub(crate) fn moves(&self) -> bool {
        let still = self.scene.defaults();
        let mut later = self.scene.defaults();
        (later.time, later.frame) = (still.time + 1.0, still.frame + 1.0);
        self.uniform(&still) != self.uniform(&later)
    }
}
