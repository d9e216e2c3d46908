//! Cameras: the ray through the centre of each pixel, in f64.

use sdfc_render::View;

use crate::oracle::Ray;

/// The camera of a picture: one ray through the centre of each pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// True if rays are parallel.
    pub parallel: bool,
    /// Origin of the rays, or the centre of the origins of parallel rays.
    pub eye: [f64; 3],
    /// Vector to the centre of the picture, at distance 1 from the eye along the camera's axis.
    pub forward: [f64; 3],
    /// Half the width of the picture, at distance 1 unless rays are parallel.
    pub right: [f64; 3],
    /// Half the height of the picture, at distance 1 unless rays are parallel.
    pub up: [f64; 3],
    /// Length of the rays.
    pub t_max: f64,
    /// Half the width of a pixel, at distance 1 unless rays are parallel.
    pub pixel_radius: f64,
}

impl Camera {
    /// Returns the camera of a view.
    pub fn of(view: &View) -> Self {
        Self {
            size: view.size,
            parallel: view.parallel,
            eye: view.eye.to_array(),
            forward: view.forward.to_array(),
            right: view.right.to_array(),
            up: view.up.to_array(),
            t_max: view.t_max,
            pixel_radius: view.footprint().at(1.0),
        }
    }

    /// Returns the ray of a pixel. Pixels are numbered row by row from the top.
    pub fn ray(&self, pixel: usize) -> Ray {
        let [width, height] = self.size.map(|side| side.max(1) as usize);
        let place = |index: usize, side: usize| 2.0 * (index as f64 + 0.5) / side as f64 - 1.0;
        let (x, y) = (place(pixel % width, width), place(pixel / width, height));
        let aside = |axis: usize| x * self.right[axis] - y * self.up[axis];
        let moved = |from: [f64; 3]| std::array::from_fn(|axis| from[axis] + aside(axis));
        let (origin, toward) = if self.parallel {
            (moved(self.eye), self.forward)
        } else {
            (self.eye, moved(self.forward))
        };
        let length = toward.iter().map(|part| part * part).sum::<f64>().sqrt();
        let direction = toward.map(|part| part / length);
        Ray { origin, direction, t_max: self.t_max }
    }

    /// Returns the width of a pixel at a distance.
    pub fn pixel_width(&self, t: f64) -> f64 {
        2.0 * self.pixel_radius * if self.parallel { 1.0 } else { t }
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}
