//! The buffers of a frame, and the commands that draw it.

use std::{sync::mpsc, time::Duration};

use glam::DVec3;

use super::culling::{self, ActiveBuffers};
use super::culling_layout;
use super::device::Gpu;
use super::display::{DeviceTexture, Display};
use super::kernel::Kernel;
use super::resources::{FIRST_TABLE, WORKGROUP, buffer};
use crate::blocks::{
    PIXEL_BYTES, UNIFORM_BYTES, VIEW_BYTES, pixel_from_bytes, uniform_bytes, view_bytes,
};
use crate::error::RenderError;
use crate::image::Image;
use crate::tiles::Tile;
use crate::view::View;

/// Timeout for a tile.
const TIMEOUT: Duration = Duration::from_secs(300);
/// Size in bytes of the two timestamps around a pass, and of the number of operands evaluated
/// before it, which follows them.
const TIMESTAMP_BYTES: u64 = 16;
const COUNT_BYTES: u64 = 4;
/// Bytes that are read back in addition to the pixels.
pub(crate) const BESIDE_PIXELS: u64 = TIMESTAMP_BYTES + COUNT_BYTES;

/// The values that the lists of cells depend on, apart from the shader.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moment {
    /// The per-frame values.
    pub(crate) uniforms: Vec<[f32; 4]>,
    /// The box that the cells enclose.
    pub(crate) within: Option<[DVec3; 2]>,
}

/// The buffers that a frame is drawn with.
#[derive(Debug)]
pub(crate) struct Buffers {
    view: wgpu::Buffer,
    uniforms: Option<wgpu::Buffer>,
    timestamps: Option<Timestamps>,
    /// Both grow with the tiles.
    pixels: Option<PixelBuffers>,
    active: Option<ActiveBuffers>,
    /// The moment for which the cells are listed; `None` if they are not.
    listed: Option<Moment>,
}

/// What happens to the pixels of a tile.
pub(crate) enum Output<'t> {
    /// This many are copied for the CPU.
    Copy(u32),
    /// They become a part of a texture.
    Texture { display: &'t Display, target: &'t DeviceTexture, tile: Tile },
}

/// A frame while it is drawn.
pub(crate) struct Run<'a> {
    kernel: &'a Kernel,
    moment: Moment,
    buffers: Buffers,
    /// The number of operands evaluated before the rays, if they are counted.
    culling_evaluations: u32,
}

#[derive(Debug)]
struct PixelBuffers {
    capacity: u32,
    storage: wgpu::Buffer,
    /// The pixels, then two timestamps and the count.
    staging: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

#[derive(Debug)]
struct Timestamps {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    period_ns: f64,
}

impl Buffers {
    fn new(kernel: &Kernel, uniforms: usize) -> Self {
        use wgpu::BufferUsages as Usage;
        let (gpu, usage) = (&kernel.gpu, Usage::UNIFORM | Usage::COPY_DST);
        let uniform_bytes = (uniforms * UNIFORM_BYTES) as u64;
        Self {
            view: buffer(gpu, "view", VIEW_BYTES as u64, usage),
            uniforms: (uniforms > 0).then(|| buffer(gpu, "uniforms", uniform_bytes, usage)),
            timestamps: gpu.has_timestamps().then(|| Timestamps::new(gpu)),
            pixels: None,
            active: None,
            listed: None,
        }
    }
}

impl<'a> Run<'a> {
    /// Starts a frame with the buffers of another frame of the pipeline, if there are any.
    pub(crate) fn new(
        kernel: &'a Kernel,
        buffers: Option<Buffers>,
        moment: Moment,
    ) -> Result<Self, RenderError> {
        let gpu = &kernel.gpu;
        let buffers = gpu.scoped("the frame's buffers", || {
            let count = moment.uniforms.len();
            let buffers = buffers.unwrap_or_else(|| Buffers::new(kernel, count));
            if let Some(uniforms) = &buffers.uniforms {
                gpu.queue.write_buffer(uniforms, 0, &uniform_bytes(&moment.uniforms));
            }
            buffers
        })?;
        Ok(Self { kernel, moment, buffers, culling_evaluations: 0 })
    }

    pub(crate) fn into_buffers(self) -> Buffers {
        self.buffers
    }

    /// The number of operands evaluated before the rays, if they are counted.
    pub(crate) fn culling_evaluations(&self) -> u64 {
        u64::from(self.culling_evaluations)
    }

    /// Makes the buffers large enough for this many pixels in this many columns and rows of
    /// workgroups.
    pub(crate) fn allocate(&mut self, pixels: u32, groups: [u32; 2]) -> Result<(), RenderError> {
        use wgpu::BufferUsages as Usage;
        let gpu = &self.kernel.gpu;
        if let Some(culling) = &self.kernel.culling
            && !self.buffers.active.as_ref().is_some_and(|active| active.fit(groups))
        {
            (self.buffers.active, self.buffers.pixels) = (None, None);
            self.buffers.listed = None;
            let (view, uniforms) = (&self.buffers.view, self.buffers.uniforms.as_ref());
            let make = || culling.allocate(gpu, groups, view, uniforms);
            self.buffers.active = Some(gpu.scoped("lists of what can matter to a tile", make)?);
        }
        if self.buffers.pixels.as_ref().is_some_and(|buffers| buffers.capacity >= pixels) {
            return Ok(());
        }
        self.buffers.pixels = None;
        let bytes = u64::from(pixels) * PIXEL_BYTES as u64;
        let buffers = gpu.scoped("a tile's pixels", || {
            let storage = buffer(gpu, "pixels", bytes, Usage::STORAGE | Usage::COPY_SRC);
            let usage = Usage::MAP_READ | Usage::COPY_DST;
            let staging = buffer(gpu, "staging", bytes + BESIDE_PIXELS, usage);
            let bind_group = self.bind_group(&storage);
            PixelBuffers { capacity: pixels, storage, staging, bind_group }
        })?;
        self.buffers.pixels = Some(buffers);
        Ok(())
    }

    fn bind_group(&self, storage: &wgpu::Buffer) -> wgpu::BindGroup {
        let Buffers { view, uniforms, active, .. } = &self.buffers;
        let buffers = [(0, Some(view)), (1, uniforms.as_ref()), (2, Some(storage))];
        let tables = (FIRST_TABLE..).zip(self.kernel.tables.iter().map(Some));
        let active = (culling::ACTIVE_LISTS, active.as_ref().map(|active| &active.lists));
        let entries: Vec<_> = buffers
            .into_iter()
            .chain(tables)
            .chain([active])
            .filter_map(|(binding, buffer)| {
                Some(wgpu::BindGroupEntry { binding, resource: buffer?.as_entire_binding() })
            })
            .collect();
        self.kernel.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tile"),
            layout: &self.kernel.layout,
            entries: &entries,
        })
    }

    /// The number of groups of cells to list: none if the lists are those of the moment.
    fn cells_to_list(&self) -> Result<u32, RenderError> {
        let Kernel { gpu, culling: Some(culling), .. } = self.kernel else { return Ok(0) };
        let Some(active) = &self.buffers.active else { return Ok(0) };
        if self.buffers.listed.as_ref() == Some(&self.moment) {
            return Ok(0);
        }
        let within = self.moment.within;
        gpu.scoped("lists of what can matter in a cell", || culling.open(gpu, active, within))?;
        Ok(within.map_or(0, |_| culling_layout::GROUPS))
    }

    /// Draws a tile into the image, whose position in the picture is `origin`. Returns its time in
    /// milliseconds if the adapter measures times.
    pub(crate) fn draw(
        &mut self,
        view: &View,
        tile: Tile,
        origin: [u32; 2],
        image: &mut Image,
    ) -> Result<Option<f64>, RenderError> {
        self.start(view, tile, Output::Copy(tile.pixels() as u32))?;
        self.read(tile, origin, image)
    }

    /// Draws a tile into a texture, and waits for it.
    pub(crate) fn display(
        &mut self,
        view: &View,
        tile: Tile,
        display: &Display,
        target: &DeviceTexture,
    ) -> Result<(), RenderError> {
        self.start(view, tile, Output::Texture { display, target, tile })?;
        self.kernel.gpu.wait(Some(TIMEOUT))
    }

    fn start(&mut self, view: &View, tile: Tile, output: Output<'_>) -> Result<(), RenderError> {
        let groups = tile.size.map(|side| side.div_ceil(WORKGROUP));
        self.allocate((tile.pixels() as u32).max(WORKGROUP * WORKGROUP), groups)?;
        let cell_groups = self.cells_to_list()?;
        self.submit(&view_bytes(&view.block(tile)), groups, cell_groups, output)?;
        self.buffers.listed = Some(self.moment.clone());
        Ok(())
    }

    /// Submits workgroups, the culling before them, and what happens to the pixels that they write.
    pub(crate) fn submit(
        &self,
        view: &[u8],
        groups: [u32; 2],
        cell_groups: u32,
        output: Output<'_>,
    ) -> Result<(), RenderError> {
        let Some(buffers) = &self.buffers.pixels else { return Ok(()) };
        let gpu = &self.kernel.gpu;
        gpu.scoped("a tile", || {
            if let Some(active) = &self.buffers.active {
                active.reset_count(gpu);
            }
            gpu.queue.write_buffer(&self.buffers.view, 0, view);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("tile"),
                    timestamp_writes: self
                        .buffers
                        .timestamps
                        .as_ref()
                        .map(Timestamps::about_a_pass),
                });
                if let (Some(culling), Some(active)) = (&self.kernel.culling, &self.buffers.active)
                {
                    if cell_groups > 0 {
                        culling.run_cells(&mut pass, active, cell_groups);
                    }
                    culling.run(&mut pass, active, groups);
                }
                pass.set_pipeline(&self.kernel.pipeline);
                pass.set_bind_group(0, &buffers.bind_group, &[]);
                pass.dispatch_workgroups(groups[0], groups[1], 1);
            }
            match output {
                Output::Copy(pixels) => self.copy(&mut encoder, buffers, pixels),
                Output::Texture { display, target, tile } => {
                    display.write(&mut encoder, tile, &buffers.storage, target);
                }
            }
            gpu.queue.submit([encoder.finish()]);
        })
    }

    /// Adds the copies of pixels, times and the count for the CPU.
    fn copy(&self, encoder: &mut wgpu::CommandEncoder, buffers: &PixelBuffers, pixels: u32) {
        let bytes = u64::from(pixels) * PIXEL_BYTES as u64;
        encoder.copy_buffer_to_buffer(&buffers.storage, 0, &buffers.staging, 0, bytes);
        if let Some(timestamps) = &self.buffers.timestamps {
            timestamps.resolve(encoder, &buffers.staging, bytes);
        }
        if let Some(active) = &self.buffers.active {
            let (from, to) = (4 * culling_layout::EVALUATED, bytes + TIMESTAMP_BYTES);
            let (counters, staging) = (&active.counters, &buffers.staging);
            encoder.copy_buffer_to_buffer(counters, from, staging, to, COUNT_BYTES);
        }
    }

    /// Reads back the pixels of a tile, and its time.
    fn read(
        &mut self,
        tile: Tile,
        origin: [u32; 2],
        image: &mut Image,
    ) -> Result<Option<f64>, RenderError> {
        let Some(buffers) = &self.buffers.pixels else { return Ok(None) };
        let bytes = (tile.pixels() * PIXEL_BYTES) as u64;
        let slice = buffers.staging.slice(..bytes + BESIDE_PIXELS);
        let (sender, receiver) = mpsc::channel();
        self.kernel.gpu.scoped("reading a tile", || {
            slice.map_async(wgpu::MapMode::Read, move |result| {
                // The receiver waits below; it is gone only if the wait itself failed.
                let _ = sender.send(result);
            });
        })?;
        self.kernel.gpu.wait(Some(TIMEOUT))?;
        let refused = |detail: String| RenderError::DeviceLost(format!("reading a tile: {detail}"));
        match receiver.try_recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(refused(error.to_string())),
            Err(error) => return Err(refused(error.to_string())),
        }
        let mapped = slice.get_mapped_range().map_err(|error| refused(error.to_string()))?;
        let (pixels, rest) = mapped.split_at(bytes as usize);
        let (times, count) = rest.split_at(TIMESTAMP_BYTES as usize);
        if self.buffers.active.is_some() {
            let count = count.try_into().map_or(0, u32::from_ne_bytes);
            self.culling_evaluations = self.culling_evaluations.saturating_add(count);
        }
        image.put(origin, tile, pixels.as_chunks().0, pixel_from_bytes);
        let time =
            self.buffers.timestamps.as_ref().map(|timestamps| timestamps.milliseconds(times));
        drop(mapped);
        buffers.staging.unmap();
        Ok(time)
    }
}

impl Timestamps {
    fn new(gpu: &Gpu) -> Self {
        use wgpu::BufferUsages as Usage;
        let queries = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("tile times"),
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        });
        let usage = Usage::QUERY_RESOLVE | Usage::COPY_SRC;
        let resolved = buffer(gpu, "tile times", TIMESTAMP_BYTES, usage);
        Self { queries, resolved, period_ns: f64::from(gpu.queue.get_timestamp_period()) }
    }

    fn about_a_pass(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    fn resolve(&self, encoder: &mut wgpu::CommandEncoder, staging: &wgpu::Buffer, offset: u64) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, staging, offset, TIMESTAMP_BYTES);
    }

    fn milliseconds(&self, bytes: &[u8]) -> f64 {
        let tick = |bytes: &[u8]| bytes.try_into().map_or(0, u64::from_ne_bytes);
        let (begin, end) = bytes.split_at(bytes.len() / 2);
        tick(end).saturating_sub(tick(begin)) as f64 * self.period_ns * 1e-6
    }
}
