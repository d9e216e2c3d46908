//! Evaluates a scene's field on the CPU, in f64.

use sdfc_graph::eval::{Dual, Evaluator, FieldSample, FrameValues, Packet};

use crate::error::Error;
use crate::scene::Scene;
use crate::tapes::Tapes;

/// Number of points that are evaluated together.
const LANES: usize = 8;

/// The material of a surface at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Linear red, green and blue.
    pub color: [f64; 3],
    /// Weight of this material, 0..1; the rest is the default material.
    pub coverage: f64,
    /// Roughness, from 0 (smooth) to 1 (rough).
    pub roughness: f64,
    /// Metalness, from 0 (dielectric) to 1 (metal).
    pub metallic: f64,
    /// Emitted light: linear red, green and blue.
    pub emission: [f64; 3],
    /// Fraction of the ambient light that reaches the surface, 0..1.
    pub occlusion: f64,
}

/// A scene's field at one frame's values of params, `time` and `frame`: see [`Scene::field`].
///
/// Per-frame values are already computed, and an evaluation allocates nothing. For several
/// threads, clone it.
#[derive(Clone, Debug)]
pub struct Field<'s> {
    one: Evaluator<'s, f64>,
    many: Evaluator<'s, Packet<f64, LANES>>,
    slope: Evaluator<'s, Dual>,
    slopes: Evaluator<'s, Dual<Packet<f64, LANES>>>,
    material: Option<Evaluator<'s, f64>>,
}

impl Scene {
    /// The field at a frame's values, for evaluations at many points.
    ///
    /// If the frame lacks a param or has NaN for it, the field is NaN.
    ///
    /// ```
    /// use sdfc::Compiler;
    ///
    /// let text = "param r = 1 in 0..2\nsphere(r).color(#f00)";
    /// let scene = Compiler::new().compile("a.sdf", text)?;
    /// let mut frame = scene.defaults();
    /// scene.set(&mut frame, "r", 0.5)?;
    ///
    /// let mut field = scene.field(&frame)?;
    /// assert_eq!(field.distance([0.0, 2.0, 0.0]), 1.5);
    /// assert_eq!(field.gradient([0.0, 2.0, 0.0]).gradient, [0.0, 1.0, 0.0]);
    /// assert_eq!(field.distances(&[[0.0; 3], [1.0, 0.0, 0.0]]), [-0.5, 0.5]);
    /// let red = field.material([0.0, 0.5, 0.0]).expect("it has a material");
    /// assert_eq!(red.color, [1.0, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn field(&self, frame: &FrameValues) -> Result<Field<'_>, Error> {
        let tapes = self.tapes.get_or_init(|| Tapes::of(&self.program)).as_ref();
        let tapes = tapes.map_err(|&error| error)?.as_ref().ok_or(Error::NothingDrawn)?;
        Ok(Field {
            one: tapes.distance.prepare(frame),
            many: tapes.distance.prepare(frame),
            slope: tapes.distance.prepare(frame),
            slopes: tapes.distance.prepare(frame),
            material: tapes.material.as_ref().map(|tape| tape.prepare(frame)),
        })
    }

    /// Signed distance at a point, at the params' defaults. If the scene is certified this is
    /// never more than the true distance. For many points or other values use [`Scene::field`].
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn distance(&self, point: [f64; 3]) -> Result<f64, Error> {
        Ok(self.field(&self.defaults())?.distance(point))
    }

    /// Distance and gradient at a point, at the params' defaults.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn gradient(&self, point: [f64; 3]) -> Result<FieldSample, Error> {
        Ok(self.field(&self.defaults())?.gradient(point))
    }

    /// Material of the nearest surface, at the params' defaults. `None` if the scene has no
    /// materials.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn material(&self, point: [f64; 3]) -> Result<Option<Material>, Error> {
        Ok(self.field(&self.defaults())?.material(point))
    }
}

impl Field<'_> {
    /// Signed distance at a point.
    pub fn distance(&mut self, point: [f64; 3]) -> f64 {
        self.one.scalar(point)
    }

    /// Distances at many points, faster than one by one.
    pub fn distances(&mut self, points: &[[f64; 3]]) -> Vec<f64> {
        let mut found = Vec::with_capacity(points.len());
        let (packets, rest) = points.as_chunks::<LANES>();
        for packet in packets {
            found.extend(self.many.scalar(transposed(packet)).0);
        }
        found.extend(rest.iter().map(|&point| self.distance(point)));
        found
    }

    /// Distance and gradient at a point.
    pub fn gradient(&mut self, point: [f64; 3]) -> FieldSample {
        let Dual { value, partials } = self.slope.scalar(Dual::point(point));
        FieldSample { distance: value, gradient: partials }
    }

    /// Distances and gradients at many points, faster than one by one.
    pub fn gradients(&mut self, points: &[[f64; 3]]) -> Vec<FieldSample> {
        let mut found = Vec::with_capacity(points.len());
        let (packets, rest) = points.as_chunks::<LANES>();
        for packet in packets {
            let Dual { value, partials } = self.slopes.scalar(Dual::point(transposed(packet)));
            found.extend((0..LANES).map(|lane| FieldSample {
                distance: value.0[lane],
                gradient: partials.map(|partial| partial.0[lane]),
            }));
        }
        found.extend(rest.iter().map(|&point| self.gradient(point)));
        found
    }

    /// Material of the nearest surface. `None` if the scene has no materials.
    pub fn material(&mut self, point: [f64; 3]) -> Option<Material> {
        let fields = self.material.as_mut()?.eval(point);
        let &[color, coverage, roughness, metallic, emission, occlusion] = fields else {
            return None;
        };
        let three = |[x, y, z, _]: [f64; 4]| [x, y, z];
        Some(Material {
            color: three(color),
            coverage: coverage[0],
            roughness: roughness[0],
            metallic: metallic[0],
            emission: three(emission),
            occlusion: occlusion[0],
        })
    }

    /// Materials at many points. Empty if the scene has no materials.
    pub fn materials(&mut self, points: &[[f64; 3]]) -> Vec<Material> {
        points.iter().filter_map(|&point| self.material(point)).collect()
    }
}

/// The coordinates of points, axis by axis.
fn transposed(points: &[[f64; 3]; LANES]) -> [Packet<f64, LANES>; 3] {
    std::array::from_fn(|axis| Packet(points.map(|point| point[axis])))
}
