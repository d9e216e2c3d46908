// The analytic pre-intersection of a ray: where it hits the analytic part of the scene, and the
// interval in which the rest has to be marched.

struct PreIntersection {
    // The hit on the analytic part of the scene; FAR if there is none.
    hit: f32,
    // The interval to march; empty (end < start) if there is nothing to march.
    start: f32,
    end: f32,
}

// The hit position of a ray that hits nothing.
const FAR: f32 = 1e30;
// The end of an empty interval.
const NO_MARCH: f32 = -1.0;

fn pre_intersect(ray: Ray) -> PreIntersection {
    var known = PreIntersection(FAR, 0.0, ray.t_max);
    if ANALYTIC {
        known.hit = analytic_hit(ray.origin, ray.direction);
        known.end = min(ray.t_max, known.hit);
    }
    if SOFT_SHADOWS {
        if records_clearance {
            // Such a ray is marched through the whole scene, to measure how narrowly it passes
            // things, unless it is blocked anyway.
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

// Distance to the part of the scene that the ray is marched through.
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

// The rest of a ray from t on. Far from the eye, positions counted from the new origin have smaller
// rounding errors.
fn advanced(ray: Ray, t: f32) -> Ray {
    var rest = ray;
    rest.origin = ray_point(ray, t);
    rest.radius = footprint(ray, t);
    rest.t_max = ray.t_max - t;
    return rest;
}

// Combines the hit of the march with the analytic hit. The pre-intersection counts as one
// evaluation.
fn combined(ray: Ray, known: PreIntersection, marched: Trace) -> Trace {
    var result = marched;
    result.t += known.start;
    result.evaluations++;
    if marched.status == MISS && !is_nan(marched.t) {
        if marched.t > known.end - known.start && known.hit <= ray.t_max {
            result = Trace(known.hit, HIT, result.evaluations);
        } else if marched.t <= ray.t_max {
            result.t = ray.t_max;
        }
    }
    return result;
}
