// Which rounds of the scene's loops are visited: those that can matter to rays from the eye through a workgroup's pixels, or all.

@group(0) @binding(4) var<storage, read> visits: array<u32>;

// The record of the tile, and the one to go by; the scene's functions read the latter.
var<private> own_record: u32;
var<private> visit_record: u32;

// Before a pixel.
fn open_visits(place: vec2u) {
    let tile = place / TILE;
    own_record = visits[FIRST_RECORD] + (tile.y * tile_counts().x + tile.x) * visits[RECORD_STRIDE];
    visit_record = own_record;
}
