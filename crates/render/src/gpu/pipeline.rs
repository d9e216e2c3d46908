//! Draws a frame on the GPU: one compute dispatch per tile, read back tile by tile.

use std::{borrow::Cow, sync::Mutex, time::Instant};

use super::culling::{self, Culling};
use super::device::Gpu;
use super::display::{DeviceTexture, Display};
use super::kernel::Kernel;
use super::resources::{FIRST_TABLE, WORKGROUP, compute_pipeline, entry, table};
use super::run::{BESIDE_PIXELS, Buffers, Moment, Output, Run};
use crate::blocks::{PIXEL_BYTES, UNIFORM_BYTES, VIEW_BYTES, uniform_bytes};
use crate::clock::{Clock, milliseconds_since};
use crate::error::RenderError;
use crate::frame::{Frame, OnProgress, Progress, RenderOptions, region_of};
use crate::image::Image;
use crate::tiles::{Tile, TileSize, Tiler};
use crate::view::View;

/// The maximum number of pixels of a tile: a picture of 1920x1080 fits, and 64 MiB are read back.
const MAX_TILE_PIXELS: u32 = 1 << 21;

/// A picture shader, compiled for a device.
#[derive(Debug)]
pub struct Pipeline {
    kernel: Kernel,
    uniform_count: usize,
    milliseconds: f64,
    last: Mutex<Option<LastFrame>>,
}

/// What the next frame can use of the last one.
#[derive(Debug)]
struct LastFrame {
    buffers: Buffers,
    /// Milliseconds per pixel.
    cost: f64,
}

impl Pipeline {
    /// Compiles a picture's shader. `uniform_count` is the number of `Program::uniforms` that it
    /// was made for.
    ///
    /// # Errors
    ///
    /// [`RenderError::Validation`] if the device refuses it, [`RenderError::Uniforms`].
    pub fn new(
        gpu: &Gpu,
        shader: sdfc_codegen::Shader,
        uniform_count: usize,
    ) -> Result<Self, RenderError> {
        Self::with_tables(gpu, shader, uniform_count, &[])
    }

    /// Compiles a shader that reads storage buffers with these contents at bindings 3, 4, ... of
    /// group 0. The shader's own lists are the first of them.
    ///
    /// # Errors
    ///
    /// As [`Pipeline::new`]; the device refuses an empty table.
    pub fn with_tables(
        gpu: &Gpu,
        mut shader: sdfc_codegen::Shader,
        uniform_count: usize,
        tables: &[Vec<u8>],
    ) -> Result<Self, RenderError> {
        let culling = shader.take_culling();
        let lists = Some(shader.lists()).filter(|lists| !lists.is_empty()).map(uniform_bytes);
        let tables: Vec<_> = lists.into_iter().chain(tables.iter().cloned()).collect();
        let source = wgpu::ShaderSource::Naga(Cow::Owned(shader.into_module()));
        Self::of_source(gpu, source, uniform_count, &tables, culling)
    }

    /// Compiles a shader in WGSL that has the bindings of `sdfc-march`: in group 0, at 0 a uniform
    /// `ViewBlock`, at 1 a uniform array of `uniform_count` `vec4f` (absent if that is 0), at 2 the
    /// storage for the tile's `PixelBlock`s. The entry point is `main`, in workgroups of 8x8.
    ///
    /// # Errors
    ///
    /// [`RenderError::Validation`] if the device refuses it, [`RenderError::Uniforms`].
    pub fn from_wgsl(gpu: &Gpu, text: &str, uniform_count: usize) -> Result<Self, RenderError> {
        Self::of_source(
            gpu,
            wgpu::ShaderSource::Wgsl(Cow::Borrowed(text)),
            uniform_count,
            &[],
            None,
        )
    }

    fn of_source(
        gpu: &Gpu,
        source: wgpu::ShaderSource<'_>,
        uniform_count: usize,
        tables: &[Vec<u8>],
        culling: Option<sdfc_codegen::Culling>,
    ) -> Result<Self, RenderError> {
        let limit = gpu.device.limits().max_uniform_buffer_binding_size as usize / UNIFORM_BYTES;
        if uniform_count > limit {
            return Err(RenderError::Uniforms { count: uniform_count, limit });
        }
        let tables_fit = |bytes: &Vec<u8>| gpu.has_storage("the scene's lists", bytes.len() as u64);
        tables.iter().try_for_each(tables_fit)?;
        culling
            .as_ref()
            .map_or(Ok(()), |made| culling::fits(gpu, &made.iterations, made.cells.is_some()))?;
        let start = Instant::now();
        let tables = gpu.scoped("the shader's tables", || {
            tables.iter().map(|bytes| table(gpu, bytes)).collect::<Vec<_>>()
        })?;
        let (pipeline, layout, culling) = gpu.scoped("the shader", || {
            let descriptor = wgpu::ShaderModuleDescriptor { label: Some("scene"), source };
            let module = gpu.device.create_shader_module(descriptor);
            let is_culled = culling.is_some();
            let layout = bind_group_layout(&gpu.device, uniform_count, tables.len(), is_culled);
            let pipeline = compute_pipeline(&gpu.device, &module, &layout, "main");
            (pipeline, layout, culling.map(|made| Culling::new(gpu, made, uniform_count)))
        })?;
        let kernel = Kernel { gpu: gpu.clone(), pipeline, layout, tables, culling };
        let last = Mutex::default();
        let mut ready = Self { kernel, uniform_count, milliseconds: 0.0, last };
        ready.dispatch_once()?;
        ready.milliseconds = milliseconds_since(start);
        Ok(ready)
    }

    /// Returns the same pipeline with the lists of another shader whose source is the same; nothing
    /// is compiled. Tables that the caller passed stay.
    ///
    /// # Errors
    ///
    /// [`RenderError`] if the device cannot hold them.
    pub fn with_lists_of(&self, shader: &sdfc_codegen::Shader) -> Result<Self, RenderError> {
        let gpu = &self.kernel.gpu;
        let lists = Some(shader.lists()).filter(|lists| !lists.is_empty()).map(uniform_bytes);
        let (lists, culling) = gpu.scoped("the shader's lists", || {
            let culling = self.kernel.culling.as_ref().zip(shader.culling());
            (
                lists.map(|bytes| table(gpu, &bytes)),
                culling.map(|(culling, made)| culling.with_lists_of(gpu, &made.shader)),
            )
        })?;
        let stored = self.kernel.tables.iter().skip(usize::from(lists.is_some())).cloned();
        let tables = lists.into_iter().chain(stored).collect();
        Ok(Self {
            kernel: Kernel { tables, culling, ..self.kernel.clone() },
            uniform_count: self.uniform_count,
            milliseconds: self.milliseconds,
            last: Mutex::default(),
        })
    }

    /// The time to create the pipeline and to run a first workgroup of it, in milliseconds.
    pub fn milliseconds(&self) -> f64 {
        self.milliseconds
    }

    /// Returns true if its rays run only those iterations of loops that can affect them.
    pub fn leaves_out(&self) -> bool {
        self.kernel.culling.is_some()
    }

    /// The device that it was compiled for.
    pub fn gpu(&self) -> &Gpu {
        &self.kernel.gpu
    }

    /// Draws a frame. `uniforms` are those that [`uniform_values`](crate::uniform_values) returns.
    ///
    /// # Errors
    ///
    /// [`RenderError`]; nothing is left half-drawn on the device.
    pub fn render(
        &self,
        view: &View,
        uniforms: &[[f32; 4]],
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        self.render_in_place_of(None, view, uniforms, options, progress)
    }

    /// As [`Pipeline::render`], in the memory of a picture that is no longer needed.
    ///
    /// # Errors
    ///
    /// As [`Pipeline::render`].
    pub fn render_in_place_of(
        &self,
        old: Option<Image>,
        view: &View,
        uniforms: &[[f32; 4]],
        options: &RenderOptions,
        progress: &mut OnProgress<'_>,
    ) -> Result<Frame, RenderError> {
        let region = region_of(view.size, options)?;
        let mut image = Image::in_place_of(old, region.size, view.footprint())?;
        let clock = if self.kernel.gpu.has_timestamps() { Clock::Gpu } else { Clock::Wall };
        let draw = |run: &mut Run<'_>, tile| run.draw(view, tile, region.origin, &mut image);
        let drawn = self.tiles(view, uniforms, (region, options.tile_size), progress, draw)?;
        let DrawnTiles { milliseconds, tiles, culling_evaluations } = drawn;
        Ok(Frame { image, milliseconds, clock, tiles, culling_evaluations })
    }

    /// Draws the whole picture into a texture of its size, which stays on the device. Returns the
    /// time in milliseconds, by the CPU's clock.
    ///
    /// # Errors
    ///
    /// As [`Pipeline::render`]; [`RenderError::TextureSize`] if the texture has another size
    /// than the picture. After an error the texture may show a part of it.
    pub fn show(
        &self,
        view: &View,
        uniforms: &[[f32; 4]],
        tile_size: TileSize,
        (display, target): (&Display, &DeviceTexture),
        progress: &mut OnProgress<'_>,
    ) -> Result<f64, RenderError> {
        if target.size() != view.size {
            let (texture, picture) = (target.size(), view.size);
            return Err(RenderError::TextureSize { texture, picture });
        }
        let draw =
            |run: &mut Run<'_>, tile| run.display(view, tile, display, target).map(|()| None);
        let region = (Tile::whole(view.size), tile_size);
        self.tiles(view, uniforms, region, progress, draw).map(|drawn| drawn.milliseconds)
    }

    /// Draws a region tile by tile. `draw` returns a tile's time in milliseconds, if the adapter
    /// measures it.
    fn tiles(
        &self,
        view: &View,
        uniforms: &[[f32; 4]],
        (region, tile_size): (Tile, TileSize),
        progress: &mut OnProgress<'_>,
        mut draw: impl FnMut(&mut Run<'_>, Tile) -> Result<Option<f64>, RenderError>,
    ) -> Result<DrawnTiles, RenderError> {
        if uniforms.len() != self.uniform_count {
            let (given, expected) = (uniforms.len(), self.uniform_count);
            return Err(RenderError::UniformCount { given, expected });
        }
        let (buffers, cost) =
            self.take_last().map_or((None, None), |it| (Some(it.buffers), Some(it.cost)));
        let most = self.max_tile_pixels();
        let mut tiler = Tiler::new(view.size, region, tile_size, most).after(cost);
        let moment = Moment { uniforms: uniforms.to_vec(), within: view.within };
        let mut run = Run::new(&self.kernel, buffers, moment)?;
        let (mut milliseconds, mut waited, mut tiles, mut done) = (0.0, 0.0, 0, 0);
        let (total, mut cancelled) = (tiler.pixels(), false);
        while !cancelled && let Some(tile) = tiler.next() {
            let start = Instant::now();
            let gpu_time = draw(&mut run, tile)?;
            let elapsed = milliseconds_since(start);
            tiler.took(tile, elapsed);
            milliseconds += gpu_time.unwrap_or(elapsed);
            waited += elapsed;
            tiles += 1;
            done += tile.pixels() as u64;
            cancelled = progress(Progress { done, total }).is_break();
        }
        let culling_evaluations = run.culling_evaluations();
        let cost = waited / done.max(1) as f64;
        self.store_last(LastFrame { buffers: run.into_buffers(), cost });
        if cancelled {
            return Err(RenderError::Cancelled);
        }
        Ok(DrawnTiles { milliseconds, tiles, culling_evaluations })
    }

    /// Takes what is left of the last frame, unless another frame is being drawn with it.
    fn take_last(&self) -> Option<LastFrame> {
        self.last.lock().ok()?.take()
    }

    fn store_last(&self, frame: LastFrame) {
        if let Ok(mut last) = self.last.lock() {
            *last = Some(frame);
        }
    }

    /// The maximum number of pixels of a tile by the limits of the adapter: a buffer, a binding,
    /// the workgroups of a row of tiles.
    fn max_tile_pixels(&self) -> u32 {
        let limits = self.kernel.gpu.device.limits();
        let bytes = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let fitting = bytes.saturating_sub(BESIDE_PIXELS) / PIXEL_BYTES as u64;
        let culled = self.kernel.culling.as_ref().map(|culling| culling.max_pixels(&limits));
        (fitting.min(u64::from(MAX_TILE_PIXELS)) as u32).min(culled.unwrap_or(u32::MAX))
    }

    /// Runs one workgroup over an empty tile, because software drivers compile when they run.
    fn dispatch_once(&self) -> Result<(), RenderError> {
        let uniforms = vec![[0.0; 4]; self.uniform_count];
        let mut run = Run::new(&self.kernel, None, Moment { uniforms, within: None })?;
        run.allocate(WORKGROUP * WORKGROUP, [1, 1])?;
        let empty = vec![0; VIEW_BYTES];
        run.submit(&empty, [1, 1], 1, Output::Copy(0))?;
        // No timeout: compiling thousands of primitives can take a software driver many minutes.
        self.kernel.gpu.wait(None)
    }
}

/// What was measured while tiles were drawn.
struct DrawnTiles {
    milliseconds: f64,
    tiles: u32,
    culling_evaluations: u64,
}

fn bind_group_layout(
    device: &wgpu::Device,
    uniform_count: usize,
    table_count: usize,
    is_culled: bool,
) -> wgpu::BindGroupLayout {
    let uniform = wgpu::BufferBindingType::Uniform;
    let mut entries = vec![entry(0, uniform, VIEW_BYTES)];
    if uniform_count > 0 {
        entries.push(entry(1, uniform, uniform_count * UNIFORM_BYTES));
    }
    entries.push(entry(2, wgpu::BufferBindingType::Storage { read_only: false }, PIXEL_BYTES));
    let table = wgpu::BufferBindingType::Storage { read_only: true };
    // The device compares the buffer's size with what the shader reads.
    entries.extend((FIRST_TABLE..).take(table_count).map(|binding| entry(binding, table, 0)));
    entries.extend(is_culled.then(|| entry(culling::ACTIVE_LISTS, table, 0)));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("tile"),
        entries: &entries,
    })
}
