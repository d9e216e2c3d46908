// Where lists of rounds are in `visits`. It begins with where the first tile's record is, how far apart these are, how many rounds
// of a loop a tile's lists hold together, how many words of 32 rounds the longest loop has, and how many loops there are. A record
// tells how many slices the tile's rays are cut into, where the second would begin if the first had their length, and that length; then for
// each slice and loop how many rounds are to be visited, and where their numbers stand, in ascending order.

const FIRST_RECORD: u32 = 0;
const RECORD_STRIDE: u32 = 1;
const CAPACITY: u32 = 2;
const MOST_WORDS: u32 = 3;
const LOOPS: u32 = 4;
// What stands in a record for a slice, by which all rounds are visited.
const WHOLE: u32 = 5;

const SLICE_COUNT: u32 = 0;
const NEAR: u32 = 1;
const SLICE_LENGTH: u32 = 2;
const FIRST_SLICE: u32 = 3;
const MOST_SLICES: u32 = 8;

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
