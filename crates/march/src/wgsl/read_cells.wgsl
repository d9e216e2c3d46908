// Reads the description of the cells from `active_lists`.

fn read_vec3(start: u32) -> vec3f {
    return bitcast<vec3f>(vec3u(active_lists[start], active_lists[start + 1u], active_lists[start + 2u]));
}

fn read_cells(start: u32) -> Cells {
    return Cells(
        active_lists[start],
        active_lists[start + 1u],
        active_lists[start + 2u],
        active_lists[start + 3u],
        active_lists[start + 4u],
        active_lists[start + 5u],
        bitcast<f32>(active_lists[start + 6u]),
        read_vec3(start + 7u),
        read_vec3(start + 10u),
        read_vec3(start + 13u),
        read_vec3(start + 16u),
    );
}
