//! Light by direction, as a square of texels: the sphere is projected on an octahedron, whose lower
//! half is folded out around the upper one.
//!
//! T. Engelhardt, C. Dachsbacher, Octahedron environment maps (VMV 2008). Texels are at the corners
//! of a grid, and the border of the square is folded in half: two texels there that have the same
//! direction have the same light. So interpolation has no seam, and needs no other operations than
//! addition, multiplication and one division. A map of longitude and latitude needs arc functions,
//! which differ between GPUs, and has poles.

/// A vector or a colour.
pub type Vector = [f32; 3];

/// A square of texels, with light by direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Octahedron {
    /// The number of texels along a side: odd, at least 3.
    pub side: usize,
    /// The texels, row by row.
    pub texels: Vec<Vector>,
}

impl Octahedron {
    /// The map of a function of the direction.
    pub fn of(side: usize, light: impl Fn(Vector) -> Vector) -> Self {
        let middle = |index: usize| 2.0 * index as f32 / (side - 1) as f32 - 1.0;
        let rows = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let texels = rows.map(|(x, y)| light(direction([middle(x), middle(y)]))).collect();
        Self { side, texels }
    }

    /// The map of a function of the direction, with the mean of four samples for each texel.
    pub fn averaged(side: usize, light: impl Fn(Vector) -> Vector) -> Self {
        let cell = 2.0 / (side - 1) as f32;
        let middle = |index: usize| cell * index as f32 - 1.0;
        let rows = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let texel = |(x, y)| {
            let [x, y] = [middle(x), middle(y)];
            let corners = [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]];
            let samples = corners.map(|[dx, dy]| {
                let at = [x + cell * dx, y + cell * dy];
                light(direction(inside(at)))
            });
            [0, 1, 2].map(|lane| 0.25 * samples.map(|sample| sample[lane]).iter().sum::<f32>())
        };
        let mut map = Self { side, texels: rows.map(texel).collect() };
        map.merge_border(|a, b| [0, 1, 2].map(|lane| 0.5 * (a[lane] + b[lane])));
        map
    }

    /// The light from a direction of unit length, interpolated.
    pub fn light(&self, direction: Vector) -> Vector {
        let [x, y] = position(direction).map(|at| 0.5 * (at + 1.0) * (self.side - 1) as f32);
        let [column, row] = [x, y].map(|at| (at as usize).min(self.side - 2));
        let [along, down] = [x - column as f32, y - row as f32];
        let first = row * self.side + column;
        let [a, b] = [self.texels[first], self.texels[first + 1]];
        let [c, d] = [self.texels[first + self.side], self.texels[first + self.side + 1]];
        [0, 1, 2].map(|lane| {
            let above = a[lane] + along * (b[lane] - a[lane]);
            let below = c[lane] + along * (d[lane] - c[lane]);
            above + down * (below - above)
        })
    }

    /// The texels with their directions and the solid angles that each covers; all together cover
    /// 4 pi.
    pub fn weighted(&self) -> impl Iterator<Item = (Vector, f64, Vector)> + '_ {
        let weights: Vec<f64> = (0..self.texels.len()).map(|index| self.weight(index)).collect();
        let factor = 4.0 * std::f64::consts::PI / weights.iter().sum::<f64>();
        self.texels.iter().zip(weights).enumerate().map(move |(index, (&texel, weight))| {
            (direction(self.middle(index)), factor * weight, texel)
        })
    }

    /// The position of a texel in the square from -1 to 1.
    fn middle(&self, index: usize) -> [f32; 2] {
        let steps = (self.side - 1) as f32;
        [index % self.side, index / self.side].map(|at| 2.0 * at as f32 / steps - 1.0)
    }

    /// A number in proportion to the solid angle of a texel. At a point of the octahedron with the
    /// distance r from the middle, an area of the square covers 1 / r^3 times as much.
    fn weight(&self, index: usize) -> f64 {
        let last = self.side - 1;
        let edges = [index % self.side, index / self.side].map(|at| at == 0 || at == last);
        let area: f64 = edges.map(|is_edge| if is_edge { 0.5 } else { 1.0 }).iter().product();
        let [x, z] = self.middle(index).map(f64::from);
        let y = 1.0 - x.abs() - z.abs();
        let [x, z] = if y < 0.0 { [1.0 - z.abs(), 1.0 - x.abs()] } else { [x, z] };
        let square = x * x + y * y + z * z;
        area / (square * square.sqrt())
    }

    /// The map with half as many texels along a side. Each texel of this one is shared among the
    /// nearest ones of the other, by its distance and its solid angle.
    pub fn halved(&self) -> Self {
        let side = (self.side - 1) / 2 + 1;
        let mut sums = vec![[0.0f64; 4]; side * side];
        for (index, texel) in self.texels.iter().enumerate() {
            let (x, y) = (index % self.side, index / self.side);
            let solid_angle = self.weight(index);
            for (row, down) in nearest(y) {
                for (column, along) in nearest(x) {
                    let weight = solid_angle * along * down;
                    let [red, green, blue] = texel.map(f64::from);
                    let sum = sums[row * side + column].iter_mut();
                    for (sum, lane) in sum.zip([red, green, blue, 1.0]) {
                        *sum += weight * lane;
                    }
                }
            }
        }
        merge_border(side, &mut sums, |a, b| [0, 1, 2, 3].map(|lane| a[lane] + b[lane]));
        let texels = sums.into_iter().map(|[red, green, blue, weight]| {
            [red, green, blue].map(|sum| (sum / weight.max(f64::MIN_POSITIVE)) as f32)
        });
        Self { side, texels: texels.collect() }
    }

    /// Gives both texels of each pair on the border the same value.
    fn merge_border(&mut self, merge: impl Fn(Vector, Vector) -> Vector) {
        merge_border(self.side, &mut self.texels, merge);
    }
}

/// The texels of a map of half the side that are nearest to a texel, and their weights.
fn nearest(index: usize) -> impl Iterator<Item = (usize, f64)> {
    let weight = if index.is_multiple_of(2) { 1.0 } else { 0.5 };
    [(index / 2, weight), (index / 2 + 1, weight)].into_iter().take(1 + index % 2)
}

/// Merges the values at the same directions on the border: each side is mirrored at its middle, and
/// the corners are one direction.
fn merge_border<T: Copy>(side: usize, values: &mut [T], merge: impl Fn(T, T) -> T) {
    let last = side - 1;
    let mut pair = |a: usize, b: usize| {
        let merged = merge(values[a], values[b]);
        (values[a], values[b]) = (merged, merged);
    };
    for index in 1..side / 2 {
        let other = last - index;
        for end in [0, last] {
            pair(end * side + index, end * side + other);
            pair(index * side + end, other * side + end);
        }
    }
    // Twice, so that all four have the same.
    let corners = [0, last, last * side, last * side + last];
    pair(corners[0], corners[1]);
    pair(corners[2], corners[3]);
    pair(corners[0], corners[2]);
    values[corners[1]] = values[corners[0]];
    values[corners[3]] = values[corners[0]];
}

/// The direction at a position in the square from -1 to 1, y up.
fn direction([x, z]: [f32; 2]) -> Vector {
    let y = 1.0 - x.abs() - z.abs();
    let [x, z] = if y < 0.0 { folded([x, z]) } else { [x, z] };
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|lane| lane / length)
}

/// The position of a direction.
fn position([x, y, z]: Vector) -> [f32; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    let at = [x / sum, z / sum];
    if y < 0.0 { folded(at) } else { at }
}

/// Folds a position between the lower half and the square's corners.
fn folded([x, z]: [f32; 2]) -> [f32; 2] {
    [(1.0 - z.abs()).copysign(x), (1.0 - x.abs()).copysign(z)]
}

/// A position beyond the border, moved to where it lies in the square.
fn inside([x, z]: [f32; 2]) -> [f32; 2] {
    let [x, z] = if x.abs() > 1.0 { [(2.0 - x.abs()).copysign(x), -z] } else { [x, z] };
    if z.abs() > 1.0 { [-x, (2.0 - z.abs()).copysign(z)] } else { [x, z] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_and_directions_are_inverse() {
        for x in -10..=10 {
            for z in -10..=10 {
                let at = [x, z].map(|index| index as f32 / 10.0);
                let again = position(direction(at));
                // The border is folded in half, so that only directions can be compared.
                let [a, b] = [direction(at), direction(again)];
                assert!((0..3).all(|lane| (a[lane] - b[lane]).abs() < 1e-5), "{at:?} {again:?}");
            }
        }
        assert_eq!(direction([0.0, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(direction([1.0, 0.0]), [1.0, 0.0, 0.0]);
        assert_eq!(direction([0.0, -1.0]), [0.0, 0.0, -1.0]);
        assert_eq!(direction([1.0, 1.0])[1], -1.0);
    }

    #[test]
    fn interpolation_has_no_seam() {
        let height = |[x, y, z]: Vector| [x, y * y, z - y];
        let map = Octahedron::of(65, height);
        for index in 0..20_000 {
            let angle = index as f32 * 0.37;
            let y = index as f32 / 10_000.0 - 1.0;
            let radius = (1.0 - y * y).max(0.0).sqrt();
            let to = [radius * angle.cos(), y, radius * angle.sin()];
            let (found, expected) = (map.light(to), height(to));
            // Across the equator the map has a crease, inside of cells.
            assert!((0..3).all(|lane| (found[lane] - expected[lane]).abs() < 2e-2), "{to:?}");
        }
    }

    #[test]
    fn halving_keeps_constants_and_means() {
        let constant = Octahedron::of(33, |_| [0.25, 1.0, 7.0]).halved();
        assert_eq!(constant.side, 17);
        assert!(constant.texels.iter().all(|texel| (texel[2] - 7.0).abs() < 1e-5));
        let uneven = Octahedron::of(129, |[x, y, _]| [(20.0 * x).sin() + 1.0, y.exp(), 1.0]);
        let mean = |map: &Octahedron, lane: usize| {
            let sum: f64 = map.weighted().map(|(_, angle, it)| angle * f64::from(it[lane])).sum();
            sum / (4.0 * std::f64::consts::PI)
        };
        for lane in 0..3 {
            let [a, b] = [&uneven, &uneven.halved()].map(|map| mean(map, lane));
            assert!((a - b).abs() < 2e-3, "{a} {b}");
        }
    }

    #[test]
    fn halving_folds_the_border() {
        let map = Octahedron::of(33, |[x, y, z]| [x + 2.0, (x - z).exp(), y]).halved();
        let last = map.side - 1;
        for index in 0..=last {
            assert_eq!(map.texels[index], map.texels[last - index]);
            assert_eq!(map.texels[index * map.side], map.texels[(last - index) * map.side]);
        }
    }

    #[test]
    fn positions_beyond_the_border_come_back_at_the_other_half() {
        for at in [[1.1, 0.3], [-1.2, 0.9], [0.4, 1.05], [0.2, -1.3]] {
            let back = inside(at);
            assert!(back.iter().all(|lane| lane.abs() <= 1.0), "{back:?}");
            // Both lie at the same distance from the border, near the same point of it.
            let border = at.map(|lane: f32| lane.clamp(-1.0, 1.0));
            let [a, b] = [direction(border), direction(back)];
            assert!((0..3).all(|lane| (a[lane] - b[lane]).abs() < 0.45), "{at:?} {back:?}");
        }
    }
}
