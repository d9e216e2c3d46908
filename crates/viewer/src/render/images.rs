//! The memory of pictures.

use std::sync::Arc;

use sdfc_render::Image;

/// The last pictures. The next one takes the memory of one that nothing else needs any more.
#[derive(Debug, Default)]
pub struct Images(Vec<Arc<Image>>);

/// The picture that the window shows, and the one before it.
const MAX_IMAGES: usize = 2;

impl Images {
    /// Shares a new picture, and remembers it.
    pub fn keep(&mut self, image: Image) -> Arc<Image> {
        let image = Arc::new(image);
        if self.0.len() >= MAX_IMAGES {
            self.0.remove(0);
        }
        self.0.push(Arc::clone(&image));
        image
    }

    /// A picture that is no longer needed.
    pub fn take(&mut self) -> Option<Image> {
        let free = self.0.iter().position(|image| Arc::strong_count(image) == 1)?;
        Arc::into_inner(self.0.swap_remove(free))
    }
}

#[cfg(test)]
mod tests {
    use sdfc_render::Footprint;

    use super::*;

    #[test]
    fn a_picture_that_is_shown_is_not_taken() {
        let mut images = Images::default();
        let mut keep = |width| images.keep(Image::new([width, 1], Footprint::default()).unwrap());
        let (first, second) = (keep(1), keep(2));
        assert_eq!(images.take(), None);
        drop(first);
        assert_eq!(images.take().map(|image| image.size()), Some([1, 1]));
        assert_eq!(images.take(), None);
        drop(second);
        assert_eq!(images.take().map(|image| image.size()), Some([2, 1]));
    }
}
