//! Vector instructions of the CPU that a program runs on.

use pulp::Arch;

/// Calls a function that is compiled for the widest vector instructions of this CPU. It must
/// be marked `#[inline(always)]`, and so must be what it calls, or they are compiled for all
/// CPUs. The results do not depend on the CPU.
///
/// ```
/// use sdfc_graph::eval::vectorized;
///
/// let mut numbers = [1.0f32; 64];
/// vectorized(
///     #[inline(always)]
///     || numbers.iter_mut().for_each(|x| *x += 1.0),
/// );
/// assert_eq!(numbers, [2.0; 64]);
/// ```
#[inline(always)]
pub fn vectorized<R>(f: impl FnOnce() -> R) -> R {
    Arch::new().dispatch(f)
}
