//! What a written shader reads, as a bind group of someone's own pipeline.
//!
//! ```no_run
//! use sdfc::bind::Bindings;
//! use sdfc::{Code, Scene, ShaderOptions, wgpu};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
//! let scene = Scene::from_source("ball.sdf", "param r = 1 in 0..2\nsphere(r)")?;
//! let written = scene.write_shader(&ShaderOptions { group: 1, ..ShaderOptions::default() })?;
//! let mut ball = Bindings::new((&device, &queue), &scene, &written, wgpu::ShaderStages::FRAGMENT)?;
//!
//! // Behind your own text, which calls `sdf_distance`; `ball.layout()` is the second of the pipeline's layouts.
//! let Code::Text(field) = &written.code else { unreachable!("WGSL is text") };
//! # let own = "";
//! let text = format!("{field}\n{own}");
//!
//! // Before a frame:
//! ball.set("r", 0.5)?;
//! ball.upload(&queue);
//! # let pass: &mut wgpu::RenderPass<'_> = unimplemented!();
//! pass.set_bind_group(ball.group(), ball.bind_group(), &[]);
//! # Ok(())
//! # }
//! ```

use sdfc_codegen::{Buffer, BufferRole, Reflection, Written};
use sdfc_graph::Param;
use sdfc_graph::eval::FrameValues;

use crate::params::{ParamError, Value, set};
use crate::{Scene, uniform_bytes};

/// Why a shader's buffers cannot be made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BindError {
    /// The shader writes pixels to a buffer, whose size is the host's affair: bind those of its reflection by hand.
    Pixels,
    /// The buffers lie in more than one group.
    Groups,
}

impl std::fmt::Display for BindError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Pixels => {
                "this shader writes its pixels to a buffer whose size its host decides: bind by the \
                 reflection, or write the fragment form"
            }
            Self::Groups => "the shader's buffers lie in more than one bind group",
        })
    }
}

impl std::error::Error for BindError {}

/// The buffers of one written field, ray method or fragment form, with their bind group.
#[derive(Debug)]
pub struct Bindings {
    params: Vec<Param>,
    reflection: Reflection,
    frame: FrameValues,
    group: u32,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    buffers: Vec<(BufferRole, wgpu::Buffer)>,
}

impl Bindings {
    /// Makes the buffers and fills them: params with their defaults, lists with what the shader looks up. Without
    /// buffers the group is empty, and may be bound all the same.
    ///
    /// # Errors
    ///
    /// [`BindError`].
    pub fn new(
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        written: &Written,
        visibility: wgpu::ShaderStages,
    ) -> Result<Self, BindError> {
        let reflection = written.reflection.clone();
        let group = reflection.buffers.first().map_or(0, |buffer| buffer.group);
        if reflection.buffers.iter().any(|buffer| buffer.role == BufferRole::Pixels) {
            return Err(BindError::Pixels);
        }
        if reflection.buffers.iter().any(|buffer| buffer.group != group) {
            return Err(BindError::Groups);
        }
        let entries: Vec<_> =
            reflection.buffers.iter().map(|buffer| layout_entry(buffer, visibility)).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("sdfc"),
            entries: &entries,
        });
        let lists = list_bytes(&reflection);
        let make = |buffer: &Buffer| (buffer.role, make_buffer(device, buffer, lists.len()));
        let buffers: Vec<_> = reflection.buffers.iter().map(make).collect();
        let places = reflection.buffers.iter().zip(&buffers);
        let entries: Vec<_> = places
            .map(|(buffer, (_, made))| wgpu::BindGroupEntry {
                binding: buffer.binding,
                resource: made.as_entire_binding(),
            })
            .collect();
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("sdfc"),
            layout: &layout,
            entries: &entries,
        });
        let (params, frame) = (scene.params().to_vec(), scene.defaults());
        let bindings = Self { params, reflection, frame, group, layout, bind_group, buffers };
        if let Some(buffer) = bindings.buffer(BufferRole::Lists) {
            queue.write_buffer(buffer, 0, &lists);
        }
        bindings.upload(queue);
        Ok(bindings)
    }

    /// For the pipeline's layout, at the place [`Bindings::group`].
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// Of the buffers.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// The number of the group that the shader was written for; 0 where it has no buffers.
    pub fn group(&self) -> u32 {
        self.group
    }

    /// The values that [`Bindings::upload`] writes; `time` and `frame` are set here.
    pub fn frame_mut(&mut self) -> &mut FrameValues {
        &mut self.frame
    }

    /// Sets a param by its name in the scene.
    ///
    /// # Errors
    ///
    /// [`ParamError`]; the value stays as it was.
    pub fn set<'v>(&mut self, name: &str, value: impl Into<Value<'v>>) -> Result<(), ParamError> {
        set(&self.params, &mut self.frame, name, value.into())
    }

    /// Writes the values to the buffer, for the frames that are submitted from then on.
    pub fn upload(&self, queue: &wgpu::Queue) {
        if let Some(buffer) = self.buffer(BufferRole::Params) {
            queue.write_buffer(buffer, 0, &uniform_bytes(&self.reflection, &self.frame));
        }
    }

    /// The buffer of a role, where the shader has one: [`BufferRole::View`] of a fragment form is written by its host,
    /// with [`view_bytes`](sdfc_render::view_bytes).
    pub fn buffer(&self, role: BufferRole) -> Option<&wgpu::Buffer> {
        self.buffers.iter().find(|buffer| buffer.0 == role).map(|buffer| &buffer.1)
    }
}

fn layout_entry(buffer: &Buffer, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    let ty = match buffer.role {
        BufferRole::View | BufferRole::Params => wgpu::BufferBindingType::Uniform,
        BufferRole::Lists => wgpu::BufferBindingType::Storage { read_only: true },
        BufferRole::Pixels => wgpu::BufferBindingType::Storage { read_only: false },
    };
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding: buffer.binding, visibility, ty, count: None }
}

fn make_buffer(device: &wgpu::Device, buffer: &Buffer, list_bytes: usize) -> wgpu::Buffer {
    let (size, usage) = match buffer.role {
        BufferRole::Lists => (list_bytes, wgpu::BufferUsages::STORAGE),
        BufferRole::View | BufferRole::Params | BufferRole::Pixels => {
            // WebGL wants whole vectors.
            ((buffer.size as usize).next_multiple_of(16), wgpu::BufferUsages::UNIFORM)
        }
    };
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(&buffer.variable),
        size: size as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn list_bytes(reflection: &Reflection) -> Vec<u8> {
    reflection.lists.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect()
}
