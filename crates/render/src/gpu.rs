//! Drawing a frame on the GPU: one compute dispatch a tile, read back tile by tile.

use std::{
    borrow::Cow,
    num::NonZero,
    sync::mpsc,
    time::{Duration, Instant},
};

use glam::DVec3;

use crate::{
    Clock, Frame, Gpu, Image, OnProgress, Progress, RenderError, RenderOptions, Tile, View,
    blocks::{PIXEL_BYTES, UNIFORM_BYTES, VIEW_BYTES, pixel_from_bytes, uniform_bytes, view_bytes},
    culling::{self, Culling, Visits},
    image::check_size,
    stats::milliseconds_since,
    testing,
    tiles::Tiler,
};

/// Columns and rows of a workgroup of the entry point `main`.
pub(crate) const WORKGROUP: u32 = 8;
/// Most pixels of a tile: 32 MiB to read back.
const MAX_TILE_PIXELS: u32 = 1 << 20;
/// A tile that takes longer is given up.
const PATIENCE: Duration = Duration::from_secs(300);
/// Binding of the first table.
const FIRST_TABLE: u32 = 3;
/// Bytes of the two timestamps about a pass, and of what follows them: how many operands were evaluated before.
const TIMESTAMP_BYTES: u64 = 16;
const COUNT_BYTES: u64 = 4;

/// A shader made ready for a device.
#[derive(Debug)]
pub struct Pipeline {
    gpu: Gpu,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    uniform_count: usize,
    tables: Vec<wgpu::Buffer>,
    culling: Option<Culling>,
    milliseconds: f64,
}

impl Pipeline {
    /// Of a picture's shader, and the number of `Program::uniforms` that it was made for.
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

    /// Of a shader that reads storage buffers at bindings 3, 4, ... of group 0, with what they hold. Its own lists
    /// are the first of them.
    ///
    /// # Errors
    ///
    /// As [`Pipeline::new`]; a table that is empty is refused by the device.
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

    /// Of a shader written in WGSL, with the bindings of `sdfc-march`: in group 0, at 0 a uniform
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
            .map_or(Ok(()), |made| culling::fits(gpu, &made.rounds, made.cells.is_some()))?;
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
        let gpu = gpu.clone();
        let mut ready =
            Self { gpu, pipeline, layout, uniform_count, tables, culling, milliseconds: 0.0 };
        ready.dispatch_once()?;
        ready.milliseconds = milliseconds_since(start);
        Ok(ready)
    }

    /// The same pipeline with the lists of another shader, whose text is the same: nothing is compiled. Tables that were
    /// handed in stay.
    ///
    /// # Errors
    ///
    /// [`RenderError`] if the device has no room for them.
    pub fn with_lists_of(&self, shader: &sdfc_codegen::Shader) -> Result<Self, RenderError> {
        let gpu = &self.gpu;
        let lists = Some(shader.lists()).filter(|lists| !lists.is_empty()).map(uniform_bytes);
        let (lists, culling) = gpu.scoped("the shader's lists", || {
            let culling = self.culling.as_ref().zip(shader.culling());
            (
                lists.map(|bytes| table(gpu, &bytes)),
                culling.map(|(culling, made)| culling.with_lists_of(gpu, &made.shader)),
            )
        })?;
        let kept = self.tables.iter().skip(usize::from(lists.is_some())).cloned();
        Ok(Self {
            gpu: gpu.clone(),
            pipeline: self.pipeline.clone(),
            layout: self.layout.clone(),
            uniform_count: self.uniform_count,
            tables: lists.into_iter().chain(kept).collect(),
            culling,
            milliseconds: self.milliseconds,
        })
    }

    /// Time to create the pipeline and to run a first workgroup of it, in milliseconds.
    pub fn milliseconds(&self) -> f64 {
        self.milliseconds
    }

    /// The device that it was made for.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Draws a frame. `uniforms` are what [`uniform_values`](crate::uniform_values) gives.
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
        check_size(view.size)?;
        if uniforms.len() != self.uniform_count {
            let (given, expected) = (uniforms.len(), self.uniform_count);
            return Err(RenderError::UniformCount { given, expected });
        }
        let mut image = Image::new(view.size, view.footprint())?;
        let mut tiler = Tiler::new(view.size, options.tile_size, self.max_tile_pixels());
        let clock = if self.gpu.has_timestamps() { Clock::Gpu } else { Clock::Wall };
        let mut run = Run::new(self, uniforms, view.within)?;
        let (mut milliseconds, mut tiles, mut done) = (0.0, 0, 0);
        let total = image.pixels().len() as u64;
        while let Some(tile) = tiler.next() {
            testing::lose_if_asked(&self.gpu);
            let start = Instant::now();
            let gpu_time = run.draw(view, tile, &mut image)?;
            let elapsed = milliseconds_since(start);
            tiler.took(tile, elapsed);
            milliseconds += gpu_time.unwrap_or(elapsed);
            tiles += 1;
            done += tile.pixels() as u64;
            if progress(Progress { done, total }).is_break() {
                return Err(RenderError::Cancelled);
            }
        }
        let evaluated_before = run.evaluated_before;
        Ok(Frame { image, milliseconds, clock, tiles, evaluated_before })
    }

    /// What fits the limits of the adapter: a buffer, a binding, the workgroups of a row of tiles.
    fn max_tile_pixels(&self) -> u32 {
        let limits = self.gpu.device.limits();
        let bytes = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let fitting = bytes.saturating_sub(TIMESTAMP_BYTES + COUNT_BYTES) / PIXEL_BYTES as u64;
        let culled = self.culling.as_ref().map(|culling| culling.max_pixels(&limits));
        (fitting.min(u64::from(MAX_TILE_PIXELS)) as u32).min(culled.unwrap_or(u32::MAX))
    }

    /// Runs one workgroup over an empty tile, because software drivers compile when they run.
    fn dispatch_once(&self) -> Result<(), RenderError> {
        let uniforms = vec![[0.0; 4]; self.uniform_count];
        let mut run = Run::new(self, &uniforms, None)?;
        run.make_room(WORKGROUP * WORKGROUP, [1, 1])?;
        run.cell_groups = 1;
        let empty = vec![0; VIEW_BYTES];
        run.submit(&empty, [1, 1], 0)?;
        // Compiling thousands of leaves can take a software driver many minutes.
        self.gpu.wait(None)
    }
}

/// The buffers of one frame.
struct Run<'a> {
    pipeline: &'a Pipeline,
    view: wgpu::Buffer,
    uniforms: Option<wgpu::Buffer>,
    timestamps: Option<Timestamps>,
    /// Both grow with the tiles.
    pixels: Option<PixelBuffers>,
    visits: Option<Visits>,
    /// The box that cells are about, and how many groups of them are still to be looked at.
    within: Option<[DVec3; 2]>,
    cell_groups: u32,
    /// How many operands were evaluated before the rays, where they are counted.
    evaluated_before: u64,
}

struct PixelBuffers {
    capacity: u32,
    storage: wgpu::Buffer,
    /// The pixels, then two timestamps and the count.
    staging: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

struct Timestamps {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    period_ns: f64,
}

impl<'a> Run<'a> {
    fn new(
        pipeline: &'a Pipeline,
        uniforms: &[[f32; 4]],
        within: Option<[DVec3; 2]>,
    ) -> Result<Self, RenderError> {
        use wgpu::BufferUsages as Usage;
        let gpu = &pipeline.gpu;
        gpu.scoped("the frame's buffers", || {
            let view = buffer(gpu, "view", VIEW_BYTES as u64, Usage::UNIFORM | Usage::COPY_DST);
            let uniforms = (!uniforms.is_empty()).then(|| {
                let bytes = uniform_bytes(uniforms);
                let usage = Usage::UNIFORM | Usage::COPY_DST;
                let uniforms = buffer(gpu, "uniforms", bytes.len() as u64, usage);
                gpu.queue.write_buffer(&uniforms, 0, &bytes);
                uniforms
            });
            let timestamps = gpu.has_timestamps().then(|| Timestamps::new(gpu));
            Self {
                pipeline,
                view,
                uniforms,
                timestamps,
                pixels: None,
                visits: None,
                within,
                cell_groups: 0,
                evaluated_before: 0,
            }
        })
    }

    /// Makes the buffers large enough for so many pixels in so many columns and rows of workgroups.
    fn make_room(&mut self, pixels: u32, groups: [u32; 2]) -> Result<(), RenderError> {
        use wgpu::BufferUsages as Usage;
        let gpu = &self.pipeline.gpu;
        if let Some(culling) = &self.pipeline.culling
            && !self.visits.as_ref().is_some_and(|visits| visits.fit(groups))
        {
            (self.visits, self.pixels) = (None, None);
            let (uniforms, within) = (self.uniforms.as_ref(), self.within);
            let room = || culling.room(gpu, groups, &self.view, uniforms, within);
            self.visits = Some(gpu.scoped("lists of what can matter to a tile", room)?);
            self.cell_groups = within.map_or(0, |_| culling::GROUPS);
        }
        if self.pixels.as_ref().is_some_and(|buffers| buffers.capacity >= pixels) {
            return Ok(());
        }
        self.pixels = None;
        let bytes = u64::from(pixels) * PIXEL_BYTES as u64;
        let buffers = gpu.scoped("a tile's pixels", || {
            let storage = buffer(gpu, "pixels", bytes, Usage::STORAGE | Usage::COPY_SRC);
            let usage = Usage::MAP_READ | Usage::COPY_DST;
            let staging = buffer(gpu, "staging", bytes + TIMESTAMP_BYTES + COUNT_BYTES, usage);
            let bind_group = self.bind_group(&storage);
            PixelBuffers { capacity: pixels, storage, staging, bind_group }
        })?;
        self.pixels = Some(buffers);
        Ok(())
    }

    fn bind_group(&self, storage: &wgpu::Buffer) -> wgpu::BindGroup {
        let buffers = [(0, Some(&self.view)), (1, self.uniforms.as_ref()), (2, Some(storage))];
        let tables = (FIRST_TABLE..).zip(self.pipeline.tables.iter().map(Some));
        let visits = (culling::VISITS, self.visits.as_ref().map(|visits| &visits.lists));
        let entries: Vec<_> = buffers
            .into_iter()
            .chain(tables)
            .chain([visits])
            .filter_map(|(binding, buffer)| {
                Some(wgpu::BindGroupEntry { binding, resource: buffer?.as_entire_binding() })
            })
            .collect();
        self.pipeline.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tile"),
            layout: &self.pipeline.layout,
            entries: &entries,
        })
    }

    /// Draws a tile into the image; its time in milliseconds where the adapter tells one.
    fn draw(
        &mut self,
        view: &View,
        tile: Tile,
        image: &mut Image,
    ) -> Result<Option<f64>, RenderError> {
        let count = tile.pixels() as u32;
        let groups = tile.size.map(|side| side.div_ceil(WORKGROUP));
        self.make_room(count.max(WORKGROUP * WORKGROUP), groups)?;
        self.submit(&view_bytes(&view.block(tile)), groups, count)?;
        self.cell_groups = 0;
        self.read(tile, image)
    }

    /// Hands in workgroups, and the copying of the pixels that they make.
    fn submit(&self, view: &[u8], groups: [u32; 2], pixels: u32) -> Result<(), RenderError> {
        let Some(buffers) = &self.pixels else { return Ok(()) };
        let gpu = &self.pipeline.gpu;
        gpu.scoped("a tile", || {
            gpu.queue.write_buffer(&self.view, 0, view);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("tile"),
                    timestamp_writes: self.timestamps.as_ref().map(Timestamps::about_a_pass),
                });
                if let (Some(culling), Some(visits)) = (&self.pipeline.culling, &self.visits) {
                    if self.cell_groups > 0 {
                        culling.run_cells(&mut pass, visits, self.cell_groups);
                    }
                    culling.run(&mut pass, visits, groups);
                }
                pass.set_pipeline(&self.pipeline.pipeline);
                pass.set_bind_group(0, &buffers.bind_group, &[]);
                pass.dispatch_workgroups(groups[0], groups[1], 1);
            }
            let bytes = u64::from(pixels) * PIXEL_BYTES as u64;
            encoder.copy_buffer_to_buffer(&buffers.storage, 0, &buffers.staging, 0, bytes);
            if let Some(timestamps) = &self.timestamps {
                timestamps.resolve(&mut encoder, &buffers.staging, bytes);
            }
            if let Some(visits) = &self.visits {
                let (from, to) = (4 * culling::EVALUATED, bytes + TIMESTAMP_BYTES);
                encoder.copy_buffer_to_buffer(
                    &visits.tally,
                    from,
                    &buffers.staging,
                    to,
                    COUNT_BYTES,
                );
            }
            gpu.queue.submit([encoder.finish()]);
        })
    }

    /// Reads the pixels of a tile, and its time.
    fn read(&mut self, tile: Tile, image: &mut Image) -> Result<Option<f64>, RenderError> {
        let Some(buffers) = &self.pixels else { return Ok(None) };
        let bytes = (tile.pixels() * PIXEL_BYTES) as u64;
        let slice = buffers.staging.slice(..bytes + TIMESTAMP_BYTES + COUNT_BYTES);
        let (sender, receiver) = mpsc::channel();
        self.pipeline.gpu.scoped("reading a tile", || {
            slice.map_async(wgpu::MapMode::Read, move |result| {
                // The receiver waits below; it is gone only where the wait itself failed.
                let _ = sender.send(result);
            });
        })?;
        self.pipeline.gpu.wait(Some(PATIENCE))?;
        let refused = |detail: String| RenderError::DeviceLost(format!("reading a tile: {detail}"));
        match receiver.try_recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(refused(error.to_string())),
            Err(error) => return Err(refused(error.to_string())),
        }
        let mapped = slice.get_mapped_range().map_err(|error| refused(error.to_string()))?;
        let (pixels, rest) = mapped.split_at(bytes as usize);
        let (times, count) = rest.split_at(TIMESTAMP_BYTES as usize);
        // Counted from the first tile on, unless the buffers are made anew.
        if self.visits.is_some() {
            let count = count.try_into().map_or(0, u32::from_ne_bytes);
            self.evaluated_before = self.evaluated_before.max(u64::from(count));
        }
        image.put(tile, pixels.chunks_exact(PIXEL_BYTES).map(pixel_from_bytes));
        let time = self.timestamps.as_ref().map(|timestamps| timestamps.milliseconds(times));
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
    // The device compares what the shader reads with what is bound.
    entries.extend((FIRST_TABLE..).take(table_count).map(|binding| entry(binding, table, 0)));
    entries.extend(is_culled.then(|| entry(culling::VISITS, table, 0)));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("tile"),
        entries: &entries,
    })
}

/// A buffer of at least so many bytes in a layout.
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

/// The stage of a module that an entry point is.
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
