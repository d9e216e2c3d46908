//! The colours of charts, on a light and on a dark background.

use plotters::style::RGBColor;

/// A background, and colours that can be distinguished on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// The background.
    pub(super) paper: RGBColor,
    /// Text.
    pub(super) ink: RGBColor,
    /// Small text.
    pub(super) soft: RGBColor,
    /// Grid lines and the band behind the front.
    pub(super) faint: RGBColor,
    /// The methods, in order.
    pub(super) methods: [RGBColor; 10],
}

impl Theme {
    /// The light theme. The first seven colours are those of Okabe and Ito ("Color universal
    /// design", 2008) except black and yellow.
    pub const LIGHT: Self = Self {
        paper: RGBColor(252, 252, 250),
        ink: RGBColor(40, 44, 52),
        soft: RGBColor(96, 100, 108),
        faint: RGBColor(214, 216, 220),
        methods: [
            RGBColor(0, 114, 178),
            RGBColor(213, 94, 0),
            RGBColor(0, 158, 115),
            RGBColor(204, 121, 167),
            RGBColor(230, 159, 0),
            RGBColor(86, 180, 233),
            RGBColor(120, 94, 240),
            RGBColor(150, 20, 60),
            RGBColor(20, 20, 24),
            RGBColor(140, 140, 140),
        ],
    };

    /// The dark theme.
    pub const DARK: Self = Self {
        paper: RGBColor(22, 24, 29),
        ink: RGBColor(222, 224, 228),
        soft: RGBColor(164, 168, 176),
        faint: RGBColor(62, 66, 74),
        methods: [
            RGBColor(46, 140, 255),
            RGBColor(236, 112, 20),
            RGBColor(20, 184, 136),
            RGBColor(224, 146, 190),
            RGBColor(240, 184, 40),
            RGBColor(130, 208, 250),
            RGBColor(160, 140, 255),
            RGBColor(236, 72, 112),
            RGBColor(250, 250, 252),
            RGBColor(130, 130, 134),
        ],
    };

    fn colors(&self) -> impl Iterator<Item = RGBColor> {
        [self.paper, self.ink, self.soft, self.faint].into_iter().chain(self.methods)
    }

    /// CSS rules that replace the colours of [`Theme::LIGHT`] by those of [`Theme::DARK`] on dark
    /// pages.
    pub(super) fn css() -> String {
        let pairs = Self::LIGHT.colors().zip(Self::DARK.colors());
        let rules = pairs.map(|(light, dark)| {
            let [light, dark] =
                [light, dark].map(|RGBColor(r, g, b)| format!("#{r:02X}{g:02X}{b:02X}"));
            format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
        });
        format!("@media (prefers-color-scheme:dark){{{}}}", rules.collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use crate::chart::svg;
    use crate::chart::testing::{FONT, chart, row};

    /// A colour without a rule would be that of the light ground on the dark one.
    #[test]
    fn every_colour_of_an_svg_has_its_rule() -> Result<(), Box<dyn std::error::Error>> {
        let rows = ["auto", "fixed", "sphere", "segment"].map(|name| row(name, 10.0, 1.0));
        let text = svg(&chart(rows.to_vec()), FONT)?;
        let (style, body) = text.split_once("</style>").ok_or("no style")?;
        for kind in ["fill", "stroke"] {
            let start = format!("{kind}=\"#");
            let colors = body.split(&start).skip(1);
            for color in colors.filter_map(|rest| rest.get(..6)) {
                assert!(style.contains(&format!("[{kind}=\"#{color}\"]")), "{kind} {color}");
            }
        }
        Ok(())
    }
}
