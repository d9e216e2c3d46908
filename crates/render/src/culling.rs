//! What runs before a picture's shader on each tile: which rounds of the scene's loops can matter to its rays.

use crate::{
    Gpu, RenderError,
    blocks::{UNIFORM_BYTES, VIEW_BYTES, uniform_bytes},
    gpu::{WORKGROUP, buffer, compute_pipeline, entry, table},
};

/// Most rounds of a loop that the lists of one tile of eight by eight pixels hold together; where more can matter, all are visited.
const CAPACITY: u32 = 512;
/// What a tile's record begins with, and for how many slices of its rays it has room, see `visit_layout.wgsl`.
const RECORD_HEAD: u32 = 3;
const MOST_SLICES: u32 = 8;
/// Most bytes of lists, and of marks, for the tiles that are drawn at once.
const MOST_BYTES: u64 = 64 << 20;
/// Binding of the lists of constants, of the lists of rounds, and of the marks that these are made from.
const TABLE: u32 = 3;
pub(crate) const VISITS: u32 = 4;
const MARKS: u32 = 5;
const LEVEL: u32 = 6;
/// Levels of tiles, each four by four of the one below, and the lowest a workgroup's pixels.
const LEVELS: u32 = 3;
/// A uniform is as large as a vector at least, for all backends.
const LEVEL_BYTES: u64 = 16;
const WIDER: u32 = 4;
/// Words before the record by which all rounds are visited, see `visit_layout.wgsl`.
const HEAD: u32 = 5;
/// Invocations of a workgroup.
const LANES: u32 = 64;
/// Rounds to a word.
const WORD: u32 = 32;

/// Both stages, made ready for a device.
#[derive(Debug)]
pub(crate) struct Culling {
    mark: wgpu::ComputePipeline,
    list: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    table: wgpu::Buffer,
    /// What tells the shader the level, lowest first.
    levels: Vec<wgpu::Buffer>,
    /// Rounds of each loop.
    rounds: Vec<u32>,
}

/// The buffers for so many tiles.
#[derive(Debug)]
pub(crate) struct Visits {
    pub(crate) lists: wgpu::Buffer,
    tiles: [u32; 2],
    /// For each level.
    bind_groups: Vec<wgpu::BindGroup>,
}

impl Visits {
    /// Whether they do for so many columns and rows of tiles.
    pub(crate) fn fit(&self, tiles: [u32; 2]) -> bool {
        lowest(self.tiles) >= lowest(tiles) && on_all_levels(self.tiles) >= on_all_levels(tiles)
    }
}

fn lowest([columns, rows]: [u32; 2]) -> u64 {
    u64::from(columns) * u64::from(rows)
}

/// Tiles of each level above so many columns and rows of the lowest.
fn each_level(tiles: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..LEVELS).map(move |level| tiles.map(|count| count.div_ceil(WIDER.pow(level))))
}

fn on_all_levels(tiles: [u32; 2]) -> u64 {
    each_level(tiles).map(lowest).sum()
}

impl Culling {
    pub(crate) fn new(gpu: &Gpu, made: sdfc_codegen::Culling, uniform_count: usize) -> Self {
        let sdfc_codegen::Culling { shader, rounds } = made;
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
        Self { mark, list, layout, table, levels: levels.collect(), rounds }
    }

    /// The same with other lists of constants.
    pub(crate) fn with_lists_of(&self, gpu: &Gpu, shader: &sdfc_codegen::Shader) -> Self {
        Self {
            mark: self.mark.clone(),
            list: self.list.clone(),
            layout: self.layout.clone(),
            table: table(gpu, &uniform_bytes(shader.lists())),
            levels: self.levels.clone(),
            rounds: self.rounds.clone(),
        }
    }

    /// Room for so many columns and rows of tiles of a workgroup each.
    pub(crate) fn room(
        &self,
        gpu: &Gpu,
        tiles: [u32; 2],
        view: &wgpu::Buffer,
        uniforms: Option<&wgpu::Buffer>,
    ) -> Visits {
        use wgpu::BufferUsages as Usage;
        let head = head(&self.rounds);
        let bytes = 4 * (head.len() as u64 + lowest(tiles) * u64::from(stride(&self.rounds)));
        let lists = buffer(gpu, "visits", bytes, Usage::STORAGE | Usage::COPY_DST);
        let head: Vec<u8> = head.iter().flat_map(|word| word.to_le_bytes()).collect();
        gpu.queue.write_buffer(&lists, 0, &head);
        let marks = on_all_levels(tiles) * mark_bytes(&self.rounds);
        let marks = buffer(gpu, "marks", marks, Usage::STORAGE);
        let bind_group = |level| {
            let buffers = [
                (0, Some(view)),
                (1, uniforms),
                (TABLE, Some(&self.table)),
                (VISITS, Some(&lists)),
                (MARKS, Some(&marks)),
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
        Visits { lists, tiles, bind_groups }
    }

    /// Finds what can matter to so many columns and rows of tiles.
    pub(crate) fn run(&self, pass: &mut wgpu::ComputePass<'_>, visits: &Visits, tiles: [u32; 2]) {
        let loops = self.rounds.len() as u32;
        let levels: Vec<_> = each_level(tiles).zip(&visits.bind_groups).collect();
        pass.set_pipeline(&self.mark);
        for (tiles, bind_group) in levels.into_iter().rev() {
            pass.set_bind_group(0, bind_group, &[]);
            let groups = most_words(&self.rounds).div_ceil(LANES);
            pass.dispatch_workgroups(groups, lowest(tiles) as u32, loops);
        }
        pass.set_pipeline(&self.list);
        pass.dispatch_workgroups((lowest(tiles) as u32).div_ceil(LANES), 1, 1);
    }

    /// Most pixels of a tile of the picture for which there is room.
    pub(crate) fn max_pixels(&self, limits: &wgpu::Limits) -> u32 {
        let bytes = MOST_BYTES.min(limits.max_storage_buffer_binding_size);
        let left = bytes.saturating_sub(4 * head(&self.rounds).len() as u64);
        // A level has no more tiles than the one below.
        let marks = u64::from(LEVELS) * mark_bytes(&self.rounds);
        let tile = marks.max(4 * u64::from(stride(&self.rounds)));
        let tiles = (left / tile).min(u64::from(limits.max_compute_workgroups_per_dimension));
        tiles as u32 * WORKGROUP * WORKGROUP
    }
}

/// Refuses loops of so many rounds that the adapter has no room for what is listed of a single tile.
pub(crate) fn fits(gpu: &Gpu, rounds: &[u32]) -> Result<(), RenderError> {
    let what = "lists of what can matter to a tile of the picture";
    gpu.has_storage(what, 4 * (head(rounds).len() as u64 + u64::from(stride(rounds))))?;
    gpu.has_storage(what, u64::from(LEVELS) * mark_bytes(rounds))?;
    gpu.has_workgroups(what, u64::from(most_words(rounds).div_ceil(LANES)))
}

/// What the lists begin with: the layout, and what stands for a slice by which all rounds are visited.
fn head(rounds: &[u32]) -> Vec<u32> {
    let loops = rounds.len() as u32;
    let all: u32 = rounds.iter().sum();
    let first_record = HEAD + 2 * loops + all;
    let mut head = vec![first_record, stride(rounds), CAPACITY, most_words(rounds), loops];
    let mut first = HEAD + 2 * loops;
    for &rounds in rounds {
        head.extend([rounds, first]);
        first += rounds;
    }
    head.extend(rounds.iter().flat_map(|&rounds| 0..rounds));
    head
}

/// Words of a tile's record and its lists.
fn stride(rounds: &[u32]) -> u32 {
    RECORD_HEAD + rounds.len() as u32 * (2 * MOST_SLICES + CAPACITY)
}

/// Words of the marks of the longest loop.
fn most_words(rounds: &[u32]) -> u32 {
    rounds.iter().max().map_or(1, |rounds| rounds.div_ceil(WORD).max(1))
}

/// Bytes of a tile's marks.
fn mark_bytes(rounds: &[u32]) -> u64 {
    4 * rounds.len() as u64 * u64::from(most_words(rounds))
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
    entries.extend([VISITS, MARKS].map(|binding| entry(binding, storage(false), 0)));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("culling"),
        entries: &entries,
    })
}
