//! The field on the CPU, at the places that a picture shows.

use sdfc::FrameValues;
use sdfc::graph::Program;
use sdfc::graph::eval::{Dual, Tape};

/// Places that one thread takes at a time.
const GROUP: usize = 2048;

/// A scene's field, in f64, with its gradient.
#[derive(Debug)]
pub struct Probe {
    tape: Option<Tape>,
}

impl Probe {
    /// Of a program, with points counted from its origin; one that cannot be evaluated gives nothing.
    pub fn new(program: &Program) -> Self {
        let tape = program.distance.and_then(|root| Tape::new(&program.graph, &[root]).ok());
        Self { tape }
    }

    /// Distance and gradient at a point.
    pub fn at(&self, frame: &FrameValues, point: [f64; 3]) -> Option<Dual> {
        let tape = self.tape.as_ref()?;
        Some(tape.prepare::<Dual>(frame).scalar(Dual::point(point)))
    }

    /// Distances and gradients at points, by all threads; `None` stays `None`.
    pub fn at_all(&self, frame: &FrameValues, points: &[Option<[f64; 3]>]) -> Vec<Option<Dual>> {
        let Some(tape) = &self.tape else { return vec![None; points.len()] };
        in_parallel(points, || {
            let mut field = tape.prepare::<Dual>(frame);
            move |point: &Option<[f64; 3]>| point.map(|point| field.scalar(Dual::point(point)))
        })
    }
}

/// A function of each place, by all threads; each thread makes its own.
pub fn in_parallel<P: Sync, T: Default + Clone + Send, F: FnMut(&P) -> T>(
    places: &[P],
    function: impl Fn() -> F + Sync,
) -> Vec<T> {
    let mut out = vec![T::default(); places.len()];
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = places.len().div_ceil(threads).max(GROUP);
    std::thread::scope(|scope| {
        for (out, places) in out.chunks_mut(share).zip(places.chunks(share)) {
            let function = &function;
            scope.spawn(move || {
                let mut of = function();
                out.iter_mut().zip(places).for_each(|(out, place)| *out = of(place));
            });
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_and_gradients_of_a_ball() {
        let scene = sdfc::compile("a", "sphere(0.5)").scene.unwrap();
        let probe = Probe::new(scene.program());
        let frame = FrameValues::defaults(scene.params());
        let points = [Some([2.0, 0.0, 0.0]), None, Some([0.0, 0.0, -0.25])];
        let [Some(outside), None, Some(inside)] = probe.at_all(&frame, &points)[..] else {
            panic!("two of three points are there")
        };
        assert_eq!((outside.value, outside.partials), (1.5, [1.0, 0.0, 0.0]));
        assert_eq!((inside.value, inside.partials), (-0.25, [0.0, 0.0, -1.0]));
    }
}
