// What tells of the cells, where it stands.

fn three_at(place: u32) -> vec3f {
    return bitcast<vec3f>(vec3u(visits[place], visits[place + 1u], visits[place + 2u]));
}

fn cells_at(place: u32) -> Cells {
    return Cells(
        visits[place],
        visits[place + 1u],
        visits[place + 2u],
        visits[place + 3u],
        visits[place + 4u],
        visits[place + 5u],
        bitcast<f32>(visits[place + 6u]),
        three_at(place + 7u),
        three_at(place + 10u),
        three_at(place + 13u),
        three_at(place + 16u),
    );
}
