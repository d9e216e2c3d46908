//! The input of a view, and helpers that several views use.

use std::collections::BTreeMap;

use glam::DVec3;
use sdfc::{FrameValues, Scene};
use sdfc_graph::eval::Dual;
use sdfc_march::PixelBlock;
use sdfc_render::{HIT, Image, View};

use crate::scene::field_probe::{FieldProbe, IsInterrupted};
use crate::scene::shapes::ShapeIndex;
use crate::views::colors::{BACKGROUND, to_srgb};
use crate::views::legend::{Legend, mix};
use crate::views::slice_plane::SlicePlane;

/// The most lines of a legend.
const MAX_KEYS: usize = 12;

/// The input of a view: a rendered image, and the scene that it shows.
#[derive(Clone, Copy)]
pub struct ViewInput<'a> {
    /// Linear colours, averaged over the samples of each pixel.
    pub colors: &'a Image,
    /// Depth, status and evaluation count of the one ray through the middle of each pixel.
    pub image: &'a Image,
    /// The rays of the rendered image. `image` has every `stride`-th pixel of every `stride`-th row
    /// of it.
    pub view: &'a View,
    /// The field in f64, at points relative to `origin`.
    pub field: &'a FieldProbe,
    /// The scene.
    pub scene: &'a Scene,
    /// The scene's shapes and their names.
    pub shapes: &'a ShapeIndex,
    /// Param values and time.
    pub frame: &'a FrameValues,
    /// The plane of the view "Slice".
    pub slice: SlicePlane,
    /// The point of the scene that rays and the field are relative to.
    pub origin: [f64; 3],
    /// See `view`.
    pub stride: u32,
    /// Returns true when the result is no longer needed; the rest of it may be anything.
    pub interrupted: IsInterrupted<'a>,
}

impl ViewInput<'_> {
    /// Colours every pixel. `color` gets the pixel's index and its shaded colour.
    pub fn map_pixels(&self, color: impl Fn(usize, &PixelBlock) -> [u8; 3]) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.colors.pixels().len() * 4);
        for (index, pixel) in self.colors.pixels().iter().enumerate() {
            let [red, green, blue] = color(index, pixel);
            out.extend([red, green, blue, 255]);
        }
        out
    }

    /// The origin and unit direction of the ray through a pixel.
    pub fn ray(&self, index: usize) -> [DVec3; 2] {
        let columns = self.image.size()[0].max(1) as usize;
        let position = [index % columns, index / columns].map(|at| at as u32);
        let [x, y] = rendered_position(position, self.stride, self.view.size);
        self.view.ray(x, y)
    }

    /// For each pixel the point that its ray hit; `None` for the background.
    pub fn hits(&self) -> Vec<Option<[f64; 3]>> {
        let point = |(index, pixel): (usize, &PixelBlock)| {
            let [start, direction] = self.ray(index);
            let hit = pixel.status == HIT && pixel.depth.is_finite();
            hit.then(|| (start + direction * f64::from(pixel.depth)).to_array())
        };
        self.image.pixels().iter().enumerate().map(point).collect()
    }

    /// For each pixel the field's value and gradient at its hit; `None` for the background.
    pub fn field_at_hits(&self) -> Vec<Option<Dual>> {
        self.field.at_all(self.frame, &self.hits(), self.interrupted)
    }

    /// Colours every pixel by its number, with the brightness of the shaded picture.
    pub fn color_by_number(
        &self,
        numbers: &[Option<usize>],
        color: impl Fn(usize) -> [u8; 3],
    ) -> Vec<u8> {
        self.map_pixels(|index, shaded| match numbers[index] {
            Some(number) => {
                let [red, green, blue] = to_srgb(shaded).map(f64::from);
                let light = (0.3 * red + 0.59 * green + 0.11 * blue) / 255.0;
                mix([0; 3], color(number), 0.45 + 0.55 * light)
            }
            None => BACKGROUND,
        })
    }

    /// A legend of the numbers that the most pixels have.
    pub fn legend_of_numbers(
        &self,
        numbers: &[Option<usize>],
        color: impl Fn(usize) -> [u8; 3],
        label: impl Fn(usize) -> String,
    ) -> Legend {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for number in numbers.iter().flatten() {
            *counts.entry(*number).or_default() += 1;
        }
        let mut most: Vec<(usize, usize)> = counts.into_iter().collect();
        most.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        most.truncate(MAX_KEYS);
        Legend::Keys(most.into_iter().map(|(number, _)| (color(number), label(number))).collect())
    }
}

/// The column and row in a rendered image of `size` of a pixel of the reduced image.
pub fn rendered_position(reduced: [u32; 2], stride: u32, size: [u32; 2]) -> [u32; 2] {
    let position = |axis: usize| {
        let middle = reduced[axis] * stride + stride / 2;
        middle.min(size[axis].saturating_sub(1))
    };
    [position(0), position(1)]
}
