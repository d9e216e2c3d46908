//! Vectors of three numbers.

pub(crate) type Vec3 = [f64; 3];

/// A point of the surface with the normal there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub(crate) position: Vec3,
    pub(crate) normal: Vec3,
}

/// Returns the longest side of a box.
pub(crate) fn longest_side([lo, hi]: [Vec3; 2]) -> f64 {
    (0..3).map(|axis| hi[axis] - lo[axis]).fold(0.0, f64::max)
}

pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Vec3, by: f64) -> Vec3 {
    a.map(|x| x * by)
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// The sum of numbers. That of none is 0, while `Iterator::sum` gives -0.
pub(crate) fn total(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |sum, number| sum + number)
}

/// The vector with length 1; `None` if it has no direction.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    let length = length(a);
    (length > 0.0 && length.is_finite()).then(|| scale(a, 1.0 / length))
}

/// The point at a fraction of the way from `a` to `b`.
pub(crate) fn between(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])]
}

/// Two unit vectors that are orthogonal to a unit vector and to each other.
pub(crate) fn tangents(n: Vec3) -> [Vec3; 2] {
    // Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
    let sign = 1f64.copysign(n[2]);
    let a = -1.0 / (sign + n[2]);
    let b = n[0] * n[1] * a;
    [[1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]], [b, sign + n[1] * n[1] * a, -n[1]]]
}
