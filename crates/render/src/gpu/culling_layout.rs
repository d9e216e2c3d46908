//! The layout of the buffers that the culling shaders read and write, as `active_layout.wgsl` and
//! `culling.wgsl` declare it.

use glam::DVec3;

/// Capacity of one tile's lists for a loop, all slices together; if more iterations can affect the
/// tile, all are run.
pub(super) const CAPACITY: u32 = 512;
/// Capacity of the scratch space while the lists of a tile are made, in iterations, and its words
/// per iteration; see `culling.wgsl`.
pub(super) const MAX_SCRATCH: u32 = 1024;
pub(super) const SCRATCH_WORDS: u32 = 2;
/// Words at the start of a tile's record, and the number of slices that it has room for; see
/// `active_layout.wgsl`.
pub(super) const RECORD_HEAD: u32 = 3;
pub(super) const MAX_SLICES: u32 = 16;
/// Levels of tiles. A tile of one level covers two by two of the level below; those of the lowest
/// level are workgroups. All levels above the lowest have masks.
pub(super) const LEVELS: u32 = 5;
pub(super) const WIDER: u32 = 2;
/// Words of the counters before the least operands, and the index of the number of evaluated
/// operands.
pub(super) const COUNTERS_HEAD: usize = 2;
pub(super) const EVALUATED: u64 = 1;
/// Words before the entries that stand for all iterations; see `active_layout.wgsl`.
pub(super) const HEAD: u32 = 7;
/// Groups of cells along an axis, and in all.
pub(super) const GROUP_SIDE: u32 = 8;
pub(super) const GROUPS: u32 = GROUP_SIDE * GROUP_SIDE * GROUP_SIDE;
/// Cells of a group along an axis, for loops with fewer than MANY_ITERATIONS in all, and for loops
/// with more.
pub(super) const GROUP: [u32; 2] = [2, 4];
pub(super) const MANY_ITERATIONS: u32 = 4000;
/// Words of the description of the cells.
pub(super) const ABOUT_CELLS: u32 = 19;
/// Mean capacity of a cell's lists, in words.
pub(super) const CELL_WORDS: u32 = 64;
/// Fraction of the longest side of the box of surfaces by which the cells reach beyond it: a ray
/// that has left them is at least that far away from it. The second one is for scenes with soft
/// shadows, whose rays run all iterations at most samples outside the cells.
pub(super) const BEYOND: [f64; 2] = [0.06, 0.25];
/// Length of a step by the bound of a cell alone, as a fraction of the cell's shortest side.
pub(super) const SHORTEST: f64 = 0.5;
/// Longer than any step: no limit.
pub(super) const FAR: f64 = 1e30;
/// Fraction of the box's coordinates by which it is enlarged: more than rounding in f32 takes from
/// it.
pub(super) const BOX_MARGIN: f64 = 1e-5;
/// Iterations per word of a mask.
pub(super) const WORD: u32 = 32;

pub(super) fn lowest([columns, rows]: [u32; 2]) -> u64 {
    u64::from(columns) * u64::from(rows)
}

/// The tiles of each level, for this many columns and rows of the lowest.
pub(super) fn each_level(tiles: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..LEVELS).map(move |level| tiles.map(|count| count.div_ceil(WIDER.pow(level))))
}

/// The number of tiles with masks.
pub(super) fn with_masks(tiles: [u32; 2]) -> u64 {
    each_level(tiles).skip(1).map(lowest).sum()
}

/// The first words of `active_lists`: the layout, and the entries and lists that stand for all
/// iterations. If rays use cells, then the same entries for points outside all cells, where
/// `joined` tells for each loop that no iteration need be run, and the description of the cells,
/// around a box and the given fraction of its longest side.
pub(super) fn head(
    iterations: &[u32],
    joined: Option<&[bool]>,
    within: Option<([DVec3; 2], f64)>,
) -> Vec<u32> {
    let loops = iterations.len() as u32;
    let (about, end) = (about_cells(iterations), first_record(iterations, joined.is_some()) as u32);
    let scratch = max_scratch(iterations);
    let mut head =
        vec![end, stride(iterations), CAPACITY, max_words(iterations), loops, about, scratch];
    let mut first = HEAD + 2 * loops;
    for &iterations in iterations {
        head.extend([iterations, first]);
        first += iterations;
    }
    head.extend(iterations.iter().flat_map(|&iterations| 0..iterations));
    let Some(joined) = joined else { return head };
    for (place, &is_joined) in joined.iter().enumerate() {
        let place = HEAD as usize + 2 * place;
        head.extend([if is_joined { 0 } else { head[place] }, head[place + 1]]);
    }
    let Some((within, beyond)) = within else {
        head.resize(head.len() + ABOUT_CELLS as usize, 0);
        return head;
    };
    let records = about + ABOUT_CELLS;
    let lists = records + (2 * loops + 1) * cell_count(iterations);
    head.extend([loops, group(iterations), records, about - 2 * loops, lists, end]);
    let grid = grid(within, beyond, GROUP_SIDE * group(iterations));
    let is_joined = joined.iter().all(|&is_joined| is_joined);
    let least_step = if is_joined { SHORTEST * grid[1].recip().min_element() } else { FAR };
    head.push((least_step as f32).to_bits());
    head.extend(grid.iter().flat_map(|v| v.as_vec3().to_array()).map(f32::to_bits));
    head
}

/// Cells of a group along an axis.
pub(super) fn group(iterations: &[u32]) -> u32 {
    GROUP[usize::from(iterations.iter().sum::<u32>() >= MANY_ITERATIONS)]
}

pub(super) fn cell_count(iterations: &[u32]) -> u32 {
    GROUPS * group(iterations).pow(3)
}

/// Index of the description of the cells, which follows the record for points outside all of them.
pub(super) fn about_cells(iterations: &[u32]) -> u32 {
    HEAD + 4 * iterations.len() as u32 + iterations.iter().sum::<u32>()
}

/// Index of the first tile's record.
pub(super) fn first_record(iterations: &[u32], has_cells: bool) -> u64 {
    let (loops, about) = (iterations.len() as u64, u64::from(about_cells(iterations)));
    if !has_cells {
        return about - 2 * loops;
    }
    let cell = (2 + u64::from(CELL_WORDS)) * loops + 1;
    about + u64::from(ABOUT_CELLS) + cell * u64::from(cell_count(iterations))
}

/// The initial counters: nothing is filled, nothing was evaluated, no least operand is known.
pub(super) fn counters(iterations: &[u32], has_cells: bool) -> Vec<u32> {
    let known = if has_cells { GROUPS as usize * iterations.len() } else { 0 };
    let mut counters = vec![0; COUNTERS_HEAD];
    counters.resize(COUNTERS_HEAD + known, u32::MAX);
    counters
}

/// Words of a tile's record and its lists.
pub(super) fn stride(iterations: &[u32]) -> u32 {
    RECORD_HEAD + iterations.len() as u32 * (2 * MAX_SLICES + CAPACITY)
}

/// Words of the masks of the longest loop.
pub(super) fn max_words(iterations: &[u32]) -> u32 {
    iterations.iter().max().map_or(1, |iterations| iterations.div_ceil(WORD).max(1))
}

/// Bytes of a tile's masks.
pub(super) fn mask_bytes(iterations: &[u32]) -> u64 {
    4 * iterations.len() as u64 * u64::from(max_words(iterations))
}

/// Capacity of a tile's scratch space, in iterations.
pub(super) fn max_scratch(iterations: &[u32]) -> u32 {
    iterations.iter().sum::<u32>().min(MAX_SCRATCH)
}

pub(super) fn scratch_bytes(iterations: &[u32]) -> u64 {
    4 * u64::from(SCRATCH_WORDS * max_scratch(iterations))
}

/// Upper bound on mask and scratch bytes: `[fixed, per tile]`. A level has at most half the tiles
/// of the one below, or one.
pub(super) fn tile_mask_bytes(iterations: &[u32]) -> [u64; 2] {
    let masks = mask_bytes(iterations);
    [u64::from(LEVELS) * masks, masks + scratch_bytes(iterations)]
}

/// The corner of the first cell and the number of cells per unit of length, then the corners of the
/// box.
pub(super) fn grid([lo, hi]: [DVec3; 2], beyond: f64, to_axis: u32) -> [DVec3; 4] {
    let margin = DVec3::splat(BOX_MARGIN * lo.abs().max(hi.abs()).max_element().max(1e-20));
    let [lo, hi] = [lo - margin, hi + margin];
    let beyond = DVec3::splat(beyond * (hi - lo).max_element());
    let low = lo - beyond;
    let side = (hi + beyond - low) / f64::from(to_axis);
    [low, side.recip(), lo, hi]
}

#[cfg(test)]
mod tests {
    use super::super::resources::WORKGROUP;
    use super::*;

    /// The value of a constant of the shaders.
    fn constant(name: &str) -> u32 {
        let text = sdfc_march::culling_source();
        let stated = text.split_once(&format!("const {name}: u32 = ")).unwrap().1;
        stated.split_once(';').unwrap().0.parse().unwrap()
    }

    #[test]
    fn what_the_shaders_know_of_the_lists_is_what_is_written() {
        assert_eq!(constant("FIRST_SLICE"), RECORD_HEAD);
        assert_eq!(constant("MAX_SLICES"), MAX_SLICES);
        assert_eq!(constant("ALL_ITERATIONS"), HEAD);
        assert_eq!(constant("TILE"), WORKGROUP);
        assert_eq!(constant("TOP_LEVEL") + 1, LEVELS);
        assert_eq!(1 << constant("WIDER_BITS"), WIDER);
        assert_eq!(constant("GROUP_SIDE"), GROUP_SIDE);
        assert_eq!(constant("LEAST_OPERANDS") as usize, COUNTERS_HEAD);
        assert_eq!(u64::from(constant("EVALUATED")), EVALUATED);
    }

    #[test]
    fn the_lists_begin_with_what_the_shaders_look_for() {
        let iterations = [40, 50];
        let is_listed = |head: &[u32], loops: usize| {
            let [count, first] = [0, 1].map(|word| head[HEAD as usize + 2 * loops + word]);
            let all = &head[first as usize..][..count as usize];
            count == iterations[loops] && all.iter().copied().eq(0..count)
        };
        let head_of = |joined, within| {
            let head = head(&iterations, joined, within);
            let at = |name| head[constant(name) as usize];
            assert_eq!(at("RECORD_STRIDE"), stride(&iterations));
            assert_eq!(at("CAPACITY"), CAPACITY);
            assert_eq!(at("MAX_WORDS"), 2);
            assert_eq!(at("LOOPS"), 2);
            assert_eq!(at("MAX_SCRATCH"), 90);
            assert!(is_listed(&head, 0) && is_listed(&head, 1));
            (at("FIRST_RECORD"), at("CELLS") as usize, head)
        };
        let (first, _, head) = head_of(None, None);
        assert_eq!(first as usize, head.len());

        let within = Some(([DVec3::splat(-1.0), DVec3::ONE], BEYOND[0]));
        let (first, cells, head) = head_of(Some(&[true, false]), within);
        assert_eq!(cells + ABOUT_CELLS as usize, head.len());
        // The order of `read_cells`.
        let [loops, side, records, outside, lists, end] =
            [0, 1, 2, 3, 4, 5].map(|i| head[cells + i]);
        assert_eq!((loops, side, records as usize, end), (2, GROUP[0], head.len(), first));
        let [_, first_of_all, _, second_of_all] = [0, 1, 2, 3].map(|i| head[HEAD as usize + i]);
        assert_eq!(head[outside as usize..][..4], [0, first_of_all, 50, second_of_all]);
        assert_eq!(lists, records + 5 * cell_count(&iterations));
        let last = format!("read_vec3(start + {}u)", ABOUT_CELLS - 3);
        assert!(sdfc_march::culling_source().contains(&last));
    }
}
