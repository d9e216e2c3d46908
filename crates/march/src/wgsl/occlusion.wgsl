// Ambient occlusion, from how far the field falls behind the height above the surface. A. Evans,
// Fast approximations for global illumination on dynamic scenes (SIGGRAPH 2006).

const OCCLUSION_SAMPLES: u32 = 5;
// The slope from which on a field is taken for a distance.
const STEEP: f32 = 0.99;

// Length of the gradient at the last normal: distances are divided by it, for fields that are
// steeper or flatter than a distance.
var<private> slope: f32;

// Called after each gradient with its squared length.
fn record_slope(square: f32) {
    slope = select(1.0, sqrt(square), square > 0.0);
}

// How much the field falls behind the distance near the last surface: the slope there, if that is
// flatter than a distance. An estimate of the distance and a way along gradients need no
// correction.
fn flatness() -> f32 {
    var flatness = select(1.0, slope, slope < STEEP);
    if ESTIMATED {
        flatness = 1.0;
    }
    if PROJECTED {
        flatness = 1.0;
    }
    return flatness;
}

fn unoccluded_fraction(point: vec3f, normal: vec3f) -> f32 {
    if CULLED {
        // Parts that do not affect a camera ray may still be near.
        use_cells(view.occlusion_radius);
    }
    var occluded = 0.0;
    var total = 0.0;
    var weight = 1.0;
    // The nearer the sample, the more it counts.
    for (var i = 1u; i <= OCCLUSION_SAMPLES; i++) {
        let height = view.occlusion_radius * f32(i) / f32(OCCLUSION_SAMPLES);
        let above = point + height * normal;
        var distance: f32;
        if ESTIMATED {
            // Beside a surface whose field is a distance, the field of others may be flatter.
            if slope > STEEP {
                distance = field_estimate(above);
            } else {
                distance = field(above) / slope;
            }
        } else {
            distance = field(above) / slope;
        }
        occluded += weight * saturate(1.0 - distance / height);
        total += weight;
        weight *= 0.5;
    }
    return 1.0 - view.occlusion_strength * occluded / total;
}
