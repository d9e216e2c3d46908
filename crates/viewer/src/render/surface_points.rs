//! The points of the surface that a picture shows.

use std::sync::Arc;

use glam::DVec3;
use sdfc_render::{HIT, Image, View};

use crate::render::picture::{Picture, RenderRequest};

/// The points of the surface that a picture shows.
#[derive(Clone, Debug)]
pub struct SurfacePoints {
    /// The request that the picture answers.
    pub request: Arc<RenderRequest>,
    image: Arc<Image>,
    view: View,
}

impl SurfacePoints {
    /// The points in a picture.
    pub fn new(picture: &Picture) -> Self {
        let (request, image) = (Arc::clone(&picture.request), Arc::clone(&picture.image));
        Self { request, image, view: picture.view.clone() }
    }

    /// Width and height of the picture in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.image.size()
    }

    /// Returns true if both are of the same picture.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.image, &other.image)
    }

    /// Returns true if the points are those of this picture.
    pub fn is_of(&self, picture: &Picture) -> bool {
        Arc::ptr_eq(&self.image, &picture.image)
    }

    /// The point that a pixel shows, relative to the origin of the drawn program, and the direction
    /// of its ray. `None` if the ray hit nothing.
    pub fn point(&self, x: u32, y: u32) -> Option<[DVec3; 2]> {
        let pixel = self.image.pixel(x, y)?;
        let [start, direction] = self.view.ray(x, y);
        let is_hit = pixel.status == HIT && pixel.depth.is_finite();
        is_hit.then(|| [start + direction * f64::from(pixel.depth), direction])
    }
}

/// The smallest stride at which an image has at most `most` pixels, which is at least 1.
pub fn stride([width, height]: [u32; 2], most: u32) -> u32 {
    let mut stride = 1;
    while width.div_ceil(stride).saturating_mul(height.div_ceil(stride)) > most.max(1) {
        stride += 1;
    }
    stride
}

#[cfg(test)]
mod tests {
    use super::stride;

    #[test]
    fn a_stride_leaves_at_most_that_many_pixels() {
        assert_eq!(
            [stride([0, 5], 1), stride([100, 20], 2000), stride([101, 20], 2000)],
            [1, 1, 2]
        );
        assert_eq!(stride([3840, 2160], 1), 3840);
        assert_eq!(stride([7, 7], 0), 7);
    }
}
