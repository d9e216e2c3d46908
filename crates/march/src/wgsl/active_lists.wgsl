// Which rounds of the scene's loops are visited: by rays from the eye those that can matter to a workgroup's pixels, by others, which go
// anywhere, those that can matter in the cell that they are in; or all.

@group(0) @binding(4) var<storage, read> active_lists: array<u32>;

// The record of the tile.
var<private> tile_record: u32;

// How many rounds of each loop to visit, and where the number of the first stands; the scene's functions read these. Kept here,
// since reading them from the buffer at each place takes as long as visiting a round.
var<private> active_spans: array<vec2u, 8>;

fn span_at(record: u32, loop_index: u32) -> vec2u {
    return vec2u(active_lists[record + 2u * loop_index], active_lists[record + 2u * loop_index + 1u]);
}

// Spans of loops that the scene does not have are read by nothing, and go when it is compiled.
fn use_lists(record: u32) {
    active_spans[0] = span_at(record, 0u);
    active_spans[1] = span_at(record, 1u);
    active_spans[2] = span_at(record, 2u);
    active_spans[3] = span_at(record, 3u);
    active_spans[4] = span_at(record, 4u);
    active_spans[5] = span_at(record, 5u);
    active_spans[6] = span_at(record, 6u);
    active_spans[7] = span_at(record, 7u);
}

// What is left out of the rounds that are visited is no nearer than this to the place at hand.
const NOTHING_INACTIVE: f32 = 1e30;
var<private> inactive_distance: f32 = NOTHING_INACTIVE;

// Whether the rays at hand go by cells, and up to what the distance must be known, and not only that it is no less.
var<private> selects_by_cell: bool;
var<private> exact_up_to: f32;

var<private> cells: Cells;

// How many rounds the scene's functions have visited, where that is counted.
var<private> iterations_run: u32;

// Before a pixel.
fn start_pixel(position: vec2u) {
    let tile = position / TILE;
    tile_record = active_lists[FIRST_RECORD] + (tile.y * tile_counts().x + tile.x) * active_lists[RECORD_STRIDE];
    if CULLED_BY_CELL {
        cells = read_cells(active_lists[CELLS]);
        // Nothing roams yet: this keeps the function until the scene's functions call it.
        select_lists(vec3f());
    }
}

// What a ray meets: one from the eye, slice after slice, each by its own lists; another by what can matter where it is.
fn trace_culled(ray: Ray, is_from_eye: bool) -> Trace {
    var slices = 1u;
    var near = 0.0;
    var length = 0.0;
    if is_from_eye {
        slices = active_lists[tile_record + SLICE_COUNT];
        near = bitcast<f32>(active_lists[tile_record + NEAR]);
        length = bitcast<f32>(active_lists[tile_record + SLICE_LENGTH]);
    }
    if CULLED_BY_CELL {
        if is_from_eye {
            use_everywhere();
        } else {
            use_cells(0.0);
            if SOFT_SHADOWS {
                if records_clearance {
                    // Where it is asked how narrowly it passes decides what is found.
                    use_all();
                }
            }
        }
    }
    var found = Trace(0.0, MISS, 0u);
    for (var slice = 0u; slice < slices; slice++) {
        var segment = ray;
        var start = 0.0;
        if is_from_eye {
            use_lists(tile_record + FIRST_SLICE + 2u * slice * active_lists[LOOPS]);
            let ends = slice_ends(slice, slices, near, length);
            start = ends.x;
            segment.origin = ray_point(ray, start);
            segment.radius = footprint(ray, start);
            segment.t_max = ends.y - start;
        }
        let hit = trace(segment);
        found = Trace(start + hit.t, hit.status, found.evaluations + hit.evaluations);
        // Nor does a ray go on where the field is no number.
        if hit.status != MISS || !(hit.t >= segment.t_max) {
            break;
        }
    }
    return found;
}

// Before any other, and before distances up to some are asked for elsewhere.
fn use_cells(up_to: f32) {
    use_all();
    selects_by_cell = cells.loops > 0u;
    exact_up_to = up_to;
}

fn use_all() {
    use_lists(ALL_ITERATIONS);
    use_everywhere();
}

// What is visited is the same everywhere.
fn use_everywhere() {
    inactive_distance = NOTHING_INACTIVE;
    selects_by_cell = false;
}

// The scene's functions call this before they read what to visit.
fn select_lists(p: vec3f) {
    if CULLED_BY_CELL {
        if selects_by_cell {
            var record = cells.outside;
            // How near what the loops are of can be; the box of that is some way from the border of the cells.
            var free = length(max(max(cells.box_low - p, p - cells.box_high), vec3f()));
            var record_here = ALL_ITERATIONS;
            var required = 0.0;
            let position = (p - cells.low) * cells.per_unit;
            if all(position >= vec3f()) && all(position < vec3f(f32(cells_to_axis(cells)))) {
                let cell = vec3u(position);
                record_here = record_of_cell(cells, cell);
                let middle = length((position - vec3f(cell) - 0.5) / cells.per_unit);
                free = bitcast<f32>(active_lists[record_here + 2u * cells.loops]) - middle;
                required = cells.least_step;
            }
            inactive_distance = free;
            if free < max(required, exact_up_to) {
                record = record_here;
                inactive_distance = NOTHING_INACTIVE;
            }
            use_lists(record);
        }
    }
}
