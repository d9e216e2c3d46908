//! The shaders that find which iterations of the scene's loops can affect which rays: before each
//! tile of a picture, those that can affect its camera rays; and once before a frame with secondary
//! rays, those that can affect each cell of a grid.

use glam::DVec3;

use super::culling_layout::{
    BEYOND, EVALUATED, GROUPS, LEVELS, counters, each_level, first_record, group, head, lowest,
    mask_bytes, max_words, scratch_bytes, stride, tile_mask_bytes, with_masks,
};
use super::device::Gpu;
use super::resources::{WORKGROUP, buffer, compute_pipeline, entry, table};
use crate::blocks::{UNIFORM_BYTES, VIEW_BYTES, uniform_bytes};
use crate::error::RenderError;

/// The maximum size of the lists, and of the masks, of the tiles that are drawn at once, in bytes.
const MAX_BYTES: u64 = 64 << 20;
/// Bindings of the lists of constants, of the lists of iterations, and of the masks that these are
/// made from.
const TABLE: u32 = 3;
pub(crate) const ACTIVE_LISTS: u32 = 4;
const MASKS: u32 = 5;
const LEVEL: u32 = 6;
const COUNTERS: u32 = 7;
/// Size of the uniform `level`: at least a vector, for all backends.
const LEVEL_BYTES: u64 = 16;
/// Invocations of a workgroup.
const LANES: u32 = 64;
/// The culling shader, compiled for a device.
#[derive(Clone, Debug)]
pub(crate) struct Culling {
    mark: wgpu::ComputePipeline,
    list: wgpu::ComputePipeline,
    cells: Option<CellStages>,
    layout: wgpu::BindGroupLayout,
    table: wgpu::Buffer,
    /// The uniforms `level`, lowest level first.
    levels: Vec<wgpu::Buffer>,
    /// The number of iterations of each loop.
    iterations: Vec<u32>,
}

/// The stages for cells, in the order in which they run.
#[derive(Clone, Debug)]
struct CellStages {
    mark_groups: wgpu::ComputePipeline,
    list_cells: wgpu::ComputePipeline,
    /// For each loop, true if no iteration need be run outside all cells.
    is_joined: Vec<bool>,
    /// How far the cells extend beyond the surfaces' box, as a fraction of its longest side.
    beyond: f64,
}

/// The buffers for a number of tiles.
#[derive(Debug)]
pub(crate) struct ActiveBuffers {
    pub(crate) lists: wgpu::Buffer,
    pub(crate) counters: wgpu::Buffer,
    tiles: [u32; 2],
    /// One for each level.
    bind_groups: Vec<wgpu::BindGroup>,
}

impl ActiveBuffers {
    /// Returns true if the buffers are large enough for this many columns and rows of tiles.
    pub(crate) fn fit(&self, tiles: [u32; 2]) -> bool {
        lowest(self.tiles) >= lowest(tiles) && with_masks(self.tiles) >= with_masks(tiles)
    }

    /// Resets the number of evaluated operands.
    pub(crate) fn reset_count(&self, gpu: &Gpu) {
        gpu.queue.write_buffer(&self.counters, 4 * EVALUATED, &0_u32.to_ne_bytes());
    }
}

impl Culling {
    pub(crate) fn new(gpu: &Gpu, made: sdfc_codegen::Culling, uniform_count: usize) -> Self {
        let sdfc_codegen::Culling { shader, iterations, cells, soft_shadows } = made;
        let table = table(gpu, &uniform_bytes(shader.lists()));
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("culling"),
            source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(shader.into_module())),
        });
        let layout = layout(&gpu.device, uniform_count);
        let pipeline = |name| compute_pipeline(&gpu.device, &module, &layout, name);
        let (mark, list) = (pipeline("mark"), pipeline("list"));
        let levels = (0..LEVELS).map(|level| {
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            let uniform = buffer(gpu, "level", LEVEL_BYTES, usage);
            gpu.queue.write_buffer(&uniform, 0, &level.to_le_bytes());
            uniform
        });
        let cells = cells.map(|is_joined| CellStages {
            mark_groups: pipeline("mark_groups"),
            list_cells: pipeline("list_cells"),
            is_joined,
            beyond: BEYOND[usize::from(soft_shadows)],
        });
        Self { mark, list, cells, layout, table, levels: levels.collect(), iterations }
    }

    /// The same shader with the lists of constants of another.
    pub(crate) fn with_lists_of(&self, gpu: &Gpu, shader: &sdfc_codegen::Shader) -> Self {
        Self { table: table(gpu, &uniform_bytes(shader.lists())), ..self.clone() }
    }

    /// Allocates buffers for this many columns and rows of tiles of a workgroup each, and for
    /// cells. Call [`Self::open`] before they are used.
    pub(crate) fn allocate(
        &self,
        gpu: &Gpu,
        tiles: [u32; 2],
        view: &wgpu::Buffer,
        uniforms: Option<&wgpu::Buffer>,
    ) -> ActiveBuffers {
        use wgpu::BufferUsages as Usage;
        let has_cells = self.cells.is_some();
        let first = first_record(&self.iterations, has_cells);
        let bytes = 4 * (first + lowest(tiles) * u64::from(stride(&self.iterations)));
        let lists = buffer(gpu, "active", bytes, Usage::STORAGE | Usage::COPY_DST);
        let groups = if has_cells { u64::from(GROUPS) } else { 0 };
        let scratch = lowest(tiles) * scratch_bytes(&self.iterations);
        let tile_masks = with_masks(tiles) * mask_bytes(&self.iterations) + scratch;
        let masks = tile_masks.max(groups * mask_bytes(&self.iterations));
        let masks = buffer(gpu, "masks", masks, Usage::STORAGE);
        let counter_bytes = 4 * counters(&self.iterations, has_cells).len() as u64;
        let counter_usage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
        let counters = buffer(gpu, "counters", counter_bytes, counter_usage);
        let bind_group = |level| {
            let buffers = [
                (0, Some(view)),
                (1, uniforms),
                (TABLE, Some(&self.table)),
                (ACTIVE_LISTS, Some(&lists)),
                (MASKS, Some(&masks)),
                (COUNTERS, Some(&counters)),
                (LEVEL, Some(level)),
            ];
            let bound = buffers.into_iter().filter_map(|(binding, buffer)| {
                Some(wgpu::BindGroupEntry { binding, resource: buffer?.as_entire_binding() })
            });
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("culling"),
                layout: &self.layout,
                entries: &bound.collect::<Vec<_>>(),
            })
        };
        let bind_groups = self.levels.iter().map(bind_group).collect();
        ActiveBuffers { lists, counters, tiles, bind_groups }
    }

    /// Writes the initial contents of the buffers, for cells around a box of surfaces if there is
    /// one.
    pub(crate) fn open(&self, gpu: &Gpu, active: &ActiveBuffers, within: Option<[DVec3; 2]>) {
        let joined = self.cells.as_ref().map(|cells| &cells.is_joined[..]);
        let beyond = self.cells.as_ref().map_or(0.0, |cells| cells.beyond);
        let head = head(&self.iterations, joined, within.map(|within| (within, beyond)));
        gpu.queue.write_buffer(&active.lists, 0, &bytes_of(&head));
        let counters = counters(&self.iterations, joined.is_some());
        gpu.queue.write_buffer(&active.counters, 0, &bytes_of(&counters));
    }

    /// Lists what can affect the cells of this many groups. Run it once after [`Self::open`], since
    /// it appends to the lists.
    pub(crate) fn run_cells(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        active: &ActiveBuffers,
        groups: u32,
    ) {
        let Some(cells) = &self.cells else { return };
        let loops = self.iterations.len() as u32;
        pass.set_pipeline(&cells.mark_groups);
        // At level 0 the least operand of each group is found, at level 1 its masks.
        for bind_group in active.bind_groups.iter().take(2) {
            pass.set_bind_group(0, bind_group, &[]);
            pass.dispatch_workgroups(groups.div_ceil(LANES), max_words(&self.iterations), loops);
        }
        pass.set_pipeline(&cells.list_cells);
        pass.dispatch_workgroups((groups * group(&self.iterations).pow(3)).div_ceil(LANES), 1, 1);
    }

    /// Lists what can affect this many columns and rows of tiles.
    pub(crate) fn run(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        active: &ActiveBuffers,
        tiles: [u32; 2],
    ) {
        let loops = self.iterations.len() as u32;
        let levels: Vec<_> = each_level(tiles).zip(&active.bind_groups).collect();
        let Some((&(lowest_tiles, list_group), wide)) = levels.split_first() else { return };
        pass.set_pipeline(&self.mark);
        for &(tiles, bind_group) in wide.iter().rev() {
            pass.set_bind_group(0, bind_group, &[]);
            let groups = max_words(&self.iterations).div_ceil(LANES);
            pass.dispatch_workgroups(groups, lowest(tiles) as u32, loops);
        }
        pass.set_pipeline(&self.list);
        pass.set_bind_group(0, list_group, &[]);
        pass.dispatch_workgroups((lowest(lowest_tiles) as u32).div_ceil(LANES), 1, 1);
    }

    /// The maximum number of pixels of a picture's tile that the limits allow.
    pub(crate) fn max_pixels(&self, limits: &wgpu::Limits) -> u32 {
        let bytes = MAX_BYTES.min(limits.max_storage_buffer_binding_size);
        let first = first_record(&self.iterations, self.cells.is_some());
        let listed = bytes.saturating_sub(4 * first) / (4 * u64::from(stride(&self.iterations)));
        let [fixed, each] = tile_mask_bytes(&self.iterations);
        let marked = bytes.saturating_sub(fixed) / each;
        let most = u64::from(limits.max_compute_workgroups_per_dimension);
        let tiles = listed.min(marked).min(most);
        tiles as u32 * WORKGROUP * WORKGROUP
    }
}

/// Refuses loops with so many iterations that the adapter cannot hold the lists of a single tile.
pub(crate) fn fits(gpu: &Gpu, iterations: &[u32], has_cells: bool) -> Result<(), RenderError> {
    let what = "lists of what can matter to a tile of the picture";
    let words = first_record(iterations, has_cells) + u64::from(stride(iterations));
    gpu.has_storage(what, 4 * words)?;
    gpu.has_storage(what, tile_mask_bytes(iterations).iter().sum())?;
    gpu.has_workgroups(what, u64::from(max_words(iterations).div_ceil(LANES)))
}

fn bytes_of(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_ne_bytes()).collect()
}

fn layout(device: &wgpu::Device, uniform_count: usize) -> wgpu::BindGroupLayout {
    let uniform = wgpu::BufferBindingType::Uniform;
    let storage = |read_only| wgpu::BufferBindingType::Storage { read_only };
    let mut entries = vec![entry(0, uniform, VIEW_BYTES)];
    if uniform_count > 0 {
        entries.push(entry(1, uniform, uniform_count * UNIFORM_BYTES));
    }
    entries.push(entry(TABLE, storage(true), 0));
    entries.push(entry(LEVEL, uniform, LEVEL_BYTES as usize));
    entries
        .extend([ACTIVE_LISTS, MASKS, COUNTERS].map(|binding| entry(binding, storage(false), 0)));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("culling"),
        entries: &entries,
    })
}
