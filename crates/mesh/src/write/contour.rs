//! Contour files, as bytes: SVG and DXF.

use std::fmt::Write;
use std::path::Path;

use crate::contour::{Contour, ContourPath};

/// A file format for contours. One scene unit is a millimetre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContourFormat {
    /// SVG: one filled path for each outer path with its holes.
    Svg,
    /// DXF of AutoCAD R12, which all programs read: one closed polyline for each path.
    Dxf,
}

/// The space around an SVG picture, as a fraction of its longer side.
const MARGIN: f64 = 0.02;

impl ContourFormat {
    /// Returns the format for the extension of a path.
    ///
    /// # Errors
    ///
    /// The extension belongs to no format. The message names the formats.
    pub fn of(path: &Path) -> Result<Self, String> {
        let extension = path.extension().unwrap_or_default();
        let is = |known: &str| extension.eq_ignore_ascii_case(known);
        if is("svg") {
            Ok(Self::Svg)
        } else if is("dxf") {
            Ok(Self::Dxf)
        } else {
            Err(format!("{}: contours are written as .svg or .dxf", path.display()))
        }
    }

    /// Encodes a contour.
    pub fn encode(self, contour: &Contour) -> Vec<u8> {
        match self {
            Self::Svg => svg(contour),
            Self::Dxf => dxf(contour),
        }
        .into_bytes()
    }
}

// Writing to a string does not fail.

/// SVG 1.1: <https://www.w3.org/TR/SVG11/paths.html>. Its second coordinate points down.
fn svg(contour: &Contour) -> String {
    let [lo, hi] = contour.bounds().unwrap_or_default();
    let [width, height] = [hi[0] - lo[0], hi[1] - lo[1]];
    let margin = MARGIN * width.max(height);
    let [left, top] = [lo[0] - margin, -hi[1] - margin];
    let [width, height] = [width + 2.0 * margin, height + 2.0 * margin];
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" \
         viewBox=\"{left} {top} {width} {height}\">\n<desc>sdfc: {}</desc>\n\
         <g fill-rule=\"evenodd\">\n",
        contour.certificate
    );
    let mut holes: Vec<Vec<&ContourPath>> = vec![Vec::new(); contour.paths.len()];
    for path in &contour.paths {
        if let (true, Some(parent)) = (path.is_hole, path.parent) {
            holes[parent].push(path);
        }
    }
    for (outer, holes) in contour.paths.iter().zip(holes).filter(|(path, _)| !path.is_hole) {
        text += "<path d=\"";
        for path in std::iter::once(outer).chain(holes) {
            svg_path(&mut text, path);
        }
        text += "\"/>\n";
    }
    text += "</g>\n</svg>\n";
    text
}

fn svg_path(text: &mut String, path: &ContourPath) {
    let mut command = "M";
    for (index, segment) in path.segments().enumerate() {
        let is_last = index + 1 == path.points.len();
        let [[x, y], [to_x, to_y]] = segment.ends;
        if command == "M" {
            let _ = write!(text, "M{x} {}", 0.0 - y);
        }
        let next = if segment.bulge == 0.0 { "L" } else { "A" };
        if segment.bulge != 0.0 {
            let radius = short(segment.radius());
            // Clockwise in a plane whose second coordinate points down.
            let sweep = u8::from(segment.bulge < 0.0);
            let _ = write!(text, "A{radius} {radius} 0 0 {sweep} {to_x} {}", 0.0 - to_y);
        } else if !is_last {
            let separator = if command == "A" { "L" } else { " " };
            let _ = write!(text, "{separator}{to_x} {}", 0.0 - to_y);
        }
        command = next;
    }
    text.push('Z');
}

/// Returns a number with 12 digits, so few that its rounding is far below any error.
fn short(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// DXF, as pairs of a group code and a value:
/// <https://help.autodesk.com/view/OARX/2024/ENU/?guid=GUID-235B22E0-A567-4CF6-92D3-38A2306D73F3>.
fn dxf(contour: &Contour) -> String {
    let [lo, hi] = contour.bounds().unwrap_or_default();
    let mut text = format!(
        "999\nsdfc: {}\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n4\n\
         9\n$EXTMIN\n10\n{}\n20\n{}\n9\n$EXTMAX\n10\n{}\n20\n{}\n0\nENDSEC\n\
         0\nSECTION\n2\nENTITIES\n",
        contour.certificate, lo[0], lo[1], hi[0], hi[1]
    );
    for path in &contour.paths {
        text += "0\nPOLYLINE\n8\n0\n66\n1\n10\n0\n20\n0\n30\n0\n70\n1\n";
        for ([x, y], bulge) in path.points.iter().zip(&path.bulges) {
            let _ = write!(text, "0\nVERTEX\n8\n0\n10\n{x}\n20\n{y}\n30\n0\n");
            if *bulge != 0.0 {
                let _ = write!(text, "42\n{bulge}\n");
            }
        }
        text += "0\nSEQEND\n8\n0\n";
    }
    text += "0\nENDSEC\n0\nEOF\n";
    text
}
