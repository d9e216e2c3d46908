// Which rounds of the scene's loops are visited: by rays from the eye those that can matter to a workgroup's pixels, by others, which go
// anywhere, those that can matter in the cell that they are in; or all.

@group(0) @binding(4) var<storage, read> visits: array<u32>;

// The record of the tile.
var<private> own_record: u32;

// How many rounds of each loop to visit, and where the number of the first stands; the scene's functions read these. Kept here,
// since reading them from the buffer at each place takes as long as visiting a round.
var<private> visit_spans: array<vec2u, 8>;

fn span_at(record: u32, which: u32) -> vec2u {
    return vec2u(visits[record + 2u * which], visits[record + 2u * which + 1u]);
}

// Spans of loops that the scene does not have are read by nothing, and go when it is compiled.
fn visit_by(record: u32) {
    visit_spans[0] = span_at(record, 0u);
    visit_spans[1] = span_at(record, 1u);
    visit_spans[2] = span_at(record, 2u);
    visit_spans[3] = span_at(record, 3u);
    visit_spans[4] = span_at(record, 4u);
    visit_spans[5] = span_at(record, 5u);
    visit_spans[6] = span_at(record, 6u);
    visit_spans[7] = span_at(record, 7u);
}

// What is left out of the rounds that are visited is no nearer than this to the place at hand.
const NOTHING_LEFT_OUT: f32 = 1e30;
var<private> visit_free: f32 = NOTHING_LEFT_OUT;

// Whether the rays at hand go by cells, and up to what the distance must be known, and not only that it is no less.
var<private> roams: bool;
var<private> known_to: f32;

var<private> cells: Cells;

// How many rounds the scene's functions have visited, where that is counted.
var<private> visited: u32;

// Before a pixel.
fn open_visits(place: vec2u) {
    let tile = place / TILE;
    own_record = visits[FIRST_RECORD] + (tile.y * tile_counts().x + tile.x) * visits[RECORD_STRIDE];
    if ROAMING {
        cells = cells_at(visits[CELLS]);
        // Nothing roams yet: this keeps the function until the scene's functions call it.
        visit_at(vec3f());
    }
}

// What a ray meets: one from the eye, slice after slice, each by its own lists; another by what can matter where it is.
fn trace_listed(ray: Ray, is_from_eye: bool) -> Trace {
    var slices = 1u;
    var near = 0.0;
    var length = 0.0;
    if is_from_eye {
        slices = visits[own_record + SLICE_COUNT];
        near = bitcast<f32>(visits[own_record + NEAR]);
        length = bitcast<f32>(visits[own_record + SLICE_LENGTH]);
    }
    if ROAMING {
        if is_from_eye {
            stay();
        } else {
            visit_cells(0.0);
            if SOFT_SHADOWS {
                if watched {
                    // Where it is asked how narrowly it passes decides what is found.
                    visit_all();
                }
            }
        }
    }
    var found = Trace(0.0, MISS, 0u);
    for (var slice = 0u; slice < slices; slice++) {
        var part = ray;
        var start = 0.0;
        if is_from_eye {
            visit_by(own_record + FIRST_SLICE + 2u * slice * visits[LOOPS]);
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

// Before any other, and before distances up to some are asked for elsewhere.
fn visit_cells(known: f32) {
    visit_all();
    roams = cells.loops > 0u;
    known_to = known;
}

fn visit_all() {
    visit_by(WHOLE);
    stay();
}

// What is visited is the same everywhere.
fn stay() {
    visit_free = NOTHING_LEFT_OUT;
    roams = false;
}

// The scene's functions call this before they read what to visit.
fn visit_at(p: vec3f) {
    if ROAMING {
        if roams {
            var record = cells.outside;
            // How near what the loops are of can be; the box of that is some way from the border of the cells.
            var free = length(max(max(cells.box_low - p, p - cells.box_high), vec3f()));
            var own = WHOLE;
            var enough = 0.0;
            let place = (p - cells.low) * cells.per_unit;
            if all(place >= vec3f()) && all(place < vec3f(f32(cells_to_axis(cells)))) {
                let cell = vec3u(place);
                own = record_of_cell(cells, cell);
                let middle = length((place - vec3f(cell) - 0.5) / cells.per_unit);
                free = bitcast<f32>(visits[own + 2u * cells.loops]) - middle;
                enough = cells.least_step;
            }
            visit_free = free;
            if free < max(enough, known_to) {
                record = own;
                visit_free = NOTHING_LEFT_OUT;
            }
            visit_by(record);
        }
    }
}
