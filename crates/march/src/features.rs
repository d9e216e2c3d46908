//! Which optional parts of a picture's shader a scene needs.

use crate::stubs;

/// The optional parts of a shader that a scene needs.
///
/// Each is an override of `features.wgsl` on which the WGSL files branch. The linker takes one side
/// of each branch and drops the other. `planar` and `materials` choose files instead.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Features {
    /// The scene consists of regions: a pixel is a formula, and there are no rays.
    pub planar: bool,
    /// The scene has materials.
    pub materials: bool,
    /// Materials depend on the normal or on the direction to the eye.
    pub seen_materials: bool,
    /// Some materials keep direct light away.
    pub unlit: bool,
    /// A part of the scene is intersected analytically.
    pub analytic: bool,
    /// A part of the scene is marched.
    pub marched: bool,
    /// The marched part lies in a box, to which rays are clipped.
    pub clipped: bool,
    /// The marched part consists of copies that are intersected analytically, a few at a time.
    pub copies: bool,
    /// A light casts a shadow.
    pub shadows: bool,
    /// A light casts a soft shadow.
    pub soft_shadows: bool,
    /// A light has a position: it is a point light or a spot light.
    pub positional_lights: bool,
    /// A light is a spot light.
    pub spot_lights: bool,
    /// Surfaces reflect each other.
    pub reflections: bool,
    /// Ambient light is occluded.
    pub occlusion: bool,
    /// The background is a sky: its colour depends on the direction.
    pub sky: bool,
    /// The sky has another colour below the horizon.
    pub ground: bool,
    /// A picture of the surroundings is the background and the ambient light.
    pub environment: bool,
    /// There is fog.
    pub fog: bool,
    /// The fog has a colour of its own.
    pub fog_color: bool,
    /// All light is multiplied by the exposure.
    pub exposure: bool,
    /// Light is compressed by the neutral tone curve.
    pub neutral_tone: bool,
    /// Light is compressed by the tone curve of film.
    pub film_tone: bool,
    /// Camera rays are parallel.
    pub parallel: bool,
    /// Camera rays run only those iterations of loops that can affect them.
    pub culled: bool,
    /// A pixel's `evaluations` counts iterations of loops instead of evaluations of the field.
    pub instrumented: bool,
    /// The scene has bounds of the field along ray segments.
    pub proved: bool,
    /// Pixels tell whether a ray passed a stretch without a proof that it is free.
    pub records_gaps: bool,
    /// The field is divided by a large Lipschitz constant.
    pub loose: bool,
    /// The field is divided by Lipschitz constants; soft shadows and ambient occlusion use what it
    /// is without.
    pub estimated: bool,
    /// The field falls behind the distance for other reasons; soft shadows follow its gradients.
    pub projected: bool,
    /// The scene's functions contain loops.
    pub loops: bool,
}

impl Features {
    /// Returns true if secondary rays are culled too: they run only the iterations that matter in
    /// the grid cell that they are in.
    pub fn culls_by_cell(self) -> bool {
        self.culled && (self.shadows || self.reflections || self.occlusion)
    }

    /// Returns true if some rays step by the distance.
    pub fn steps(self) -> bool {
        self.soft_shadows || !self.copies
    }

    /// Returns true if some rays are marched, if only to measure how narrowly they pass things.
    pub fn marches(self) -> bool {
        self.marched || self.soft_shadows
    }

    /// The overrides of `features.wgsl` and their values.
    pub fn overrides(self) -> [(&'static str, bool); 34] {
        // Destructured so that a new feature does not compile until it is handled here.
        let Self {
            planar: _,
            materials,
            seen_materials,
            unlit,
            analytic,
            marched,
            clipped,
            copies,
            shadows,
            soft_shadows,
            positional_lights,
            spot_lights,
            reflections,
            occlusion,
            sky,
            ground,
            environment,
            fog,
            fog_color,
            exposure,
            neutral_tone,
            film_tone,
            parallel,
            culled,
            instrumented,
            proved,
            records_gaps,
            loose,
            estimated,
            projected,
            loops,
        } = self;
        [
            ("SEEN_MATERIALS", seen_materials),
            ("UNLIT", unlit),
            ("ANALYTIC", analytic),
            ("MARCHED", marched),
            ("CLIPPED", clipped),
            ("COPIES", copies),
            ("PRE_INTERSECTS", analytic || clipped),
            ("ANY_MARCHED", self.marches()),
            ("SHADOWS", shadows),
            ("SOFT_SHADOWS", soft_shadows),
            ("POSITIONAL_LIGHTS", positional_lights),
            ("SPOT_LIGHTS", spot_lights),
            ("REFLECTIONS", reflections),
            ("OCCLUSION", occlusion),
            ("SKY", sky),
            ("GROUND", ground),
            ("MIRRORS_SKY", sky && materials && !reflections),
            ("ENVIRONMENT", environment),
            ("FOG", fog),
            ("FOG_COLOR", fog_color),
            ("DEVELOPS", exposure || neutral_tone || film_tone),
            ("EXPOSURE", exposure),
            ("NEUTRAL_TONE", neutral_tone),
            ("FILM_TONE", film_tone),
            ("PARALLEL", parallel),
            ("CULLED", culled),
            ("CULLED_BY_CELL", self.culls_by_cell()),
            ("INSTRUMENTED", instrumented),
            ("PROVED", proved),
            ("RECORDS_GAPS", records_gaps),
            ("LOOSE", loose),
            ("ESTIMATED", estimated),
            ("PROJECTED", projected && soft_shadows),
            ("HAS_LOOPS", loops),
        ]
    }

    /// The functions whose calls the linker drops because nothing reads what they set.
    pub fn unused(self) -> Vec<&'static str> {
        let calls = [
            (stubs::RECORD_SAMPLE, self.soft_shadows),
            (stubs::RECORD_SLOPE, self.occlusion || self.soft_shadows),
            (stubs::RECORD_GAP, self.records_gaps),
            (stubs::LIMIT_LOOPS, self.loops),
        ];
        calls.into_iter().filter(|call| !call.1).map(|call| call.0).collect()
    }
}
