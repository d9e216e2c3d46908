//! What can be shown of a picture.

/// What is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Light and materials.
    #[default]
    Shaded,
    /// Directions of the surface.
    Normals,
    /// Lengths of the rays.
    Depth,
    /// Evaluations of the field.
    Evaluations,
    /// Rays that ran out of steps.
    Capped,
    /// Rays that went through a surface.
    Overshoot,
    /// Length of the gradient.
    Slope,
    /// Which shape it is.
    Shapes,
    /// What it is made of.
    Materials,
    /// What the field promises.
    Quality,
    /// The field on a plane.
    Slice,
}

impl Mode {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 11] = [
        Self::Shaded,
        Self::Normals,
        Self::Depth,
        Self::Evaluations,
        Self::Capped,
        Self::Overshoot,
        Self::Slope,
        Self::Shapes,
        Self::Materials,
        Self::Quality,
        Self::Slice,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "Shaded",
            Self::Normals => "Normals",
            Self::Depth => "Depth",
            Self::Evaluations => "Evaluations",
            Self::Capped => "Capped rays",
            Self::Overshoot => "Overshoot",
            Self::Slope => "Gradient length",
            Self::Shapes => "Shapes",
            Self::Materials => "Materials",
            Self::Quality => "Distance quality",
            Self::Slice => "Slice",
        }
    }

    /// What it shows.
    pub fn help(self) -> &'static str {
        match self {
            Self::Shaded => "Light and materials, as `sdfc render` draws them.",
            Self::Normals => {
                "The direction of the surface, from the field's gradient in double precision: \
                 x, y, z as red, green, blue, with 0 in the middle."
            }
            Self::Depth => {
                "How long each ray is, from the nearest hit to that which nine of ten hits are nearer than."
            }
            Self::Evaluations => {
                "How often the field was evaluated for each pixel, shadows and mirrors included."
            }
            Self::Capped => {
                "Rays that ran out of steps before they met anything, and pixels that are no number."
            }
            Self::Overshoot => {
                "The field in double precision where each ray stopped: deeper inside than a quarter of \
                 a pixel, the ray went through the surface. A ray that left again on the other side \
                 cannot be told from one that met nothing."
            }
            Self::Slope => {
                "The length of the gradient where each ray stopped: 1 is a distance, above 1 the field \
                 grows faster than the distance and rays may step through."
            }
            Self::Shapes => {
                "Each shape in a colour of its own; where two blend, that of the one with the greater share."
            }
            Self::Materials => {
                "The colour of each surface without light and shadow, and what the most seen materials are."
            }
            Self::Quality => {
                "What the field of each part promises outside: the distance itself, a bound of it, or a bound \
                 after division by a constant. Nothing keeps rays from stepping through what is uncertified."
            }
            Self::Slice => {
                "The field on a plane: warm inside, cool outside, with lines of equal distance."
            }
        }
    }
}

/// A plane to show the field on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// Which coordinate is the same all over it, 0 to 2.
    pub axis: usize,
    /// That coordinate, in scene units.
    pub offset: f64,
    /// From line to line, in scene units.
    pub spacing: f64,
    /// Whether it is seen through what stands before it.
    pub over: bool,
}

impl Default for Slice {
    fn default() -> Self {
        Self { axis: 2, offset: 0.0, spacing: 0.1, over: false }
    }
}
