//! A model for both programs.

use std::path::Path;

use anyhow::{Context as _, Result, anyhow};
use fidget::context::{Context, Node, Tree};
use nalgebra::{Matrix4, Translation3};
use sdfc::{Compiler, LoopStrategy, Scene};

use crate::{tree, vm};

/// A file, and what is drawn of it.
pub struct Model {
    /// The text of the scene.
    pub text: String,
    name: String,
    folder: sdfc_files::Folder,
    /// The text of Fidget's own format, if the file has it.
    vm: Option<String>,
}

/// The cube that is drawn and meshed, from the direction of z.
#[derive(Clone, Copy)]
pub struct View {
    pub is_planar: bool,
    pub center: [f64; 3],
    pub half: f64,
}

impl Model {
    /// Reads a `.sdf` or a `.vm` file.
    pub fn read(path: &Path) -> Result<Self> {
        let input = sdfc_files::read(path)?;
        let is_vm = path.extension().is_some_and(|extension| extension == "vm");
        let text = if is_vm { vm::scene(&input.text)? } else { input.text.clone() };
        Ok(Self {
            text,
            name: input.name,
            folder: sdfc_files::Folder::of(path),
            vm: is_vm.then_some(input.text),
        })
    }

    /// The scene as sdfc compiles it.
    pub fn scene(&self) -> Result<Scene> {
        self.compile(LoopStrategy::Auto)
    }

    fn compile(&self, loops: LoopStrategy) -> Result<Scene> {
        let compiler = Compiler::new().resolver(&self.folder).loops(loops);
        compiler.compile(&self.name, &self.text).map_err(|found| anyhow!("{found}"))
    }

    /// The scene's field, if Fidget cannot read the file itself.
    pub fn tree(&self) -> Result<Option<Tree>> {
        Ok(match self.vm {
            Some(_) => None,
            None => Some(tree::tree(&self.compile(LoopStrategy::Unrolled)?)?),
        })
    }

    /// The model in a context of Fidget; `tree` is that of [`Model::tree`].
    pub fn context(&self, tree: Option<&Tree>) -> Result<(Context, Node)> {
        if let Some(tree) = tree {
            let mut context = Context::new();
            let root = context.import(tree);
            return Ok((context, root));
        }
        Ok(Context::from_text(self.vm.as_deref().unwrap_or(&self.text).as_bytes())?)
    }

    /// What is drawn: the cube from -1 to 1 for Fidget's own models, else one around what the scene
    /// shows.
    pub fn view(&self) -> Result<View> {
        if self.vm.is_some() {
            let is_planar = self.text.starts_with("region");
            return Ok(View { is_planar, center: [0.0; 3], half: 1.0 });
        }
        let scene = self.scene()?;
        let focus = scene.focus_at(&scene.defaults());
        let [low, high] = focus.context("the scene has no bounds")?;
        let center = [0, 1, 2].map(|axis| (low[axis] + high[axis]) / 2.0);
        let half = (0..3).map(|axis| (high[axis] - low[axis]) / 2.0).fold(0.0, f64::max);
        Ok(View { is_planar: scene.is_planar(), center, half: half * 1.05 })
    }
}

impl View {
    /// The map from the cube from -1 to 1 to this cube.
    pub fn matrix(self) -> Matrix4<f32> {
        let [x, y, z] = self.center.map(|x| x as f32);
        Translation3::new(x, y, z).to_homogeneous() * Matrix4::new_scaling(self.half as f32)
    }
}
