//! Pixels of planar pictures: a formula of the pixel's middle and its size, without rays.

use sdfc_graph::eval::{FrameValues, Packet, Tape};
use sdfc_march::PixelBlock;

use super::pixels::Pixels;
use super::planar_cells::{FINEST, PlanarCells, Shown};
use super::ray::{LANES, Real, packed_from};
use crate::image::{HIT, MISS};
use crate::view::View;

/// Distance of the camera from the plane, as in the shader.
const DEPTH: f32 = 1.0;

/// The state of one thread that draws a planar picture.
#[derive(Clone)]
pub(super) struct PlanarPixels<'a, T> {
    view: &'a View,
    frame: &'a FrameValues,
    cells: &'a PlanarCells<'a>,
    /// Width and height of a pixel.
    width: T,
}

impl<'a, T: Real> PlanarPixels<'a, T> {
    pub(super) fn new(cells: &'a PlanarCells<'a>, view: &'a View, frame: &'a FrameValues) -> Self {
        Self { view, frame, cells, width: T::constant(2.0 * view.footprint().radius) }
    }

    /// Evaluates the formula, which `tape` computes, for some of the positions.
    fn evaluate(
        &self,
        tape: &Tape,
        positions: &[[u32; 2]],
        indices: &[usize],
        pixels: &mut [PixelBlock],
    ) {
        let mut formula = tape.prepare::<Packet<T, LANES>>(self.frame);
        let size = [Packet([self.width; LANES]); 3];
        for group in indices.chunks(LANES) {
            let middles = group.iter().map(|&index| {
                let [x, y] = positions[index];
                self.view.ray(x, y)[0].to_array().map(T::constant)
            });
            let [shown] = formula.eval_ray(packed_from(middles), size) else { return };
            for (lane, &index) in group.iter().enumerate() {
                let value = |Packet(lanes): Packet<T, LANES>| Into::<f64>::into(lanes[lane]) as f32;
                pixels[index] = block(shown.map(value));
            }
        }
    }
}

impl<T: Real> Pixels for PlanarPixels<'_, T> {
    fn pixels(&mut self, positions: &[[u32; 2]]) -> Vec<PixelBlock> {
        let mut pixels = vec![PixelBlock::default(); positions.len()];
        let cell = |index: usize| positions[index].map(|place| place / FINEST);
        let mut order: Vec<usize> = (0..positions.len()).collect();
        order.sort_by_key(|&index| cell(index));
        for indices in order.chunk_by(|&a, &b| cell(a) == cell(b)) {
            let Some(&first) = indices.first() else { continue };
            match &self.cells.at(positions[first]) {
                Shown::Same(shown) => indices.iter().for_each(|&i| pixels[i] = block(*shown)),
                Shown::Formula(tape) => self.evaluate(tape, positions, indices, &mut pixels),
            }
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
