// Writes the position and the normal of the hit in place of a colour; accuracy charts measure
// normals by them. This is a file of its own so that pictures need not carry normals.

fn picture(pixel: vec2u) -> Pixel {
    let ray = camera_ray(pixel);
    var found: Trace;
    if CULLED {
        found = trace_culled(ray, true);
    } else {
        found = trace(ray);
    }
    var point = vec3f();
    var encoded = vec2f();
    if found.status == HIT {
        point = ray_point(ray, found.t);
        encoded = octahedral(normal_at(point, -ray.direction));
    }
    var pixel_out = pixel_of(found, point, bitcast<u32>(encoded.y));
    pixel_out.color.w = encoded.x;
    return pixel_out;
}

// Octahedral encoding of a unit vector: the lower half of the octahedron is folded outwards, so
// that two numbers hold a direction. Q. Meyer et al., On Floating-Point Normal Vectors (EGSR 2010).
fn octahedral(direction: vec3f) -> vec2f {
    let on_face = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    let side = select(vec2f(-1.0), vec2f(1.0), on_face.xy >= vec2f());
    return select(on_face.xy, (1.0 - abs(on_face.yx)) * side, on_face.z < 0.0);
}
