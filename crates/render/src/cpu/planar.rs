//! Pixels of planar pictures: a formula of the pixel's middle and its size, without rays.

use sdfc_graph::eval::Packet;
use sdfc_march::PixelBlock;

use super::pixels::Pixels;
use super::ray::{Batch, LANES, Real, packed_from};
use crate::image::{HIT, MISS};
use crate::view::View;

/// Distance of the camera from the plane, as in the shader.
const DEPTH: f32 = 1.0;

/// The state of one thread that draws a planar picture.
#[derive(Clone)]
pub(super) struct PlanarPixels<'a, T> {
    pub(super) view: &'a View,
    /// `Program::planar_pixel`.
    pub(super) pixel: Batch<'a, T>,
}

impl<T: Real> Pixels for PlanarPixels<'_, T> {
    fn pixels(&mut self, positions: &[[u32; 2]]) -> Vec<PixelBlock> {
        let width = T::constant(2.0 * self.view.footprint().radius);
        let size = [Packet([width; LANES]); 3];
        let mut pixels = Vec::with_capacity(positions.len());
        for group in positions.chunks(LANES) {
            let middles = group.iter().map(|[x, y]| {
                let [middle, _] = self.view.ray(*x, *y);
                middle.to_array().map(T::constant)
            });
            let [shown] = self.pixel.eval_ray(packed_from(middles), size) else { return pixels };
            pixels.extend((0..group.len()).map(|lane| {
                block(shown.map(|Packet(lanes)| Into::<f64>::into(lanes[lane]) as f32))
            }));
        }
        pixels
    }
}

fn block([red, green, blue, distance]: [f32; 4]) -> PixelBlock {
    PixelBlock {
        color: [red, green, blue, 1.0],
        depth: DEPTH,
        status: if distance <= 0.0 { HIT } else { MISS },
        unproven: 0,
        evaluations: 1,
        primary_evaluations: 1,
    }
}
