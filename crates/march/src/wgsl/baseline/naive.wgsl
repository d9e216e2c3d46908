// The march of a classroom practical as it stands, to compare with. Its faults are kept: docs/faults.md says
// what becomes of them.

// A hit is nearer than this, whatever the scale of the scene.
const LEAST_DISTANCE: f32 = 0.001;
const MOST_STEPS: u32 = 255;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return LEAST_DISTANCE;
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    var steps = 0u;
    // Leads to where the ray starts.
    var distance = LEAST_DISTANCE;
    // A sample below 0 ends the loop before it is looked at.
    while distance >= 0.0 && steps < MOST_STEPS {
        if distance < LEAST_DISTANCE {
            return Trace(t, HIT, steps);
        }
        // What is taken off keeps the next distance from falling below the least one.
        t += distance - LEAST_DISTANCE;
        if t > ray.t_max {
            break;
        }
        distance = field(ray_point(ray, t));
        record_sample(t, distance);
        steps++;
    }
    return Trace(t, select(MISS, CAPPED, steps == MOST_STEPS), steps);
}
