// Before a picture: which rounds of the scene's loops can matter to the rays through each tile's pixels. A round can where its operand,
// less what it reaches beyond its surface, is not above 0 somewhere in a cone around the rays. The operand is itself
// marched along the middle of the cone, which is as sound as a field's march.
//
// Wide tiles come first, and a tile asks only for the rounds that can matter to the wider one that it is part of. Those of wide tiles
// are marked; those of the narrowest are listed.

@group(0) @binding(4) var<storage, read_write> active_lists: array<u32>;
// For each loop and tile of each level from 1 on, a bit for each round that can matter. Then for each tile of level 0 what is kept of
// rounds while it is listed: two words, the number, and where the round matters.
@group(0) @binding(5) var<storage, read_write> masks: array<u32>;
// The level at hand. The tiles of level 0 have lists, those of each other, which have marks, are two by two of the one below.
@group(0) @binding(6) var<uniform> level: u32;
// How much of the cells' lists is filled; how many operands were evaluated; then for each loop and group of cells the least operand
// there, as a word that is ordered as it is.
@group(0) @binding(7) var<storage, read_write> counters: array<atomic<u32>>;

const FILLED: u32 = 0;
const EVALUATED: u32 = 1;
const LEAST_OPERANDS: u32 = 2;

const TOP_LEVEL: u32 = 4;
const WIDER_BITS: u32 = 1;

// Supplied by the scene, as many as it has loops: how far a point is from where a round can matter to a ray, or less; the round's operand
// less what blends reach; the operand.

fn culling_bounds_0(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_1(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_2(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_3(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_4(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_5(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_6(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn culling_bounds_7(iteration: f32, p: vec3f) -> vec3f {
    return vec3f();
}

// How many operands were evaluated, where that is counted.
var<private> evaluated: u32;

fn culling_bounds(loop_index: u32, iteration: f32, p: vec3f) -> vec3f {
    if INSTRUMENTED {
        evaluated++;
    }
    switch loop_index {
        case 0u: {
            return culling_bounds_0(iteration, p);
        }
        case 1u: {
            return culling_bounds_1(iteration, p);
        }
        case 2u: {
            return culling_bounds_2(iteration, p);
        }
        case 3u: {
            return culling_bounds_3(iteration, p);
        }
        case 4u: {
            return culling_bounds_4(iteration, p);
        }
        case 5u: {
            return culling_bounds_5(iteration, p);
        }
        case 6u: {
            return culling_bounds_6(iteration, p);
        }
        default: {
            return culling_bounds_7(iteration, p);
        }
    }
}

// At the end of each stage.
fn add_evaluated() {
    if INSTRUMENTED {
        atomicAdd(&counters[EVALUATED], evaluated);
    }
}

// Rays that start and lead near others: those through the pixels of a tile.
struct Cone {
    origin: vec3f,
    // How far from the middle they are where they start, and what that gains per unit of length.
    radius: f32,
    direction: vec3f,
    spread: f32,
    // What of that is added, since what is hit is nearer than a pixel.
    margin: Margin,
}

struct Margin {
    radius: f32,
    spread: f32,
}

// Part of its width that a cone is made wider by, so that marches along it end.
const SLACK: f32 = 0.1;
// An operand that is not told by so many steps can matter from there on.
const MAX_STEPS: u32 = 32;

fn side_of(at: u32) -> u32 {
    return TILE << (WIDER_BITS * at);
}

fn counts_of(at: u32) -> vec2u {
    let side = side_of(at);
    return (view.tile_size + (side - 1u)) / side;
}

fn cone_around(tile: vec2u) -> Cone {
    let corner = view.tile_origin + side_of(level) * tile;
    let side = f32(side_of(level));
    let middle = ray_through(vec2f(corner) + 0.5 * side);
    let margin = Margin(2.0 * middle.radius, 2.0 * middle.spread);
    var cone = Cone(middle.origin, 0.0, middle.direction, 0.0, margin);
    for (var i = 0u; i < 4u; i++) {
        let ray = ray_through(vec2f(corner) + side * vec2f(vec2u(i & 1u, i >> 1u)));
        cone.radius = max(cone.radius, distance(ray.origin, middle.origin));
        cone.spread = max(cone.spread, distance(ray.direction, middle.direction));
    }
    cone.radius += margin.radius;
    cone.spread += margin.spread;
    return cone;
}

// How far a round is from mattering to the cone at a place along it; less than 0 where it is so near that steps would not end, or no number.
fn distance_at(cone: Cone, loop_index: u32, iteration: f32, t: f32) -> f32 {
    let wide = cone.radius + cone.spread * t;
    let free = culling_bounds(loop_index, iteration, cone.origin + t * cone.direction).x - wide;
    return select(-1.0, free, free > SLACK * wide + ROUNDING * (length(cone.origin) + t));
}

// Where a round begins to matter to the cone, or a place beyond the end of rays where it does not.
fn entry(cone: Cone, loop_index: u32, iteration: f32) -> f32 {
    var t = 0.0;
    for (var step = 0u; step < MAX_STEPS && t <= view.t_max; step++) {
        let free = distance_at(cone, loop_index, iteration, t);
        if free < 0.0 {
            break;
        }
        t += free / (1.0 + cone.spread);
    }
    return t;
}

// Where it begins to, and where it ceases to, which is looked for from the end of rays back. One call of `free_at`: drivers inline it
// wherever it is called.
fn active_interval(cone: Cone, loop_index: u32, iteration: f32) -> vec2f {
    var ends = vec2f(0.0, view.t_max);
    var is_back = false;
    var steps = 0u;
    while steps < MAX_STEPS && ends.x < ends.y {
        let free = distance_at(cone, loop_index, iteration, select(ends.x, ends.y, is_back));
        steps++;
        if !is_back && free >= 0.0 {
            ends.x += free / (1.0 + cone.spread);
        }
        // Nearer to the eye the cone is no wider.
        if is_back && free >= 0.0 {
            ends.y -= free;
        }
        if free < 0.0 || steps == MAX_STEPS {
            if is_back {
                break;
            }
            is_back = true;
            steps = 0u;
        }
    }
    return vec2f(ends.x, max(ends.x, ends.y));
}

// Where the marks of a tile are: those of level 1 come first.
fn mask_words(at: u32, tile: vec2u, loop_index: u32) -> u32 {
    var before = 0u;
    for (var below = 1u; below < at; below++) {
        let counts = counts_of(below);
        before += active_lists[LOOPS] * counts.x * counts.y;
    }
    let counts = counts_of(at);
    return (before + (loop_index * counts.y + tile.y) * counts.x + tile.x) * active_lists[MAX_WORDS];
}

@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u) {
    let word = id.x;
    let loop_index = id.z;
    let count_all = active_lists[ALL_ITERATIONS + 2u * loop_index];
    let counts = counts_of(level);
    if id.y >= counts.x * counts.y || 32u * word >= count_all {
        return;
    }
    load_frame();
    let tile = vec2u(id.y % counts.x, id.y / counts.x);
    let cone = cone_around(tile);
    var candidates = 0xffffffffu >> (32u - min(32u, count_all - 32u * word));
    if level < TOP_LEVEL {
        candidates = masks[mask_words(level + 1u, tile >> vec2u(WIDER_BITS), loop_index) + word];
    }
    var bits = 0u;
    while candidates != 0u {
        let i = firstTrailingBit(candidates);
        candidates &= candidates - 1u;
        if entry(cone, loop_index, f32(32u * word + i)) <= view.t_max {
            bits |= 1u << i;
        }
    }
    masks[mask_words(level, tile, loop_index) + word] = bits;
    add_evaluated();
}

// A stretch of rays in one word, as parts of their length: no less than it is.
const FRACTION_STEPS: f32 = 65535.0;

fn packed_interval(interval: vec2f) -> u32 {
    let ends = FRACTION_STEPS / view.t_max * interval;
    return u32(clamp(floor(ends.x), 0.0, FRACTION_STEPS)) | (u32(clamp(ceil(ends.y), 0.0, FRACTION_STEPS)) << 16u);
}

fn unpacked_interval(word: u32) -> vec2f {
    return vec2f(vec2u(word & 0xffffu, word >> 16u)) * (view.t_max / FRACTION_STEPS);
}

// Rays are cut into a slice for each so many rounds that can matter to their tile.
const ITERATIONS_PER_SLICE: u32 = 4;
const MAX_LOOPS: u32 = 8;

// First it is found where the rounds matter that do; then, slice by slice, they are listed.
@compute @workgroup_size(64)
fn list(@builtin(global_invocation_id) id: vec3u) {
    let tiles = tile_counts();
    if id.x >= tiles.x * tiles.y {
        return;
    }
    load_frame();
    let tile = vec2u(id.x % tiles.x, id.x / tiles.x);
    let cone = cone_around(tile);
    let loops = active_lists[LOOPS];
    let max_scratch = active_lists[MAX_SCRATCH];
    let scratch = mask_words(TOP_LEVEL + 1u, vec2u(), 0u) + id.x * 2u * max_scratch;
    var near = view.t_max;
    var far = 0.0;
    var count = 0u;
    // How many there are when those of a loop have been counted.
    var counts: array<u32, MAX_LOOPS>;
    for (var loop_index = 0u; loop_index < loops; loop_index++) {
        let count_all = active_lists[ALL_ITERATIONS + 2u * loop_index];
        let words = mask_words(1u, tile >> vec2u(WIDER_BITS), loop_index);
        for (var word = 0u; 32u * word < count_all; word++) {
            var bits = masks[words + word];
            while bits != 0u {
                let iteration = 32u * word + firstTrailingBit(bits);
                bits &= bits - 1u;
                let interval = active_interval(cone, loop_index, f32(iteration));
                if interval.x <= view.t_max {
                    if count < max_scratch {
                        masks[scratch + 2u * count] = iteration;
                        masks[scratch + 2u * count + 1u] = packed_interval(interval);
                    }
                    near = min(near, interval.x);
                    far = max(far, interval.x);
                    count++;
                }
            }
        }
        counts[loop_index] = count;
    }
    let slices = clamp(count / ITERATIONS_PER_SLICE, 1u, MAX_SLICES);
    let slice_length = max(far - near, 0.0) / f32(slices);
    let record = active_lists[FIRST_RECORD] + id.x * active_lists[RECORD_STRIDE];
    let capacity = active_lists[CAPACITY];
    var listed: array<u32, MAX_LOOPS>;
    for (var slice = 0u; slice < slices; slice++) {
        // A gradient by differences is taken a little beyond a slice.
        var ends = slice_ends(slice, slices, near, slice_length);
        let beyond = cone.margin.radius + cone.margin.spread * ends.y;
        ends += vec2f(-beyond, beyond);
        var index = 0u;
        for (var loop_index = 0u; loop_index < loops; loop_index++) {
            let list = record + FIRST_SLICE + 2u * MAX_SLICES * loops + loop_index * capacity;
            let first = listed[loop_index];
            var next = first;
            while index < min(counts[loop_index], max_scratch) {
                let interval = unpacked_interval(masks[scratch + 2u * index + 1u]);
                if interval.x <= ends.y && interval.y >= ends.x {
                    if next < capacity {
                        active_lists[list + next] = masks[scratch + 2u * index];
                    }
                    next++;
                }
                index++;
            }
            let at = record + FIRST_SLICE + 2u * (slice * loops + loop_index);
            // Where there is no room, all rounds are visited.
            if counts[loop_index] <= max_scratch && next <= capacity {
                active_lists[at] = next - first;
                active_lists[at + 1u] = list + first;
                listed[loop_index] = next;
            } else {
                active_lists[at] = active_lists[ALL_ITERATIONS + 2u * loop_index];
                active_lists[at + 1u] = active_lists[ALL_ITERATIONS + 2u * loop_index + 1u];
            }
        }
    }
    active_lists[record + SLICE_COUNT] = slices;
    active_lists[record + NEAR] = bitcast<u32>(near);
    active_lists[record + SLICE_LENGTH] = bitcast<u32>(slice_length);
    add_evaluated();
}
