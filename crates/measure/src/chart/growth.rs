//! Draws how the cost per pixel grows with the number of leaves, beside the square root; both axes
//! are logarithmic.

use plotters::prelude::*;

use super::draw::{DrawError, Font, mesh, themed};

const SIZE: (u32, u32) = (760, 460);
/// Margin as a fraction of the range.
const MARGIN: f64 = 1.4;

/// The data of the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// Title: the scene and the GPU.
    pub title: String,
    /// Label of the cost, with its unit.
    pub cost: String,
    /// Names and points: number of leaves and cost per pixel. Values that are not above 0 are left
    /// out.
    pub series: Vec<(String, Vec<(f64, f64)>)>,
}

/// Draws the plot as SVG.
///
/// # Errors
///
/// [`DrawError`] if there is nothing to draw, or the font is none.
pub fn growth_svg(growth: &Growth, font: Font) -> Result<String, DrawError> {
    let positive = |&&(leaves, cost): &&(f64, f64)| leaves > 0.0 && cost > 0.0;
    let series: Vec<(&str, Vec<(f64, f64)>)> = growth
        .series
        .iter()
        .map(|(name, points)| (&name[..], points.iter().filter(positive).copied().collect()))
        .collect();
    let all = || series.iter().flat_map(|(_, points)| points.iter().copied());
    let Some(leaves) = span(all().map(|point| point.0)) else {
        return Err(DrawError::new(&"nothing was measured"));
    };
    // The square root, from the first point on.
    let first = series.iter().find_map(|(_, points)| points.first().copied());
    let (from, at) = first.unwrap_or((1.0, 1.0));
    let root = |leaves: f64| (leaves, at * (leaves / from).sqrt());
    let ends = leaves.map(root);
    let Some(costs) = span(all().chain(ends).map(|point| point.1)) else {
        return Err(DrawError::new(&"nothing was measured"));
    };
    font.register()?;
    themed(SIZE, |area, theme| {
        area.fill(&theme.paper)?;
        let label = |size| ("sans-serif", size).into_font().color(&theme.ink);
        let mut plane = ChartBuilder::on(area)
            .caption(&growth.title, label(14))
            .margin(12)
            .margin_right(24)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d(
                (leaves[0]..leaves[1]).log_scale(),
                (costs[0]..costs[1]).log_scale(),
            )?;
        mesh(&mut plane, theme, ["leaves", &growth.cost])?;
        plane
            .draw_series(LineSeries::new(ends, theme.soft.stroke_width(1)))?
            .label("square root")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], theme.soft));
        for (index, (name, points)) in series.iter().enumerate() {
            let color = theme.methods[index % theme.methods.len()];
            plane
                .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
                .label(*name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 5, color.filled()));
            let discs = points.iter().map(|&point| Circle::new(point, 4, color.filled()));
            plane.draw_series(discs)?;
        }
        plane
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(theme.paper.mix(0.85))
            .border_style(theme.faint)
            .label_font(label(13))
            .draw()?;
        area.present()
    })
}

/// Returns the range of values, with a margin.
fn span(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let ends = values.fold(None, |ends: Option<[f64; 2]>, value| {
        let [lo, hi] = ends.unwrap_or([value; 2]);
        Some([lo.min(value), hi.max(value)])
    });
    ends.map(|[lo, hi]| [lo / MARGIN, hi * MARGIN])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_those_of_what_is_shown() {
        assert_eq!(span([4.0, 2.0, 8.0].into_iter()), Some([2.0 / MARGIN, 8.0 * MARGIN]));
        assert_eq!(span(std::iter::empty()), None);
    }
}
