//! Derivatives by one reverse sweep (reverse-mode differentiation).
//!
//! One walk from a scalar down to any number of nodes gives the scalar's derivatives with respect
//! to all of them. Each node sums up the derivative of the root with respect to it, its *adjoint*,
//! from the nodes that use it, and passes contributions on to its arguments. So the gradient costs
//! about three times the field's operations for all its components together; forward
//! differentiation costs that for each.
//!
//! At points without a derivative these rules hold:
//!
//! | operation | derivative |
//! |---|---|
//! | `length`, `normalize`, `sqrt` at 0 | 0 |
//! | `abs` at 0 | +1 |
//! | `min`, `max`, `clamp`, `saturate`, `select` | of the selected argument; the first on a tie |
//! | `floor`, `ceil`, `round`, `trunc`, `sign`, `step`, `hash`, comparisons | 0 |
//! | a loop's iteration count | 0 |
//! | `x % y` | 1 for x, `-floor(x / y)` for y |

mod cuts;
mod gradient;
mod live;
mod loops;
mod parts;
mod rules;
mod sweep;
mod terms;

pub use self::gradient::{GradientReport, best_gradient, gradient, gradient_in_parts};
pub(crate) use self::sweep::TINY;
pub use self::sweep::adjoints;
