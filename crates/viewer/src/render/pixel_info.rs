//! Information about one pixel of a picture.

use std::ops::Range;

use glam::DVec3;
use sdfc_render::{HIT, is_unproven};

use crate::render::picture::Picture;

/// Information about one pixel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelInfo {
    /// The status of the pixel's ray: [`HIT`] or another of the renderer's.
    pub status: u16,
    /// True if a ray of the pixel was not proven all the way.
    pub unproven: bool,
    /// The length of the ray in scene units.
    pub depth: f64,
    /// The point of the scene where the ray ended.
    pub point: DVec3,
    /// The field's value at that point, in f64.
    pub distance: Option<f64>,
    /// The unit normal at a hit.
    pub normal: Option<DVec3>,
    /// Evaluations of the field for this pixel.
    pub evaluations: u32,
    /// The name and source position of the shape that was hit, once the classifier is built.
    pub shape: Option<String>,
    /// The name of the file that writes that shape, and the range of the call in it.
    pub call: Option<(String, Range<usize>)>,
}

impl PixelInfo {
    /// The pixel at a position, given as fractions of width and height from the upper left corner.
    pub fn at(picture: &Picture, [right, down]: [f64; 2]) -> Option<Self> {
        let [width, height] = picture.image.size();
        let pixel = |fraction: f64, side: u32| ((fraction * f64::from(side)) as u32).min(side - 1);
        let (x, y) = (pixel(right, width), pixel(down, height));
        let pixel = picture.image.pixel(x, y)?;
        let [start, direction] = picture.view.ray(x, y);
        let depth = f64::from(pixel.depth);
        let point = start + direction * depth;
        let request = &picture.request;
        let field = request.model.field.at(&request.frame, point.to_array());
        // Rays and the field are relative to this point of the scene.
        let origin = DVec3::from(request.model.scene.drawn().origin);
        let gradient = field.map(|field| DVec3::from(field.partials));
        let (shapes, scene) = (&request.model.shapes, &request.model.scene);
        let shape = shapes.known_leaves().filter(|_| pixel.status == HIT).and_then(|leaves| {
            let index = leaves.at(&request.frame, &[Some(point.to_array())], &|| false).pop()??;
            leaves.shapes().get(index).copied()
        });
        Some(Self {
            status: pixel.status,
            unproven: is_unproven(pixel),
            depth,
            point: point + origin,
            distance: field.map(|field| field.value),
            normal: gradient.and_then(DVec3::try_normalize).filter(|_| pixel.status == HIT),
            evaluations: pixel.evaluations,
            call: shape.and_then(|shape| shapes.call(shape).cloned()),
            shape: shape.map(|shape| shapes.label(scene, shape)),
        })
    }
}
