// What is known of a ray before it is marched: what it meets without steps, and where it passes the rest.

// A ray that meets nothing meets it there.
const FAR: f32 = 1e30;

struct Ahead {
    // Where the ray meets something without steps.
    met: f32,
    // Where the march begins and ends; it ends before it begins where there is nothing to march.
    start: f32,
    end: f32,
}

// Whether it is wanted how narrowly the ray passes what it does not meet: then it is marched through all there is.
fn is_watched() -> bool {
    var is = false;
    if SOFT_SHADOWS {
        is = watched;
    }
    return is;
}

fn look_ahead(ray: Ray) -> Ahead {
    var ahead = Ahead(FAR, 0.0, ray.t_max);
    if CLOSED {
        ahead.met = hits(ray.origin, ray.direction);
        ahead.end = min(ray.t_max, ahead.met);
    }
    if is_watched() {
        if ahead.met <= ray.t_max {
            // All else makes no difference.
            ahead.end = -1.0;
        }
    } else {
        if MARCHED {
            if CLIPPED {
                let way = clip(ray.origin, ray.direction);
                ahead.start = max(way.x, 0.0);
                ahead.end = min(ahead.end, way.y);
            }
        } else {
            ahead.end = -1.0;
        }
    }
    return ahead;
}

// Distance to what a ray is marched through.
fn along(p: vec3f) -> f32 {
    var distance: f32;
    if CLOSED {
        if MARCHED {
            distance = marched(p);
            if is_watched() {
                distance = min(distance, closed(p));
            }
        } else {
            distance = closed(p);
        }
    } else {
        distance = field(p);
    }
    return distance;
}

// What a ray that was marched has met in all. Looking ahead counts as one evaluation.
fn with_ahead(ray: Ray, ahead: Ahead, marched: Trace) -> Trace {
    var found = marched;
    if LOOKS_AHEAD {
        found.evaluations++;
    }
    if found.status == MISS {
        // Where the field is no number, so is the place, and both comparisons fail.
        if found.t > ahead.end && ahead.met <= ray.t_max {
            found = Trace(ahead.met, HIT, found.evaluations);
        } else if found.t <= ray.t_max {
            found.t = ray.t_max;
        }
    }
    return found;
}
