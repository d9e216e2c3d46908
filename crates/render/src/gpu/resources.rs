//! Buffers, bind group layouts and pipelines.

use std::num::NonZero;

use super::device::Gpu;

/// Columns and rows of a workgroup of the entry point `main`.
pub(crate) const WORKGROUP: u32 = 8;
/// Binding of the first table.
pub(crate) const FIRST_TABLE: u32 = 3;

/// The layout of a buffer of at least this many bytes.
pub(crate) fn entry(
    binding: u32,
    kind: wgpu::BufferBindingType,
    bytes: usize,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: kind,
            has_dynamic_offset: false,
            min_binding_size: NonZero::new(bytes as u64),
        },
        count: None,
    }
}

/// The compute pipeline of a module's entry point.
pub(crate) fn compute_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry_point),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: Some(&layout),
        module,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}

pub(crate) fn table(gpu: &Gpu, bytes: &[u8]) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    let table = buffer(gpu, "table", bytes.len() as u64, usage);
    gpu.queue.write_buffer(&table, 0, bytes);
    table
}

pub(crate) fn buffer(gpu: &Gpu, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}
