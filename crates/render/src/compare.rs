//! Measures how far two pictures of the same view differ, apart from their edges.
//!
//! At a silhouette or a crease one pixel's ray may hit one surface in one picture and another in
//! the other, by rounding alone. Such pixels are counted, and left out of the differences. They are
//! found by depth alone: where the material or the normal changes while the depth is smooth, pixels
//! are compared as elsewhere.

use sdfc_graph::linear_to_srgb8;
use sdfc_march::PixelBlock;

use crate::image::{HIT, Image};

/// A pixel is an edge if the depth bends by more than this many pixel widths over three
/// neighbouring pixels.
const EDGE_PIXEL_WIDTHS: f32 = 4.0;

/// The difference of two pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// The number of pixels compared, edges left out.
    pub compared: usize,
    /// The number of pixels that are an edge in either picture.
    pub edges: usize,
    /// The number of pixels that are a hit in only one picture, edges left out.
    pub status: usize,
    /// The largest difference of depth, in scene units, of pixels that are hits in both; infinite
    /// if a depth is NaN.
    pub depth: f32,
    /// The largest difference of depth as a fraction of the depth.
    pub relative_depth: f32,
    /// The largest difference of a colour channel, in sRGB steps of 1/255.
    pub color: u8,
    /// The mean difference of the colour channels, in sRGB steps of 1/255.
    pub mean_color: f32,
}

/// Returns, for each pixel, true if it is an edge: its 3x3 neighbours contain hits and misses, or
/// the depth of hits along a line through it bends by more than four pixel widths.
pub fn edges(image: &Image) -> Vec<bool> {
    let [width, height] = image.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.map(|(x, y)| is_edge(image, x, y)).collect()
}

fn is_edge(image: &Image, x: u32, y: u32) -> bool {
    let neighbour =
        |dx: i32, dy: i32| image.pixel(x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
    let Some(center) = neighbour(0, 0) else { return false };
    // Opposite neighbours are compared, so that a slanted plane, whose depth changes evenly, has no
    // edges.
    [(1, 0), (0, 1), (1, 1), (1, -1)].into_iter().any(|(dx, dy)| {
        let pair = [neighbour(dx, dy), neighbour(-dx, -dy)];
        pair.iter().flatten().any(|other| (other.status == HIT) != (center.status == HIT))
            || matches!(pair, [Some(before), Some(after)] if bends(image, before, center, after))
    })
}

fn bends(image: &Image, before: &PixelBlock, center: &PixelBlock, after: &PixelBlock) -> bool {
    let bend = before.depth - 2.0 * center.depth + after.depth;
    let pixel_width = image.pixel_width(center.depth);
    center.status == HIT && bend.abs() > EDGE_PIXEL_WIDTHS * pixel_width
}

/// Compares two pictures of equal size; `None` if their sizes differ.
pub fn compare(a: &Image, b: &Image) -> Option<Difference> {
    if a.size() != b.size() {
        return None;
    }
    let (edges_a, edges_b) = (edges(a), edges(b));
    let mut difference = Difference::default();
    let mut color_sum = 0u64;
    for (index, (one, other)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        if edges_a[index] || edges_b[index] {
            difference.edges += 1;
            continue;
        }
        difference.compared += 1;
        if (one.status == HIT) != (other.status == HIT) {
            difference.status += 1;
        } else if one.status == HIT {
            let depth = depth_difference(one, other);
            difference.depth = difference.depth.max(depth);
            let relative = depth / one.depth.max(f32::MIN_POSITIVE);
            difference.relative_depth = difference.relative_depth.max(relative);
        }
        for channel in 0..3 {
            let step =
                linear_to_srgb8(one.color[channel]).abs_diff(linear_to_srgb8(other.color[channel]));
            difference.color = difference.color.max(step);
            color_sum += u64::from(step);
        }
    }
    difference.mean_color = color_sum as f32 / (3 * difference.compared.max(1)) as f32;
    Some(difference)
}

fn depth_difference(one: &PixelBlock, other: &PixelBlock) -> f32 {
    let difference = (one.depth - other.depth).abs();
    if difference.is_nan() { f32::INFINITY } else { difference }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::footprint::Footprint;

    /// 5x5 hits whose depth is given by column and row.
    fn hits(depth: impl Fn(usize, usize) -> f32) -> Image {
        let mut image = Image::new([5, 5], Footprint { radius: 0.0, spread: 0.01 }).unwrap();
        for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
            pixel.status = HIT;
            pixel.depth = depth(index % 5, index / 5);
        }
        image
    }

    #[test]
    fn a_slanted_plane_has_no_edges_and_a_step_has_two_columns_of_them() {
        let slanted = hits(|x, y| 5.0 + x as f32 + 0.5 * y as f32);
        assert!(edges(&slanted).iter().all(|edge| !edge));
        let step = hits(|x, _| if x < 2 { 5.0 } else { 7.0 });
        let row: Vec<bool> = edges(&step)[10..15].to_vec();
        assert_eq!(row, [false, true, true, false, false]);
    }

    #[test]
    fn a_pixel_beside_a_miss_is_an_edge_corners_included() {
        let mut image = hits(|_, _| 5.0);
        image.pixels_mut()[0].status = 0;
        let found = edges(&image);
        assert_eq!(&found[..7], [true, true, false, false, false, true, true]);
    }

    #[test]
    fn differences_are_taken_outside_edges_only() {
        let a = hits(|_, _| 5.0);
        let mut b = a.clone();
        b.pixels_mut()[12].depth = 5.01;
        b.pixels_mut()[12].color[0] = 1.0;
        let difference = compare(&a, &b).unwrap();
        assert_eq!(difference.edges, 0);
        assert!((difference.depth - 0.01).abs() < 1e-6);
        assert!((difference.relative_depth - 0.002).abs() < 1e-6);
        assert_eq!(difference.color, 255);
        b.pixels_mut()[12].status = 0;
        let difference = compare(&a, &b).unwrap();
        assert_eq!((difference.edges, difference.compared), (9, 16));
        assert_eq!((difference.depth, difference.color), (0.0, 0));
    }

    #[test]
    fn a_depth_that_is_not_a_number_is_an_infinite_difference() {
        let a = hits(|_, _| 5.0);
        let b = hits(|_, _| f32::NAN);
        assert_eq!(compare(&a, &b).unwrap().depth, f32::INFINITY);
    }

    #[test]
    fn pictures_of_different_sizes_do_not_compare() {
        let a = hits(|_, _| 5.0);
        assert!(
            compare(&a, &Image::new([5, 4], Footprint { radius: 0.0, spread: 0.01 }).unwrap())
                .is_none()
        );
    }
}
