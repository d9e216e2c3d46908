// Sampling of a ray where nothing is proven: the samples are so near to each other that a surface
// is unlikely to hide between two of them. What is thinner than the step may be missed.

// Step budget of the samples, as a factor of that of a proof. Three quarters of it cover the ray
// with the longest steps; the rest is for shorter ones near a surface.
const SAMPLE_BUDGET_FACTOR: u32 = 4;
// The longest step grows with t, as pixels do. At the start of the ray it is as long as it would be
// after this fraction of the ray.
const START_FRACTION: f32 = 0.03125;
// Growth of the longest step, as a multiple of 1 / steps: ln(1 + 1 / START_FRACTION) / 3.
const STEP_GROWTH: f32 = 1.1655;
// A step is no longer than this fraction of the way to where the field would be 0.
const APPROACH: f32 = 0.5;
// Weight of the steepest slope so far, beside that of the last step.
const SLOPE_MEMORY: f32 = 0.75;
// Steps that are left for a bracket.
const BRACKET_STEPS: u32 = 48;

// True once a ray of the pixel has passed a stretch without a proof that it is free.
var<private> is_unproven: bool;

// Methods call this for each stretch longer than the tolerance that they pass without a proof.
fn record_gap() {
    is_unproven = true;
}

// How steep the field has been of late, with one more sample.
fn recent_slope(slope: f32, before: vec2f, t: f32, distance: f32) -> f32 {
    var steepest = slope;
    if t > before.x {
        steepest = max(SLOPE_MEMORY * slope, abs(distance - before.y) / (t - before.x));
    }
    return steepest;
}

// The step from a sample to the next, where `left` steps are left in the budget. It is at least the
// tolerance. Once the rest of the budget is only enough for the longest steps, it is one of these
// or longer, so that the ray reaches its end.
fn sampling_step(ray: Ray, t: f32, distance: f32, slope: f32, left: u32) -> f32 {
    let growth = STEP_GROWTH / f32(ray.steps);
    let start = START_FRACTION * ray.t_max;
    let pixel = 2.0 * footprint(ray, t);
    let longest = max(growth * (t + start), pixel);
    let near = footprint_tolerance(ray, t);
    let step = clamp(APPROACH * distance / max(slope, 1e-20), near, max(longest, near));
    // Steps that multiply t + start by exp(needed) reach the end within the budget.
    let samples = f32(max(left, BRACKET_STEPS + 1u) - BRACKET_STEPS);
    let needed = log((ray.t_max + start) / (t + start)) / samples;
    let forced = select(0.0, (t + start) * (exp(needed) - 1.0), needed >= growth);
    return max(limited_step(step, max(distance, near)), forced);
}
