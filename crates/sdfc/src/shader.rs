//! A scene's shader in the language of choice.

use sdfc_codegen::{
    FieldOptions, PictureOptions, Shader, Stage, Target, Written, field_module, march_module,
    picture_module, shadertoy_module,
};
use sdfc_diagnostics::{FileId, Sources};
use sdfc_render::{Tile, View, view_bytes};

use crate::marched::with_stretches;
use crate::{Error, Scene};

/// Which part of a shader is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Emit {
    /// The functions for distance, gradient and material.
    #[default]
    Field,
    /// The same and a ray method: where a ray meets the surface.
    March,
    /// The whole shader that draws pictures.
    Render,
}

/// How a shader is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderOptions {
    /// The language.
    pub target: Target,
    /// The part.
    pub emit: Emit,
    /// The stages of [`Emit::Render`]; nothing elsewhere.
    pub stage: Stage,
    /// The ray method of [`Emit::March`] and [`Emit::Render`]; `None` takes the scene's, or `auto`.
    pub method: Option<String>,
    /// Start of every name; [`Target::Shadertoy`] has none.
    pub prefix: String,
    /// Bind group of the buffers, where the target has groups.
    pub group: u32,
    /// Binding of the first of them, where the target has bindings.
    pub binding: u32,
}

impl Default for ShaderOptions {
    /// A field in WGSL, its names beginning with `sdf_`, its buffer at 0, 0.
    fn default() -> Self {
        let FieldOptions { prefix, group, binding, .. } = FieldOptions::default();
        let (target, emit, stage) = (Target::Wgsl, Emit::Field, Stage::Compute);
        Self { target, emit, stage, method: None, prefix, group, binding }
    }
}

impl Emit {
    /// Its name, as the command line has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Field => "field",
            Self::March => "march",
            Self::Render => "render",
        }
    }
}

impl ShaderOptions {
    /// What `sdfc compile` is to be told for the same shader, but for what changes nothing.
    pub fn as_arguments(&self) -> String {
        let defaults = Self::default();
        let Self { target, emit, stage, method, prefix, group, binding } = self;
        let mut words = format!("--target {} --emit {}", target.name(), emit.name());
        let mut add = |name: &str, value: &dyn std::fmt::Display, counts: bool| {
            if counts {
                words += &format!(" --{name} {value}");
            }
        };
        let stage = match stage {
            Stage::Compute => "compute",
            Stage::Fragment => "fragment",
        };
        add("stage", &stage, *emit == Emit::Render);
        if let Some(method) = method {
            add("march", method, *emit != Emit::Field);
        }
        let has_prefix = *target != Target::Shadertoy && *prefix != defaults.prefix;
        add("prefix", if prefix.is_empty() { &"''" } else { prefix }, has_prefix);
        add("group", group, target.has_groups() && *group != defaults.group);
        add("binding", binding, target.has_bindings() && *binding != defaults.binding);
        words
    }
}

/// What a scene was compiled from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    /// Name of its file, without the folder: the same scene gives the same bytes wherever it lies.
    name: String,
    hash: u64,
}

impl Origin {
    pub(crate) fn new(sources: &Sources, scene: FileId) -> Self {
        let name = sources.name(scene);
        let name = name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned();
        let texts = (0..sources.len()).map(|file| sources.text(FileId(file as u32)));
        Self { name, hash: texts.fold(FNV_OFFSET, fnv) }
    }
}

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;

/// FNV-1a of 64 bits over a text and the 0 that ends it.
fn fnv(hash: u64, text: &str) -> u64 {
    let bytes = text.bytes().chain([0]);
    bytes.fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(FNV_PRIME))
}

impl Scene {
    /// A hash of all that the scene was compiled from, the library and imported files included: 16
    /// hexadecimal digits (FNV-1a).
    pub fn source_hash(&self) -> String {
        format!("{:016x}", self.origin.hash)
    }

    /// The shader in a target's language. A text says at its head what wrote it and from what; the same
    /// source gives the same bytes.
    ///
    /// ```
    /// use sdfc::{Code, ShaderOptions, Target, compile};
    ///
    /// let scene = compile("ball.sdf", "sphere(0.5)").scene.expect("no errors");
    /// let options = ShaderOptions { target: Target::Hlsl, ..ShaderOptions::default() };
    /// let Code::Text(text) = scene.write_shader(&options)?.code else { unreachable!() };
    /// assert!(text.contains("float sdf_distance(float3 p)"));
    /// # Ok::<(), sdfc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`], also where the target cannot hold what is asked for; [`Error::View`] for
    /// [`Target::Shadertoy`], where the settings make no picture.
    pub fn write_shader(&self, options: &ShaderOptions) -> Result<Written, Error> {
        let shader = self.shader(options)?;
        let (version, name) = (env!("CARGO_PKG_VERSION"), &self.origin.name);
        let doubt = if self.is_certified() { "" } else { ", field uncertified" };
        let (hash, how) = (self.source_hash(), options.as_arguments());
        let comment = format!("sdfc {version}, {name}, source {hash}{doubt}, {how}");
        Ok(shader.write(options.target, &comment)?)
    }

    fn shader(&self, options: &ShaderOptions) -> Result<Shader, Error> {
        let ShaderOptions { target, stage, prefix, group, binding, .. } = options.clone();
        let method = options.method.as_deref().unwrap_or(self.method());
        if options.emit == Emit::Render && !target.has_stage(stage) {
            let what = stage.name();
            return Err(sdfc_codegen::Error::Unsupported { target, what }.into());
        }
        let lists = target.lists();
        let functions = || {
            let prefix = prefix.clone();
            FieldOptions { prefix, group, binding, lists, ..FieldOptions::default() }
        };
        let method = self.marched_by(method);
        let program = with_stretches(&self.program, method);
        let shader = match options.emit {
            Emit::Field => field_module(&self.program, &functions())?,
            Emit::March => march_module(&program, method, &functions())?,
            Emit::Render if target == Target::Shadertoy => {
                shadertoy_module(&program, method, &self.default_view()?)?
            }
            Emit::Render => {
                let rows_up = target.counts_rows_upwards();
                let method = method.to_owned();
                let options =
                    PictureOptions { method, stage, rows_up, prefix, group, binding, lists };
                picture_module(&program, &options)?
            }
        };
        Ok(shader)
    }

    /// The view at the defaults, as a buffer would hold it. Its size says how wide it is, no more.
    pub(crate) fn default_view(&self) -> Result<Vec<u8>, Error> {
        let frame = self.defaults();
        let view = View::new(&self.program, &frame, self.bounds_at(&frame), VIEW_SIZE)?;
        Ok(view_bytes(&view.block(Tile { origin: [0, 0], size: VIEW_SIZE })))
    }
}

/// The size of picture that a view is written for, that of shadertoy.com beside a text.
pub const VIEW_SIZE: [u32; 2] = [640, 360];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shader_says_where_its_field_is_uncertified() -> Result<(), crate::Error> {
        let says = |text: &str| -> Result<bool, crate::Error> {
            let scene = crate::compile("a.sdf", text).scene.ok_or(crate::Error::NothingDrawn)?;
            let shader = scene.write_shader(&crate::ShaderOptions::default())?;
            let sdfc_codegen::Code::Text(text) = shader.code else { return Ok(false) };
            Ok(text.lines().next().is_some_and(|line| line.contains("uncertified")))
        };
        assert!(!says("sphere(1)")?);
        assert!(says("solid s() = p.x * p.x + p.y * p.y - 1\ns()")?);
        Ok(())
    }

    #[test]
    fn a_text_says_how_it_was_made() -> Result<(), crate::Error> {
        let scene = crate::compile("a.sdf", "sphere(1)").scene.ok_or(crate::Error::NothingDrawn)?;
        let says = |options: &ShaderOptions| -> Result<String, crate::Error> {
            let head = scene.write_shader(options)?.code.into_bytes();
            let head = String::from_utf8_lossy(&head).lines().next().unwrap_or("").to_owned();
            Ok(head.rsplit(", ").next().unwrap_or("").to_owned())
        };
        let options = ShaderOptions::default();
        assert_eq!(says(&options)?, "--target wgsl --emit field");
        let (emit, prefix) = (Emit::March, "a_".to_owned());
        let options = ShaderOptions { emit, prefix, group: 2, ..options };
        assert_eq!(says(&options)?, "--target wgsl --emit march --prefix a_ --group 2");
        let (target, stage) = (Target::Msl, Stage::Fragment);
        let method = Some("sphere".to_owned());
        let options = ShaderOptions { target, stage, method, emit: Emit::Render, ..options };
        let expected = "--target msl --emit render --stage fragment --march sphere --prefix a_";
        assert_eq!(says(&options)?, expected);
        Ok(())
    }

    #[test]
    fn the_hash_is_fnv() {
        // Published vector of FNV-1a: "foobar" gives 85944171f73967e8.
        let bytes = "foobar".bytes();
        let hash = bytes.fold(FNV_OFFSET, |h, b| (h ^ u64::from(b)).wrapping_mul(FNV_PRIME));
        assert_eq!(hash, 0x8594_4171_f739_67e8);
        assert_ne!(fnv(fnv(FNV_OFFSET, "a"), "b"), fnv(fnv(FNV_OFFSET, "ab"), ""));
    }
}
