// Before a picture: which rounds of the scene's loops can matter to the rays through each tile's pixels. A round can where its operand,
// less what it reaches beyond its surface, is not above 0 somewhere in a cone around the rays. The operand is itself
// marched along the middle of the cone, which is as sound as a field's march.
//
// Wide tiles come first, and a tile asks only for the rounds that can matter to the wider one that it is part of.

@group(0) @binding(4) var<storage, read_write> visits: array<u32>;
// For each loop and tile of each level, a bit for each round that can matter.
@group(0) @binding(5) var<storage, read_write> marks: array<u32>;
// The level at hand. The tiles of level 0 have lists, those of each other are four by four of the one below.
@group(0) @binding(6) var<uniform> level: u32;

const HIGHEST: u32 = 2;

// Supplied by the scene, as many as it has loops: how far a point is from where a round can matter, or less.

fn reach_0(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_1(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_2(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_3(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_4(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_5(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_6(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach_7(round: f32, p: vec3f) -> f32 {
    return 0.0;
}

fn reach(which: u32, round: f32, p: vec3f) -> f32 {
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

// Rays that start and lead near others: those through the pixels of a tile.
struct Cone {
    origin: vec3f,
    // How far from the middle they are where they start, and what that gains per unit of length.
    radius: f32,
    direction: vec3f,
    spread: f32,
}

// Part of its width that a cone is made wider by, so that marches along it end.
const SLACK: f32 = 0.1;
// An operand that is not told by so many steps can matter.
const MOST_STEPS: u32 = 32;

fn side_of(at: u32) -> u32 {
    return TILE << (2u * at);
}

fn counts_of(at: u32) -> vec2u {
    let side = side_of(at);
    return (view.tile_size + (side - 1u)) / side;
}

fn cone_around(place: vec2u) -> Cone {
    let corner = view.tile_origin + side_of(level) * place;
    let side = f32(side_of(level));
    let middle = ray_through(vec2f(corner) + 0.5 * side);
    var cone = Cone(middle.origin, 0.0, middle.direction, 0.0);
    for (var i = 0u; i < 4u; i++) {
        let ray = ray_through(vec2f(corner) + side * vec2f(vec2u(i & 1u, i >> 1u)));
        cone.radius = max(cone.radius, distance(ray.origin, middle.origin));
        cone.spread = max(cone.spread, distance(ray.direction, middle.direction));
    }
    // What is hit is nearer than a pixel.
    cone.radius += 2.0 * middle.radius;
    cone.spread += 2.0 * middle.spread;
    return cone;
}

fn reaches(cone: Cone, which: u32, round: f32) -> bool {
    var t = 0.0;
    for (var step = 0u; step < MOST_STEPS; step++) {
        let point = cone.origin + t * cone.direction;
        let wide = cone.radius + cone.spread * t;
        let free = reach(which, round, point) - wide;
        // Also where it is no number.
        if !(free > SLACK * wide + ROUNDING * (length(cone.origin) + t)) {
            return true;
        }
        t += free / (1.0 + cone.spread);
        if t > view.t_max {
            return false;
        }
    }
    return true;
}

// Where the marks of a tile are: those of level 0 come first.
fn words_of(at: u32, place: vec2u, which: u32, loops: u32) -> u32 {
    var before = 0u;
    for (var below = 0u; below < at; below++) {
        let counts = counts_of(below);
        before += loops * counts.x * counts.y;
    }
    let counts = counts_of(at);
    return (before + (which * counts.y + place.y) * counts.x + place.x) * visits[MOST_WORDS];
}

@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
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
        asked = marks[words_of(level + 1u, place / 4u, which, groups.z) + word];
    }
    var bits = 0u;
    while asked != 0u {
        let i = firstTrailingBit(asked);
        asked &= asked - 1u;
        if reaches(cone, which, f32(32u * word + i)) {
            bits |= 1u << i;
        }
    }
    marks[words_of(level, place, which, groups.z) + word] = bits;
}

@compute @workgroup_size(64)
fn list(@builtin(global_invocation_id) place: vec3u, @builtin(num_workgroups) counts: vec3u) {
    let tile = place.x;
    let which = place.z;
    let tiles = tile_counts();
    if tile >= tiles.x * tiles.y {
        return;
    }
    let all = visits[WHOLE + 2u * which];
    let capacity = visits[CAPACITY];
    let record = visits[FIRST_RECORD] + tile * visits[RECORD_STRIDE];
    let first = record + 2u * counts.z + which * capacity;
    let words = words_of(0u, vec2u(tile % tiles.x, tile / tiles.x), which, counts.z);
    var count = 0u;
    for (var word = 0u; 32u * word < all; word++) {
        var bits = marks[words + word];
        while bits != 0u {
            if count < capacity {
                visits[first + count] = 32u * word + firstTrailingBit(bits);
            }
            count++;
            bits &= bits - 1u;
        }
    }
    if count <= capacity {
        visits[record + 2u * which] = count;
        visits[record + 2u * which + 1u] = first;
    } else {
        visits[record + 2u * which] = all;
        visits[record + 2u * which + 1u] = visits[WHOLE + 2u * which + 1u];
    }
}
