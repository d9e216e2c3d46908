//! What runs before a picture's shader on each tile: which rounds of the scene's loops can matter to its rays. And what runs once before
//! a frame where rays leave the tiles: which can matter in each cell of a grid.

use glam::DVec3;

use crate::{
    Gpu, RenderError,
    blocks::{UNIFORM_BYTES, VIEW_BYTES, uniform_bytes},
    gpu::{WORKGROUP, buffer, compute_pipeline, entry, table},
};

/// Most rounds of a loop that the lists of one tile of eight by eight pixels hold together; where more can matter, all are visited.
const CAPACITY: u32 = 512;
/// Most rounds that are kept while the lists of a tile are made, and what is kept of one: see `culling.wgsl`.
const MOST_KEPT: u32 = 1024;
const KEPT_WORDS: u32 = 2;
/// What a tile's record begins with, and for how many slices of its rays it has room, see `active_layout.wgsl`.
const RECORD_HEAD: u32 = 3;
const MOST_SLICES: u32 = 16;
/// Most bytes of lists, and of marks, for the tiles that are drawn at once.
const MOST_BYTES: u64 = 64 << 20;
/// Binding of the lists of constants, of the lists of rounds, and of the marks that these are made from.
const TABLE: u32 = 3;
pub(crate) const VISITS: u32 = 4;
const MARKS: u32 = 5;
const LEVEL: u32 = 6;
/// Levels of tiles, each two by two of the one below, and the lowest a workgroup's pixels. All above the lowest have marks.
const LEVELS: u32 = 5;
/// A uniform is as large as a vector at least, for all backends.
const LEVEL_BYTES: u64 = 16;
const WIDER: u32 = 2;
const TALLY: u32 = 7;
/// Words of the tally before the least operands, and where it counts operands that were evaluated.
const TALLY_HEAD: usize = 2;
pub(crate) const EVALUATED: u64 = 1;
/// Words before the record by which all rounds are visited, see `active_layout.wgsl`.
const HEAD: u32 = 7;
/// Groups of cells, to an axis and in all.
const GROUP_SIDE: u32 = 8;
pub(crate) const GROUPS: u32 = GROUP_SIDE * GROUP_SIDE * GROUP_SIDE;
/// Cells of a group to an axis, where loops have fewer rounds than so many in all, and where they have more.
const GROUP: [u32; 2] = [2, 4];
const MANY_ROUNDS: u32 = 4000;
/// Words of what tells of the cells.
const ABOUT_CELLS: u32 = 19;
/// Words of a cell's lists, in the mean.
const CELL_ROOM: u32 = 64;
/// Part of the longest side of the box of surfaces by which the cells reach beyond it: a ray that has left them is as far away from it.
const BEYOND: f64 = 0.06;
/// Part of the least side of a cell that is a step by what is known of the cell alone.
const SHORTEST: f64 = 0.5;
/// A step that nothing is.
const FAR: f64 = 1e30;
/// Part of the box's places by which it is made larger: more than rounding in f32 takes from it.
const BOX_MARGIN: f64 = 1e-5;
/// Invocations of a workgroup.
const LANES: u32 = 64;
/// Rounds to a word.
const WORD: u32 = 32;

/// Both stages, made ready for a device.
#[derive(Debug)]
pub(crate) struct Culling {
    mark: wgpu::ComputePipeline,
    list: wgpu::ComputePipeline,
    cells: Option<CellStages>,
    layout: wgpu::BindGroupLayout,
    table: wgpu::Buffer,
    /// What tells the shader the level, lowest first.
    levels: Vec<wgpu::Buffer>,
    /// Rounds of each loop.
    rounds: Vec<u32>,
}

/// The stages for cells, in their order.
#[derive(Clone, Debug)]
struct CellStages {
    least_of_groups: wgpu::ComputePipeline,
    mark_groups: wgpu::ComputePipeline,
    list_cells: wgpu::ComputePipeline,
    /// For each loop, whether no round need be visited outside all cells.
    is_joined: Vec<bool>,
}

/// The buffers for so many tiles.
#[derive(Debug)]
pub(crate) struct Visits {
    pub(crate) lists: wgpu::Buffer,
    pub(crate) tally: wgpu::Buffer,
    tiles: [u32; 2],
    /// For each level.
    bind_groups: Vec<wgpu::BindGroup>,
}

impl Visits {
    /// Whether they do for so many columns and rows of tiles.
    pub(crate) fn fit(&self, tiles: [u32; 2]) -> bool {
        lowest(self.tiles) >= lowest(tiles) && with_marks(self.tiles) >= with_marks(tiles)
    }

    /// Nothing was evaluated yet.
    pub(crate) fn count_anew(&self, gpu: &Gpu) {
        gpu.queue.write_buffer(&self.tally, 4 * EVALUATED, &0_u32.to_ne_bytes());
    }
}

fn lowest([columns, rows]: [u32; 2]) -> u64 {
    u64::from(columns) * u64::from(rows)
}

/// Tiles of each level above so many columns and rows of the lowest.
fn each_level(tiles: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..LEVELS).map(move |level| tiles.map(|count| count.div_ceil(WIDER.pow(level))))
}

/// How many tiles have marks.
fn with_marks(tiles: [u32; 2]) -> u64 {
    each_level(tiles).skip(1).map(lowest).sum()
}

impl Culling {
    pub(crate) fn new(gpu: &Gpu, made: sdfc_codegen::Culling, uniform_count: usize) -> Self {
        let sdfc_codegen::Culling { shader, iterations: rounds, cells } = made;
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
            least_of_groups: pipeline("least_of_groups"),
            mark_groups: pipeline("mark_groups"),
            list_cells: pipeline("list_cells"),
            is_joined,
        });
        Self { mark, list, cells, layout, table, levels: levels.collect(), rounds }
    }

    /// The same with other lists of constants.
    pub(crate) fn with_lists_of(&self, gpu: &Gpu, shader: &sdfc_codegen::Shader) -> Self {
        Self {
            mark: self.mark.clone(),
            list: self.list.clone(),
            cells: self.cells.clone(),
            layout: self.layout.clone(),
            table: table(gpu, &uniform_bytes(shader.lists())),
            levels: self.levels.clone(),
            rounds: self.rounds.clone(),
        }
    }

    /// Room for so many columns and rows of tiles of a workgroup each, and for cells; to be opened before it is used.
    pub(crate) fn room(
        &self,
        gpu: &Gpu,
        tiles: [u32; 2],
        view: &wgpu::Buffer,
        uniforms: Option<&wgpu::Buffer>,
    ) -> Visits {
        use wgpu::BufferUsages as Usage;
        let has_cells = self.cells.is_some();
        let first = first_record(&self.rounds, has_cells);
        let bytes = 4 * (first + lowest(tiles) * u64::from(stride(&self.rounds)));
        let lists = buffer(gpu, "visits", bytes, Usage::STORAGE | Usage::COPY_DST);
        let groups = if has_cells { u64::from(GROUPS) } else { 0 };
        let kept = lowest(tiles) * kept_bytes(&self.rounds);
        let tile_marks = with_marks(tiles) * mark_bytes(&self.rounds) + kept;
        let marks = tile_marks.max(groups * mark_bytes(&self.rounds));
        let marks = buffer(gpu, "marks", marks, Usage::STORAGE);
        let tally_bytes = 4 * tally(&self.rounds, has_cells).len() as u64;
        let tally_usage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
        let tally = buffer(gpu, "tally", tally_bytes, tally_usage);
        let bind_group = |level| {
            let buffers = [
                (0, Some(view)),
                (1, uniforms),
                (TABLE, Some(&self.table)),
                (VISITS, Some(&lists)),
                (MARKS, Some(&marks)),
                (TALLY, Some(&tally)),
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
        Visits { lists, tally, tiles, bind_groups }
    }

    /// Writes what the stages begin with, for cells about a box of surfaces if there is one.
    pub(crate) fn open(&self, gpu: &Gpu, visits: &Visits, within: Option<[DVec3; 2]>) {
        let joined = self.cells.as_ref().map(|cells| &cells.is_joined[..]);
        let head = head(&self.rounds, joined, within);
        gpu.queue.write_buffer(&visits.lists, 0, &bytes_of(&head));
        let tally = tally(&self.rounds, joined.is_some());
        gpu.queue.write_buffer(&visits.tally, 0, &bytes_of(&tally));
    }

    /// Finds what can matter in so many groups of cells; once, since it fills what was empty.
    pub(crate) fn run_cells(&self, pass: &mut wgpu::ComputePass<'_>, visits: &Visits, groups: u32) {
        let (Some(cells), Some(bind_group)) = (&self.cells, visits.bind_groups.first()) else {
            return;
        };
        let loops = self.rounds.len() as u32;
        pass.set_bind_group(0, bind_group, &[]);
        for stage in [&cells.least_of_groups, &cells.mark_groups] {
            pass.set_pipeline(stage);
            pass.dispatch_workgroups(groups.div_ceil(LANES), most_words(&self.rounds), loops);
        }
        pass.set_pipeline(&cells.list_cells);
        pass.dispatch_workgroups((groups * group(&self.rounds).pow(3)).div_ceil(LANES), 1, 1);
    }

    /// Finds what can matter to so many columns and rows of tiles.
    pub(crate) fn run(&self, pass: &mut wgpu::ComputePass<'_>, visits: &Visits, tiles: [u32; 2]) {
        let loops = self.rounds.len() as u32;
        let levels: Vec<_> = each_level(tiles).zip(&visits.bind_groups).collect();
        let Some((&(lowest_tiles, list_group), wide)) = levels.split_first() else { return };
        pass.set_pipeline(&self.mark);
        for &(tiles, bind_group) in wide.iter().rev() {
            pass.set_bind_group(0, bind_group, &[]);
            let groups = most_words(&self.rounds).div_ceil(LANES);
            pass.dispatch_workgroups(groups, lowest(tiles) as u32, loops);
        }
        pass.set_pipeline(&self.list);
        pass.set_bind_group(0, list_group, &[]);
        pass.dispatch_workgroups((lowest(lowest_tiles) as u32).div_ceil(LANES), 1, 1);
    }

    /// Most pixels of a tile of the picture for which there is room.
    pub(crate) fn max_pixels(&self, limits: &wgpu::Limits) -> u32 {
        let bytes = MOST_BYTES.min(limits.max_storage_buffer_binding_size);
        let first = first_record(&self.rounds, self.cells.is_some());
        let listed = bytes.saturating_sub(4 * first) / (4 * u64::from(stride(&self.rounds)));
        let [ahead, each] = tile_mark_bytes(&self.rounds);
        let marked = bytes.saturating_sub(ahead) / each;
        let most = u64::from(limits.max_compute_workgroups_per_dimension);
        let tiles = listed.min(marked).min(most);
        tiles as u32 * WORKGROUP * WORKGROUP
    }
}

/// Refuses loops of so many rounds that the adapter has no room for what is listed of a single tile.
pub(crate) fn fits(gpu: &Gpu, rounds: &[u32], has_cells: bool) -> Result<(), RenderError> {
    let what = "lists of what can matter to a tile of the picture";
    let words = first_record(rounds, has_cells) + u64::from(stride(rounds));
    gpu.has_storage(what, 4 * words)?;
    gpu.has_storage(what, tile_mark_bytes(rounds).iter().sum())?;
    gpu.has_workgroups(what, u64::from(most_words(rounds).div_ceil(LANES)))
}

/// What the lists begin with: the layout, what stands for a slice by which all rounds are visited and its lists; where rays go by cells,
/// the same outside all of these, given for each loop whether no round need be visited there, and what tells of the cells.
fn head(rounds: &[u32], joined: Option<&[bool]>, within: Option<[DVec3; 2]>) -> Vec<u32> {
    let loops = rounds.len() as u32;
    let (about, end) = (about_cells(rounds), first_record(rounds, joined.is_some()) as u32);
    let kept = most_kept(rounds);
    let mut head = vec![end, stride(rounds), CAPACITY, most_words(rounds), loops, about, kept];
    let mut first = HEAD + 2 * loops;
    for &rounds in rounds {
        head.extend([rounds, first]);
        first += rounds;
    }
    head.extend(rounds.iter().flat_map(|&rounds| 0..rounds));
    let Some(joined) = joined else { return head };
    for (place, &is_joined) in joined.iter().enumerate() {
        let place = HEAD as usize + 2 * place;
        head.extend([if is_joined { 0 } else { head[place] }, head[place + 1]]);
    }
    let Some(within) = within else {
        head.resize(head.len() + ABOUT_CELLS as usize, 0);
        return head;
    };
    let records = about + ABOUT_CELLS;
    let lists = records + (2 * loops + 1) * cell_count(rounds);
    head.extend([loops, group(rounds), records, about - 2 * loops, lists, end]);
    let grid = grid(within, GROUP_SIDE * group(rounds));
    let is_joined = joined.iter().all(|&is_joined| is_joined);
    let least_step = if is_joined { SHORTEST * grid[1].recip().min_element() } else { FAR };
    head.push((least_step as f32).to_bits());
    head.extend(grid.iter().flat_map(|v| v.as_vec3().to_array()).map(f32::to_bits));
    head
}

/// How many cells of a group there are to an axis.
fn group(rounds: &[u32]) -> u32 {
    GROUP[usize::from(rounds.iter().sum::<u32>() >= MANY_ROUNDS)]
}

fn cell_count(rounds: &[u32]) -> u32 {
    GROUPS * group(rounds).pow(3)
}

/// Where what tells of the cells stands, behind the record of what is outside all of them.
fn about_cells(rounds: &[u32]) -> u32 {
    HEAD + 4 * rounds.len() as u32 + rounds.iter().sum::<u32>()
}

/// Where the first tile's record stands.
fn first_record(rounds: &[u32], has_cells: bool) -> u64 {
    let (loops, about) = (rounds.len() as u64, u64::from(about_cells(rounds)));
    if !has_cells {
        return about - 2 * loops;
    }
    let cell = (2 + u64::from(CELL_ROOM)) * loops + 1;
    about + u64::from(ABOUT_CELLS) + cell * u64::from(cell_count(rounds))
}

/// What the stages count from: nothing is filled, none was evaluated, no least operand known.
fn tally(rounds: &[u32], has_cells: bool) -> Vec<u32> {
    let known = if has_cells { GROUPS as usize * rounds.len() } else { 0 };
    let mut tally = vec![0; TALLY_HEAD];
    tally.resize(TALLY_HEAD + known, u32::MAX);
    tally
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

/// Most rounds that are kept of a tile.
fn most_kept(rounds: &[u32]) -> u32 {
    rounds.iter().sum::<u32>().min(MOST_KEPT)
}

fn kept_bytes(rounds: &[u32]) -> u64 {
    4 * u64::from(KEPT_WORDS * most_kept(rounds))
}

/// Most bytes of marks and of what is kept: in any case, and for each tile. Each level has half the tiles of the one below at most, or one.
fn tile_mark_bytes(rounds: &[u32]) -> [u64; 2] {
    let marks = mark_bytes(rounds);
    [u64::from(LEVELS) * marks, marks + kept_bytes(rounds)]
}

/// The corner of the first cell and how many there are to a unit of length, then the corners of the box.
fn grid([lo, hi]: [DVec3; 2], to_axis: u32) -> [DVec3; 4] {
    let margin = DVec3::splat(BOX_MARGIN * lo.abs().max(hi.abs()).max_element().max(1e-20));
    let [lo, hi] = [lo - margin, hi + margin];
    let beyond = DVec3::splat(BEYOND * (hi - lo).max_element());
    let low = lo - beyond;
    let side = (hi + beyond - low) / f64::from(to_axis);
    [low, side.recip(), lo, hi]
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
    entries.extend([VISITS, MARKS, TALLY].map(|binding| entry(binding, storage(false), 0)));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("culling"),
        entries: &entries,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a constant of the shaders is.
    fn constant(name: &str) -> u32 {
        let text = sdfc_march::culling_source();
        let stated = text.split_once(&format!("const {name}: u32 = ")).unwrap().1;
        stated.split_once(';').unwrap().0.parse().unwrap()
    }

    #[test]
    fn what_the_shaders_know_of_the_lists_is_what_is_written() {
        assert_eq!(constant("FIRST_SLICE"), RECORD_HEAD);
        assert_eq!(constant("MAX_SLICES"), MOST_SLICES);
        assert_eq!(constant("ALL_ITERATIONS"), HEAD);
        assert_eq!(constant("TILE"), WORKGROUP);
        assert_eq!(constant("TOP_LEVEL") + 1, LEVELS);
        assert_eq!(1 << constant("WIDER_BITS"), WIDER);
        assert_eq!(constant("GROUP_SIDE"), GROUP_SIDE);
        assert_eq!(constant("LEAST_OPERANDS") as usize, TALLY_HEAD);
        assert_eq!(u64::from(constant("EVALUATED")), EVALUATED);
    }

    #[test]
    fn the_lists_begin_with_what_the_shaders_look_for() {
        let rounds = [40, 50];
        let is_round = |head: &[u32], loops: usize| {
            let [count, first] = [0, 1].map(|word| head[HEAD as usize + 2 * loops + word]);
            let all = &head[first as usize..][..count as usize];
            count == rounds[loops] && all.iter().copied().eq(0..count)
        };
        let head_of = |joined, within| {
            let head = head(&rounds, joined, within);
            let at = |name| head[constant(name) as usize];
            assert_eq!(at("RECORD_STRIDE"), stride(&rounds));
            assert_eq!(at("CAPACITY"), CAPACITY);
            assert_eq!(at("MAX_WORDS"), 2);
            assert_eq!(at("LOOPS"), 2);
            assert_eq!(at("MAX_SCRATCH"), 90);
            assert!(is_round(&head, 0) && is_round(&head, 1));
            (at("FIRST_RECORD"), at("CELLS") as usize, head)
        };
        let (first, _, head) = head_of(None, None);
        assert_eq!(first as usize, head.len());

        let within = Some([DVec3::splat(-1.0), DVec3::ONE]);
        let (first, cells, head) = head_of(Some(&[true, false]), within);
        assert_eq!(cells + ABOUT_CELLS as usize, head.len());
        // The order of `read_cells`.
        let [loops, side, records, outside, lists, end] =
            [0, 1, 2, 3, 4, 5].map(|i| head[cells + i]);
        assert_eq!((loops, side, records as usize, end), (2, GROUP[0], head.len(), first));
        let [_, first_of_all, _, second_of_all] = [0, 1, 2, 3].map(|i| head[HEAD as usize + i]);
        assert_eq!(head[outside as usize..][..4], [0, first_of_all, 50, second_of_all]);
        assert_eq!(lists, records + 5 * cell_count(&rounds));
        let last = format!("read_vec3(start + {}u)", ABOUT_CELLS - 3);
        assert!(sdfc_march::culling_source().contains(&last));
    }
}
