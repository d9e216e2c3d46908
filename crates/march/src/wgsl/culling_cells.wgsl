// Runs before a frame: finds which iterations of the scene's loops can affect the loop's value in
// each cell of a grid. An iteration can if its operand minus the blend radius may be as small as
// the minimum of all operands somewhere in the cell. The search runs for groups of cells first,
// then for each cell among its group's iterations.

// If more iterations of a loop can affect a cell, all are run there.
const MAX_PER_CELL: u32 = 1024;
// Margin for rounding, as a fraction of the cell's width.
const CELL_SLACK: f32 = 1e-3;

struct Ball {
    center: vec3f,
    radius: f32,
}

// The ball around a cube of `side` cells.
fn ball_around(cells: Cells, corner: vec3u, side: u32) -> Ball {
    let half = 0.5 * f32(side) / cells.per_unit;
    return Ball(cells.low + vec3f(corner) / cells.per_unit + half, length(half));
}

fn group_position(group: u32) -> vec3u {
    return vec3u(group, group / GROUP_SIDE, group / (GROUP_SIDE * GROUP_SIDE)) % GROUP_SIDE;
}

fn ball_around_group(cells: Cells, group: u32) -> Ball {
    return ball_around(cells, cells.group * group_position(group), cells.group);
}

// An operand can matter in the ball if its value at the centre is at most this.
fn limit_of(ball: Ball, least: f32) -> f32 {
    return least + (2.0 + CELL_SLACK) * ball.radius + 8.0 * ROUNDING * length(ball.center);
}

fn groups() -> u32 {
    return GROUP_SIDE * GROUP_SIDE * GROUP_SIDE;
}

fn ordered_word(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return bits ^ select(0x80000000u, 0xffffffffu, (bits >> 31u) == 1u);
}

fn ordered_value(word: u32) -> f32 {
    return bitcast<f32>(word ^ select(0xffffffffu, 0x80000000u, (word >> 31u) == 1u));
}

fn group_words(loop_index: u32, group: u32) -> u32 {
    return (loop_index * groups() + group) * active_lists[MAX_WORDS];
}

// One invocation for each group (x), 32 iterations (y) and loop (z). It runs at level 0 to find the
// least operand of each group, then at level 1 to find the iterations that can matter there.
// Drivers inline `culling_bounds` wherever it is called, so each stage calls it at one place.
@compute @workgroup_size(64)
fn mark_groups(@builtin(global_invocation_id) id: vec3u) {
    let count_all = active_lists[ALL_ITERATIONS + 2u * id.z];
    if id.x >= groups() || 32u * id.y >= count_all {
        return;
    }
    load_frame();
    let ball = ball_around_group(read_cells(active_lists[CELLS]), id.x);
    let least_of_group = LEAST_OPERANDS + id.z * groups() + id.x;
    let limit = limit_of(ball, ordered_value(atomicLoad(&counters[least_of_group])));
    var least = 1e30;
    var bits = 0u;
    for (var i = 0u; i < min(32u, count_all - 32u * id.y); i++) {
        let bounds = culling_bounds(id.z, f32(32u * id.y + i), ball.center);
        least = min(least, bounds.z);
        // The negation also keeps an operand that is not a number.
        if !(bounds.y > limit) {
            bits |= 1u << i;
        }
    }
    if is_level(0u, id) {
        atomicMin(&counters[least_of_group], ordered_word(least));
    } else {
        masks[group_words(id.z, id.x) + id.y] = bits;
    }
    add_evaluated();
}

// For the iterations that can matter in a group, one bit each: can it matter in the current cell?
// Iterations beyond the capacity are kept.
const MAX_MASKED: u32 = 1024;
var<private> kept_bits: array<u32, 32>;

// One invocation for each cell; those of a group are neighbours.
@compute @workgroup_size(64)
fn list_cells(@builtin(global_invocation_id) id: vec3u) {
    let cells = read_cells(active_lists[CELLS]);
    let side = cells.group;
    let group = id.x / max(side * side * side, 1u);
    if cells.loops == 0u || group >= groups() {
        return;
    }
    load_frame();
    let position = vec3u(id.x, id.x / side, id.x / (side * side)) % side;
    let cell = side * group_position(group) + position;
    let ball = ball_around(cells, cell, 1u);
    let record = record_of_cell(cells, cell);
    var distance = 1e30;
    for (var loop_index = 0u; loop_index < cells.loops; loop_index++) {
        distance = min(distance, list_cell(cells, ball, loop_index, group_words(loop_index, group), record + 2u * loop_index));
    }
    active_lists[record + 2u * cells.loops] = bitcast<u32>(distance);
    add_evaluated();
}

// Lists the iterations of a loop that can matter in a ball, among those whose mask bit is set.
// Returns a lower bound on the distance from the ball's centre to where any iteration can affect a
// ray.
fn list_cell(cells: Cells, ball: Ball, loop_index: u32, first_word: u32, record: u32) -> f32 {
    let count_all = active_lists[ALL_ITERATIONS + 2u * loop_index];
    let words = (count_all + 31u) / 32u;
    for (var i = 0u; i < MAX_MASKED / 32u; i++) {
        kept_bits[i] = 0u;
    }
    var distance = 1e30;
    var least = 1e30;
    var limit = 0.0;
    var position_in_group = 0u;
    var count = 0u;
    // The words of the mask twice: first for the least operand, then for the list.
    for (var i = 0u; i < 2u * words; i++) {
        let is_first = i < words;
        if i == words {
            limit = limit_of(ball, least);
        }
        let word = select(i - words, i, is_first);
        var bits = masks[first_word + word];
        while bits != 0u {
            let iteration = f32(32u * word + firstTrailingBit(bits));
            bits &= bits - 1u;
            let bounds = culling_bounds(loop_index, iteration, ball.center);
            if is_first {
                distance = min(distance, bounds.x);
                least = min(least, bounds.z);
            } else {
                if position_in_group >= MAX_MASKED {
                    count++;
                } else if !(bounds.y > limit) {
                    kept_bits[position_in_group / 32u] |= 1u << (position_in_group % 32u);
                    count++;
                }
                position_in_group++;
            }
        }
    }
    var next = cells.lists_end;
    if count <= MAX_PER_CELL {
        next = cells.lists + atomicAdd(&counters[FILLED], count);
    }
    if next + count > cells.lists_end {
        active_lists[record] = count_all;
        active_lists[record + 1u] = active_lists[ALL_ITERATIONS + 2u * loop_index + 1u];
        return distance;
    }
    active_lists[record] = count;
    active_lists[record + 1u] = next;
    position_in_group = 0u;
    for (var word = 0u; word < words; word++) {
        var bits = masks[first_word + word];
        while bits != 0u {
            if position_in_group >= MAX_MASKED || (kept_bits[position_in_group / 32u] >> (position_in_group % 32u) & 1u) == 1u {
                active_lists[next] = 32u * word + firstTrailingBit(bits);
                next++;
            }
            bits &= bits - 1u;
            position_in_group++;
        }
    }
    return distance;
}
