//! The device objects that frames are drawn with.

use super::culling::Culling;
use super::device::Gpu;

/// A compiled picture shader, what runs before it, and the tables that both read.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    pub(super) gpu: Gpu,
    pub(super) pipeline: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
    /// The storage buffers from binding [`FIRST_TABLE`](super::resources::FIRST_TABLE) on.
    pub(super) tables: Vec<wgpu::Buffer>,
    /// The shader that finds which iterations of loops can affect which rays.
    pub(super) culling: Option<Culling>,
}
