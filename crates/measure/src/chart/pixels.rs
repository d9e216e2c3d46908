//! Draws a chart as pixels: what plotters draws for an SVG, with supersampling.

use std::convert::Infallible;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops::thumbnail;
use image::{Rgb, RgbImage};
use plotters::prelude::*;
use plotters::style::TextStyle;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind, rasterizer,
};

use super::Chart;
use super::draw::{DrawError, Font, SIZE, draw};
use super::theme::Theme;

/// Pixels of the picture per unit of the chart, so that small text stays sharp.
const SCALE: u32 = 2;
/// Samples per pixel along each axis.
const SAMPLES: u32 = 2;
const ENLARGED: u32 = SCALE * SAMPLES;

/// Draws the chart as PNG: the picture of [`svg`](super::svg) in one theme.
///
/// # Errors
///
/// [`DrawError`] if there is no row to draw, or the font is none.
pub fn png(chart: &Chart, font: Font, theme: &Theme) -> Result<Vec<u8>, DrawError> {
    let failed = |error: &dyn std::fmt::Display| DrawError::new(error);
    font.register()?;
    let mut fine = Fine(RgbImage::new(ENLARGED * SIZE.0, ENLARGED * SIZE.1));
    draw(chart, &Enlarged(&mut fine).into_drawing_area(), theme).map_err(|error| failed(&error))?;
    let picture = thumbnail(&fine.0, SCALE * SIZE.0, SCALE * SIZE.1);
    let mut file = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(encoder).map_err(|error| failed(&error))?;
    Ok(file)
}

/// A pixel buffer as a backend of plotters.
struct Fine(RgbImage);

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for &mut Fine {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.0.dimensions()
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        let place = u32::try_from(x).ok().zip(u32::try_from(y).ok());
        if let Some(Rgb(below)) = place.and_then(|(x, y)| self.0.get_pixel_mut_checked(x, y)) {
            let (r, g, b) = color.rgb;
            *below = if color.alpha >= 1.0 {
                [r, g, b]
            } else {
                let mixed = |axis: usize, above: u8| {
                    let [under, over] = [below[axis], above].map(f64::from);
                    (under + (over - under) * color.alpha).round() as u8
                };
                [mixed(0, r), mixed(1, g), mixed(2, b)]
            };
        }
        Ok(())
    }
}

/// A backend with lengths in units of the chart.
struct Enlarged<'f>(&'f mut Fine);

/// A style with scaled line widths.
struct Wide {
    color: BackendColor,
    width: u32,
}

impl BackendStyle for Wide {
    fn color(&self) -> BackendColor {
        self.color
    }

    fn stroke_width(&self) -> u32 {
        self.width
    }
}

fn wide(style: &impl BackendStyle) -> Wide {
    Wide { color: style.color(), width: ENLARGED * style.stroke_width() }
}

fn far((x, y): BackendCoord) -> BackendCoord {
    (x * ENLARGED as i32, y * ENLARGED as i32)
}

impl DrawingBackend for Enlarged<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        SIZE
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.draw_rect((x, y), (x + 1, y + 1), &color, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Drawn {
        rasterizer::draw_line(&mut self.0, far(from), far(to), &wide(style))
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        rasterizer::draw_rect(&mut self.0, far(from), far(to), &wide(style), fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        (&mut self.0).draw_path(path.into_iter().map(far), &wide(style))
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        rasterizer::draw_circle(&mut self.0, far(center), ENLARGED * radius, &wide(style), fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        (&mut self.0).fill_polygon(corners.into_iter().map(far), &wide(style))
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        place: BackendCoord,
    ) -> Drawn {
        let size = f64::from(ENLARGED) * style.size();
        let font = FontDesc::new(FontFamily::SansSerif, size, style.style());
        let font = font.transform(style.transform());
        let style = TextStyle { font, color: style.color(), pos: style.anchor() };
        (&mut self.0).draw_text(text, &style, far(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::testing::{FONT, chart, row};
    use crate::chart::{Theme, svg};

    #[test]
    fn both_pictures_show_the_same_marks() -> Result<(), Box<dyn std::error::Error>> {
        let chart = chart(vec![row("auto", 10.0, 1e-3), row("fixed", 1000.0, 10.0)]);
        let text = svg(&chart, FONT)?;
        let theme = Theme::DARK;
        let picture = image::load_from_memory(&png(&chart, FONT, &theme)?)?.into_rgb8();
        assert_eq!(picture.dimensions(), (SCALE * SIZE.0, SCALE * SIZE.1));
        let RGBColor(r, g, b) = theme.paper;
        assert_eq!(picture.get_pixel(2, 2), &Rgb([r, g, b]));
        for (index, color) in theme.methods[..2].iter().enumerate() {
            // A disc of the SVG is at the same position in the PNG.
            let RGBColor(r, g, b) = Theme::LIGHT.methods[index];
            let fill = format!("fill=\"#{r:02X}{g:02X}{b:02X}\"");
            let circle =
                text.lines().find(|line| line.starts_with("<circle") && line.contains(&fill));
            let circle = circle.ok_or("no disc")?;
            let number = |name: &str| -> Option<u32> {
                circle.split_once(&format!("{name}=\""))?.1.split('"').next()?.parse().ok()
            };
            let (x, y) = number("cx").zip(number("cy")).ok_or("no place")?;
            let RGBColor(r, g, b) = *color;
            assert_eq!(picture.get_pixel(SCALE * x, SCALE * y), &Rgb([r, g, b]));
        }
        Ok(())
    }
}
