// What is known of a ray before it is marched: what it meets without steps, and where it passes the rest.

struct Ahead {
    // Where the ray meets something without steps; FAR where it does not.
    met: f32,
    // Where the march begins and ends; it ends before it begins where there is nothing to march.
    start: f32,
    end: f32,
}

// A ray that meets nothing meets it there.
const FAR: f32 = 1e30;
// The end of a march that there is no need of.
const NO_MARCH: f32 = -1.0;

fn look_ahead(ray: Ray) -> Ahead {
    var ahead = Ahead(FAR, 0.0, ray.t_max);
    if CLOSED {
        ahead.met = hits(ray.origin, ray.direction);
        ahead.end = min(ray.t_max, ahead.met);
    }
    if SOFT_SHADOWS {
        if watched {
            // Such a ray is marched through all there is, to see how narrowly it passes; not where it ends anyway.
            ahead.end = select(ray.t_max, NO_MARCH, ahead.met <= ray.t_max);
            return ahead;
        }
    }
    if MARCHED {
        if CLIPPED {
            let way = clip(ray.origin, ray.direction);
            ahead.start = max(way.x, 0.0);
            ahead.end = min(ahead.end, way.y);
        }
    } else {
        ahead.end = NO_MARCH;
    }
    return ahead;
}

// Distance to what a ray is marched through.
fn along(p: vec3f) -> f32 {
    var distance: f32;
    if CLOSED {
        if MARCHED {
            distance = marched(p);
            if SOFT_SHADOWS {
                if watched {
                    distance = min(distance, closed(p));
                }
            }
        } else {
            distance = closed(p);
        }
    } else {
        distance = field(p);
    }
    return distance;
}

// The ray from one of its places on. Far from the eye its places are known better when they are counted from there.
fn moved(ray: Ray, t: f32) -> Ray {
    var rest = ray;
    rest.origin = ray_point(ray, t);
    rest.radius = footprint(ray, t);
    rest.t_max = ray.t_max - t;
    return rest;
}

// What a ray has met that was marched from where the march begins or had no need of it. Looking ahead counts as one evaluation.
fn met_in_all(ray: Ray, ahead: Ahead, found: Trace) -> Trace {
    var all = found;
    all.t += ahead.start;
    all.evaluations++;
    if found.status == MISS {
        // Where the field is no number, so is the place, and both comparisons fail.
        if found.t > ahead.end - ahead.start && ahead.met <= ray.t_max {
            all = Trace(ahead.met, HIT, all.evaluations);
        } else if found.t <= ray.t_max {
            all.t = ray.t_max;
        }
    }
    return all;
}
