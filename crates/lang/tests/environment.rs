//! Pictures of the surroundings: the scene of `docs/look/studio.sdf`, and what is reported about
//! pictures that cannot be used.
//!
//! `STUDIO_UPDATE=1 cargo test -p sdfc-lang --test environment` writes `docs/look/studio.hdr`.

use std::path::PathBuf;
use std::time::Instant;

use sdfc_diagnostics::{Diagnostic, Sources};
use sdfc_graph::Scene;
use sdfc_lang::environment::{Surroundings, analyze, irradiance_at};
use sdfc_lang::{Resolver, front_with_imports};

type Vector = [f64; 3];

/// Columns and rows of the picture of the studio.
const SIZE: [usize; 2] = [512, 256];

/// A light behind a white sheet: the direction of its middle, half its width and height at distance
/// 1, and its light.
struct SoftBox {
    towards: Vector,
    half: [f64; 2],
    light: Vector,
}

const SOFT_BOXES: [SoftBox; 4] = [
    SoftBox { towards: [-0.75, 0.55, 0.6], half: [0.55, 0.4], light: [9.0, 8.4, 7.4] },
    SoftBox { towards: [0.95, 0.25, 0.15], half: [0.14, 0.75], light: [4.6, 5.4, 6.4] },
    SoftBox { towards: [0.1, 1.0, -0.1], half: [0.7, 0.35], light: [3.4, 3.4, 3.4] },
    SoftBox { towards: [-0.6, 0.3, -0.8], half: [0.1, 0.5], light: [5.0, 4.6, 4.2] },
];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normalized(a: Vector) -> Vector {
    a.map(|lane| lane / dot(a, a).sqrt())
}

fn cross(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|lane| {
        let (next, last) = ((lane + 1) % 3, (lane + 2) % 3);
        a[next] * b[last] - a[last] * b[next]
    })
}

/// The light of the studio in a direction: soft boxes in a dark room with a paler backdrop. All
/// but these depends on the height alone, so that rows compress well.
fn studio(direction: Vector) -> Vector {
    let height = direction[1];
    let wall = 0.1 + 0.24 * (-(height - 0.05).powi(2) / 0.08).exp();
    let floor = 0.16 + 0.1 * (1.0 + height).max(0.0);
    let edge = ((height + 0.12) / 0.1).clamp(0.0, 1.0);
    let room = floor + edge * edge * (3.0 - 2.0 * edge) * (wall - floor);
    let mut light = [0.96 * room, room, 1.06 * room];
    for SoftBox { towards, half, light: own } in &SOFT_BOXES {
        let middle = normalized(*towards);
        let nearness = dot(direction, middle);
        if nearness <= 0.0 {
            continue;
        }
        let side = if middle[1].abs() > 0.9 { [0.0, 0.0, -1.0] } else { [0.0, 1.0, 0.0] };
        let right = normalized(cross(middle, side));
        let up = cross(right, middle);
        let inside = |axis: Vector, half: f64| {
            let at = (half - (dot(direction, axis) / nearness).abs()) / 0.03;
            at.clamp(0.0, 1.0)
        };
        let mask = inside(right, half[0]) * inside(up, half[1]);
        light = [0, 1, 2].map(|lane| light[lane] + mask * (own[lane] - light[lane]));
    }
    light
}

/// The bytes of a pixel: mantissas and a shared exponent.
fn rgbe(light: Vector) -> [u8; 4] {
    let most = light.into_iter().fold(0.0, f64::max);
    if most < 1e-9 {
        return [0; 4];
    }
    let exponent = most.log2().floor() + 1.0;
    let [red, green, blue] =
        light.map(|lane| (lane / exponent.exp2() * 256.0).round().clamp(0.0, 255.0) as u8);
    [red, green, blue, (exponent + 128.0) as u8]
}

/// A Radiance picture, each component of a row compressed by itself.
fn picture([width, height]: [usize; 2], light: impl Fn(Vector) -> Vector) -> Vec<u8> {
    let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    let mut bytes = head.into_bytes();
    for row in 0..height {
        let latitude = std::f64::consts::PI * (0.5 - (row as f64 + 0.5) / height as f64);
        let pixel = |column: usize| {
            let longitude = std::f64::consts::TAU * ((column as f64 + 0.5) / width as f64 - 0.5);
            let (sine, cosine) = longitude.sin_cos();
            let level = latitude.cos();
            rgbe(light([level * sine, latitude.sin(), -level * cosine]))
        };
        let pixels: Vec<[u8; 4]> = (0..width).map(pixel).collect();
        bytes.extend([2, 2, (width >> 8) as u8, (width & 255) as u8]);
        for component in 0..4 {
            let values: Vec<u8> = pixels.iter().map(|pixel| pixel[component]).collect();
            compress(&values, &mut bytes);
        }
    }
    bytes
}

/// Adds runs of at least 3 equal bytes, and plain bytes between them.
fn compress(mut values: &[u8], bytes: &mut Vec<u8>) {
    let run = |values: &[u8]| values.iter().take(127).take_while(|&&it| it == values[0]).count();
    while !values.is_empty() {
        let same = run(values);
        if same > 2 {
            bytes.extend([128 + same as u8, values[0]]);
            values = &values[same..];
            continue;
        }
        let plain = (1..values.len().min(128)).find(|&at| run(&values[at..]) > 2);
        let (plain, rest) = values.split_at(plain.unwrap_or(values.len().min(128)));
        bytes.push(plain.len() as u8);
        bytes.extend(plain);
        values = rest;
    }
}

/// A resolver with one file.
struct OneFile(&'static str, Vec<u8>);

impl Resolver for OneFile {
    fn read(&self, _: &str) -> Result<String, String> {
        Err("no such file".to_owned())
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        if path == self.0 { Ok(self.1.clone()) } else { Err("no such file".to_owned()) }
    }
}

fn compiled(text: &str, files: &OneFile) -> (Option<Scene>, Vec<Diagnostic>) {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    let (elaborated, found) = front_with_imports(&mut sources, file, files);
    (elaborated.map(|elaborated| elaborated.scene), found)
}

fn messages(text: &str, files: &OneFile) -> String {
    let found = compiled(text, files).1;
    let message = |it: &Diagnostic| format!("{}: {}\n", it.code.0, it.message);
    found.iter().map(message).collect()
}

fn lit_from_above() -> OneFile {
    let light = |[_, y, _]: Vector| if y > 0.0 { [2.0; 3] } else { [0.25; 3] };
    OneFile("sky.hdr", picture([64, 32], light))
}

#[test]
fn the_picture_of_the_studio_is_what_this_test_writes() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/look/studio.hdr");
    let written = picture(SIZE, studio);
    if std::env::var_os("STUDIO_UPDATE").is_some() {
        std::fs::write(&path, &written).expect("the folder is there");
    }
    assert!(written.len() <= 100 << 10, "{} bytes", written.len());
    let [found, expected] = [std::fs::read(&path).expect("it is there"), written]
        .map(|bytes| analyze(&bytes).expect("it is a picture"));
    // The mathematical functions of platforms differ in the last bit.
    for (found, expected) in found.irradiance.iter().zip(expected.irradiance) {
        assert!((0..3).all(|lane| (found[lane] - expected[lane]).abs() < 1e-3));
    }
}

#[test]
fn light_comes_from_the_side_where_the_picture_is_bright() {
    let sides = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let sides: Vec<Vector> =
        sides.into_iter().flat_map(|side| [side, side.map(|lane: f64| -lane)]).collect();
    for &lit in &sides {
        let spot = |to: Vector| if dot(to, lit) > 0.8 { [5.0; 3] } else { [0.1; 3] };
        let Surroundings { levels, irradiance } =
            analyze(&picture([128, 64], spot)).expect("it is a picture");
        for &side in &sides {
            let to = side.map(|lane| lane as f32);
            let (is_lit, is_opposite) = (side == lit, dot(side, lit) < -0.5);
            assert_eq!(levels[0].light(to)[0] > 4.5, is_lit, "{lit:?} {side:?}");
            assert_eq!(levels[2].light(to)[0] > 4.0, is_lit, "{lit:?} {side:?}");
            let [received, most] = [side, lit]
                .map(|normal| irradiance_at(&irradiance, normal.map(|lane| lane as f32))[0]);
            assert!(is_lit || received < 0.6 * most, "{lit:?} {side:?}");
            assert!(!is_opposite || received < 0.2 * most, "{lit:?} {side:?}");
        }
    }
}

#[test]
fn a_picture_takes_the_place_of_the_light_of_the_look() {
    let files = lit_from_above();
    let (scene, found) = compiled("sphere(1)\nsky(image: \"sky.hdr\")\n", &files);
    assert!(found.is_empty(), "{found:?}");
    let settings = scene.expect("it compiles").settings;
    assert!(settings.environment.is_some() && settings.sky.is_none());
    assert!(settings.lights.is_empty() && settings.ambient.is_none());
    assert!(settings.occlusion.is_some() && settings.exposure.is_some());
    assert_eq!(settings.samples, Some(4));
    assert!(!settings.has_headlight());

    let text = "sphere(1)\nsky(image: \"sky.hdr\")\nambient(#fff, 0.5)\nsun()\n";
    let settings = compiled(text, &files).0.expect("it compiles").settings;
    let irradiance = settings.environment.map(|environment| environment.irradiance);
    assert!(irradiance == settings.ambient && settings.lights.len() == 1);
    assert!(settings.occlusion.is_none() && settings.exposure.is_none());
}

#[test]
fn turn_and_strength_may_be_params() {
    let text = "param turn = 30deg\nparam strength = 1\nsphere(1)\n\
                sky(image: \"sky.hdr\", turn: turn + time * 1rad, strength: strength)\n";
    let (scene, found) = compiled(text, &lit_from_above());
    assert!(scene.is_some(), "{found:?}");
}

#[test]
fn pictures_that_cannot_be_used_are_errors_with_a_reason() {
    let files = lit_from_above();
    let why = |sky: &str| messages(&format!("sphere(1)\nsky({sky})\n"), &files);
    let missing = why("image: \"other.hdr\"");
    assert!(missing.contains("E0415") && missing.contains("`other.hdr` cannot be read"));
    assert!(why("image: \"../sky.hdr\"").contains("outside the folder of the scene"));
    assert!(why("image: \"\"").contains("E0415"));
    assert!(
        why("image: \"sky.hdr\", zenith: #fff").contains("`zenith` is the colour of a gradient")
    );
    assert!(why("turn: 30deg").contains("`turn` belongs to a picture"));
    assert!(why("strength: 2").contains("`strength` belongs to a picture"));
    assert!(why("image: \"sky.hdr\", strength: -1").contains("E0309"));
    let short = OneFile("sky.hdr", files.1[..200].to_vec());
    let cut_off = messages("sphere(1)\nsky(image: \"sky.hdr\")\n", &short);
    assert!(cut_off.contains("the picture `sky.hdr` ends in the middle of a row"), "{cut_off}");
    let other = OneFile("sky.hdr", b"\x89PNG\r\n\x1a\n and so on".to_vec());
    let not_radiance = messages("sphere(1)\nsky(image: \"sky.hdr\")\n", &other);
    assert!(not_radiance.contains("is not a Radiance picture"), "{not_radiance}");
}

#[test]
fn a_planar_scene_has_no_surroundings() {
    let planar = messages("circle(1)\nsky(image: \"sky.hdr\")\n", &lit_from_above());
    assert!(planar.contains("W0607"), "{planar}");
}

#[test]
fn a_large_picture_is_analyzed_in_a_moment() {
    let bytes = picture([1024, 512], studio);
    let start = Instant::now();
    let found = analyze(&bytes).expect("it is a picture");
    println!("1024x512: {:?}", start.elapsed());
    assert_eq!(found.levels[0].side, 513);
    // The goal is 0.3 s in a release build.
    assert!(start.elapsed().as_secs_f64() < 30.0);
}
