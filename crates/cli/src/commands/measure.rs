//! `sdfc measure`: prints measurements of a scene, as proven intervals.

use std::fmt::Write;

use sdfc::{Clearance, MeasureOptions, Measurements, Proven, Scene, Wall};

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

/// Limit of the decimals of a number, so that the power of ten is finite.
const MAX_DECIMALS: f64 = 300.0;

/// Measures a scene, and prints the result.
///
/// # Errors
///
/// The scene cannot be read, has errors, draws nothing or has no limit; a param does not take its
/// value; Ctrl-C.
pub fn run(args: &args::Measure, console: &Console) -> Result<(), Failure> {
    let compiler = super::compiler_of_constants();
    let scene = super::scene_with(&args.file, compiler, &args.values.params.set, console)?;
    let frame = super::values(&scene, args.values.time);
    let options = MeasureOptions::new().relative(args.error_relative).frame(frame);
    let options = args.max_cells.map_or(options.clone(), |limit| options.max_cells(limit));
    let (text, is_limited) = match &args.between[..] {
        [first, second] => clearance(&scene, [first, second], &options, args.json, console)?,
        _ if args.thinnest_wall => wall(&scene, &options, args.json, console)?,
        _ => measurements(&scene, &options, args.json, console)?,
    };
    if is_limited {
        console.warning(&format!(
            "the limit of {} boxes was reached: the intervals are true, but wider than asked for",
            options.max_cells
        ));
    }
    output::to_stdout(&text)
}

/// A text to print, and whether the limit of boxes was reached.
type Printed = (Vec<u8>, bool);

fn measurements(
    scene: &Scene,
    options: &MeasureOptions,
    is_json: bool,
    console: &Console,
) -> Result<Printed, Failure> {
    let found =
        super::mesh_work("measuring", console, |progress| scene.measure(options, progress))?;
    let is_limited = found.is_limited;
    Ok((printed(scene, options, found, table, is_json, console)?, is_limited))
}

fn wall(
    scene: &Scene,
    options: &MeasureOptions,
    is_json: bool,
    console: &Console,
) -> Result<Printed, Failure> {
    let found =
        super::mesh_work("measuring", console, |progress| scene.thinnest_wall(options, progress))?;
    let is_limited = found.is_limited;
    Ok((printed(scene, options, found, wall_table, is_json, console)?, is_limited))
}

/// Returns a report about a scene as JSON or as a table, and notes which solids it ignores.
fn printed<T: serde::Serialize>(
    scene: &Scene,
    options: &MeasureOptions,
    found: T,
    table: impl Fn(&T) -> String,
    is_json: bool,
    console: &Console,
) -> Result<Vec<u8>, Failure> {
    let frame = options.frame.clone().unwrap_or_else(|| scene.defaults());
    let reported = scene.reported(&frame, found);
    super::note_left_out(&reported.left_out, console);
    match is_json {
        true => output::json(&reported),
        false => Ok(table(&reported.report).into_bytes()),
    }
}

fn clearance(
    scene: &Scene,
    names: [&str; 2],
    options: &MeasureOptions,
    is_json: bool,
    console: &Console,
) -> Result<Printed, Failure> {
    let found = super::mesh_work("measuring", console, |progress| {
        scene.clearance(names, options, progress)
    })?;
    let text = match is_json {
        true => output::json(&found)?,
        false => clearance_table(&found).into_bytes(),
    };
    Ok((text, found.is_limited))
}

fn wall_table(found: &Wall) -> String {
    let thickness = match found.thickness {
        Some(thickness) => interval(thickness),
        None if found.is_absent => "no wall".to_owned(),
        None => "no wall was found".to_owned(),
    };
    let mut text = format!("thinnest wall     {thickness}\n");
    for point in found.at.into_iter().flatten() {
        text += &format!("end of the wall   {point:?}\n");
    }
    if found.undecided > 0 {
        let boxes = if found.undecided == 1 { "box" } else { "boxes" };
        text += &format!(
            "not decided       walls from {} small {boxes} may be thinner\n",
            found.undecided
        );
    }
    text
}

fn clearance_table(found: &Clearance) -> String {
    let collides = match found.collides {
        Some(true) => "yes",
        Some(false) => "no",
        None => "not decided",
    };
    let mut text = format!("clearance         {}\n", interval(found.distance));
    text += &format!("collision         {collides}\n");
    for point in found.nearest.into_iter().flatten() {
        text += &format!("nearest point     {point:?}\n");
    }
    text
}

fn table(found: &Measurements) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let mut row = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<18}{value}");
    };
    row("volume", interval(found.volume));
    for (name, values) in [
        ("center of mass", found.center_of_mass),
        ("lowest", found.lowest),
        ("highest", found.highest),
    ] {
        for (axis, value) in ["x", "y", "z"].into_iter().zip(values.into_iter().flatten()) {
            row(&format!("{name} {axis}"), interval(value));
        }
    }
    let axes = ["xx", "yy", "zz", "xy", "xz", "yz"];
    for (axes, value) in axes.into_iter().zip(found.inertia.into_iter().flatten()) {
        row(&format!("inertia {axes}"), interval(value));
    }
    row("area", format!("about {} (an estimate, not proven)", estimate(found.area_estimate)));
    if found.lowest.is_none() {
        row("inside", "not proven to exist".to_owned());
    }
    text
}

/// Returns an interval in decimal numbers, rounded outwards to two digits of its width.
fn interval([lo, hi]: Proven) -> String {
    let size = lo.abs().max(hi.abs());
    // A number has no more than 16 digits.
    let decimals = (1.0 - (hi - lo).log10().floor()).min(15.0 - size.log10().floor());
    let decimals = decimals.clamp(0.0, MAX_DECIMALS) as i32;
    let scale = 10f64.powi(decimals);
    // A division by the scale would round: not all powers of ten are exact.
    let unscaled = |x: f64| format!("{x}e-{decimals}").parse::<f64>();
    let below = unscaled((lo * scale).floor()).map_or(lo, |below| below.min(lo));
    let above = unscaled((hi * scale).ceil()).map_or(hi, |above| above.max(hi));
    format!("{} .. {}", decimal(below), decimal(above))
}

/// Returns a number of which no more than five digits are known.
fn estimate(value: f64) -> String {
    decimal(format!("{value:.4e}").parse().unwrap_or(value))
}

/// Returns a number in decimal digits, with an exponent if it is tiny.
fn decimal(value: f64) -> String {
    let is_tiny = value != 0.0 && value.abs() < 1e-4;
    if is_tiny { format!("{value:e}") } else { format!("{value}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_rounded_outwards() {
        assert_eq!(interval([4.188_512_3, 4.189_123_4]), "4.18851 .. 4.18913");
        assert_eq!(interval([-0.000_123_4, 0.000_567_8]), "-0.00013 .. 0.00057");
        assert_eq!(interval([1234.56, 1300.0]), "1234 .. 1300");
        assert_eq!(interval([0.0, f64::INFINITY]), "0 .. inf");
    }

    #[test]
    fn small_intervals_keep_their_digits() {
        assert_eq!(interval([4.187_35e-9, 4.190_15e-9]), "4.1873e-9 .. 4.1902e-9");
        assert_eq!(interval([1.674_45e-15, 1.675_55e-15]), "1.6744e-15 .. 1.6756e-15");
        assert_eq!(interval([0.0, 0.0]), "0 .. 0");
        assert_eq!(interval([1.0, 1.0]), "1 .. 1");
    }

    #[test]
    fn estimates_have_five_digits() {
        assert_eq!(estimate(1.256_637e-5), "1.2566e-5");
        assert_eq!(estimate(12.566_37), "12.566");
        assert_eq!(estimate(123_456.7), "123460");
        assert_eq!(estimate(0.0), "0");
    }
}
