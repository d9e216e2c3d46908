// What is known of a ray before it is marched: what it meets without steps, and where it passes the rest.

struct PreIntersection {
    // Where the ray meets something without steps; FAR where it does not.
    hit: f32,
    // Where the march begins and ends; it ends before it begins where there is nothing to march.
    start: f32,
    end: f32,
}

// A ray that meets nothing meets it there.
const FAR: f32 = 1e30;
// The end of a march that there is no need of.
const NO_MARCH: f32 = -1.0;

fn pre_intersect(ray: Ray) -> PreIntersection {
    var known = PreIntersection(FAR, 0.0, ray.t_max);
    if ANALYTIC {
        known.hit = analytic_hit(ray.origin, ray.direction);
        known.end = min(ray.t_max, known.hit);
    }
    if SOFT_SHADOWS {
        if records_clearance {
            // Such a ray is marched through all there is, to see how narrowly it passes; not where it ends anyway.
            known.end = select(ray.t_max, NO_MARCH, known.hit <= ray.t_max);
            return known;
        }
    }
    if MARCHED {
        if CLIPPED {
            let box = clip_interval(ray.origin, ray.direction);
            known.start = max(box.x, 0.0);
            known.end = min(known.end, box.y);
        }
    } else {
        known.end = NO_MARCH;
    }
    return known;
}

// Distance to what a ray is marched through.
fn marched_field(p: vec3f) -> f32 {
    var distance: f32;
    if ANALYTIC {
        if MARCHED {
            distance = marched_distance(p);
            if SOFT_SHADOWS {
                if records_clearance {
                    distance = min(distance, analytic_distance(p));
                }
            }
        } else {
            distance = analytic_distance(p);
        }
    } else {
        distance = field(p);
    }
    return distance;
}

// The ray from one of its places on. Far from the eye its places are known better when they are counted from there.
fn advanced(ray: Ray, t: f32) -> Ray {
    var rest = ray;
    rest.origin = ray_point(ray, t);
    rest.radius = footprint(ray, t);
    rest.t_max = ray.t_max - t;
    return rest;
}

// What a ray has met that was marched from where the march begins or had no need of it. Looking ahead counts as one evaluation.
fn combined(ray: Ray, known: PreIntersection, marched: Trace) -> Trace {
    var result = marched;
    result.t += known.start;
    result.evaluations++;
    if marched.status == MISS {
        // Where the field is no number, so is the place, and both comparisons fail.
        if marched.t > known.end - known.start && known.hit <= ray.t_max {
            result = Trace(known.hit, HIT, result.evaluations);
        } else if marched.t <= ray.t_max {
            result.t = ray.t_max;
        }
    }
    return result;
}
