// The layout of `active_lists`: which iterations of the scene's loops to run.
//
// The buffer begins with seven words: the index of the first tile's record, the distance between
// records, the capacity of a tile's lists per loop, the number of 32-iteration mask words of the
// longest loop, the number of loops, the index of the `Cells` record, and the number of iterations
// that fit into the scratch space of a tile.
//
// A tile's record holds the number of slices that the tile's rays are cut into, the position where
// the second slice would begin if the first had the common length, and that length. Then come, for
// each slice and loop, the number of iterations to run and the index of the first one's number. The
// numbers ascend.

const FIRST_RECORD: u32 = 0;
const RECORD_STRIDE: u32 = 1;
const CAPACITY: u32 = 2;
const MAX_WORDS: u32 = 3;
const LOOPS: u32 = 4;
const CELLS: u32 = 5;
const MAX_SCRATCH: u32 = 6;
// Index of the entries that stand for a slice in which all iterations are run.
const ALL_ITERATIONS: u32 = 7;

const SLICE_COUNT: u32 = 0;
const NEAR: u32 = 1;
const SLICE_LENGTH: u32 = 2;
const FIRST_SLICE: u32 = 3;
const MAX_SLICES: u32 = 16;

// Side of a tile in pixels. Each tile has its own lists; it is the size of a workgroup.
const TILE: u32 = 8;

fn tile_counts() -> vec2u {
    return (view.tile_size + (TILE - 1u)) / TILE;
}

// The interval of a slice along the ray: the first begins at the eye, the last ends where rays end.
fn slice_ends(slice: u32, slices: u32, near: f32, length: f32) -> vec2f {
    let start = select(near + f32(slice) * length, 0.0, slice == 0u);
    let end = select(near + f32(slice + 1u) * length, view.t_max, slice + 1u == slices);
    return vec2f(start, end);
}

// Cells of equal size fill a box. Each has a record and a lower bound on the distance from the
// cell's centre to where any iteration can affect a ray. There are this many groups of cells along
// each axis.
const GROUP_SIDE: u32 = 8;

// The description of the cells, in this order; vectors are stored as three words.
struct Cells {
    // The number of loops in a record; 0 if there are no cells.
    loops: u32,
    // The number of cells of a group along an axis.
    group: u32,
    // Index of the first record, and of the record used outside the box of surfaces.
    first: u32,
    outside: u32,
    // The index range of the cells' lists.
    lists: u32,
    lists_end: u32,
    // The distance to a cell's contents from which the bound alone is used as a step.
    least_step: f32,
    // The lowest corner of the first cell, and the number of cells per unit of length.
    low: vec3f,
    per_unit: vec3f,
    // The box that contains all surfaces of the loops.
    box_low: vec3f,
    box_high: vec3f,
}

fn cells_to_axis(cells: Cells) -> u32 {
    return GROUP_SIDE * cells.group;
}

fn record_of_cell(cells: Cells, cell: vec3u) -> u32 {
    let side = cells_to_axis(cells);
    return cells.first + (2u * cells.loops + 1u) * ((cell.z * side + cell.y) * side + cell.x);
}
