//! A picture of all directions by longitude and latitude, reduced while its rows are read.
//!
//! The middle of the picture is in the direction -z, where a camera on the side of z looks; its
//! right half is towards +x, its top row towards +y.

use std::f32::consts::PI;

use super::octahedron::Vector;
use super::radiance::Radiance;

/// The largest number of columns that are kept; there are half as many rows.
pub const MAX_COLUMNS: usize = 1024;

/// The pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Linear colours, row by row, from the top.
    pub pixels: Vec<Vector>,
}

impl Panorama {
    /// Reads a picture. If it has more than [`MAX_COLUMNS`] columns, each pixel is the mean over
    /// its part of the sphere.
    ///
    /// # Errors
    ///
    /// Returns the reason as the rest of a sentence about the picture.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut picture = Radiance::new(bytes)?;
        let [width, height] = picture.size;
        let size = [width.min(MAX_COLUMNS), height.min(MAX_COLUMNS / 2)];
        let mut sums = vec![[0.0f64; 4]; size[0] * size[1]];
        let (mut row, mut reduced) = (Vec::new(), vec![[0.0; 3]; size[0]]);
        let columns: Vec<_> = shares(width, size[0]).collect();
        for (y, rows) in shares(height, size[1]).enumerate() {
            picture.row(&mut row)?;
            reduced.fill([0.0; 3]);
            for (pixel, shares) in row.iter().zip(&columns) {
                for &(column, share) in shares {
                    for (sum, &lane) in reduced[column].iter_mut().zip(pixel) {
                        *sum += share * f64::from(lane);
                    }
                }
            }
            let latitude = std::f64::consts::PI * (0.5 - (y as f64 + 0.5) / height as f64);
            for (target, share) in rows {
                let weight = share * latitude.cos();
                let sums = &mut sums[target * size[0]..][..size[0]];
                for (sum, pixel) in sums.iter_mut().zip(&reduced) {
                    let [red, green, blue] = *pixel;
                    for (sum, lane) in sum.iter_mut().zip([red, green, blue, 1.0]) {
                        *sum += weight * lane;
                    }
                }
            }
        }
        let mean = |[red, green, blue, weight]: [f64; 4]| {
            [red, green, blue].map(|sum| (sum / weight.max(f64::MIN_POSITIVE)) as f32)
        };
        Ok(Self { size, pixels: sums.into_iter().map(mean).collect() })
    }

    /// The light from a direction of unit length, interpolated.
    pub fn light(&self, [x, y, z]: Vector) -> Vector {
        let [width, height] = self.size;
        let longitude = angle(-z, x) / (2.0 * PI) + 0.5;
        let from_above = angle(y, (x * x + z * z).sqrt()) / PI;
        // Half a pixel left of the picture is its right edge.
        let column = longitude * width as f32 + (width as f32 - 0.5);
        let row = (from_above * height as f32 - 0.5).clamp(0.0, (height - 1) as f32);
        let (left, top) = (column as usize, row as usize);
        let [along, down] = [column - left as f32, row - top as f32];
        let columns = [left, left + 1].map(|at| at % width);
        let rows = [top, (top + 1).min(height - 1)];
        let pixel = |row: usize, column: usize| self.pixels[row * width + column];
        let [a, b] = columns.map(|column| pixel(rows[0], column));
        let [c, d] = columns.map(|column| pixel(rows[1], column));
        [0, 1, 2].map(|lane| {
            let above = a[lane] + along * (b[lane] - a[lane]);
            let below = c[lane] + along * (d[lane] - c[lane]);
            above + down * (below - above)
        })
    }
}

/// The angle of a point from the x axis, from -pi to pi, to 1e-5: M. Abramowitz, I. A. Stegun,
/// Handbook of mathematical functions (1964), 4.4.49. The function of the platform takes several
/// times as long, and its last bit differs.
fn angle(x: f32, y: f32) -> f32 {
    let (small, large) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    let ratio = small / large.max(f32::MIN_POSITIVE);
    let square = ratio * ratio;
    let high = -0.085_133 + square * 0.020_835_1;
    let series = 0.999_866 + square * (-0.330_299_5 + square * (0.180_141 + square * high));
    let steep = if y.abs() > x.abs() { PI / 2.0 - ratio * series } else { ratio * series };
    let upper = if x < 0.0 { PI - steep } else { steep };
    upper.copysign(y)
}

/// For each of `count` intervals, the ones of `fewer` intervals that it overlaps, and the fractions
/// of those that it covers. `fewer` is at most `count`, so there are at most two.
fn shares(count: usize, fewer: usize) -> impl Iterator<Item = Vec<(usize, f64)>> {
    (0..count).map(move |index| {
        // In units of 1 / (count * fewer), where all limits are whole numbers.
        let (start, end) = (index * fewer, (index + 1) * fewer);
        let first = start / count;
        let limit = (first + 1) * count;
        let share = |length: usize| length as f64 / count as f64;
        if end <= limit {
            vec![(first, share(end - start))]
        } else {
            vec![(first, share(limit - start)), (first + 1, share(end - limit))]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An uncompressed file.
    fn file(size: [usize; 2], pixel: impl Fn(usize, usize) -> [u8; 4]) -> Vec<u8> {
        let mut bytes = format!("#?RADIANCE\n\n-Y {} +X {}\n", size[1], size[0]).into_bytes();
        for row in 0..size[1] {
            bytes.extend((0..size[0]).flat_map(|column| pixel(column, row)));
        }
        bytes
    }

    #[test]
    fn the_middle_is_behind_the_scene_and_the_right_half_to_the_right() {
        let side = |column: usize, row: usize| match (row, column) {
            (0..8, _) => [255, 255, 255, 129],
            (_, 12..20) => [128, 0, 0, 129],
            (_, 20..28) => [0, 128, 0, 129],
            (_, 4..12) => [0, 0, 128, 129],
            (..) => [0, 0, 0, 0],
        };
        let panorama = Panorama::read(&file([32, 16], side)).unwrap();
        let y = -0.5;
        assert_eq!(panorama.light([0.0, y, -0.8]), [1.0, 0.0, 0.0]);
        assert_eq!(panorama.light([0.8, y, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(panorama.light([-0.8, y, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(panorama.light([0.0, y, 0.8]), [0.0; 3]);
        assert!(panorama.light([0.0, 1.0, 0.0])[1] > 1.9);
    }

    #[test]
    fn angles_are_those_of_atan2() {
        for index in 0..10_000 {
            let expected = (index as f32 / 5000.0 - 1.0) * 0.999 * PI;
            let found = angle(expected.cos(), expected.sin());
            assert!((found - expected).abs() < 3e-5, "{found} {expected}");
        }
        assert_eq!(angle(0.0, 0.0), 0.0);
    }

    #[test]
    fn large_pictures_keep_their_mean() {
        let size = [3000, 1500];
        let bright = |column: usize, _: usize| [128, (column / 1500 * 128) as u8, 64, 129];
        let panorama = Panorama::read(&file(size, bright)).unwrap();
        assert_eq!(panorama.size, [1024, 512]);
        let near = |a: f32, b: f32| (a - b).abs() < 1e-5;
        assert!(panorama.pixels.iter().all(|it| near(it[0], 1.0) && near(it[2], 0.5)));
        let half = panorama.pixels.iter().filter(|it| near(it[1], 1.0)).count();
        assert_eq!(half, 512 * 512);

        // A row covers the more of the sphere the farther it is from the pole: 0.5, 1.5 and, of the
        // third row, 2.5 times 0.93.
        let first = |_: usize, row: usize| if row == 0 { [128, 128, 128, 129] } else { [0; 4] };
        let panorama = Panorama::read(&file(size, first)).unwrap();
        let third = 2.5 * (1500.0 / 512.0 - 2.0);
        assert!(near(panorama.pixels[0][0], 0.5 / (2.0 + third)), "{:?}", panorama.pixels[0]);
        assert!(near(panorama.pixels[1024][0], 0.0));
    }
}
