//! Buffers and bind group of a written shader, for your own wgpu pipeline.
//!
//! ```no_run
//! use sdfc::bind::Bindings;
//! use sdfc::{Code, Compiler, ShaderOptions, wgpu};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
//! let scene = Compiler::new().compile("ball.sdf", "param r = 1 in 0..2\nsphere(r)")?;
//! let written = scene.write_shader(&ShaderOptions::new().group(1))?;
//! let visibility = wgpu::ShaderStages::FRAGMENT;
//! let mut ball = Bindings::new((&device, &queue), &scene, &written, visibility)?;
//!
//! // Append your own shader source, which calls `sdf_distance`. `ball.layout()` is the second
//! // bind group layout of the pipeline.
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
use crate::scene::Scene;
use crate::uniforms::uniform_bytes;

/// Why the buffers of a shader cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BindError {
    /// The shader writes pixels to a buffer whose size only its host knows. Bind the buffers of
    /// its reflection by hand.
    #[error(
        "this shader writes its pixels to a buffer whose size its host decides: bind the buffers \
         of its reflection, or write the fragment stage"
    )]
    Pixels,
    /// The buffers lie in more than one bind group.
    #[error("the shader's buffers lie in more than one bind group")]
    Groups,
}

/// Buffers of a written field, ray method or fragment shader, with their bind group.
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
    /// Makes the buffers and fills them: params with their defaults, lists with their elements.
    ///
    /// If the shader has no buffers the group is empty and can still be bound.
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

    /// The bind group layout, for index [`Bindings::group`] of the pipeline's layout.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group of the buffers.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Index of the bind group that the shader was written for; 0 if it has no buffers.
    pub fn group(&self) -> u32 {
        self.group
    }

    /// The values that [`Bindings::upload`] writes. Set `time` and `frame` here.
    pub fn frame_mut(&mut self) -> &mut FrameValues {
        &mut self.frame
    }

    /// Sets a param by its name in the scene.
    ///
    /// # Errors
    ///
    /// [`ParamError`]. The value is not changed.
    pub fn set<'v>(&mut self, name: &str, value: impl Into<Value<'v>>) -> Result<(), ParamError> {
        set(&self.params, &mut self.frame, name, value.into())
    }

    /// Writes the values to the buffer, for frames that are submitted later.
    pub fn upload(&self, queue: &wgpu::Queue) {
        if let Some(buffer) = self.buffer(BufferRole::Params) {
            queue.write_buffer(buffer, 0, &uniform_bytes(&self.reflection, &self.frame));
        }
    }

    /// The buffer with a role, if the shader has one. The buffer [`BufferRole::View`] of a fragment
    /// shader is written by its host, with `view_bytes` of the crate `sdfc-render`.
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
            // WebGL requires a multiple of 16 bytes.
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
