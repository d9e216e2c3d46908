// Where lists of rounds are in `visits`. It begins with where the first tile's record is, how far apart these are, how many rounds
// of a loop a tile's list holds, and how many words of 32 rounds the longest loop has. A record has for each loop how many rounds
// are to be visited, and where their numbers stand, in ascending order.

const FIRST_RECORD: u32 = 0;
const RECORD_STRIDE: u32 = 1;
const CAPACITY: u32 = 2;
const MOST_WORDS: u32 = 3;
// The record by which all rounds are visited.
const WHOLE: u32 = 4;

// The sides of a tile, which has a list of its own: a workgroup's.
const TILE: u32 = 8;

fn tile_counts() -> vec2u {
    return (view.tile_size + (TILE - 1u)) / TILE;
}
