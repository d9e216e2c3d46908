//! Chooses the CPU back end for fields that a software GPU driver draws slowly.

use sdfc_analyze::certain_operations;
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
/// The CPU back end draws a planar picture faster if this many operations run at a pixel.
const LEAST_PIXEL_OPERATIONS: usize = 10_000;
/// The squares of a planar picture that are examined: along each axis this many, each this part of
/// the picture's height.
const SQUARES: usize = 3;
const SQUARE: f64 = 32.0 / 360.0;

impl Scene {
    /// Says why the CPU back end draws this scene faster than a GPU does, in one line.
    ///
    /// A software driver takes seconds to compile a formula of thousands of operations, and then
    /// evaluates all of them everywhere. The CPU back end evaluates in each cell of space what
    /// matters there. `None` if the GPU is faster, as far as `docs/scale.md` has measured.
    pub fn faster_on_cpu(&self, gpu: &Gpu, method: Method) -> Option<String> {
        if !gpu.info().software {
            return None;
        }
        let operations = if self.is_planar() {
            self.needless_pixel_operations()
        } else {
            self.needless_operations(method)
        }?;
        Some(format!(
            "drawn on the CPU, which is faster than the software driver {} for a formula of \
             {operations} operations",
            gpu.info().name
        ))
    }

    /// The number of operations that a ray's step takes, if few of them matter in each cell. Loops
    /// that may end early do not count: those of outlines run few of their iterations.
    fn needless_operations(&self, method: Method) -> Option<usize> {
        let field = self.program.marched_field()?;
        let operations = certain_operations(&self.program.graph, &[field]);
        let is_large = operations >= LEAST_OPERATIONS && self.program.cullable_loops.is_empty();
        let is_simple = method == Method::Auto && self.is_certified();
        (is_large && is_simple && self.part_in_cells()? <= GREATEST_PART).then_some(operations)
    }

    /// The number of operations that a pixel of a planar picture takes, if few of them matter in
    /// each square. Loops may run fewer iterations than they are allowed to, so it is counted.
    fn needless_pixel_operations(&self) -> Option<usize> {
        if self.report.pixel_cost.operations < LEAST_PIXEL_OPERATIONS {
            return None;
        }
        let frame = self.defaults();
        let tape = Tape::for_rays(&self.program.graph, &[self.program.planar_pixel?]).ok()?;
        let pose = self.pose(&frame, 1.0).ok()?;
        let height = 2.0 * pose.half_height;
        let over = |place: [f64; 2], half: f64| {
            let x = Affine::coordinate(place[0], [half, 0.0, 0.0]);
            let y = Affine::coordinate(place[1], [0.0, half, 0.0]);
            let width = Affine::coordinate(height * SQUARE / 32.0, [0.0; 3]);
            tape.over_rays(&frame, [[x, y, y], [width; 3]])
        };
        let (mut ran, mut kept) = (0, 0);
        for index in 0..SQUARES.pow(2) {
            let steps = [index % SQUARES, index / SQUARES].map(|step| step as f64 + 0.5);
            let place = [0, 1].map(|axis: usize| {
                pose.target[axis] + height * (steps[axis] / SQUARES as f64 - 0.5)
            });
            ran += over(place, 0.0).operations;
            let short = over(place, 0.5 * SQUARE * height).tape;
            kept += short.map_or(tape.operations(), |short| short.operations());
        }
        let is_large = ran / SQUARES.pow(2) >= LEAST_PIXEL_OPERATIONS;
        (is_large && kept as f64 <= GREATEST_PART * ran as f64).then(|| ran / SQUARES.pow(2))
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
