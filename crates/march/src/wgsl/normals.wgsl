// The place where a ray from the eye has met something, and the normal there, in place of a colour: what a picture's normals are
// measured by. A file of its own, so that pictures carry no normals about.

fn picture(pixel: vec2u) -> Pixel {
    let ray = camera_ray(pixel);
    var found: Trace;
    if CULLED {
        found = trace_listed(ray, true);
    } else {
        found = trace(ray);
    }
    var place = vec3f();
    var turned = vec2f();
    if found.status == HIT {
        place = ray_point(ray, found.t);
        turned = unfolded(normal_at(place, -ray.direction));
    }
    var told = pixel_of(found, place, bitcast<u32>(turned.y));
    told.color.w = turned.x;
    return told;
}

// A direction on the faces of an octahedron, its lower half turned outward: two numbers for three.
// Q. Meyer et al., On Floating-Point Normal Vectors (EGSR 2010).
fn unfolded(direction: vec3f) -> vec2f {
    let on_face = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    let side = select(vec2f(-1.0), vec2f(1.0), on_face.xy >= vec2f());
    return select(on_face.xy, (1.0 - abs(on_face.yx)) * side, on_face.z < 0.0);
}
