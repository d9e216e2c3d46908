//! What a picture and the field tell of one pixel.

use glam::DVec3;
use sdfc::render::HIT;

use crate::painter::Picture;

/// What a look at a pixel tells.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The pixel's ray ended like this: [`HIT`] and its like.
    pub status: u32,
    /// Length of the ray.
    pub depth: f64,
    /// Where it ended.
    pub point: DVec3,
    /// The field there, in double precision.
    pub distance: Option<f64>,
    /// The field's gradient there, of length 1.
    pub normal: Option<DVec3>,
    /// Evaluations of the field for this pixel.
    pub evaluations: u32,
    /// What the shape is called, and where it is written, once that is known.
    pub shape: Option<String>,
}

impl Look {
    /// What is at a place of the picture, from its upper left corner in parts of its sides.
    pub fn at(picture: &Picture, [right, down]: [f64; 2]) -> Option<Self> {
        let [width, height] = picture.image.size();
        let place = |share: f64, side: u32| ((share * f64::from(side)) as u32).min(side - 1);
        let (x, y) = (place(right, width), place(down, height));
        let pixel = picture.image.pixel(x, y)?;
        let [start, direction] = picture.view.ray(x, y);
        let depth = f64::from(pixel.depth);
        let point = start + direction * depth;
        let request = &picture.request;
        let field = request.model.probe.at(&request.frame, point.to_array());
        // Rays and field are counted from there.
        let origin = DVec3::from(request.model.scene.drawn().origin);
        let gradient = field.map(|field| DVec3::from(field.partials));
        let (shapes, scene) = (&request.model.shapes, &request.model.scene);
        let shape = shapes.known_leaves().filter(|_| pixel.status == HIT).and_then(|leaves| {
            let place = leaves.at(&request.frame, &[Some(point.to_array())]).pop()??;
            Some(shapes.label(scene, *leaves.shapes().get(place)?))
        });
        Some(Self {
            status: pixel.status,
            depth,
            point: point + origin,
            distance: field.map(|field| field.value),
            normal: gradient.and_then(DVec3::try_normalize).filter(|_| pixel.status == HIT),
            evaluations: pixel.evaluations,
            shape,
        })
    }
}
