// The normal of what a ray from the eye meets in place of a colour: what a picture's normals are measured by. A file of its
// own, so that pictures carry no normals about.

fn picture(pixel: vec2u) -> Pixel {
    let ray = camera_ray(pixel);
    var found: Trace;
    if CULLED {
        found = trace_listed(ray, true);
    } else {
        found = trace(ray);
    }
    var normal = vec3f();
    if found.status == HIT {
        normal = normal_at(ray_point(ray, found.t), -ray.direction);
    }
    return pixel_of(found, normal, found.evaluations);
}
