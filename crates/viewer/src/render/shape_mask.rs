//! Which pixels of a picture show the shapes that a call in the source makes.
//!
//! The shape is looked up at every few pixels first. Between pixels that differ, every pixel is
//! looked up, so that the edge is exact to the pixel. A part that is thinner than the distance of
//! the first pixels can be missed. Pixels near the edge are marked, for an outline.

use std::sync::Arc;
use std::sync::mpsc::Sender;

use sdfc_graph::ShapeId;

use crate::render::picture::Picture;
use crate::render::surface_points::{SurfacePoints, stride};
use crate::scene::field_probe::IsInterrupted;
use crate::scene::shapes::ShapeClassifier;
use crate::worker_thread::WorkerThread;

/// The most pixels at which the shape is looked up first.
const FIRST_PIXELS: u32 = 40_000;

/// The width of the edge in pixels.
const EDGE_WIDTH: usize = 2;

/// A question about a picture.
#[derive(Clone, Debug)]
pub struct MaskRequest {
    surface: SurfacePoints,
    /// The shapes.
    pub shapes: Vec<ShapeId>,
}

impl MaskRequest {
    /// A question about the pixels of a picture.
    pub fn new(picture: &Picture, shapes: Vec<ShapeId>) -> Self {
        Self { surface: SurfacePoints::new(picture), shapes }
    }

    /// Returns true if both ask the same.
    pub fn is_same(&self, other: &Self) -> bool {
        self.shapes == other.shapes && self.surface.is_same(&other.surface)
    }

    /// Returns true if the question is about this picture.
    pub fn is_about(&self, picture: &Picture) -> bool {
        self.surface.is_of(picture)
    }

    fn points(&self, indices: &[usize]) -> Vec<Option<[f64; 3]>> {
        let columns = self.surface.size()[0].max(1) as usize;
        let point = |index: &usize| {
            let [x, y] = [index % columns, index / columns].map(|at| at as u32);
            self.surface.point(x, y).map(|[point, _]| point.to_array())
        };
        indices.iter().map(point).collect()
    }
}

/// Whether a pixel shows one of the shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lit {
    /// It shows none of them.
    No,
    /// It shows one of them.
    Inside,
    /// It shows one of them, near pixels that show none.
    Edge,
}

/// The pixels that show some shapes.
#[derive(Clone, Debug)]
pub struct ShapeMask {
    /// The question.
    pub request: MaskRequest,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// For each pixel whether it shows one of the shapes, row by row.
    pub pixels: Arc<[Lit]>,
}

impl ShapeMask {
    /// Computes the mask. `None` if it was interrupted.
    fn new(
        request: MaskRequest,
        classifier: &ShapeClassifier,
        interrupted: IsInterrupted<'_>,
    ) -> Option<Self> {
        let size = request.surface.size();
        let [width, height] = size.map(|side| side as usize);
        let frame = &request.surface.request.frame;
        let look_up = |indices: &[usize]| {
            let found = classifier.at(frame, &request.points(indices), interrupted);
            found.into_iter().map(|shape| shape.is_some()).collect::<Vec<bool>>()
        };
        let stride = stride(size, FIRST_PIXELS) as usize;
        let [columns, rows] = [width, height].map(|side| side.div_ceil(stride));
        let nodes: Vec<usize> = (0..columns * rows)
            .map(|node| node / columns * stride * width + node % columns * stride)
            .collect();
        let coarse = look_up(&nodes);
        let node_at = |x: usize, y: usize| coarse[y.min(rows - 1) * columns + x.min(columns - 1)];
        // The value of the pixel's cell if all cells around it have the same.
        let is_clear = |x: usize, y: usize| {
            let own = node_at(x, y);
            let mut around = (y.saturating_sub(1)..=y + 1)
                .flat_map(|y| (x.saturating_sub(1)..=x + 1).map(move |x| (x, y)));
            around.all(|(x, y)| node_at(x, y) == own).then_some(own)
        };
        let mut inside = vec![false; width * height];
        let mut open = Vec::new();
        for (index, pixel) in inside.iter_mut().enumerate() {
            match is_clear(index % width / stride, index / width / stride) {
                Some(own) => *pixel = own,
                None => open.push(index),
            }
        }
        for (index, found) in open.iter().zip(look_up(&open)) {
            inside[*index] = found;
        }
        (!interrupted()).then(|| Self { size, pixels: with_edges(&inside, width), request })
    }
}

/// Marks the pixels near the edge of a mask that has rows of `width` pixels. The border of the
/// picture is no edge of the shape.
fn with_edges(inside: &[bool], width: usize) -> Arc<[Lit]> {
    let is_outside = |index: Option<usize>| index.and_then(|at| inside.get(at)) == Some(&false);
    let lit = |(index, is_inside): (usize, &bool)| {
        if !is_inside {
            return Lit::No;
        }
        let x = index % width;
        let is_edge = (1..=EDGE_WIDTH).any(|by| {
            (x >= by && is_outside(index.checked_sub(by)))
                || (x + by < width && is_outside(index.checked_add(by)))
                || is_outside(index.checked_sub(by * width))
                || is_outside(index.checked_add(by * width))
        });
        if is_edge { Lit::Edge } else { Lit::Inside }
    };
    inside.iter().enumerate().map(lit).collect()
}

/// The thread that computes masks; dropping this ends it.
#[derive(Debug)]
pub struct MaskWorker(WorkerThread<MaskRequest>);

impl MaskWorker {
    /// Starts the thread. It sends `masks` and calls `wake` after each.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        masks: Sender<ShapeMask>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        // The classifier serves as long as the scene and the shapes stay the same.
        let mut last: Option<(u64, Vec<ShapeId>, ShapeClassifier)> = None;
        let init = move |requests: Arc<crate::latest_channel::LatestChannel<MaskRequest>>| {
            move |request: MaskRequest| {
                let model = &request.surface.request.model;
                let key = (model.serial, &request.shapes);
                if last.as_ref().is_none_or(|(serial, shapes, _)| (*serial, shapes) != key) {
                    let classifier =
                        ShapeClassifier::of_shapes(&model.scene, request.shapes.clone());
                    last = Some((model.serial, request.shapes.clone(), classifier));
                }
                let Some((_, _, classifier)) = &last else { return };
                let interrupted = || requests.is_interrupted();
                if let Some(mask) = ShapeMask::new(request, classifier, &interrupted) {
                    // Sending fails only after the session is dropped.
                    let _ = masks.send(mask);
                    wake();
                }
            }
        };
        WorkerThread::start("shape mask", init).map(Self)
    }

    /// Asks a question in place of any earlier one.
    pub fn send(&self, request: MaskRequest) {
        self.0.channel().send(request);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edge_is_two_pixels_wide_and_not_at_the_border_of_the_picture() {
        let picture =
            ["iiee......", "eeee......", "eeee.eeeee", ".....eeeee", ".....eeiii", ".....eeiii"];
        let rows = picture.map(str::as_bytes).concat();
        let inside: Vec<bool> = rows.iter().map(|it| *it != b'.').collect();
        let expected = rows.iter().map(|it| match it {
            b'.' => Lit::No,
            b'e' => Lit::Edge,
            _ => Lit::Inside,
        });
        assert_eq!(with_edges(&inside, 10).to_vec(), expected.collect::<Vec<_>>());
    }
}
