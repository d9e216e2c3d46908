//! Evaluation of flat math: in f32 (as the shader computes), f64, intervals, affine forms and dual
//! numbers.
//!
//! [`Number`] names the scalar operations of the closed set; each number type implements them. One
//! place turns nodes into scalar operations for all number types: a [`Tape`] records them once and
//! then runs in any of them; [`fold`] computes them at once.
//!
//! ```
//! use sdfc_graph::eval::{Dual, FrameValues, Interval, Packet, Tape};
//! use sdfc_graph::{Dim, Graph};
//!
//! let mut graph = Graph::new();
//! let p = graph.point(0, Dim::Three);
//! let (radius, length) = (graph.number(0.5), graph.length(p));
//! let sphere = graph.sub(length, radius);
//!
//! let tape = Tape::new(&graph, &[sphere])?;
//! let frame = FrameValues::default();
//!
//! assert_eq!(tape.prepare::<f64>(&frame).scalar([0.0, 3.0, 4.0]), 4.5);
//! assert_eq!(tape.prepare::<f32>(&frame).scalar([0.0, 0.0, 0.0]), -0.5);
//!
//! let slope = tape.prepare::<Dual>(&frame).scalar(Dual::point([0.0, 0.0, 2.0]));
//! assert_eq!(slope.partials, [0.0, 0.0, 1.0]);
//!
//! // Over a box, the distance is from that of its nearest point to that of its farthest.
//! let side = Interval::new(1.0, 3.0);
//! let region = [side, Interval::new(0.0, 4.0), Interval::new(0.0, 0.0)];
//! let over = tape.prepare::<Interval>(&frame).scalar(region);
//! assert!(over.contains(0.5) && over.contains(4.5) && over.lo() > 0.499 && over.hi() < 4.501);
//!
//! let mut pair = tape.prepare::<Packet<f32, 2>>(&frame);
//! let [x, y, z] = [Packet([0.0, 2.0]), Packet([1.0, 0.0]), Packet([0.0, 0.0])];
//! assert_eq!(pair.scalar([x, y, z]), Packet([0.5, 1.5]));
//! # Ok::<(), sdfc_graph::eval::TapeError>(())
//! ```

mod affine;
mod allocate;
mod compile;
pub(crate) mod direct;
mod dual;
mod evaluator;
mod float;
mod fold;
mod frame;
mod hash;
mod interval;
mod number;
mod op;
mod packet;
mod record;
mod registers;
mod sample;
pub(crate) mod scalarise;
mod specialize;
mod tape;
mod tracer;
mod vectors;

pub use affine::Affine;
pub use dual::Dual;
pub use evaluator::Evaluator;
pub use fold::fold;
pub(crate) use fold::fold_where;
pub use frame::FrameValues;
pub use hash::{HASH_COUNT, hash};
pub use interval::{BranchPath, Interval};
pub use number::Number;
pub use packet::Packet;
pub use sample::{FieldSample, evaluate_frame, sample_field};
pub use specialize::{FieldOver, RootsOver};
pub use tape::{Tape, TapeError};
pub use vectors::vectorized;
