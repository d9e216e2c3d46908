// Where lists of rounds are in `visits`. It begins with where the first tile's record is, how far apart these are, how many rounds
// of a loop a tile's lists hold together, how many words of 32 rounds the longest loop has, how many loops there are, where what
// tells of the cells stands, and how many rounds are kept while a tile's lists are made. A record tells how many slices the tile's rays are cut into, where the second would begin if the first had their length, and that length; then for
// each slice and loop how many rounds are to be visited, and where their numbers stand, in ascending order.

const FIRST_RECORD: u32 = 0;
const RECORD_STRIDE: u32 = 1;
const CAPACITY: u32 = 2;
const MAX_WORDS: u32 = 3;
const LOOPS: u32 = 4;
const CELLS: u32 = 5;
const MAX_SCRATCH: u32 = 6;
// What stands in a record for a slice, by which all rounds are visited.
const ALL_ITERATIONS: u32 = 7;

const SLICE_COUNT: u32 = 0;
const NEAR: u32 = 1;
const SLICE_LENGTH: u32 = 2;
const FIRST_SLICE: u32 = 3;
const MAX_SLICES: u32 = 16;

// The sides of a tile, which has lists of its own: a workgroup's.
const TILE: u32 = 8;

fn tile_counts() -> vec2u {
    return (view.tile_size + (TILE - 1u)) / TILE;
}

// Where a slice begins and ends: the first at the eye, the last where rays do.
fn slice_ends(slice: u32, slices: u32, near: f32, length: f32) -> vec2f {
    let start = select(near + f32(slice) * length, 0.0, slice == 0u);
    let end = select(near + f32(slice + 1u) * length, view.t_max, slice + 1u == slices);
    return vec2f(start, end);
}

// Cells of equal size fill a box, each with a record, and how far the middle of the cell is from where any round can matter to a ray. To
// each axis there are so many groups of cells.
const GROUP_SIDE: u32 = 8;

// What tells of the cells: in this order, numbers of three lanes as those of 32 bits that they are.
struct Cells {
    // How many loops a record is of; none: there are no cells.
    loops: u32,
    // How many cells of a group there are to an axis.
    group: u32,
    // The first record, and the one of where no loop matters that is left out.
    first: u32,
    outside: u32,
    // Where lists of rounds begin and end.
    lists: u32,
    lists_end: u32,
    // From how far away on what is in a cell is not looked at.
    least_step: f32,
    // The corner of the first cell, and how many cells there are to a unit of length.
    low: vec3f,
    per_unit: vec3f,
    // The box that all of them that hold a surface are in.
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
