//! Several samples per pixel, averaged.

use super::Image;
use crate::error::RenderError;
use crate::limits::MAX_SAMPLES;

/// The golden ratio minus 1: the number whose multiples, modulo 1, stay farthest apart.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Returns the positions of `count` samples in a pixel, in pixels to the right of its centre and
/// below it. One sample is at the centre; of several no two share a row or a column, so that edges
/// along either have as many shades as there are samples. Their mean is the centre, and the first
/// is the nearest to it.
///
/// The positions are a lattice, `((i + 1/2) / n, i * golden)` modulo 1: the same at every pixel, in
/// every frame, on every device.
///
/// # Errors
///
/// [`RenderError::Samples`] for 0 and for more than [`MAX_SAMPLES`].
pub fn sample_offsets(count: u32) -> Result<Vec<[f64; 2]>, RenderError> {
    if !(1..=MAX_SAMPLES).contains(&count) {
        return Err(RenderError::Samples(count));
    }
    let total = f64::from(count);
    let lattice = |index: u32| {
        let index = f64::from(index);
        [(index + 0.5) / total - 0.5, (index * GOLDEN).fract() - 0.5]
    };
    let mut offsets: Vec<[f64; 2]> = (0..count).map(lattice).collect();
    let mean = offsets.iter().map(|offset| offset[1]).sum::<f64>() / total;
    offsets.iter_mut().for_each(|offset| offset[1] -= mean);
    offsets.sort_by(|a, b| length(a).total_cmp(&length(b)));
    Ok(offsets)
}

fn length([x, y]: &[f64; 2]) -> f64 {
    x.hypot(*y)
}

impl Image {
    /// Adds the colours and evaluations of another picture of the same size, and what it leaves
    /// unproven; depths and statuses stay. The sum of `n` pictures [divided](Self::divide) by `n`
    /// is their mean in linear light.
    pub fn add(&mut self, other: &Image) {
        for (pixel, more) in self.pixels.iter_mut().zip(&other.pixels) {
            for (channel, more) in pixel.color.iter_mut().zip(more.color) {
                *channel += more;
            }
            pixel.unproven |= more.unproven;
            pixel.evaluations = pixel.evaluations.saturating_add(more.evaluations);
            pixel.primary_evaluations =
                pixel.primary_evaluations.saturating_add(more.primary_evaluations);
        }
    }

    /// Divides the colours.
    pub fn divide(&mut self, by: f32) {
        for pixel in &mut self.pixels {
            pixel.color.iter_mut().for_each(|channel| *channel /= by);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::footprint::Footprint;

    #[test]
    fn one_ray_passes_through_the_centre() {
        assert_eq!(sample_offsets(1), Ok(vec![[0.0, 0.0]]));
        for wrong in [0, MAX_SAMPLES + 1] {
            assert_eq!(sample_offsets(wrong), Err(RenderError::Samples(wrong)));
        }
    }

    #[test]
    fn places_are_spread_about_the_centre() {
        for count in [2, 3, 4, 8, 16, 64, MAX_SAMPLES] {
            let offsets = sample_offsets(count).unwrap();
            for axis in 0..2 {
                let mut along: Vec<f64> = offsets.iter().map(|offset| offset[axis]).collect();
                let mean = along.iter().sum::<f64>() / f64::from(count);
                assert!(mean.abs() < 1e-9, "{count}: {mean}");
                along.sort_by(f64::total_cmp);
                let apart = along.windows(2).all(|pair| pair[1] - pair[0] > 0.3 / f64::from(count));
                assert!(apart, "{count}: {along:?}");
                assert!(along.iter().all(|offset| offset.abs() < 0.75), "{count}: {along:?}");
            }
            assert!(offsets.iter().all(|offset| length(offset) >= length(&offsets[0])));
        }
    }

    #[test]
    fn a_mean_is_of_light_and_leaves_depths() {
        let mut sum = Image::new([1, 1], Footprint::default()).unwrap();
        let mut other = sum.clone();
        sum.pixels_mut()[0].depth = 3.0;
        sum.pixels_mut()[0].color = [1.0, 0.5, 0.0, 1.0];
        other.pixels_mut()[0].color = [0.0, 0.5, 0.5, 1.0];
        other.pixels_mut()[0].evaluations = 7;
        sum.add(&other);
        sum.divide(2.0);
        let pixel = sum.pixels()[0];
        assert_eq!((pixel.color, pixel.depth), ([0.5, 0.5, 0.25, 1.0], 3.0));
        assert_eq!(pixel.evaluations, 7);
    }
}
