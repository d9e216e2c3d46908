//! The field of a scene at points.

use crate::boundary::{Failure, guarded, handle, slice, slice_mut};
use crate::scene::Scene;
use crate::status::Status;

/// Computes the signed distances at `count` points, each given as x, y, z. If the scene is
/// certified, they never exceed the true distances.
///
/// # Safety
///
/// `scene` is null or a valid scene. `points` has 3 numbers for each point, `distances` has room
/// for 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_distance(
    scene: *const Scene,
    points: *const f64,
    count: usize,
    distances: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, points, to) =
            unsafe { (handle(scene)?, slice(points.cast(), count)?, slice_mut(distances, count)?) };
        let mut field = scene.scene.field(&scene.frame)?;
        to.copy_from_slice(&field.distances(points));
        Ok(())
    })
}

/// Computes the gradient of the distance and the distance at `count` points: x, y, z, distance for
/// each.
///
/// # Safety
///
/// `scene` is null or a valid scene. `points` has 3 numbers for each point, `gradients` has room
/// for 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_gradient(
    scene: *const Scene,
    points: *const f64,
    count: usize,
    gradients: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, points, to) = unsafe {
            (handle(scene)?, slice(points.cast(), count)?, slice_mut(gradients.cast(), count)?)
        };
        let mut field = scene.scene.field(&scene.frame)?;
        for (to, point) in to.iter_mut().zip(points) {
            let found = field.gradient(*point);
            let [x, y, z] = found.gradient;
            *to = [x, y, z, found.distance];
        }
        Ok(())
    })
}

/// Computes the lowest and the highest corner of a box that contains the surface, three numbers
/// each. A number is infinite if the surface has no bound on that side.
///
/// # Safety
///
/// `scene` is null or a valid scene. `lowest` and `highest` have room for 3 numbers each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_bounds(
    scene: *const Scene,
    lowest: *mut f64,
    highest: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, lowest, highest) =
            unsafe { (handle(scene)?, slice_mut(lowest, 3)?, slice_mut(highest, 3)?) };
        let bounds = scene.scene.bounds_at(&scene.frame);
        let [lo, hi] = bounds.ok_or_else(|| Failure::from(sdfc::Error::NothingDrawn))?;
        lowest.copy_from_slice(&lo);
        highest.copy_from_slice(&hi);
        Ok(())
    })
}
