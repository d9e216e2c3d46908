//! Pictures that stay on the device: a window shows them without a copy on the CPU.

use super::device::Gpu;
use super::resources::{WORKGROUP, buffer, compute_pipeline, entry};
use crate::blocks::PIXEL_BYTES;
use crate::error::RenderError;
use crate::tiles::Tile;

/// Bytes of a tile's position and size in the shader.
const TILE_BYTES: u64 = 16;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A picture on a device: red, green, blue and alpha of each pixel, in sRGB. A clone is the same
/// texture.
#[derive(Clone, Debug)]
pub struct DeviceTexture {
    texture: wgpu::Texture,
}

impl DeviceTexture {
    /// A black picture.
    ///
    /// # Errors
    ///
    /// [`RenderError::Limit`] if the device has no textures of that size,
    /// [`RenderError::OutOfMemory`].
    pub fn new(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<Self, RenderError> {
        gpu.has_texture_side(width.max(height))?;
        let descriptor = wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        };
        let texture = gpu.scoped("a picture", || gpu.device.create_texture(&descriptor))?;
        Ok(Self { texture })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }

    /// The texture, of the format `Rgba8Unorm`.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }
}

/// The shader that writes tiles into textures, compiled for a device.
#[derive(Debug)]
pub struct Display {
    gpu: Gpu,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    tile: wgpu::Buffer,
}

impl Display {
    /// Compiles the shader.
    ///
    /// # Errors
    ///
    /// [`RenderError::Validation`] if the device refuses it.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        let (pipeline, layout, tile) = gpu.scoped("the display", || {
            let source = wgpu::ShaderSource::Wgsl(sdfc_march::display_source().into());
            let descriptor = wgpu::ShaderModuleDescriptor { label: Some("display"), source };
            let module = gpu.device.create_shader_module(descriptor);
            let storage = wgpu::BufferBindingType::Storage { read_only: true };
            let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("display"),
                entries: &[
                    entry(0, wgpu::BufferBindingType::Uniform, TILE_BYTES as usize),
                    entry(1, storage, PIXEL_BYTES),
                    wgpu::BindGroupLayoutEntry {
                        binding: 2,
                        visibility: wgpu::ShaderStages::COMPUTE,
                        ty: wgpu::BindingType::StorageTexture {
                            access: wgpu::StorageTextureAccess::WriteOnly,
                            format: FORMAT,
                            view_dimension: wgpu::TextureViewDimension::D2,
                        },
                        count: None,
                    },
                ],
            });
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            let tile = buffer(gpu, "display", TILE_BYTES, usage);
            (compute_pipeline(&gpu.device, &module, &layout, "main"), layout, tile)
        })?;
        Ok(Self { gpu: gpu.clone(), pipeline, layout, tile })
    }

    /// Returns true if it was compiled for this device.
    pub fn is_on(&self, gpu: &Gpu) -> bool {
        self.gpu.device == gpu.device
    }

    /// Adds the commands that write the pixels of a tile into a texture.
    pub(crate) fn write(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        tile: Tile,
        pixels: &wgpu::Buffer,
        target: &DeviceTexture,
    ) {
        let Tile { origin: [left, top], size } = tile;
        let bytes = [left, top, size[0], size[1]].map(u32::to_ne_bytes).concat();
        self.gpu.queue.write_buffer(&self.tile, 0, &bytes);
        let picture = target.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let resources = [
            self.tile.as_entire_binding(),
            pixels.as_entire_binding(),
            wgpu::BindingResource::TextureView(&picture),
        ];
        let entries = (0..).zip(resources);
        let entries: Vec<_> =
            entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let bind_group = self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("display"),
            layout: &self.layout,
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        let [columns, rows] = size.map(|side| side.div_ceil(WORKGROUP));
        pass.dispatch_workgroups(columns, rows, 1);
    }
}
