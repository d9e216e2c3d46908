// Which rounds of the scene's loops are visited: those that can matter to rays from the eye through a workgroup's pixels, or all.

@group(0) @binding(4) var<storage, read> visits: array<u32>;

// The record of the tile, and where it stands which rounds to visit; the scene's functions read the latter.
var<private> own_record: u32;
var<private> visit_record: u32;

// Before a pixel.
fn open_visits(place: vec2u) {
    let tile = place / TILE;
    own_record = visits[FIRST_RECORD] + (tile.y * tile_counts().x + tile.x) * visits[RECORD_STRIDE];
}

// What a ray meets: one from the eye, slice after slice, each by its own lists; another by all rounds.
fn trace_listed(ray: Ray, is_from_eye: bool) -> Trace {
    var slices = 1u;
    if is_from_eye {
        slices = visits[own_record + SLICE_COUNT];
    }
    visit_record = WHOLE;
    var found = Trace(0.0, MISS, 0u);
    for (var slice = 0u; slice < slices; slice++) {
        var part = ray;
        var start = 0.0;
        if is_from_eye {
            visit_record = own_record + FIRST_SLICE + 2u * slice * visits[LOOPS];
            let near = bitcast<f32>(visits[own_record + NEAR]);
            let length = bitcast<f32>(visits[own_record + SLICE_LENGTH]);
            let ends = slice_ends(slice, slices, near, length);
            start = ends.x;
            part.origin = ray_point(ray, start);
            part.radius = footprint(ray, start);
            part.t_max = ends.y - start;
        }
        let met = trace(part);
        found = Trace(start + met.t, met.status, found.evaluations + met.evaluations);
        // Nor does a ray go on where the field is no number.
        if met.status != MISS || !(met.t >= part.t_max) {
            break;
        }
    }
    return found;
}
