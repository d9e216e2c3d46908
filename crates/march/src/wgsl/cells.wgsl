// Before a frame: which rounds of the scene's loops can matter in each cell of a grid, to the value of the loop: those whose operand,
// less what blends reach, may be as little as the least of all in some place of the cell. First for groups of cells, then for each cell
// among those of its group.

// Where more rounds of a loop than this can matter in a cell, all are visited.
const MOST_OF_CELL: u32 = 1024;
// Part of a cell's width that a round is kept beyond, for rounding.
const CELL_SLACK: f32 = 1e-3;

struct Ball {
    center: vec3f,
    radius: f32,
}

// The ball around so many cells.
fn ball_around(cells: Cells, corner: vec3u, side: u32) -> Ball {
    let half = 0.5 * f32(side) / cells.per_unit;
    return Ball(cells.low + vec3f(corner) / cells.per_unit + half, length(half));
}

fn place_of_group(group: u32) -> vec3u {
    return vec3u(group, group / GROUP_SIDE, group / (GROUP_SIDE * GROUP_SIDE)) % GROUP_SIDE;
}

fn ball_around_group(cells: Cells, group: u32) -> Ball {
    return ball_around(cells, cells.group * place_of_group(group), cells.group);
}

// Operands that are at most this at the center of a ball can matter within it.
fn limit_of(ball: Ball, least: f32) -> f32 {
    return least + (2.0 + CELL_SLACK) * ball.radius + 8.0 * ROUNDING * length(ball.center);
}

fn groups() -> u32 {
    return GROUP_SIDE * GROUP_SIDE * GROUP_SIDE;
}

fn word_of(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return bits ^ select(0x80000000u, 0xffffffffu, (bits >> 31u) == 1u);
}

fn value_of(word: u32) -> f32 {
    return bitcast<f32>(word ^ select(0xffffffffu, 0x80000000u, (word >> 31u) == 1u));
}

fn group_words(which: u32, group: u32) -> u32 {
    return (which * groups() + group) * visits[MOST_WORDS];
}

// One invocation for each group (x), 32 rounds (y) and loop (z).
@compute @workgroup_size(64)
fn least_of_groups(@builtin(global_invocation_id) place: vec3u) {
    let all = visits[WHOLE + 2u * place.z];
    if place.x >= groups() || 32u * place.y >= all {
        return;
    }
    load_frame();
    let ball = ball_around_group(cells_at(visits[CELLS]), place.x);
    var least = 1e30;
    for (var i = 32u * place.y; i < min(32u * place.y + 32u, all); i++) {
        least = min(least, reach(place.z, f32(i), ball.center).z);
    }
    atomicMin(&tally[LEAST + place.z * groups() + place.x], word_of(least));
    tell_evaluated();
}

// The same.
@compute @workgroup_size(64)
fn mark_groups(@builtin(global_invocation_id) place: vec3u) {
    let all = visits[WHOLE + 2u * place.z];
    if place.x >= groups() || 32u * place.y >= all {
        return;
    }
    load_frame();
    let ball = ball_around_group(cells_at(visits[CELLS]), place.x);
    let limit = limit_of(ball, value_of(atomicLoad(&tally[LEAST + place.z * groups() + place.x])));
    var bits = 0u;
    for (var i = 0u; i < min(32u, all - 32u * place.y); i++) {
        // Also where it is no number.
        if !(reach(place.z, f32(32u * place.y + i), ball.center).y > limit) {
            bits |= 1u << i;
        }
    }
    marks[group_words(place.z, place.x) + place.y] = bits;
    tell_evaluated();
}

// Whether the rounds that can matter in a group can matter in the cell at hand, a bit for each; of rounds past these they do.
const MOST_TOLD: u32 = 1024;
var<private> kept: array<u32, 32>;

// One invocation for each cell, those of a group together.
@compute @workgroup_size(64)
fn list_cells(@builtin(global_invocation_id) place: vec3u) {
    let cells = cells_at(visits[CELLS]);
    let side = cells.group;
    let group = place.x / max(side * side * side, 1u);
    if cells.loops == 0u || group >= groups() {
        return;
    }
    load_frame();
    let own = vec3u(place.x, place.x / side, place.x / (side * side)) % side;
    let cell = side * place_of_group(group) + own;
    let ball = ball_around(cells, cell, 1u);
    let record = record_of_cell(cells, cell);
    var free = 1e30;
    for (var which = 0u; which < cells.loops; which++) {
        free = min(free, list_cell(cells, ball, which, group_words(which, group), record + 2u * which));
    }
    visits[record + 2u * cells.loops] = bitcast<u32>(free);
    tell_evaluated();
}

// Lists the rounds of a loop that can matter in a ball, among those that are marked, and gives how far its middle is from where any can
// matter to a ray.
fn list_cell(cells: Cells, ball: Ball, which: u32, first_word: u32, record: u32) -> f32 {
    let all = visits[WHOLE + 2u * which];
    let words = (all + 31u) / 32u;
    var free = 1e30;
    var least = 1e30;
    for (var word = 0u; word < words; word++) {
        var bits = marks[first_word + word];
        while bits != 0u {
            let ends = reach(which, f32(32u * word + firstTrailingBit(bits)), ball.center);
            bits &= bits - 1u;
            free = min(free, ends.x);
            least = min(least, ends.z);
        }
    }
    let limit = limit_of(ball, least);
    for (var i = 0u; i < MOST_TOLD / 32u; i++) {
        kept[i] = 0u;
    }
    var known = 0u;
    var count = 0u;
    for (var word = 0u; word < words; word++) {
        var bits = marks[first_word + word];
        while bits != 0u {
            let round = f32(32u * word + firstTrailingBit(bits));
            bits &= bits - 1u;
            if known >= MOST_TOLD {
                count++;
            } else if !(reach(which, round, ball.center).y > limit) {
                kept[known / 32u] |= 1u << (known % 32u);
                count++;
            }
            known++;
        }
    }
    var next = cells.lists_end;
    if count <= MOST_OF_CELL {
        next = cells.lists + atomicAdd(&tally[FILLED], count);
    }
    if next + count > cells.lists_end {
        visits[record] = all;
        visits[record + 1u] = visits[WHOLE + 2u * which + 1u];
        return free;
    }
    visits[record] = count;
    visits[record + 1u] = next;
    known = 0u;
    for (var word = 0u; word < words; word++) {
        var bits = marks[first_word + word];
        while bits != 0u {
            if known >= MOST_TOLD || (kept[known / 32u] >> (known % 32u) & 1u) == 1u {
                visits[next] = 32u * word + firstTrailingBit(bits);
                next++;
            }
            bits &= bits - 1u;
            known++;
        }
    }
    return free;
}
