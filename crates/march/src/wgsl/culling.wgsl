// Runs before a picture: finds which iterations of the scene's loops can affect the rays through
// each tile's pixels. An iteration can if its operand, minus the distance that it reaches beyond
// its surface, is at most 0 somewhere in a cone around the rays. The operand itself is marched
// along the axis of the cone, which is as safe as marching a field.
//
// Wide tiles come first. A tile tests only the iterations that can affect the wider tile that it is
// part of. Wide tiles have bit masks; the narrowest have lists.

@group(0) @binding(4) var<storage, read_write> active_lists: array<u32>;
// For each loop and each tile of every level from 1 on: one bit per iteration that can affect the
// tile. Then, for each tile of level 0, scratch space while its lists are made: two words per
// iteration, its number and the packed interval in which it matters.
@group(0) @binding(5) var<storage, read_write> masks: array<u32>;
// The current level. Tiles of level 0 have lists. A tile of any other level has masks and covers
// two by two tiles of the level below.
@group(0) @binding(6) var<uniform> level: u32;
// The filled length of the cells' lists; the number of operands evaluated; then, for each loop and
// group of cells, the least operand there, as a word with the same order.
@group(0) @binding(7) var<storage, read_write> counters: array<atomic<u32>>;

const FILLED: u32 = 0;
const EVALUATED: u32 = 1;
const LEAST_OPERANDS: u32 = 2;

const TOP_LEVEL: u32 = 4;
const WIDER_BITS: u32 = 1;

// Supplied by the scene, one for each of its loops. x: lower bound on the distance to where the
// iteration can affect a ray. y: the operand minus the blend radius. z: the operand.

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

// The number of operands evaluated, if that is counted.
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

// Call at the end of each entry point.
fn add_evaluated() {
    if INSTRUMENTED {
        atomicAdd(&counters[EVALUATED], evaluated);
    }
}

// A cone around rays that start and lead close together: those through the pixels of a tile.
struct Cone {
    origin: vec3f,
    // Distance of the rays from the axis at their origin, and its growth per unit of length.
    radius: f32,
    direction: vec3f,
    spread: f32,
    // The part of radius and spread that was added because a hit is less than a pixel away.
    margin: Margin,
}

struct Margin {
    radius: f32,
    spread: f32,
}

// Margin by which a cone is widened, as a fraction of its width, so that marches along it end.
const SLACK: f32 = 0.1;
// If this many steps do not decide where an operand can matter, it counts from there on.
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

// The distance at position t of the cone's axis within which the iteration cannot affect the cone;
// negative if it is too small for steps to end, or not a number.
fn distance_at(cone: Cone, loop_index: u32, iteration: f32, t: f32) -> f32 {
    let wide = cone.radius + cone.spread * t;
    let free = culling_bounds(loop_index, iteration, cone.origin + t * cone.direction).x - wide;
    return select(-1.0, free, free > SLACK * wide + ROUNDING * (length(cone.origin) + t));
}

// The position where an iteration begins to affect the cone; beyond the end of rays if it never
// does.
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

// The interval in which an iteration can affect the cone; its end is searched for from the end of
// rays backwards. There is one call of `distance_at`: drivers inline it wherever it is called.
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

// True at this level. The result depends on the invocation, too: Mesa's software driver compiles a
// shader anew for each level if a branch depends on the level alone.
fn is_level(at: u32, id: vec3u) -> bool {
    return level == at && id.x <= 0x7fffffffu;
}

// Index of a tile's masks; those of level 1 come first.
fn mask_words(at: u32, tile: vec2u, loop_index: u32) -> u32 {
    var before = 0u;
    for (var below = 1u; below <= TOP_LEVEL; below++) {
        let counts = counts_of(below);
        before += select(0u, active_lists[LOOPS] * counts.x * counts.y, below < at);
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
    if !is_level(TOP_LEVEL, id) {
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

// An interval in one word, its ends as fractions of the rays' length, rounded outwards.
const FRACTION_STEPS: f32 = 65535.0;

fn packed_interval(interval: vec2f) -> u32 {
    let ends = FRACTION_STEPS / view.t_max * interval;
    return u32(clamp(floor(ends.x), 0.0, FRACTION_STEPS)) | (u32(clamp(ceil(ends.y), 0.0, FRACTION_STEPS)) << 16u);
}

fn unpacked_interval(word: u32) -> vec2f {
    return vec2f(vec2u(word & 0xffffu, word >> 16u)) * (view.t_max / FRACTION_STEPS);
}

// Rays are cut into one slice per this many iterations that can affect their tile.
const ITERATIONS_PER_SLICE: u32 = 4;
const MAX_LOOPS: u32 = 8;

// Finds the interval of each iteration that matters first; then lists the iterations slice by
// slice.
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
    // The running number of iterations after each loop.
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
        // A gradient by differences samples a little beyond the slice.
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
            // If the lists do not fit, all iterations are run.
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
