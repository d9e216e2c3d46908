//! Where the surface moves when a value changes, for handles in the picture.
//!
//! A point of the surface of the field f(p, v) moves along its unit normal n by
//! -(∂f/∂v) / |∇f| per unit of the value v. The first derivative comes from central differences at
//! two values, the gradient from the field itself. If one translation d explains these speeds at
//! all points that move, speed = n · d in the sense of least squares, then the value moves a part
//! of the scene by d. Otherwise, as for a radius, the handle is at one point and follows its
//! normal.

use std::sync::Arc;
use std::sync::mpsc::Sender;

use glam::{DMat3, DVec3};

use crate::render::picture::{Picture, RenderRequest};
use crate::render::surface_points::{SurfacePoints, stride};
use crate::scene::field_probe::IsInterrupted;
use crate::scene::handle_values::LiveParam;
use crate::worker_thread::WorkerThread;

/// The most points of the surface that are looked at.
const MAX_POINTS: u32 = 2000;
/// The difference of a value for its derivative, as a fraction of the value or of 1.
const STEP: f64 = 1e-5;
/// A point moves if its speed is at least this fraction of the greatest one.
const MIN_SPEED: f64 = 0.02;
/// The fewest points that a translation is fitted to.
const MIN_FITTED: usize = 6;
/// The largest part of the squared speeds that a translation may leave unexplained.
const MAX_UNEXPLAINED: f64 = 0.05;
/// A handle stays near its point as long as that is this good, as a fraction of the best point.
const GOOD_ENOUGH: f64 = 0.4;
/// Keeps the fit defined if not all directions are seen, as a fraction of the matrix.
const REGULARISATION: f64 = 1e-6;

/// A question about a picture.
#[derive(Clone, Debug)]
pub struct HandleRequest {
    surface: SurfacePoints,
    params: Vec<LiveParam>,
    /// Where the handles of the values are shown, if they are.
    shown: Vec<Option<DVec3>>,
    /// The values in the picture, in the order of the params.
    pub start: Vec<f64>,
}

impl HandleRequest {
    /// A question about the surface in a picture. Handles stay near the points where those of the
    /// values are `shown`.
    pub fn new(picture: &Picture, params: Vec<LiveParam>, shown: Vec<Option<DVec3>>) -> Self {
        let lanes = &picture.request.frame.params;
        let value = |param: &LiveParam| lanes.get(param.index).map_or(0.0, |it| it[0]) * param.sign;
        let start = params.iter().map(value).collect();
        Self { surface: SurfacePoints::new(picture), params, shown, start }
    }

    /// The request that the picture answers.
    pub fn request(&self) -> &RenderRequest {
        &self.surface.request
    }

    /// Returns true if both ask the same.
    pub fn is_same(&self, other: &Self) -> bool {
        self.has_same_params(other) && self.surface.is_same(&other.surface)
    }

    /// Returns true if both are about the same values.
    pub fn has_same_params(&self, other: &Self) -> bool {
        self.params == other.params
    }

    /// Points of the surface, and the direction of their rays.
    fn points(&self) -> Vec<[DVec3; 2]> {
        let [width, height] = self.surface.size();
        let stride = stride([width, height], MAX_POINTS);
        let columns = |y| (stride / 2..width).step_by(stride as usize).map(move |x| (x, y));
        let pixels = (stride / 2..height).step_by(stride as usize).flat_map(columns);
        pixels.filter_map(|(x, y)| self.surface.point(x, y)).collect()
    }
}

/// A handle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handle {
    /// A point of the scene.
    pub origin: DVec3,
    /// How it moves per unit of the value, in scene units.
    pub motion: DVec3,
    /// True if all of a part moves so, false if other points of it move in other directions.
    pub is_translation: bool,
}

/// The answer to a question: for each value a handle, or `None` if nothing that is seen moves.
#[derive(Clone, Debug)]
pub struct Handles {
    /// The question.
    pub request: HandleRequest,
    /// In the order of the values.
    pub handles: Vec<Option<Handle>>,
}

impl Handles {
    fn new(request: HandleRequest, interrupted: IsInterrupted<'_>) -> Self {
        let points = request.points();
        let shown = request.shown.iter().copied().chain(std::iter::repeat(None));
        let values = request.params.iter().zip(shown);
        let handle = |(param, shown): (&LiveParam, _)| {
            handle_of(&request, (*param, shown), &points, interrupted)
        };
        let handles = values.map(handle).collect();
        Self { request, handles }
    }
}

/// A point of the surface that moves.
struct Moving {
    point: DVec3,
    normal: DVec3,
    ray: DVec3,
    speed: f64,
}

fn handle_of(
    request: &HandleRequest,
    (param, shown): (LiveParam, Option<DVec3>),
    points: &[[DVec3; 2]],
    interrupted: IsInterrupted<'_>,
) -> Option<Handle> {
    let RenderRequest { model, frame, .. } = request.request();
    let value = frame.params.get(param.index)?[0];
    let step = STEP * value.abs().max(1.0);
    let positions: Vec<Option<[f64; 3]>> =
        points.iter().map(|[point, _]| Some(point.to_array())).collect();
    let at = |offset: f64| {
        let mut frame = frame.clone();
        if let Some(lanes) = frame.params.get_mut(param.index) {
            lanes[0] = value + offset;
        }
        model.field.at_all(&frame, &positions, interrupted)
    };
    let (here, less, more) = (at(0.0), at(-step), at(step));
    let moving = points.iter().zip(here).zip(less.into_iter().zip(more));
    let moving = moving.filter_map(|(([point, ray], here), (less, more))| {
        let gradient = DVec3::from(here?.partials);
        let slope = (more?.value - less?.value) / (2.0 * step) * param.sign;
        let speed = -slope / gradient.length();
        let normal = gradient.try_normalize()?;
        speed.is_finite().then_some(Moving { point: *point, normal, ray: *ray, speed })
    });
    let mut moving: Vec<Moving> = moving.collect();
    let fastest = moving.iter().map(|it| it.speed.abs()).fold(0.0, f64::max);
    moving.retain(|it| it.speed.abs() > (MIN_SPEED * fastest).max(1e-9));
    let origin = DVec3::from(model.scene.drawn().origin);
    let shown = shown.map(|shown| shown - origin);
    let handle = translation(&moving).or_else(|| along_normal(&moving, shown))?;
    (!interrupted()).then_some(Handle { origin: handle.origin + origin, ..handle })
}

/// A handle in the middle of the points if one translation explains their speeds.
fn translation(moving: &[Moving]) -> Option<Handle> {
    if moving.len() < MIN_FITTED {
        return None;
    }
    let outer = |n: DVec3| DMat3::from_cols(n * n.x, n * n.y, n * n.z);
    let matrix = moving.iter().fold(DMat3::ZERO, |sum, it| sum + outer(it.normal));
    let right: DVec3 = moving.iter().map(|it| it.normal * it.speed).sum();
    let matrix = matrix + DMat3::IDENTITY * (REGULARISATION * moving.len() as f64);
    let motion = matrix.inverse() * right;
    let unexplained: f64 = moving.iter().map(|it| (it.speed - it.normal.dot(motion)).powi(2)).sum();
    let all: f64 = moving.iter().map(|it| it.speed.powi(2)).sum();
    if !motion.is_finite() || unexplained > MAX_UNEXPLAINED * all {
        return None;
    }
    let middle = moving.iter().map(|it| it.point).sum::<DVec3>() / moving.len() as f64;
    let distance = |it: &Moving| (it.point - middle).length_squared();
    let nearest = moving.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    Some(Handle { origin: nearest.point, motion, is_translation: true })
}

/// A handle at a fast point whose normal is seen from the side. If a handle is shown, it is at the
/// nearest point to that one which is not much worse.
fn along_normal(moving: &[Moving], shown: Option<DVec3>) -> Option<Handle> {
    let seen = |it: &Moving| it.speed.abs() * (0.2 + it.normal.cross(it.ray).length());
    let best = moving.iter().max_by(|a, b| seen(a).total_cmp(&seen(b)))?;
    let nearest = shown.and_then(|shown| {
        let good = moving.iter().filter(|it| seen(it) >= GOOD_ENOUGH * seen(best));
        let distance = |it: &Moving| (it.point - shown).length_squared();
        good.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    });
    let best = nearest.unwrap_or(best);
    let motion = best.normal * best.speed;
    Some(Handle { origin: best.point, motion, is_translation: false })
}

/// The thread that finds handles; dropping this ends it.
#[derive(Debug)]
pub struct HandleWorker(WorkerThread<HandleRequest>);

impl HandleWorker {
    /// Starts the thread. It sends `answers` and calls `wake` after each.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        answers: Sender<Handles>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let init = |requests: Arc<crate::latest_channel::LatestChannel<HandleRequest>>| {
            move |request: HandleRequest| {
                let handles = Handles::new(request, &|| requests.is_interrupted());
                if !requests.is_interrupted() {
                    // Sending fails only after the session is dropped.
                    let _ = answers.send(handles);
                    wake();
                }
            }
        };
        WorkerThread::start("handles", init).map(Self)
    }

    /// Asks a question in place of any earlier one.
    pub fn send(&self, request: HandleRequest) {
        self.0.channel().send(request);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moving(normal: DVec3, speed: f64) -> Moving {
        Moving { point: normal, normal, ray: DVec3::NEG_Z, speed }
    }

    /// The normals of a ball at the pixels that show it.
    fn normals() -> impl Iterator<Item = DVec3> {
        let pixels = (-9..=9).flat_map(|x| (-9..=9).map(move |y| [x, y].map(f64::from)));
        pixels.filter_map(|[x, y]| {
            let [x, y] = [x / 10.0, y / 10.0];
            let squared = 1.0 - x * x - y * y;
            (squared > 0.0).then(|| DVec3::new(x, y, squared.sqrt()))
        })
    }

    #[test]
    fn a_translation_is_distinguished_from_a_growing_radius() {
        let d = DVec3::new(0.5, -1.0, 0.25);
        let moved: Vec<Moving> = normals().map(|n| moving(n, n.dot(d))).collect();
        let handle = translation(&moved).unwrap();
        assert!(handle.motion.abs_diff_eq(d, 1e-4) && handle.is_translation, "{handle:?}");
        let grown: Vec<Moving> = normals().map(|n| moving(n, 1.0)).collect();
        assert_eq!(translation(&grown), None);
        let handle = along_normal(&grown, None).unwrap();
        assert!(handle.motion.abs_diff_eq(handle.origin, 1e-12), "{handle:?}");
        // It stays where it is shown, although another point is as good.
        let shown = DVec3::new(-handle.origin.x, -handle.origin.y, handle.origin.z) * 1.1;
        let stays = along_normal(&grown, Some(shown)).unwrap();
        assert!((stays.origin - shown).length() < 0.2, "{stays:?}");
        // A point that faces the eye is too bad.
        let away = along_normal(&grown, Some(DVec3::Z)).unwrap();
        assert!((away.origin - DVec3::Z).length() > 0.1, "{away:?}");
        // If only one side is seen, from the front, the fit finds only the motion towards the eye.
        let side: Vec<Moving> = (0..9).map(|_| moving(DVec3::Z, 2.0)).collect();
        let handle = translation(&side).unwrap();
        assert!(handle.motion.abs_diff_eq(2.0 * DVec3::Z, 1e-4), "{handle:?}");
    }
}
