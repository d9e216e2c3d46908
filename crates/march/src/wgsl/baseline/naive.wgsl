// The naive marcher of a classroom exercise, kept with its faults to compare with: docs/faults.md
// shows what they cause.

// A hit is nearer than this, whatever the scale of the scene.
const LEAST_DISTANCE: f32 = 0.001;
const MOST_STEPS: u32 = 255;

fn tolerance(ray: Ray, t: f32) -> f32 {
    return LEAST_DISTANCE;
}

fn trace(ray: Ray) -> Trace {
    var t = 0.0;
    var steps = 0u;
    // The initial value makes the first sample the ray's origin.
    var distance = LEAST_DISTANCE;
    // A negative sample ends the loop before it is examined.
    while distance >= 0.0 && steps < MOST_STEPS {
        if distance < LEAST_DISTANCE {
            return Trace(t, HIT, steps);
        }
        // The subtraction keeps the next distance from falling below LEAST_DISTANCE.
        t += distance - LEAST_DISTANCE;
        if t > ray.t_max {
            break;
        }
        distance = field(ray_point(ray, t));
        record_sample(ray, t, distance);
        steps++;
    }
    return Trace(t, select(MISS, CAPPED, steps == MOST_STEPS), steps);
}
