// Before a picture: which rounds of the scene's loops can matter to the rays through each tile's pixels. A round can where its operand,
// less what it reaches beyond its surface, is not above 0 somewhere in a cone around the rays. The operand is itself
// marched along the middle of the cone, which is as sound as a field's march.
//
// Wide tiles come first, and a tile asks only for the rounds that can matter to the wider one that it is part of. Those of wide tiles
// are marked; those of the narrowest are listed.

@group(0) @binding(4) var<storage, read_write> visits: array<u32>;
// For each loop and tile of each level from 1 on, a bit for each round that can matter. Then for each tile of level 0 what is kept of
// rounds while it is listed: two words, the number, and where the round matters.
@group(0) @binding(5) var<storage, read_write> marks: array<u32>;
// The level at hand. The tiles of level 0 have lists, those of each other, which have marks, are two by two of the one below.
@group(0) @binding(6) var<uniform> level: u32;
// How much of the cells' lists is filled; how many operands were evaluated; then for each loop and group of cells the least operand
// there, as a word that is ordered as it is.
@group(0) @binding(7) var<storage, read_write> tally: array<atomic<u32>>;

const FILLED: u32 = 0;
const EVALUATED: u32 = 1;
const LEAST: u32 = 2;

const HIGHEST: u32 = 4;
const WIDER_BITS: u32 = 1;

// Supplied by the scene, as many as it has loops: how far a point is from where a round can matter to a ray, or less; the round's operand
// less what blends reach; the operand.

fn reach_0(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_1(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_2(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_3(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_4(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_5(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_6(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

fn reach_7(round: f32, p: vec3f) -> vec3f {
    return vec3f();
}

// How many operands were evaluated, where that is counted.
var<private> evaluated: u32;

fn reach(which: u32, round: f32, p: vec3f) -> vec3f {
    if COUNTED {
        evaluated++;
    }
    switch which {
        case 0u: {
            return reach_0(round, p);
        }
        case 1u: {
            return reach_1(round, p);
        }
        case 2u: {
            return reach_2(round, p);
        }
        case 3u: {
            return reach_3(round, p);
        }
        case 4u: {
            return reach_4(round, p);
        }
        case 5u: {
            return reach_5(round, p);
        }
        case 6u: {
            return reach_6(round, p);
        }
        default: {
            return reach_7(round, p);
        }
    }
}

// At the end of each stage.
fn tell_evaluated() {
    if COUNTED {
        atomicAdd(&tally[EVALUATED], evaluated);
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
const MOST_STEPS: u32 = 32;

fn side_of(at: u32) -> u32 {
    return TILE << (WIDER_BITS * at);
}

fn counts_of(at: u32) -> vec2u {
    let side = side_of(at);
    return (view.tile_size + (side - 1u)) / side;
}

fn cone_around(place: vec2u) -> Cone {
    let corner = view.tile_origin + side_of(level) * place;
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
fn free_at(cone: Cone, which: u32, round: f32, t: f32) -> f32 {
    let wide = cone.radius + cone.spread * t;
    let free = reach(which, round, cone.origin + t * cone.direction).x - wide;
    return select(-1.0, free, free > SLACK * wide + ROUNDING * (length(cone.origin) + t));
}

// Where a round begins to matter to the cone, or a place beyond the end of rays where it does not.
fn entry(cone: Cone, which: u32, round: f32) -> f32 {
    var t = 0.0;
    for (var step = 0u; step < MOST_STEPS && t <= view.t_max; step++) {
        let free = free_at(cone, which, round, t);
        if free < 0.0 {
            break;
        }
        t += free / (1.0 + cone.spread);
    }
    return t;
}

// Where it begins to, and where it ceases to, which is looked for from the end of rays back. One call of `free_at`: drivers inline it
// wherever it is called.
fn stretch(cone: Cone, which: u32, round: f32) -> vec2f {
    var ends = vec2f(0.0, view.t_max);
    var is_back = false;
    var steps = 0u;
    while steps < MOST_STEPS && ends.x < ends.y {
        let free = free_at(cone, which, round, select(ends.x, ends.y, is_back));
        steps++;
        if !is_back && free >= 0.0 {
            ends.x += free / (1.0 + cone.spread);
        }
        // Nearer to the eye the cone is no wider.
        if is_back && free >= 0.0 {
            ends.y -= free;
        }
        if free < 0.0 || steps == MOST_STEPS {
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
fn words_of(at: u32, place: vec2u, which: u32) -> u32 {
    var before = 0u;
    for (var below = 1u; below < at; below++) {
        let counts = counts_of(below);
        before += visits[LOOPS] * counts.x * counts.y;
    }
    let counts = counts_of(at);
    return (before + (which * counts.y + place.y) * counts.x + place.x) * visits[MOST_WORDS];
}

@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u) {
    let word = id.x;
    let which = id.z;
    let all = visits[WHOLE + 2u * which];
    let counts = counts_of(level);
    if id.y >= counts.x * counts.y || 32u * word >= all {
        return;
    }
    load_frame();
    let place = vec2u(id.y % counts.x, id.y / counts.x);
    let cone = cone_around(place);
    var asked = 0xffffffffu >> (32u - min(32u, all - 32u * word));
    if level < HIGHEST {
        asked = marks[words_of(level + 1u, place >> vec2u(WIDER_BITS), which) + word];
    }
    var bits = 0u;
    while asked != 0u {
        let i = firstTrailingBit(asked);
        asked &= asked - 1u;
        if entry(cone, which, f32(32u * word + i)) <= view.t_max {
            bits |= 1u << i;
        }
    }
    marks[words_of(level, place, which) + word] = bits;
    tell_evaluated();
}

// A stretch of rays in one word, as parts of their length: no less than it is.
const PARTS: f32 = 65535.0;

fn word_of_stretch(own: vec2f) -> u32 {
    let ends = PARTS / view.t_max * own;
    return u32(clamp(floor(ends.x), 0.0, PARTS)) | (u32(clamp(ceil(ends.y), 0.0, PARTS)) << 16u);
}

fn stretch_of_word(word: u32) -> vec2f {
    return vec2f(vec2u(word & 0xffffu, word >> 16u)) * (view.t_max / PARTS);
}

// Rays are cut into a slice for each so many rounds that can matter to their tile.
const WORTH: u32 = 4;
const MOST_LOOPS: u32 = 8;

// First it is found where the rounds matter that do; then, slice by slice, they are listed.
@compute @workgroup_size(64)
fn list(@builtin(global_invocation_id) id: vec3u) {
    let tiles = tile_counts();
    if id.x >= tiles.x * tiles.y {
        return;
    }
    load_frame();
    let place = vec2u(id.x % tiles.x, id.x / tiles.x);
    let cone = cone_around(place);
    let loops = visits[LOOPS];
    let most_kept = visits[MOST_KEPT];
    let kept = words_of(HIGHEST + 1u, vec2u(), 0u) + id.x * 2u * most_kept;
    var near = view.t_max;
    var far = 0.0;
    var count = 0u;
    // How many there are when those of a loop have been counted.
    var counts: array<u32, MOST_LOOPS>;
    for (var which = 0u; which < loops; which++) {
        let all = visits[WHOLE + 2u * which];
        let words = words_of(1u, place >> vec2u(WIDER_BITS), which);
        for (var word = 0u; 32u * word < all; word++) {
            var bits = marks[words + word];
            while bits != 0u {
                let round = 32u * word + firstTrailingBit(bits);
                bits &= bits - 1u;
                let own = stretch(cone, which, f32(round));
                if own.x <= view.t_max {
                    if count < most_kept {
                        marks[kept + 2u * count] = round;
                        marks[kept + 2u * count + 1u] = word_of_stretch(own);
                    }
                    near = min(near, own.x);
                    far = max(far, own.x);
                    count++;
                }
            }
        }
        counts[which] = count;
    }
    let slices = clamp(count / WORTH, 1u, MOST_SLICES);
    let slice_length = max(far - near, 0.0) / f32(slices);
    let record = visits[FIRST_RECORD] + id.x * visits[RECORD_STRIDE];
    let capacity = visits[CAPACITY];
    var listed: array<u32, MOST_LOOPS>;
    for (var slice = 0u; slice < slices; slice++) {
        // A gradient by differences is taken a little beyond a slice.
        var ends = slice_ends(slice, slices, near, slice_length);
        let beyond = cone.margin.radius + cone.margin.spread * ends.y;
        ends += vec2f(-beyond, beyond);
        var index = 0u;
        for (var which = 0u; which < loops; which++) {
            let list = record + FIRST_SLICE + 2u * MOST_SLICES * loops + which * capacity;
            let first = listed[which];
            var next = first;
            while index < min(counts[which], most_kept) {
                let stretch = stretch_of_word(marks[kept + 2u * index + 1u]);
                if stretch.x <= ends.y && stretch.y >= ends.x {
                    if next < capacity {
                        visits[list + next] = marks[kept + 2u * index];
                    }
                    next++;
                }
                index++;
            }
            let at = record + FIRST_SLICE + 2u * (slice * loops + which);
            // Where there is no room, all rounds are visited.
            if counts[which] <= most_kept && next <= capacity {
                visits[at] = next - first;
                visits[at + 1u] = list + first;
                listed[which] = next;
            } else {
                visits[at] = visits[WHOLE + 2u * which];
                visits[at + 1u] = visits[WHOLE + 2u * which + 1u];
            }
        }
    }
    visits[record + SLICE_COUNT] = slices;
    visits[record + NEAR] = bitcast<u32>(near);
    visits[record + SLICE_LENGTH] = bitcast<u32>(slice_length);
    tell_evaluated();
}
