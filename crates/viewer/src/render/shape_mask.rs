//! Which pixels of a picture show the shapes that a call in the source makes.
//!
//! The shape is looked up at every few pixels first. Between pixels that differ, every pixel is
//! looked up, so that the edge is exact to the pixel. A part that is thinner than the distance of
//! the first pixels can be missed.

use std::sync::Arc;
use std::sync::mpsc::Sender;

use sdfc_graph::ShapeId;
use sdfc_render::{HIT, Image, View};

use crate::render::picture::{Picture, RenderRequest};
use crate::scene::field_probe::IsInterrupted;
use crate::scene::shapes::ShapeClassifier;
use crate::worker_thread::WorkerThread;

/// The most pixels at which the shape is looked up first.
const FIRST_PIXELS: u32 = 40_000;

/// A question about a picture.
#[derive(Clone, Debug)]
pub struct MaskRequest {
    request: Arc<RenderRequest>,
    image: Arc<Image>,
    view: View,
    /// The shapes.
    pub shapes: Vec<ShapeId>,
}

impl MaskRequest {
    /// A question about the pixels of a picture.
    pub fn new(picture: &Picture, shapes: Vec<ShapeId>) -> Self {
        let (request, image) = (Arc::clone(&picture.request), Arc::clone(&picture.image));
        Self { request, image, view: picture.view.clone(), shapes }
    }

    /// Returns true if both ask the same.
    pub fn is_same(&self, other: &Self) -> bool {
        self.shapes == other.shapes && Arc::ptr_eq(&self.image, &other.image)
    }

    /// Returns true if the question is about this picture.
    pub fn is_about(&self, picture: &Picture) -> bool {
        Arc::ptr_eq(&self.image, &picture.image)
    }

    fn point(&self, index: usize) -> Option<[f64; 3]> {
        let pixel = self.image.pixels().get(index)?;
        let columns = self.image.size()[0].max(1) as usize;
        let [start, direction] = self.view.ray((index % columns) as u32, (index / columns) as u32);
        let is_hit = pixel.status == HIT && pixel.depth.is_finite();
        is_hit.then(|| (start + direction * f64::from(pixel.depth)).to_array())
    }

    fn points(&self, indices: &[usize]) -> Vec<Option<[f64; 3]>> {
        indices.iter().map(|index| self.point(*index)).collect()
    }
}

/// The pixels that show some shapes.
#[derive(Clone, Debug)]
pub struct ShapeMask {
    /// The question.
    pub request: MaskRequest,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// True for each pixel that shows one of the shapes, row by row.
    pub inside: Arc<[bool]>,
}

impl ShapeMask {
    /// Computes the mask. `None` if it was interrupted.
    fn new(
        request: MaskRequest,
        classifier: &ShapeClassifier,
        interrupted: IsInterrupted<'_>,
    ) -> Option<Self> {
        let size = request.image.size();
        let [width, height] = size.map(|side| side as usize);
        let frame = &request.request.frame;
        let look_up = |indices: &[usize]| {
            let found = classifier.at(frame, &request.points(indices), interrupted);
            found.into_iter().map(|shape| shape.is_some()).collect::<Vec<bool>>()
        };
        let stride = stride(size) as usize;
        let [columns, rows] = [width, height].map(|side| side.div_ceil(stride));
        let nodes: Vec<usize> = (0..columns * rows)
            .map(|node| node / columns * stride * width + node % columns * stride)
            .collect();
        let coarse = look_up(&nodes);
        let node_at = |x: usize, y: usize| coarse[y.min(rows - 1) * columns + x.min(columns - 1)];
        // Of the pixel's cell and those around it.
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
        (!interrupted()).then(|| Self { size, inside: inside.into(), request })
    }
}

/// The distance of the pixels that are looked up first.
fn stride([width, height]: [u32; 2]) -> u32 {
    let mut stride = 1;
    while width.div_ceil(stride).saturating_mul(height.div_ceil(stride)) > FIRST_PIXELS {
        stride += 1;
    }
    stride
}

/// A handle to the thread that computes masks; dropping it ends the thread.
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
                let model = &request.request.model;
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
