//! The list of views.

use crate::views::input::ViewInput;
use crate::views::legend::Legend;
use crate::views::view::View;
use crate::views::{
    depth, distance_quality, evaluations, gradient_length, grid, materials, normals, out_of_steps,
    overshoot, shaded, shapes, slice,
};

/// A view of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewMode {
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
    OutOfSteps,
    /// Rays that went through a surface.
    Overshoot,
    /// Length of the field's gradient.
    GradientLength,
    /// The shape that each pixel belongs to.
    Shapes,
    /// Colours without light.
    Materials,
    /// The field's guarantees about the distance.
    DistanceQuality,
    /// The field on a plane.
    Slice,
    /// Lines of equal coordinates.
    Grid,
}

impl ViewMode {
    /// All views in the order of the menu.
    pub const ALL: [Self; 12] = [
        Self::Shaded,
        Self::Normals,
        Self::Depth,
        Self::Evaluations,
        Self::OutOfSteps,
        Self::Overshoot,
        Self::GradientLength,
        Self::Shapes,
        Self::Materials,
        Self::DistanceQuality,
        Self::Slice,
        Self::Grid,
    ];

    /// The next view of the menu; after the last one, the first.
    pub fn next(self) -> Self {
        let at = Self::ALL.iter().position(|it| *it == self).unwrap_or(0);
        Self::ALL[(at + 1) % Self::ALL.len()]
    }

    /// The name in the menu.
    pub fn name(self) -> &'static str {
        self.view().name
    }

    /// The hover text: the quantity that the view shows, and its unit.
    pub fn help(self) -> &'static str {
        self.view().help
    }

    /// The colours of each pixel as red, green, blue, alpha in sRGB, and their legend.
    pub fn paint(self, input: &ViewInput<'_>) -> (Vec<u8>, Legend) {
        (self.view().paint)(input)
    }

    fn view(self) -> &'static View {
        match self {
            Self::Shaded => &shaded::VIEW,
            Self::Normals => &normals::VIEW,
            Self::Depth => &depth::VIEW,
            Self::Evaluations => &evaluations::VIEW,
            Self::OutOfSteps => &out_of_steps::VIEW,
            Self::Overshoot => &overshoot::VIEW,
            Self::GradientLength => &gradient_length::VIEW,
            Self::Shapes => &shapes::VIEW,
            Self::Materials => &materials::VIEW,
            Self::DistanceQuality => &distance_quality::VIEW,
            Self::Slice => &slice::VIEW,
            Self::Grid => &grid::VIEW,
        }
    }
}
