//! Chooses the CPU back end for fields that a software GPU driver draws slowly.

use sdfc_graph::eval::{Affine, FrameValues, Tape};
use sdfc_march::Method;
use sdfc_render::Gpu;

use crate::scene::Scene;

/// The least number of operations of a field that the CPU back end may draw faster. See
/// `docs/scale.md` for times of both at many sizes.
const LEAST_OPERATIONS: usize = 3000;
/// The CPU back end is faster if at most this part of the operations matters in its cells.
const GREATEST_PART: f64 = 0.1;
/// The cubes that are examined: along each axis this many, each this many times smaller than the
/// scene's longest side.
const CUBES: usize = 3;
const SMALLER: f64 = 64.0;

impl Scene {
    /// Says why the CPU back end draws this scene faster than a GPU does, in one line.
    ///
    /// A software driver takes seconds to compile a formula of thousands of operations, and then
    /// evaluates all of them everywhere. The CPU back end evaluates in each cell of space what
    /// matters there.
    pub(crate) fn faster_on_cpu(&self, gpu: &Gpu, method: Method) -> Option<String> {
        let operations = self.report.marched_cost.operations;
        let is_large = operations >= LEAST_OPERATIONS && self.program.cullable_loops.is_empty();
        let is_simple = method == Method::Auto && self.is_certified();
        if !gpu.info().software || !is_large || !is_simple {
            return None;
        }
        (self.part_in_cells()? <= GREATEST_PART).then(|| {
            format!(
                "drawn on the CPU, which is faster than the software driver {} for a formula of \
                 {operations} operations",
                gpu.info().name
            )
        })
    }

    /// The mean part of the field's operations that matter in small cubes of the scene, from 0 to
    /// 1; `None` without bounds.
    fn part_in_cells(&self) -> Option<f64> {
        let frame = self.defaults();
        let [lo, hi] = self.focus_at(&frame)?;
        let sides: [f64; 3] = std::array::from_fn(|axis| hi[axis] - lo[axis]);
        let longest = sides.into_iter().fold(0.0, f64::max);
        let tape = Tape::new(&self.program.graph, &[self.program.distance?]).ok()?;
        let kept = (0..CUBES.pow(3)).map(|index| {
            let at = [index % CUBES, index / CUBES % CUBES, index / CUBES.pow(2)];
            let middle = std::array::from_fn(|axis| {
                lo[axis] + sides[axis] * (at[axis] as f64 + 0.5) / CUBES as f64
            });
            operations_in(&tape, &frame, middle, 0.5 * longest / SMALLER)
        });
        let mean = kept.sum::<usize>() as f64 / CUBES.pow(3) as f64;
        longest.is_finite().then(|| mean / tape.operations() as f64)
    }
}

/// The operations that matter in a cube.
fn operations_in(tape: &Tape, frame: &FrameValues, middle: [f64; 3], half: f64) -> usize {
    let coordinate = |axis: usize| {
        let mut slopes = [0.0; 3];
        slopes[axis] = half;
        Affine::coordinate(middle[axis], slopes)
    };
    let over = tape.over(frame, [0, 1, 2].map(coordinate));
    over.tape.map_or(tape.operations(), |short| short.operations())
}
