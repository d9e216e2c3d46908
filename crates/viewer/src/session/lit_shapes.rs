//! The shapes in the picture that the code at the cursor makes.

use sdfc::Scene;
use sdfc_graph::ShapeId;

use super::Session;
use crate::render::shape_mask::{MaskRequest, ShapeMask};
use crate::session::tabs::TabFile;

impl Session {
    /// Lights the shapes that the innermost call at an offset of a file makes. `None` lights
    /// nothing, nor does a position without a call.
    pub fn light_shapes(&mut self, at: Option<(TabFile, usize)>) {
        let Some((file, offset)) = at else { return self.lit_shapes.clear() };
        // A moving picture is replaced before its shapes are known.
        let Some(picture) = self.known_picture().filter(|it| !it.request.moving) else { return };
        let model = &picture.request.model;
        let now = (file, offset, model.serial, self.picture_count);
        if self.lit_shapes.looked_at.as_ref() == Some(&now) {
            return;
        }
        let file = &now.0;
        let is_current = self
            .compiled_text(model, file)
            .is_some_and(|compiled| self.text_of(file).is_some_and(|text| **text == *compiled));
        let shapes = match is_current {
            true => shapes_at(&model.scene, &file.name(self.path()), offset),
            false => Vec::new(),
        };
        let asked = (!shapes.is_empty()).then(|| MaskRequest::new(picture, shapes));
        let lit = &mut self.lit_shapes;
        lit.looked_at = Some(now);
        match asked {
            None => (lit.asked, lit.mask) = (None, None),
            Some(asked) if lit.asked.as_ref().is_some_and(|last| last.is_same(&asked)) => {}
            Some(asked) => {
                lit.asked = Some(asked.clone());
                lit.worker.send(asked);
            }
        }
    }

    /// The pixels of the current picture that show the lit shapes, once they are known.
    pub fn lit_mask(&self) -> Option<&ShapeMask> {
        let (mask, asked) = (self.lit_shapes.mask.as_ref()?, self.lit_shapes.asked.as_ref()?);
        let is_current = self.known_picture().is_some_and(|it| mask.request.is_about(it));
        (is_current && mask.request.is_same(asked)).then_some(mask)
    }
}

/// The shapes that the innermost call around an offset of a file makes.
fn shapes_at(scene: &Scene, file: &str, offset: usize) -> Vec<ShapeId> {
    let Ok(offset) = u32::try_from(offset) else { return Vec::new() };
    let around = scene.sites().iter().filter(|site| {
        (site.span.start..=site.span.end).contains(&offset)
            && scene.sources().name(site.span.file) == file
    });
    let innermost = around.clone().map(|site| site.span).min_by_key(|span| span.end - span.start);
    let mut shapes: Vec<ShapeId> =
        around.filter(|site| Some(site.span) == innermost).map(|site| site.shape).collect();
    shapes.sort_unstable();
    shapes.dedup();
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_call_decides() {
        let text = "union(for i in 0..3: sphere(0.1).translate(x: i), box(1)) // end\n";
        let scene = sdfc::Compiler::new().compile("a.sdf", text).unwrap();
        let count = |at: &str| shapes_at(&scene, "a.sdf", text.find(at).unwrap()).len();
        // One ball, three copies of it, one union.
        assert_eq!([count("0.1"), count("x: i"), count("box"), count("for")], [1, 3, 1, 1]);
        assert_eq!(count("end"), 0);
        assert_eq!(shapes_at(&scene, "b.sdf", 0), []);
    }
}
