//! The ways to evaluate the field.

use sdfc_codegen::FieldSource;

/// How a variant evaluates the field.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Units,
    Tape,
    Specialized,
    LiveLiterals,
    /// Loops over similar parts, with all iterations.
    Looped,
    /// The same; primary rays use the active lists of their tiles.
    Culled,
}

impl Kind {
    /// The order is that of a row.
    pub(super) const ALL: [Self; 6] = [
        Self::Units,
        Self::Tape,
        Self::Specialized,
        Self::LiveLiterals,
        Self::Looped,
        Self::Culled,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Units => "units",
            Self::Tape => "tape",
            Self::Specialized => "specialized",
            Self::LiveLiterals => "live-literals",
            Self::Looped => "loops",
            Self::Culled => "culled",
        }
    }

    pub(super) fn field(self, by_differences: bool) -> FieldSource {
        match self {
            Self::Units => FieldSource::Units,
            Self::Tape => FieldSource::Tape,
            Self::Specialized | Self::LiveLiterals | Self::Looped | Self::Culled => {
                match by_differences {
                    true => FieldSource::Distance,
                    false => FieldSource::Scene,
                }
            }
        }
    }
}
