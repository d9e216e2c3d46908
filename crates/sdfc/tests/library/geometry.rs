//! Points and random numbers.

/// A point or a vector; the third lane is 0 for a region.
pub type Point = [f64; 3];

pub fn combine(a: Point, b: Point, f: impl Fn(f64, f64) -> f64) -> Point {
    [0, 1, 2].map(|axis| f(a[axis], b[axis]))
}

pub fn add(a: Point, b: Point) -> Point {
    combine(a, b, |a, b| a + b)
}

pub fn sub(a: Point, b: Point) -> Point {
    combine(a, b, |a, b| a - b)
}

pub fn mix(a: Point, b: Point, t: f64) -> Point {
    combine(a, b, |a, b| a + (b - a) * t)
}

pub fn scaled(a: Point, by: f64) -> Point {
    a.map(|lane| lane * by)
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

pub fn distance(a: Point, b: Point) -> f64 {
    length(sub(a, b))
}

/// SplitMix64: the same numbers on every machine.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number in 0..1.
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number in -1..1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next_u64() % count as u64) as usize
    }
}
