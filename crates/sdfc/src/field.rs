//! A scene's field at points, on the CPU, in f64.

use sdfc_graph::eval::{Dual, Evaluator, FieldSample, FrameValues, Packet, Tape, TapeError};

use crate::{Error, Scene};

/// Points that are evaluated together.
const LANES: usize = 8;

/// What a scene's field is computed by.
#[derive(Debug)]
pub(crate) struct Tapes {
    distance: Tape,
    /// The fields of `MaterialField::ALL`, where something is painted.
    material: Option<Tape>,
}

/// What a surface is made of at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Linear red, green and blue.
    pub color: [f64; 3],
    /// How much of it is painted, 0..1: what is not has the colour of unpainted surfaces.
    pub coverage: f64,
    /// 0 smooth to 1 rough.
    pub roughness: f64,
    /// 0 dielectric to 1 metal.
    pub metallic: f64,
    /// Linear light that it gives off.
    pub emission: [f64; 3],
    /// Part of the light from everywhere that reaches it, 0..1.
    pub occlusion: f64,
}

/// A scene's field at one frame's values of params, `time` and `frame`: see [`Scene::field`].
///
/// What is known per frame has been computed; evaluating allocates nothing. Threads each clone their own.
#[derive(Clone, Debug)]
pub struct Field<'s> {
    one: Evaluator<'s, f64>,
    many: Evaluator<'s, Packet<f64, LANES>>,
    slopes: Evaluator<'s, Dual>,
    material: Option<Evaluator<'s, f64>>,
}

impl Scene {
    /// The field at a frame's values, to be asked at many points. Params that the frame lacks and such as are
    /// not numbers give a field that is not a number; nothing else comes of them.
    ///
    /// ```
    /// use sdfc::{FrameValues, Scene};
    ///
    /// let scene = Scene::from_source("a.sdf", "param r = 1 in 0..2\nsphere(r).color(#f00)")?;
    /// let mut frame = FrameValues::defaults(scene.params());
    /// scene.set(&mut frame, "r", 0.5)?;
    ///
    /// let mut field = scene.field(&frame)?;
    /// assert_eq!(field.distance([0.0, 2.0, 0.0]), 1.5);
    /// assert_eq!(field.gradient([0.0, 2.0, 0.0]).gradient, [0.0, 1.0, 0.0]);
    /// assert_eq!(field.distances(&[[0.0; 3], [1.0, 0.0, 0.0]]), [-0.5, 0.5]);
    /// let red = field.material([0.0, 0.5, 0.0]).expect("it is painted");
    /// assert_eq!(red.color, [1.0, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn field(&self, frame: &FrameValues) -> Result<Field<'_>, Error> {
        let tapes = self.tapes.get_or_init(|| Tapes::of(self)).as_ref();
        let tapes = tapes.map_err(|&error| error)?.as_ref().ok_or(Error::NothingDrawn)?;
        Ok(Field {
            one: tapes.distance.prepare(frame),
            many: tapes.distance.prepare(frame),
            slopes: tapes.distance.prepare(frame),
            material: tapes.material.as_ref().map(|tape| tape.prepare(frame)),
        })
    }

    /// Signed distance at a point, at the params' defaults; never more than the true distance where the scene is
    /// certified. For many points or other values, [`Scene::field`].
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn distance(&self, point: [f64; 3]) -> Result<f64, Error> {
        Ok(self.field(&self.defaults())?.distance(point))
    }

    /// The derivative of [`Scene::distance`], and the distance.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn gradient(&self, point: [f64; 3]) -> Result<FieldSample, Error> {
        Ok(self.field(&self.defaults())?.gradient(point))
    }

    /// What the nearest surface is made of, at the params' defaults; `None` where nothing is painted.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`].
    pub fn material(&self, point: [f64; 3]) -> Result<Option<Material>, Error> {
        Ok(self.field(&self.defaults())?.material(point))
    }

    /// The params' defaults, at time 0 and frame 0.
    pub fn defaults(&self) -> FrameValues {
        FrameValues::defaults(self.params())
    }
}

impl Tapes {
    fn of(scene: &Scene) -> Result<Option<Self>, TapeError> {
        let program = &scene.program;
        let Some(distance) = program.distance else { return Ok(None) };
        let tape = |roots: &[_]| Tape::new(&program.graph, roots);
        let material = program.material.map(|fields| tape(&fields)).transpose()?;
        Ok(Some(Self { distance: tape(&[distance])?, material }))
    }
}

impl Field<'_> {
    /// Signed distance at a point.
    pub fn distance(&mut self, point: [f64; 3]) -> f64 {
        self.one.scalar(point)
    }

    /// Distance at many points: faster than one after the other.
    pub fn distances(&mut self, points: &[[f64; 3]]) -> Vec<f64> {
        let mut found = Vec::with_capacity(points.len());
        let (packets, rest) = points.as_chunks::<LANES>();
        for packet in packets {
            let axis = |axis: usize| Packet(packet.map(|point| point[axis]));
            found.extend(self.many.scalar([axis(0), axis(1), axis(2)]).0);
        }
        found.extend(rest.iter().map(|&point| self.distance(point)));
        found
    }

    /// Distance and its derivative at a point.
    pub fn gradient(&mut self, point: [f64; 3]) -> FieldSample {
        let Dual { value, partials } = self.slopes.scalar(Dual::point(point));
        FieldSample { distance: value, gradient: partials }
    }

    /// Distance and its derivative at many points.
    pub fn gradients(&mut self, points: &[[f64; 3]]) -> Vec<FieldSample> {
        points.iter().map(|&point| self.gradient(point)).collect()
    }

    /// What the nearest surface is made of; `None` where nothing is painted.
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

    /// Materials at many points; empty where nothing is painted.
    pub fn materials(&mut self, points: &[[f64; 3]]) -> Vec<Material> {
        points.iter().filter_map(|&point| self.material(point)).collect()
    }
}
