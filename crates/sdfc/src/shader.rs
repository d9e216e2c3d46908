//! Writes a scene as a shader.

use std::str::FromStr;

use sdfc_codegen::{
    FieldOptions, Lists, PictureOptions, Shader, Stage, Target, UnknownName, Written, by_name,
    field_module, march_module, picture_module, render_module, shadertoy_module,
};
use sdfc_march::Method;
use sdfc_render::{Tile, View, view_bytes};

use crate::error::Error;
use crate::scene::Scene;

/// The greatest bind group and the greatest binding of a shader.
pub const MAX_BINDING: u32 = 65_535;

/// The part of a shader that is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Emit {
    /// Functions for distance, gradient and material.
    #[default]
    Field,
    /// The same, and a ray method that finds where a ray meets the surface.
    March,
    /// A complete shader that draws pictures.
    Render,
}

/// Options of [`Scene::write_shader`].
///
/// ```
/// use sdfc::{Emit, ShaderOptions, Target};
///
/// let options = ShaderOptions::new().target(Target::Hlsl).emit(Emit::March).prefix("ball_");
/// assert_eq!(options.as_arguments(), "--target hlsl --emit march --prefix ball_");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShaderOptions {
    /// The language.
    pub target: Target,
    /// The part of the shader.
    pub emit: Emit,
    /// The shader stage of [`Emit::Render`]; ignored otherwise.
    pub stage: Stage,
    /// The ray method of [`Emit::March`] and [`Emit::Render`]; `None` takes the scene's, or `auto`.
    pub method: Option<Method>,
    /// Prefix of every name; ignored by [`Target::Shadertoy`].
    pub prefix: String,
    /// Bind group of the buffers, if the target has groups; at most [`MAX_BINDING`].
    pub group: u32,
    /// Binding of the first buffer, if the target has bindings; at most [`MAX_BINDING`].
    pub binding: u32,
}

impl Default for ShaderOptions {
    /// As [`ShaderOptions::new`].
    fn default() -> Self {
        let FieldOptions { prefix, group, binding, .. } = FieldOptions::default();
        let (target, emit, stage) = (Target::Wgsl, Emit::Field, Stage::Compute);
        Self { target, emit, stage, method: None, prefix, group, binding }
    }
}

impl Emit {
    /// All parts.
    pub const ALL: [Self; 3] = [Self::Field, Self::March, Self::Render];

    /// The part that is written in a language unless another one is asked for.
    pub fn default_for(target: Target) -> Self {
        if target == Target::Shadertoy { Self::Render } else { Self::Field }
    }

    /// The part's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Field => "field",
            Self::March => "march",
            Self::Render => "render",
        }
    }

    /// One sentence about the part.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Field => "Functions for distance, gradient and material",
            Self::March => "The same, and a ray method",
            Self::Render => "A complete shader that draws pictures",
        }
    }
}

impl FromStr for Emit {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        by_name("part", name, &Self::ALL, Self::name)
    }
}

impl ShaderOptions {
    /// The default options: a field in WGSL with the prefix `sdf_`, its buffers from group 0,
    /// binding 0.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the language.
    #[must_use]
    pub fn target(self, target: Target) -> Self {
        Self { target, ..self }
    }

    /// Sets which part of the shader is written.
    #[must_use]
    pub fn emit(self, emit: Emit) -> Self {
        Self { emit, ..self }
    }

    /// Sets the shader stage of [`Emit::Render`].
    #[must_use]
    pub fn stage(self, stage: Stage) -> Self {
        Self { stage, ..self }
    }

    /// Sets the ray method; `None` takes the scene's, or `auto`.
    #[must_use]
    pub fn method(self, method: impl Into<Option<Method>>) -> Self {
        Self { method: method.into(), ..self }
    }

    /// Sets the prefix of every name.
    #[must_use]
    pub fn prefix(self, prefix: impl Into<String>) -> Self {
        Self { prefix: prefix.into(), ..self }
    }

    /// Sets the bind group of the buffers.
    #[must_use]
    pub fn group(self, group: u32) -> Self {
        Self { group, ..self }
    }

    /// Sets the binding of the first buffer.
    #[must_use]
    pub fn binding(self, binding: u32) -> Self {
        Self { binding, ..self }
    }

    /// The arguments of `sdfc compile` that give the same shader, without those that are defaults.
    pub fn as_arguments(&self) -> String {
        let defaults = Self::default();
        let Self { target, emit, stage, method, prefix, group, binding } = self;
        let mut words = format!("--target {} --emit {}", target.name(), emit.name());
        let mut add = |name: &str, value: &dyn std::fmt::Display, counts: bool| {
            if counts {
                words += &format!(" --{name} {value}");
            }
        };
        add("stage", &stage.name(), *emit == Emit::Render);
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

impl Scene {
    /// The functions of the field, to embed in a shader.
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`].
    pub fn field_shader(&self, options: &FieldOptions) -> Result<Shader, Error> {
        Ok(field_module(&self.program, options)?)
    }

    /// The shader of a picture.
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`].
    pub fn picture_shader(&self, method: Method) -> Result<Shader, Error> {
        let program = self.with_bounds_for(&self.program, method);
        Ok(render_module(&program, self.marched_by(method))?)
    }

    /// Writes the shader in the language of `options`.
    ///
    /// A shader in text form begins with a comment that names the version, the source and the
    /// options. The same source gives the same bytes.
    ///
    /// ```
    /// use sdfc::{Code, Compiler, ShaderOptions, Target};
    ///
    /// let scene = Compiler::new().compile("ball.sdf", "sphere(0.5)")?;
    /// let options = ShaderOptions::new().target(Target::Hlsl);
    /// let Code::Text(text) = scene.write_shader(&options)?.code else { unreachable!() };
    /// assert!(text.contains("float sdf_distance(float3 p)"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Codegen`], also if the target does not support the options; [`Error::Binding`];
    /// [`Error::Planar`]; [`Error::View`] for [`Target::Shadertoy`] if the settings give no valid
    /// view.
    pub fn write_shader(&self, options: &ShaderOptions) -> Result<Written, Error> {
        let shader = self.shader(options)?;
        let (version, name) = (env!("CARGO_PKG_VERSION"), &self.id.name);
        let doubt = if self.is_certified() { "" } else { ", field uncertified" };
        let (hash, how) = (self.source_hash(), options.as_arguments() + &self.fixed_arguments());
        let comment = format!("sdfc {version}, {name}, source {hash}{doubt}, {how}");
        Ok(shader.write(options.target, &comment)?)
    }

    fn shader(&self, options: &ShaderOptions) -> Result<Shader, Error> {
        let ShaderOptions { target, stage, prefix, group, binding, .. } = options.clone();
        let method = options.method.unwrap_or(self.method());
        let number = group.max(binding);
        if number > MAX_BINDING {
            return Err(Error::Binding { number, limit: MAX_BINDING });
        }
        if options.emit == Emit::Render && !target.has_stage(stage) {
            return Err(sdfc_codegen::Error::MissingStage { target, stage }.into());
        }
        if self.is_planar() && options.emit == Emit::March {
            return Err(Error::Planar("the ray method"));
        }
        let lists = target.lists();
        let functions = FieldOptions {
            prefix: prefix.clone(),
            group,
            binding,
            lists,
            ..FieldOptions::default()
        };
        if options.emit == Emit::Field {
            return Ok(field_module(&self.program, &functions)?);
        }
        if options.emit == Emit::Render
            && lists == Lists::Constants
            && self.program.settings.environment.is_some()
        {
            // Compilers would need minutes for so many constants, if they accept them.
            let what = "storage buffers, which the picture of `sky(image: ...)` needs; choose \
                        another target, or write a gradient: sky()";
            return Err(sdfc_codegen::Error::Unsupported { target, what }.into());
        }
        // The choice of a method may trace rays on the CPU. A field does without.
        let program = self.with_bounds_for(&self.program, method);
        let method = self.marched_by(method);
        if options.emit == Emit::March {
            return Ok(march_module(&program, method, &functions)?);
        }
        if target == Target::Shadertoy {
            return Ok(shadertoy_module(&program, method, &self.default_view()?)?);
        }
        let rows_up = target.counts_rows_upwards();
        let options = PictureOptions { method, stage, rows_up, prefix, group, binding, lists };
        Ok(picture_module(&program, &options)?)
    }

    /// The contents of the view buffer at the params' defaults, for a picture of [`VIEW_SIZE`].
    pub(crate) fn default_view(&self) -> Result<Vec<u8>, Error> {
        let frame = self.defaults();
        let [width, height] = VIEW_SIZE.map(f64::from);
        let (bounds, pose) = (self.bounds_at(&frame), self.pose(&frame, width / height)?);
        let view = View::from_pose(&self.program, &frame, bounds, VIEW_SIZE, &pose)?;
        Ok(view_bytes(&view.block(Tile { origin: [0, 0], size: VIEW_SIZE })))
    }
}

/// Picture size for which a default view is written: that of shadertoy.com beside its editor.
pub const VIEW_SIZE: [u32; 2] = [640, 360];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compiler::Compiler;

    #[test]
    fn a_shader_says_if_its_field_is_uncertified() -> Result<(), Error> {
        let says = |text: &str| -> Result<bool, Error> {
            let scene = Compiler::new().compile("a.sdf", text).map_err(|_| Error::NothingDrawn)?;
            let shader = scene.write_shader(&ShaderOptions::default())?;
            let sdfc_codegen::Code::Text(text) = shader.code else { return Ok(false) };
            Ok(text.lines().next().is_some_and(|line| line.contains("uncertified")))
        };
        assert!(!says("sphere(1)")?);
        assert!(says("solid s() = p.x * p.x + p.y * p.y - 1\ns()")?);
        Ok(())
    }

    #[test]
    fn groups_and_bindings_have_a_limit() -> Result<(), Error> {
        let scene = Compiler::new().compile("a.sdf", "sphere(1)");
        let scene = scene.map_err(|_| Error::NothingDrawn)?;
        let write = |group, binding| {
            let options = ShaderOptions::new().group(group).binding(binding);
            scene.write_shader(&options).map(|_| ())
        };
        write(MAX_BINDING, MAX_BINDING)?;
        for (group, binding) in [(MAX_BINDING + 1, 0), (0, u32::MAX)] {
            let refused = write(group, binding);
            assert!(matches!(&refused, Err(error @ Error::Binding { .. }) if error.is_call()));
        }
        Ok(())
    }

    #[test]
    fn a_shader_names_the_options_it_was_written_with() -> Result<(), Error> {
        let scene = Compiler::new().compile("a.sdf", "sphere(1)");
        let scene = scene.map_err(|_| Error::NothingDrawn)?;
        let says = |options: &ShaderOptions| -> Result<String, Error> {
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
        let method = Some(Method::Sphere);
        let options = ShaderOptions { target, stage, method, emit: Emit::Render, ..options };
        let expected = "--target msl --emit render --stage fragment --march sphere --prefix a_";
        assert_eq!(says(&options)?, expected);
        Ok(())
    }
}
