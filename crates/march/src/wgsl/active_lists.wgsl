// Which iterations of the scene's loops are run. Camera rays run those that can affect the pixels
// of their workgroup; secondary rays, which lead anywhere, those that can affect the cell that they
// are in; otherwise all are run.

@group(0) @binding(4) var<storage, read> active_lists: array<u32>;

// Index of the tile's record.
var<private> tile_record: u32;

// For each loop, the number of iterations to run and the index of the first one's number in
// `active_lists`. The scene's functions read this. It is kept in private memory, since reading it
// from the buffer for each sample takes as long as running an iteration.
var<private> active_spans: array<vec2u, 8>;

fn span_at(record: u32, loop_index: u32) -> vec2u {
    return vec2u(active_lists[record + 2u * loop_index], active_lists[record + 2u * loop_index + 1u]);
}

// The spans of loops that the scene does not have are never read, and removed by the compiler.
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

// A lower bound on the distance from the sample point to what the lists leave out.
const NOTHING_INACTIVE: f32 = 1e30;
var<private> inactive_distance: f32 = NOTHING_INACTIVE;

// True if the current rays select lists by cell. Distances up to `exact_up_to` must be exact;
// farther away a lower bound is enough.
var<private> selects_by_cell: bool;
var<private> exact_up_to: f32;

// The ray whose clearance is recorded.
var<private> recorded_ray: Ray;

var<private> cells: Cells;

// The number of iterations that the scene's functions have run, if that is counted.
var<private> iterations_run: u32;

// Call before the first ray of a pixel; `position` is relative to the tile of the picture.
fn start_pixel(position: vec2u) {
    let tile = position / TILE;
    tile_record = active_lists[FIRST_RECORD] + (tile.y * tile_counts().x + tile.x) * active_lists[RECORD_STRIDE];
    if CULLED_BY_CELL {
        cells = read_cells(active_lists[CELLS]);
        // Nothing selects lists by cell yet: this call keeps the function alive until the scene's
        // functions, which call it, replace their stubs.
        select_lists(vec3f());
    }
}

// Traces a ray. A camera ray is traced slice by slice, each slice with its own lists; other rays
// use the lists of the cells that they pass.
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
                    // The clearance of the ray depends on where it is sampled, so distances must be
                    // exact.
                    use_cells(NOTHING_INACTIVE);
                    recorded_ray = ray;
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
        // The negation also ends a ray whose t is not a number.
        if hit.status != MISS || !(hit.t >= segment.t_max) {
            break;
        }
    }
    return found;
}

// Call before tracing a secondary ray or sampling the field elsewhere. Distances up to `up_to` will
// be exact.
fn use_cells(up_to: f32) {
    use_all();
    selects_by_cell = cells.loops > 0u;
    exact_up_to = up_to;
}

fn use_all() {
    use_lists(ALL_ITERATIONS);
    use_everywhere();
}

// Uses the same lists everywhere.
fn use_everywhere() {
    inactive_distance = NOTHING_INACTIVE;
    selects_by_cell = false;
}

// The distance up to which a sample outside the box of cells must be exact. A ray that leads away
// from the box never meets it again, and a clearance of twice the least one so far, or of twice
// that of full light, has no effect.
fn exact_distance_outside(p: vec3f) -> f32 {
    if SOFT_SHADOWS {
        if records_clearance {
            let outward = p - clamp(p, cells.box_low, cells.box_high);
            if dot(outward, recorded_ray.direction) >= 0.0 {
                return 2.0 * min(full_light, clearance) * length(p - recorded_ray.origin);
            }
        }
    }
    return exact_up_to;
}

// Selects the lists for a sample point. The scene's functions call this before they run their
// loops.
fn select_lists(p: vec3f) {
    if CULLED_BY_CELL {
        if selects_by_cell {
            var record = cells.outside;
            // A lower bound on the distance to the loops' surfaces; their box keeps some distance
            // from the border of the cells.
            var free = length(max(max(cells.box_low - p, p - cells.box_high), vec3f()));
            var record_here = ALL_ITERATIONS;
            var required = 0.0;
            var exact = exact_up_to;
            let position = (p - cells.low) * cells.per_unit;
            if all(position >= vec3f()) && all(position < vec3f(f32(cells_to_axis(cells)))) {
                let cell = vec3u(position);
                record_here = record_of_cell(cells, cell);
                let middle = length((position - vec3f(cell) - 0.5) / cells.per_unit);
                free = bitcast<f32>(active_lists[record_here + 2u * cells.loops]) - middle;
                required = cells.least_step;
            } else {
                exact = exact_distance_outside(p);
            }
            inactive_distance = free;
            if free < max(required, exact) {
                record = record_here;
                inactive_distance = NOTHING_INACTIVE;
            }
            use_lists(record);
        }
    }
}
