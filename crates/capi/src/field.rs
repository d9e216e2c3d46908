//! The field of a scene at points.

use sdfc::FieldSample;

use crate::boundary::{Failure, guarded, handle, slice, store, writable};
use crate::scene::Scene;
use crate::status::Status;

/// Computes the signed distances at `count` points, each given as x, y, z. If the scene is
/// certified, they never exceed the true distances. `distances` may be `points`.
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
        let (scene, points) = unsafe { (handle(scene)?, slice(points.cast(), count)?) };
        writable(distances, count)?;
        let found = scene.scene.field(&scene.frame)?.distances(points);
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        unsafe { store(distances, &found) }
    })
}

/// Computes the gradient of the distance and the distance at `count` points: x, y, z, distance for
/// each. `gradients` may be `points`.
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
        let (scene, points) = unsafe { (handle(scene)?, slice::<[f64; 3]>(points.cast(), count)?) };
        writable(gradients.cast::<[f64; 4]>(), count)?;
        let found = scene.scene.field(&scene.frame)?.gradients(points);
        let row = |FieldSample { gradient: [x, y, z], distance }| [x, y, z, distance];
        // All of them before the first is stored, because `gradients` may overlap `points`.
        let rows: Vec<[f64; 4]> = found.into_iter().map(row).collect();
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        unsafe { store(gradients, rows.as_flattened()) }
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
        let scene = unsafe { handle(scene)? };
        writable(lowest, 3)?;
        writable(highest, 3)?;
        let bounds = scene.scene.bounds_at(&scene.frame);
        let [lo, hi] = bounds.ok_or_else(|| Failure::from(sdfc::Error::NothingDrawn))?;
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        unsafe {
            store(lowest, &lo)?;
            store(highest, &hi)
        }
    })
}
