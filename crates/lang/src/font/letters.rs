//! Letters as curves.
//!
//! `harfrust` reads the font's tables and applies kerning, ligatures and scripts. This module takes
//! the outlines of the glyphs, converts them to quadratic curves, and these to circular arcs.
//!
//! Lengths are in ems; the baseline of the first line is y = 0.

use std::cell::RefCell;

use harfrust::font::{Font, glyph::outline};
use harfrust::{Buffer, GlyphId, ShapeOptions, ShaperFont, shape};
use rustc_hash::FxHashMap;

use super::{SANS, Setting};
use crate::arcs::arcs;
use crate::import::{self, Resolver};
use crate::outline::{Curve, Piece, Point, boundary, mix, sub};
use outline::{DrawMemory, DrawOptions, PathElement};

/// The name of the built-in font in scenes.
const SANS_NAME: &str = "sans";
/// The largest number of curves of a text.
pub const MAX_CURVES: usize = 4096;
/// Largest distance of quadratic curves from the cubic curve that they replace, in ems: 1/8 of a
/// unit of most fonts.
pub const TOLERANCE: f64 = 1.25e-4;
/// A curve is a line if its control point is nearer than this to the line between its ends, in ems.
const STRAIGHT: f64 = 1e-6;
/// The largest number of quadratic curves for a cubic one.
const MAX_PARTS: f64 = 16.0;

/// The fonts of a scene by name; each is read once.
pub struct Fonts<'r> {
    resolver: &'r dyn Resolver,
    known: RefCell<FxHashMap<String, Result<Font, String>>>,
}

impl<'r> Fonts<'r> {
    /// Fonts that are `"sans"` or files of a resolver.
    pub fn new(resolver: &'r dyn Resolver) -> Self {
        Self { resolver, known: RefCell::default() }
    }

    fn font(&self, name: &str) -> Result<Font, String> {
        let known = self.known.borrow().get(name).cloned();
        known.unwrap_or_else(|| {
            let font = self.read(name);
            self.known.borrow_mut().insert(name.to_owned(), font.clone());
            font
        })
    }

    fn read(&self, name: &str) -> Result<Font, String> {
        if name == SANS_NAME {
            return Font::new(SANS, 0).ok_or_else(|| "the built-in font is damaged".to_owned());
        }
        if !name.contains('.') {
            return Err(format!(
                "there is no built-in font `{name}`: the only one is \"{SANS_NAME}\"; others are \
                 files, such as \"fonts/bold.ttf\""
            ));
        }
        let path = import::locate("", name)?;
        let bytes = self
            .resolver
            .read_bytes(&path)
            .map_err(|why| format!("the font file `{path}` cannot be read: {why}"))?;
        Font::new(bytes, 0)
            .filter(|font| font.num_glyphs() > 0 && font.units_per_em() > 0)
            .ok_or_else(|| format!("`{path}` is not a TrueType or OpenType font"))
    }

    /// The outline of a text, as arcs. Lines end at `\n`.
    ///
    /// # Errors
    ///
    /// Returns the reason in one sentence: the font cannot be read, or lacks a letter.
    pub fn curves(&self, text: &str, font: &str, setting: Setting) -> Result<Vec<Piece>, String> {
        let font = self.font(font)?;
        let mut curves = Vec::new();
        for (number, line) in text.split('\n').enumerate() {
            let baseline = -(number as f64) * setting.leading;
            set_line(&font, line, baseline, setting, &mut curves)?;
        }
        Ok(arcs(boundary(curves)))
    }
}

/// Adds the outlines of one line.
fn set_line(
    font: &Font,
    line: &str,
    baseline: f64,
    setting: Setting,
    curves: &mut Vec<Curve>,
) -> Result<(), String> {
    let mut buffer = Buffer::new();
    buffer.push_str(line);
    buffer.guess_segment_properties();
    shape(&ShaperFont::new(font), &mut buffer, ShapeOptions::default())
        .map_err(|why| format!("the text cannot be laid out: {why}"))?;
    let em = f64::from(font.units_per_em());
    let first = curves.len();
    let mut pen: f64 = 0.0;
    for (info, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
        if info.glyph_id == 0 {
            let character = line.get(info.cluster as usize..).and_then(|rest| rest.chars().next());
            let character = character.unwrap_or('\u{fffd}');
            let code = u32::from(character);
            return Err(format!("the font has no letter for `{character}` (U+{code:04X})"));
        }
        let origin =
            [pen + f64::from(position.x_offset) / em, baseline + f64::from(position.y_offset) / em];
        draw(font, GlyphId::new(info.glyph_id), origin, curves)?;
        pen += f64::from(position.x_advance) / em + setting.spacing;
    }
    let shift = -setting.align * (pen - setting.spacing).max(0.0);
    for point in curves[first..].as_flattened_mut() {
        point[0] += shift;
    }
    Ok(())
}

/// Adds the outline of a glyph. White space has none.
fn draw(font: &Font, glyph: GlyphId, origin: Point, curves: &mut Vec<Curve>) -> Result<(), String> {
    let Some(outline) = font.outline_glyphs().get(glyph) else { return Ok(()) };
    let mut path: Vec<PathElement> = Vec::new();
    outline
        .draw(&DrawOptions::new(), DrawMemory::default(), &mut path)
        .map_err(|why| format!("a letter of the font cannot be read: {why}"))?;
    let em = f64::from(font.units_per_em());
    let point = |x: f32, y: f32| [origin[0] + f64::from(x) / em, origin[1] + f64::from(y) / em];
    let (mut start, mut at) = (origin, origin);
    for element in path {
        let end = match element {
            PathElement::MoveTo { x, y } => {
                start = point(x, y);
                start
            }
            PathElement::LineTo { x, y } => {
                line(at, point(x, y), curves);
                point(x, y)
            }
            PathElement::QuadTo { cx0, cy0, x, y } => {
                quadratic(at, point(cx0, cy0), point(x, y), curves);
                point(x, y)
            }
            PathElement::CurveTo { cx0, cy0, cx1, cy1, x, y } => {
                cubic([at, point(cx0, cy0), point(cx1, cy1), point(x, y)], curves);
                point(x, y)
            }
            PathElement::Close => {
                line(at, start, curves);
                start
            }
        };
        at = end;
        if curves.len() > MAX_CURVES {
            return Err(format!("the outlines of the text have more than {MAX_CURVES} curves"));
        }
    }
    Ok(())
}

fn line(from: Point, to: Point, curves: &mut Vec<Curve>) {
    if from != to {
        curves.push([from, mix(from, to, 0.5), to]);
    }
}

/// Adds a cubic curve as quadratic curves within [`TOLERANCE`]. The error of one quadratic curve is
/// at most sqrt(3) / 36 of the third difference of the control points, which falls with the cube of
/// the number of curves.
fn cubic([a, b, c, d]: [Point; 4], curves: &mut Vec<Curve>) {
    let third = [0, 1].map(|axis| d[axis] - 3.0 * c[axis] + 3.0 * b[axis] - a[axis]);
    let off = 3f64.sqrt() / 36.0 * third[0].hypot(third[1]);
    let parts = (off / TOLERANCE).cbrt().ceil().clamp(1.0, MAX_PARTS);
    // The control points of the part from s to t are the blossom's values at (s, s, s), (s, s, t),
    // (s, t, t) and (t, t, t).
    let blossom = |r: f64, s: f64, t: f64| {
        let (ab, bc, cd) = (mix(a, b, r), mix(b, c, r), mix(c, d, r));
        mix(mix(ab, bc, s), mix(bc, cd, s), t)
    };
    for part in 0..parts as u32 {
        let (s, t) = (f64::from(part) / parts, f64::from(part + 1) / parts);
        let (from, to) = (blossom(s, s, s), blossom(t, t, t));
        let (first, second) = (blossom(s, s, t), blossom(s, t, t));
        let control = [0, 1].map(|i| (3.0 * (first[i] + second[i]) - from[i] - to[i]) / 4.0);
        quadratic(from, control, to, curves);
    }
}

/// Adds a quadratic curve, or a line if the curve is straight.
fn quadratic(from: Point, control: Point, to: Point, curves: &mut Vec<Curve>) {
    let (chord, bend) = (sub(to, from), sub(control, from));
    let off = (bend[0] * chord[1] - bend[1] * chord[0]).abs();
    if off <= STRAIGHT * chord[0].hypot(chord[1]) {
        line(from, to, curves);
    } else {
        curves.push([from, control, to]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::NoFiles;

    const LEFT: Setting = Setting { align: 0.0, spacing: 0.0, leading: 1.2 };

    fn extent(pieces: &[Piece]) -> [f64; 2] {
        let xs = pieces.iter().flat_map(|piece| piece.curve).map(|point| point[0]);
        [xs.clone().fold(f64::INFINITY, f64::min), xs.fold(f64::NEG_INFINITY, f64::max)]
    }

    #[test]
    fn kerning_spacing_and_alignment_move_letters() {
        let fonts = Fonts::new(&NoFiles);
        let width = |text: &str, setting| {
            let [left, right] = extent(&fonts.curves(text, "sans", setting).unwrap_or_default());
            right - left
        };
        // A and V move towards each other.
        let apart = width("A", LEFT) + width("V", LEFT);
        assert!(width("AV", LEFT) < apart, "{} and {apart}", width("AV", LEFT));
        let wider = width("AV", Setting { spacing: 0.1, ..LEFT });
        assert!((wider - width("AV", LEFT) - 0.1).abs() < 1e-9);
        let middle =
            fonts.curves("HoH", "sans", Setting { align: 0.5, ..LEFT }).unwrap_or_default();
        let [left, right] = extent(&middle);
        assert!((left + right).abs() < 0.01, "{left} {right}");
    }

    #[test]
    fn quadratic_curves_follow_a_cubic_one_within_the_tolerance() {
        let ends = [[0.0, 0.0], [0.1, 0.9], [0.9, -0.5], [1.0, 0.3]];
        let mut curves = Vec::new();
        cubic(ends, &mut curves);
        assert!(curves.len() > 3);
        let points: Vec<Point> = (0..=20_000)
            .map(|i| {
                let t = f64::from(i) / 20_000.0;
                let s = 1.0 - t;
                [0, 1].map(|axis| {
                    let [a, b, c, d] = ends.map(|end| end[axis]);
                    s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d
                })
            })
            .collect();
        for [a, b, c] in curves {
            for i in 0..=20 {
                let t = f64::from(i) / 20.0;
                let p = mix(mix(a, b, t), mix(b, c, t), t);
                let far = |q: &Point| (p[0] - q[0]).hypot(p[1] - q[1]);
                let nearest = points.iter().map(far).fold(f64::INFINITY, f64::min);
                assert!(nearest < TOLERANCE + 1e-5, "{nearest}");
            }
        }
    }

    #[test]
    fn text_that_cannot_be_drawn_is_an_error() {
        let fonts = Fonts::new(&NoFiles);
        let why = |text: &str, font: &str| fonts.curves(text, font, LEFT).err().unwrap_or_default();
        assert!(why("a\u{2603}", "sans").contains("U+2603"));
        assert!(why("a", "bold").contains("no built-in font"));
        assert!(why("a", "missing.ttf").contains("missing.ttf"));
        assert!(why("a", "../up.ttf").contains("outside the folder"));
        assert!(why(&"ø".repeat(500), "sans").contains("4096"));
    }
}
