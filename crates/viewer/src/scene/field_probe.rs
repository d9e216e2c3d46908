//! Evaluates the scene's field on the CPU at the points that a picture shows.

use sdfc::FrameValues;
use sdfc_graph::Program;
use sdfc_graph::eval::{Dual, Tape};

/// A function that returns true when the result of a long computation is no longer needed.
pub type IsInterrupted<'a> = &'a (dyn Fn() -> bool + Sync);

/// The number of points between two questions whether the computation is interrupted.
const POINTS_PER_QUESTION: usize = 64;
/// The fewest points for which another thread is started.
const MIN_POINTS_PER_THREAD: usize = 2048;

/// A scene's field and its gradient, in f64.
#[derive(Debug)]
pub struct FieldProbe {
    tape: Option<Tape>,
}

impl FieldProbe {
    /// The field of a program. Points are relative to the program's origin. If the program cannot
    /// be evaluated, every result is `None`.
    pub fn new(program: &Program) -> Self {
        let tape = program.distance.and_then(|root| Tape::new(&program.graph, &[root]).ok());
        Self { tape }
    }

    /// The distance and gradient at a point.
    pub fn at(&self, frame: &FrameValues, point: [f64; 3]) -> Option<Dual> {
        let tape = self.tape.as_ref()?;
        Some(tape.prepare::<Dual>(frame).scalar(Dual::point(point)))
    }

    /// The distances and gradients at points, computed on all cores. `None` stays `None`.
    pub fn at_all(
        &self,
        frame: &FrameValues,
        points: &[Option<[f64; 3]>],
        interrupted: IsInterrupted<'_>,
    ) -> Vec<Option<Dual>> {
        let Some(tape) = &self.tape else { return vec![None; points.len()] };
        in_parallel(points, interrupted, || {
            let mut field = tape.prepare::<Dual>(frame);
            move |point: &Option<[f64; 3]>| point.map(|point| field.scalar(Dual::point(point)))
        })
    }
}

/// Maps points to values on all cores. `function` is called once per thread and returns that
/// thread's map. If the computation is interrupted, the rest are default values.
pub fn in_parallel<P: Sync, T: Default + Clone + Send, F: FnMut(&P) -> T>(
    points: &[P],
    interrupted: IsInterrupted<'_>,
    function: impl Fn() -> F + Sync,
) -> Vec<T> {
    let mut out = vec![T::default(); points.len()];
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let chunk = points.len().div_ceil(threads).max(MIN_POINTS_PER_THREAD);
    std::thread::scope(|scope| {
        for (out, points) in out.chunks_mut(chunk).zip(points.chunks(chunk)) {
            let function = &function;
            scope.spawn(move || {
                let mut map = function();
                let parts = out.chunks_mut(POINTS_PER_QUESTION);
                for (out, points) in parts.zip(points.chunks(POINTS_PER_QUESTION)) {
                    if interrupted() {
                        return;
                    }
                    out.iter_mut().zip(points).for_each(|(out, point)| *out = map(point));
                }
            });
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_of_a_ball_has_exact_distances_and_gradients() {
        let scene = sdfc::Compiler::new().compile("a", "sphere(0.5)").unwrap();
        let probe = FieldProbe::new(scene.program());
        let frame = FrameValues::defaults(scene.params());
        let points = [Some([2.0, 0.0, 0.0]), None, Some([0.0, 0.0, -0.25])];
        let [Some(outside), None, Some(inside)] = probe.at_all(&frame, &points, &|| false)[..]
        else {
            panic!("two of three points are there")
        };
        assert_eq!((outside.value, outside.partials), (1.5, [1.0, 0.0, 0.0]));
        assert_eq!((inside.value, inside.partials), (-0.25, [0.0, 0.0, -1.0]));
    }
    #[test]
    fn an_interrupted_computation_ends_early() {
        let points = vec![(); 10 * POINTS_PER_QUESTION];
        let done = std::sync::atomic::AtomicUsize::new(0);
        let count = |_: &()| done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let interrupted = || done.load(std::sync::atomic::Ordering::Relaxed) > 0;
        in_parallel(&points, &interrupted, || count);
        assert_eq!(done.into_inner(), POINTS_PER_QUESTION);
    }
}
