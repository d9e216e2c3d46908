//! A page of letters as one flat formula, as other programs write it: bars, slanted bars, rings and
//! arcs, joined by `min` and cut to a plate.

use std::fmt::Write;

use fastrand::Rng;

/// Half the thickness of the plate.
const HALF: f64 = 0.05;
/// Width of a stroke, and length of a bar.
const WIDTH: f64 = 0.1;
const LENGTH: f64 = 0.3;
/// Cells of a row, and the distance from one to the next.
const COLUMNS: u32 = 7;
const PITCH: f64 = 0.36;
/// A slanted bar's distance, divided by its greatest slope for these slants.
const STEEPEST: f64 = 0.5;

/// A page of letters.
pub struct Page(Vec<Letter>);

/// A letter: its strokes, cut where the next letter begins.
struct Letter {
    strokes: Vec<Stroke>,
    right: f64,
}

/// A stroke of a letter, from its lower left corner or about its center.
struct Stroke {
    kind: Kind,
    x: f64,
    y: f64,
}

#[derive(Clone, Copy)]
enum Kind {
    Upright,
    Level,
    /// Its x grows by this for each unit of y.
    Slanted(f64),
    Ring,
    /// The left half of a ring.
    Arc,
}

impl Page {
    /// A page with this number of letters, each of two to four strokes.
    pub fn new(letters: u32) -> Self {
        let mut random = Rng::with_seed(11);
        let kinds = [
            Kind::Upright,
            Kind::Level,
            Kind::Slanted(0.5),
            Kind::Slanted(-0.5),
            Kind::Ring,
            Kind::Arc,
        ];
        let letter = |letter: u32| {
            let corner = [letter % COLUMNS, letter / COLUMNS].map(|at| PITCH * f64::from(at) - 1.2);
            let mut strokes = Vec::new();
            for _ in 0..random.u32(2..=4) {
                let kind = kinds[random.usize(..kinds.len())];
                // Short decimal numbers are the same numbers in the scene and here.
                let mut moved = |at: f64| (1e3 * (at + 0.1 * random.f64())).round() / 1e3;
                let [x, y] = corner.map(&mut moved);
                strokes.push(Stroke { kind, x, y });
            }
            let right = (1e3 * (corner[0] + PITCH)).round() / 1e3;
            Letter { strokes, right }
        };
        Self((0..letters).map(letter).collect())
    }

    /// The scene.
    pub fn scene(&self) -> String {
        let mut text = "solid page() = {\n".to_owned();
        let mut page = "1e3".to_owned();
        for (index, letter) in self.0.iter().enumerate() {
            // Writing to a string does not fail.
            let _ = writeln!(text, "let v{index} = min({page}, {})", letter.text());
            page = format!("v{index}");
        }
        let _ = writeln!(text, "max({page}, abs(p.z) - {HALF})\n}}\npage() & box([4, 9, 0.2])");
        text + "camera(eye: [0.5, 0.3, 6], target: [0, -0.4, 0], fov: 26deg)\nsun()\n"
    }

    /// The value of the formula at a point.
    pub fn at(&self, [x, y, z]: [f64; 3]) -> f64 {
        let page = self.0.iter().map(|letter| letter.at(x, y)).fold(f64::INFINITY, f64::min);
        page.max(z.abs() - HALF)
    }
}

impl Letter {
    fn text(&self) -> String {
        let strokes = self.strokes.iter().map(Stroke::text);
        let all = strokes.reduce(|a, b| format!("min({a}, {b})")).unwrap_or_default();
        format!("max({all}, p.x - {})", self.right)
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let all = self.strokes.iter().map(|stroke| stroke.at(x, y)).fold(f64::INFINITY, f64::min);
        all.max(x - self.right)
    }
}

impl Stroke {
    fn text(&self) -> String {
        let Self { kind, x, y } = *self;
        let bar = |x: String, width: f64, height: f64| {
            let (right, top) = (width, y + height);
            format!("max(max(-({x}), {x} - {right}), max({y} - p.y, p.y - {top}))")
        };
        let ring = |r: f64| {
            format!("abs(sqrt(pow(p.x - {x}, 2) + pow(p.y - {y}, 2)) - {r}) - {}", 0.5 * WIDTH)
        };
        match kind {
            Kind::Upright => bar(format!("p.x - {x}"), WIDTH, LENGTH),
            Kind::Level => bar(format!("p.x - {x}"), LENGTH, WIDTH),
            Kind::Slanted(slant) => bar(
                format!("(p.x - {x} - {slant} * (p.y - {y})) * {STEEPEST}"),
                WIDTH * STEEPEST,
                LENGTH,
            ),
            Kind::Ring => ring(0.5 * LENGTH),
            Kind::Arc => format!("max({}, p.x - {x})", ring(0.5 * LENGTH)),
        }
    }

    fn at(&self, px: f64, py: f64) -> f64 {
        let (dx, dy) = (px - self.x, py - self.y);
        let bar =
            |dx: f64, width: f64, height: f64| (-dx).max(dx - width).max(-dy).max(dy - height);
        let ring = |r: f64| ((dx * dx + dy * dy).sqrt() - r).abs() - 0.5 * WIDTH;
        match self.kind {
            Kind::Upright => bar(dx, WIDTH, LENGTH),
            Kind::Level => bar(dx, LENGTH, WIDTH),
            Kind::Slanted(slant) => bar((dx - slant * dy) * STEEPEST, WIDTH * STEEPEST, LENGTH),
            Kind::Ring => ring(0.5 * LENGTH),
            Kind::Arc => ring(0.5 * LENGTH).max(dx),
        }
    }
}
