//! The table of ray methods, and which files make a picture's shader.

/// A ray method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// What scenes and the command line call it.
    pub name: &'static str,
    /// One sentence.
    pub summary: &'static str,
    /// Text of its file.
    pub source: &'static str,
    /// Text of a file with a gradient that belongs to it; none: any will do.
    pub gradient: Option<&'static str>,
    /// Whether it asks what the scene knows of a ray before it is marched (`ahead.wgsl`).
    pub looks_ahead: bool,
    /// What trades its cost for its error; none: nothing does.
    pub knob: Option<Knob>,
    /// Values of the knob that a chart shows, in parts of what the scene states or else of its default.
    pub charted: &'static [f64],
}

/// What trades the cost of a ray for its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knob {
    /// How many steps a ray may take.
    Steps,
    /// How near to the surface a hit is, in scene units.
    Epsilon,
    /// The same in widths of a pixel there.
    Tolerance,
}

impl Knob {
    /// What a scene's `march(...)` calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Epsilon => "epsilon",
            Self::Tolerance => "tolerance",
        }
    }

    /// What its values count.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Epsilon => "scene units",
            Self::Tolerance => "widths of a pixel",
        }
    }

    /// Its value where a scene states none; of [`Self::Epsilon`], for what is looked at from 1 away.
    pub fn default_value(self) -> f64 {
        match self {
            Self::Steps => 256.0,
            // About 100 times the rounding of f32 there.
            Self::Epsilon => 5e-5,
            Self::Tolerance => 0.25,
        }
    }
}

impl Method {
    /// Its own file, and those that it calls.
    fn files(&self) -> Vec<&'static str> {
        const AHEAD: [&str; 2] = [include_str!("wgsl/rays.wgsl"), include_str!("wgsl/ahead.wgsl")];
        let mut files = if self.looks_ahead { AHEAD.to_vec() } else { Vec::new() };
        files.push(self.source);
        files
    }

    /// Whether its file calls a function of that name, one of [`stubs`].
    pub fn calls(&self, stub: &str) -> bool {
        self.source.contains(&format!("{stub}("))
    }
}

/// All ray methods, the default first.
pub const METHODS: [Method; 10] = [
    Method {
        name: "auto",
        summary: "Relaxed steps to a quarter of a pixel, then secants, or a bracket once the sign changes.",
        source: include_str!("wgsl/auto.wgsl"),
        gradient: None,
        looks_ahead: true,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "fixed",
        summary: "Constant steps, halved once the sign changes.",
        source: include_str!("wgsl/fixed.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Steps),
        charted: &[0.25, 0.5, 1.0, 2.0, 4.0],
    },
    Method {
        name: "sphere",
        summary: "Sphere tracing to an absolute distance.",
        source: include_str!("wgsl/sphere.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Epsilon),
        charted: &[100.0, 10.0, 1.0, 0.1],
    },
    Method {
        name: "sphere-cone",
        summary: "Sphere tracing to a part of the pixel.",
        source: include_str!("wgsl/sphere_cone.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "relaxed",
        summary: "Steps longer than the distance, taken back where the balls of free space do not meet.",
        source: include_str!("wgsl/relaxed.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "accelerated",
        summary: "Steps to where the next ball would touch, were the surface flat, taken back where it does not meet.",
        source: include_str!("wgsl/accelerated.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "auto-relaxed",
        summary: "The same with the slope averaged over the steps.",
        source: include_str!("wgsl/auto_relaxed.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "segment",
        summary: "Steps as long as the slope along the next stretch of the ray allows, which grows with them.",
        source: include_str!("wgsl/segment.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "interval",
        summary: "Stretches of the ray are proven free or cut, the nearer part first, down to a part of the tolerance.",
        source: include_str!("wgsl/interval.wgsl"),
        gradient: None,
        looks_ahead: false,
        knob: Some(Knob::Tolerance),
        charted: &PIXELS,
    },
    Method {
        name: "practical",
        summary: "A classroom practical's march and normals, faults and all: to compare with.",
        source: include_str!("wgsl/baseline/practical.wgsl"),
        gradient: Some(include_str!("wgsl/baseline/central.wgsl")),
        looks_ahead: false,
        knob: None,
        charted: &[1.0],
    },
];

/// Of a quarter of a pixel: from the radius of a pixel down to a hundredth of its width.
const PIXELS: [f64; 4] = [2.0, 1.0, 0.2, 0.04];

/// The method that finds the first hit whatever the field promises.
pub const UNCERTIFIED: &str = "interval";

/// The method of that name.
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}

/// What a scene needs beyond the least.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Features {
    /// Something is painted.
    pub materials: bool,
    /// Some of the scene is met without marching.
    pub closed: bool,
    /// Some is left to march.
    pub marched: bool,
    /// That lies in a box.
    pub clipped: bool,
    /// All of that is met in closed form, as far as it is sampled at a place.
    pub copies: bool,
    /// Some light casts a shadow.
    pub shadows: bool,
    /// Some light's shadow is soft.
    pub soft_shadows: bool,
    /// Some light stands at a point.
    pub lamps: bool,
    /// Some light shines in a cone.
    pub spots: bool,
    /// Surfaces mirror each other.
    pub reflections: bool,
    /// Light from everywhere does not reach everything.
    pub occlusion: bool,
    /// The background changes with the direction.
    pub sky: bool,
    /// What is far away fades.
    pub fog: bool,
    /// It fades to a colour of its own.
    pub fog_color: bool,
    /// Rays from the eye are parallel.
    pub parallel: bool,
    /// Rays from the eye visit only those rounds of loops that can matter to them.
    pub culled: bool,
    /// A pixel's evaluations are not those of the field, but of operands of its loops: all rounds that were visited.
    pub counted: bool,
}

impl Features {
    /// Whether there are rays from elsewhere too that visit only rounds that can matter.
    pub fn roaming(self) -> bool {
        self.culled && (self.shadows || self.reflections || self.occlusion)
    }

    /// Whether some rays step by the distance.
    pub fn steps(self) -> bool {
        self.soft_shadows || !self.copies
    }

    /// The overrides of `features.wgsl` and their values.
    pub fn overrides(self) -> [(&'static str, bool); 19] {
        // Taken apart so that a new feature does not compile until it is thought of here. Materials have a file
        // of their own.
        let Self {
            materials: _,
            closed,
            marched,
            clipped,
            copies,
            shadows,
            soft_shadows,
            lamps,
            spots,
            reflections,
            occlusion,
            sky,
            fog,
            fog_color,
            parallel,
            culled,
            counted,
        } = self;
        [
            ("CLOSED", closed),
            ("MARCHED", marched),
            ("CLIPPED", clipped),
            ("COPIES", copies),
            ("LOOKS_AHEAD", closed || clipped),
            ("ANY_MARCHED", marched || soft_shadows),
            ("SHADOWS", shadows),
            ("SOFT_SHADOWS", soft_shadows),
            ("LAMPS", lamps),
            ("SPOTS", spots),
            ("REFLECTIONS", reflections),
            ("OCCLUSION", occlusion),
            ("SKY", sky),
            ("FOG", fog),
            ("FOG_COLOR", fog_color),
            ("PARALLEL", parallel),
            ("CULLED", culled),
            ("ROAMING", self.roaming()),
            ("COUNTED", counted),
        ]
    }

    /// Functions whose calls have no use.
    pub fn unused(self) -> Vec<&'static str> {
        let stubs = [(stubs::PASSED, self.soft_shadows), (stubs::SLOPED, self.occlusion)];
        stubs.into_iter().filter(|stub| !stub.1).map(|stub| stub.0).collect()
    }
}

/// Where a picture's distance and gradient come from. Pictures that are compared for speed differ in nothing
/// else: all but [`FieldSource::Scene`] take the gradient by the same four evaluations of the field. A method's
/// own gradient goes before any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FieldSource {
    /// The scene supplies both.
    #[default]
    Scene,
    /// The scene supplies the distance.
    Distance,
    /// An interpreter of operations on two primitives each, from buffers at bindings 3 to 6.
    Units,
    /// A stack machine, from a buffer at binding 3.
    Tape,
}

impl FieldSource {
    /// The files of `field` and of `field_gradient`.
    fn files(self) -> [&'static str; 2] {
        const SCENE: &str = include_str!("wgsl/field.wgsl");
        const DERIVATIVE: &str = include_str!("wgsl/gradient.wgsl");
        const DIFFERENCES: &str = include_str!("wgsl/baseline/differences.wgsl");
        match self {
            Self::Scene => [SCENE, DERIVATIVE],
            Self::Distance => [SCENE, DIFFERENCES],
            Self::Units => [include_str!("wgsl/baseline/units.wgsl"), DIFFERENCES],
            Self::Tape => [include_str!("wgsl/baseline/tape.wgsl"), DIFFERENCES],
        }
    }
}

/// How a picture's shader is called.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Form {
    /// A compute stage, one invocation for each pixel of a tile, into a buffer.
    #[default]
    Compute,
    /// As [`Form::Compute`], with the normals of what rays from the eye meet for colours, and no other rays.
    Normals,
    /// A triangle over the target and a fragment stage, the target's first row topmost.
    Fragment,
    /// As [`Form::Fragment`], the target's first row lowest.
    FragmentUp,
    /// A function of a place, the size of the picture, the mouse and the clock, without buffers.
    Shadertoy,
}

impl Form {
    fn files(self) -> &'static [&'static str] {
        const PICTURE: &str = include_str!("wgsl/picture.wgsl");
        const BUFFER: &str = include_str!("wgsl/view_buffer.wgsl");
        const COMPUTE: &str = include_str!("wgsl/compute.wgsl");
        const FRAGMENT: &str = include_str!("wgsl/fragment.wgsl");
        match self {
            Self::Compute => &[PICTURE, BUFFER, COMPUTE],
            Self::Normals => &[include_str!("wgsl/normals.wgsl"), BUFFER, COMPUTE],
            Self::Fragment => &[PICTURE, BUFFER, include_str!("wgsl/rows_down.wgsl"), FRAGMENT],
            Self::FragmentUp => &[PICTURE, BUFFER, include_str!("wgsl/rows_up.wgsl"), FRAGMENT],
            Self::Shadertoy => &[PICTURE, include_str!("wgsl/shadertoy.wgsl")],
        }
    }
}

/// Text of a picture's shader: whole files, joined. Of all branches on `features.wgsl` both sides are still there.
pub fn source(method: &Method, features: Features) -> String {
    source_over(FieldSource::Scene, Form::Compute, method, features)
}

/// As [`source`], with the distance and the gradient from elsewhere, or called otherwise.
pub fn source_over(field: FieldSource, form: Form, method: &Method, features: Features) -> String {
    let [field, gradient] = field.files();
    let shade = if features.materials {
        include_str!("wgsl/shade_painted.wgsl")
    } else {
        include_str!("wgsl/shade_plain.wgsl")
    };
    let mut files = vec![
        include_str!("wgsl/features.wgsl"),
        include_str!("wgsl/view.wgsl"),
        VISIT_LAYOUT,
        include_str!("wgsl/cells_at.wgsl"),
        include_str!("wgsl/visits.wgsl"),
        field,
        method.gradient.unwrap_or(gradient),
        include_str!("wgsl/frame.wgsl"),
        RANGES,
        RAY,
        BRACKET,
        PASSED,
    ];
    files.extend(method.files());
    files.extend([
        include_str!("wgsl/lamp.wgsl"),
        include_str!("wgsl/occlusion.wgsl"),
        include_str!("wgsl/shade.wgsl"),
        shade,
        include_str!("wgsl/secondary.wgsl"),
        include_str!("wgsl/behind.wgsl"),
        include_str!("wgsl/pixel.wgsl"),
    ]);
    files.extend(form.files());
    files.join("\n")
}

/// Text of a ray method by itself, for a shader of someone else's. Its entry point is there only to
/// reach `trace` and `intersect`.
pub fn ray_source(method: &Method) -> String {
    let [field, _] = FieldSource::Scene.files();
    let features = include_str!("wgsl/features.wgsl");
    let mut files = vec![features, field, RANGES, RAY, BRACKET, PASSED];
    files.extend(method.files());
    files.extend([include_str!("wgsl/intersect.wgsl"), include_str!("wgsl/anchor.wgsl")]);
    files.join("\n")
}

/// Text of the shader that runs before a picture with [`Features::culled`]: entry points `mark` and `list`, for cells
/// `least_of_groups`, `mark_groups` and `list_cells`.
pub fn prune_source() -> String {
    let files = [
        include_str!("wgsl/features.wgsl"),
        include_str!("wgsl/view.wgsl"),
        VISIT_LAYOUT,
        include_str!("wgsl/frame.wgsl"),
        RAY,
        include_str!("wgsl/view_buffer.wgsl"),
        include_str!("wgsl/prune.wgsl"),
        include_str!("wgsl/cells_at.wgsl"),
        include_str!("wgsl/cells.wgsl"),
    ];
    files.join("\n")
}

const VISIT_LAYOUT: &str = include_str!("wgsl/visit_layout.wgsl");
const RANGES: &str = include_str!("wgsl/ranges.wgsl");
const RAY: &str = include_str!("wgsl/ray.wgsl");
const BRACKET: &str = include_str!("wgsl/bracket.wgsl");
const PASSED: &str = include_str!("wgsl/passed.wgsl");

/// What stands before the functions of [`Form::Shadertoy`] in the text for shadertoy.com, in GLSL.
pub const SHADERTOY_HEAD: &str = include_str!("shadertoy/head.glsl");
/// What stands behind them: the entry point.
pub const SHADERTOY_TAIL: &str = include_str!("shadertoy/tail.glsl");

/// Names of the functions that a scene supplies, and of those that a host calls.
pub mod stubs {
    /// `fn field(p: vec3f) -> f32`, signed distance.
    pub const FIELD: &str = "field";
    /// `fn field_gradient(p: vec3f) -> vec3f`, its spatial derivative, unless the method has its own.
    pub const GRADIENT: &str = "field_gradient";
    /// `fn hits(origin: vec3f, direction: vec3f) -> f32`, where a ray is first inside what is not marched, where
    /// [`super::Features::closed`] is set.
    pub const HITS: &str = "hits";
    /// `fn closed(p: vec3f) -> f32`, distance to that.
    pub const CLOSED: &str = "closed";
    /// `fn marched(p: vec3f) -> f32`, distance to all else, where there is some.
    pub const MARCHED: &str = "marched";
    /// `fn clip(origin: vec3f, direction: vec3f) -> vec2f`, where a ray passes a box around what is marched, where
    /// [`super::Features::clipped`] is set.
    pub const CLIP: &str = "clip";
    /// `fn copies(origin: vec3f, direction: vec3f) -> vec2f`, where a ray is first inside of what is sampled at its origin, and how far
    /// from there nothing else is marched, where [`super::Features::copies`] is set.
    pub const COPIES: &str = "copies";
    /// `fn field_range(a: vec3f, b: vec3f) -> vec2f`, the least and the greatest of `field` on the stretch from a to b.
    pub const RANGE: &str = "field_range";
    /// `fn field_slope_range(a: vec3f, b: vec3f, direction: vec3f) -> vec2f`, the least and the greatest slope of `field` on
    /// the stretch from a to b, which leads along the direction.
    pub const SLOPE_RANGE: &str = "field_slope_range";
    /// `fn material(p: vec3f) -> Material`, where [`super::Features::materials`] is set.
    pub const MATERIAL: &str = "material";
    /// `fn load_frame()`; calls to it are dropped where nothing is known per frame.
    pub const LOAD_FRAME: &str = "load_frame";
    /// `fn trace(ray: Ray) -> Trace`, which a method supplies and a host may call.
    pub const TRACE: &str = "trace";
    /// `fn intersect(origin: vec3f, direction: vec3f, t_min: f32, t_max: f32) -> Trace`, which a host may call.
    pub const INTERSECT: &str = "intersect";
    /// `var<private> view: View` of [`super::Form::Shadertoy`], and the functions that fill it.
    pub const VIEW: &str = "view";
    /// `fn load_view()`, what of the view does not follow from the camera.
    pub const LOAD_VIEW: &str = "load_view";
    /// `fn camera() -> Camera`.
    pub const CAMERA: &str = "camera";
    /// `fn load_time(now: f32)`; calls to it are dropped where nothing depends on the time.
    pub const LOAD_TIME: &str = "load_time";
    /// `fn load_count(count: f32)`; calls to it are dropped where nothing depends on the frame's number.
    pub const LOAD_COUNT: &str = "load_count";
    /// `fn load_headlight()`; calls to it are dropped where the scene states lights.
    pub const LOAD_HEADLIGHT: &str = "load_headlight";
    /// `fn image(...) -> vec4f` of [`super::Form::Shadertoy`], which the entry point of the text calls.
    pub const IMAGE: &str = "image";
    /// `fn passed(t: f32, distance: f32)`, told each sample of a ray; not supplied by a scene, but dropped where
    /// no shadow is soft.
    pub const PASSED: &str = "passed";
    /// `fn reach_0(round: f32, p: vec3f) -> vec3f` and so on, of [`super::prune_source`]: how far a point is from where a round of
    /// a loop can matter to a ray, or less; the round's operand less what blends reach; the operand.
    pub const REACHES: [&str; 8] =
        ["reach_0", "reach_1", "reach_2", "reach_3", "reach_4", "reach_5", "reach_6", "reach_7"];
    /// `var<storage, read> visits`, the lists of rounds.
    pub const VISITS: &str = "visits";
    /// `var<private> visited: u32`, how many rounds were visited, where [`super::Features::counted`] is set.
    pub const VISITED: &str = "visited";
    /// `var<private> visit_spans: array<vec2u, 8>`, how many rounds of each loop to visit, and where in `visits` the first one's
    /// number stands.
    pub const VISIT_SPANS: &str = "visit_spans";
    /// `fn visit_at(p: vec3f)`, which sets the latter for a place.
    pub const VISIT_AT: &str = "visit_at";
    /// `var<private> visit_free: f32`: what is left out is no nearer than that.
    pub const VISIT_FREE: &str = "visit_free";
    /// `fn sloped(square: f32)`, told the square of each gradient; dropped where nothing is occluded.
    pub const SLOPED: &str = "sloped";
}
