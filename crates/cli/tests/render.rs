//! Tests `sdfc render` and its options on the CPU.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeSet;

use common::{folder, names, run, run_in, said};
use exr::prelude::traits::*;
use tempfile::TempDir;

const WITH_PARAMS: &str = "param r = 0.5 in 0.1..1\nparam tilt = 0deg in 0deg..90deg\nparam paint = #ff0000\n\
                     box([3 * r, r, r]).rotate(z: tilt).translate(x: sin(time))\n  .color(paint)\n\
                     camera(eye: [0, 0, 5], target: [0, 0, 0], fov: 45deg)\nambient(strength: 1)\n";

fn with_params() -> TempDir {
    folder(&[("params.sdf", WITH_PARAMS)])
}

/// Returns the pixels of a PNG file. Files of equal pictures differ in how they were drawn.
fn pixels(file: &[u8]) -> Vec<u8> {
    image::load_from_memory(file).unwrap().to_rgb8().into_raw()
}

/// Returns the pixels of the picture with these options, 24 by 16.
fn drawn(folder: &TempDir, options: &str) -> Vec<u8> {
    let args = format!("render params.sdf --backend cpu --size 24x16 -o out.png {options}");
    let output = run(folder, &args);
    assert_eq!(output.status.code(), Some(0), "{options}: {}", said(&output));
    pixels(&std::fs::read(folder.path().join("out.png")).unwrap())
}

fn refused(folder: &TempDir, options: &str, part: &str) {
    let args = format!("render params.sdf --backend cpu --size 24x16 {options}");
    let output = run(folder, &args);
    assert_eq!(output.status.code(), Some(2), "{options}: {}", said(&output));
    assert!(said(&output).contains(part), "{options}: {}", said(&output));
}

#[test]
fn params_and_time_move_the_picture() {
    let folder = with_params();
    let plain = drawn(&folder, "");
    for options in ["--set r=0.9", "--set tilt=45deg", "--set paint=#00f", "--time 1"] {
        assert_ne!(drawn(&folder, options), plain, "{options}");
    }
    assert_eq!(drawn(&folder, "--set r=0.9 --set r=0.5 --set tilt=0 --time 0"), plain);
}

#[test]
fn a_param_that_decides_what_is_built_is_set_like_any_other() {
    let scene = "param n: int = 2 in 1..9\nparam r = 0.3\n\
                 union(for i in 0..n: sphere(r).translate(x: i))\ncamera(eye: [0, 0, 9])\n";
    let folder = folder(&[("params.sdf", scene)]);
    let plain = drawn(&folder, "");
    assert_ne!(drawn(&folder, "--set n=4"), plain);
    assert_ne!(drawn(&folder, "--set n=4 --set r=0.5"), drawn(&folder, "--set n=4"));
    assert_eq!(drawn(&folder, "--set n=2 --set r=0.3"), plain);
    refused(&folder, "--set n=10", "the param `n` takes 1..9; 10 is outside");
    let explained = run(&folder, "explain params.sdf --set n=4");
    let text = String::from_utf8_lossy(&explained.stdout).into_owned();
    assert!(text.contains("n: decides what the scene consists of"), "{text}");
}

#[test]
fn params_of_imported_files_of_the_same_name_are_set_one_by_one() {
    let storey = "param width = 1 in 0.5..3\nfn storey() = box(width)\n";
    let scene = "import storey from \"house/storey.sdf\"\nimport storey as tower from \
                 \"tower/storey.sdf\"\nstorey()\ntower().translate(x: 4)\ncamera(eye: [0, 0, 9])\n";
    let files = [("params.sdf", scene), ("house/storey.sdf", storey), ("tower/storey.sdf", storey)];
    let folder = folder(&files);
    let [plain, house, tower] =
        ["", "--set house/storey.width=2", "--set tower/storey.width=2"].map(|o| drawn(&folder, o));
    assert!(plain != house && plain != tower && house != tower);
    let both = "write `house/storey.width` or `tower/storey.width`";
    refused(&folder, "--set storey.width=2", both);
    refused(&folder, "--set tower/storey.widht=2", "did you mean `tower/storey.width`?");
}

#[test]
fn shared_modules_are_imported_from_the_folders_of_sdfc_path() {
    let scene = "import bolt from \"screws/bolt.sdf\"\nbolt()\ncamera(eye: [0, 0, 9])\n";
    let bolt = "import pitch from \"pitch.sdf\"\nsolid bolt() = length(p) - pitch\n";
    let folder = folder(&[
        ("scene.sdf", scene),
        ("shared/screws/bolt.sdf", bolt),
        ("shared/screws/pitch.sdf", "let pitch = 0.5\n"),
    ]);
    let args = "render scene.sdf --backend cpu --size 24x16 -o out.png";
    assert!(said(&run(&folder, args)).contains("E0209"));
    let shared = folder.path().join("shared");
    // A folder that does not exist is skipped.
    let listed = std::env::join_paths([&folder.path().join("none"), &shared]).unwrap();
    let variables = [("SDFC_PATH", listed.to_str().unwrap())];
    let with_modules = || run_in(folder.path(), args, b"", &variables);
    let output = with_modules();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    // A message names the file where it is.
    let wrong = shared.join("screws/pitch.sdf");
    std::fs::write(&wrong, "let pitch = 0.5 +\n").unwrap();
    let output = with_modules();
    assert!(said(&output).contains(&format!("{}:1:", wrong.display())), "{}", said(&output));
    // A file in the folder of the scene comes first.
    std::fs::create_dir(folder.path().join("screws")).unwrap();
    std::fs::write(folder.path().join("screws/pitch.sdf"), "let pitch = 0.7\n").unwrap();
    let output = with_modules();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

#[test]
fn wrong_values_are_refused_by_name() {
    let folder = with_params();
    refused(&folder, "--set q=1", "it has r, tilt, paint");
    refused(&folder, "--set r=2", "the param `r` takes 0.1..1; 2 is outside");
    refused(&folder, "--set tilt=45", "an angle with its unit");
    refused(&folder, "--set tilt=100deg", "0deg..90deg");
    refused(&folder, "--set paint=red", "a colour");
    refused(&folder, "--set r", "NAME=VALUE");
    refused(&folder, "--time inf", "a number of seconds");
    refused(&folder, "--time 1 --frames 0..2", "cannot be used with");
    refused(&folder, "--frames 2..2", "contains no frame");
    refused(&folder, "--frames 0..2 -o -", "cannot be written to stdout");
    refused(&folder, "--frames 0..2 --stats a.json", "cannot be used with");
    refused(&folder, "--frames 0..2 --fps 100 -o a.gif", "50 frames per second");
    refused(&folder, "--samples 0", "--samples");
    refused(&folder, "-o out.jpg", ".png");
    assert_eq!(names(folder.path()), ["params.sdf"]);
}

#[test]
fn a_sequence_cut_into_ranges_gives_the_same_files() {
    let (whole, cut) = (with_params(), with_params());
    let draw = |folder: &TempDir, frames: &str| {
        let args = "render params.sdf --backend cpu --size 24x16 -o f.png --fps 2 --frames";
        let output = run(folder, &format!("{args} {frames}"));
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        assert!(said(&output).contains("f.000"), "it says where the pictures are");
    };
    draw(&whole, "0..4");
    draw(&cut, "2..4");
    assert_eq!(names(cut.path()), ["f.0002.png", "f.0003.png", "params.sdf"]);
    draw(&cut, "0..2");
    assert_eq!(names(whole.path()), names(cut.path()));
    let read = |folder: &TempDir, n: u32| {
        std::fs::read(folder.path().join(format!("f.{n:04}.png"))).unwrap()
    };
    for number in 0..4 {
        assert_eq!(read(&whole, number), read(&cut, number), "{number}");
    }
    // At 2 frames per second frame 2 is at second 1.
    assert_eq!(pixels(&read(&whole, 2)), drawn(&whole, "--time 1"));
    assert_ne!(read(&whole, 2), read(&whole, 3));
}

#[test]
fn an_animation_is_one_file() {
    let folder = with_params();
    let args = "render params.sdf --backend cpu --size 24x16 -o f.gif --frames 0..3";
    let output = run(&folder, args);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(names(folder.path()), ["f.gif", "params.sdf"]);
    let gif = std::fs::read(folder.path().join("f.gif")).unwrap();
    // The signature and the size, one graphic control extension per frame, and the trailer.
    assert_eq!(
        (&gif[..6], &gif[6..10], gif.last()),
        (&b"GIF89a"[..], &[24, 0, 16, 0][..], Some(&0x3b))
    );
    assert_eq!(gif.windows(3).filter(|bytes| *bytes == [0x21, 0xf9, 4]).count(), 3);
}

/// Slanted bars of one shade before black: a pixel with one ray has one of two values, a pixel with
/// nine rays any ninth between them.
#[test]
fn more_samples_soften_edges() {
    let bars = "union([for i in 0..8: box([0.3, 6, 0.001]).translate(x: i * 0.6 - 2.1)]).rotate(z: 20deg)\n\
                camera(eye: [0, 0, 5], target: 0, fov: 45deg)\nsun(direction: [0, 0, 1])\n";
    let folder = folder(&[("params.sdf", bars)]);
    let shades = |options: &str| {
        drawn(&folder, options).as_chunks::<3>().0.iter().copied().collect::<BTreeSet<_>>()
    };
    let (one, many) = (shades(""), shades("--samples 9"));
    assert_eq!(one.len(), 2, "{one:?}");
    assert!(many.len() >= 9 && many.is_superset(&one), "{many:?}");
    assert!(many.iter().all(|shade| one.first() <= Some(shade) && Some(shade) <= one.last()));
    assert_eq!(drawn(&folder, "--samples 1"), drawn(&folder, ""));
    assert_eq!(drawn(&folder, "--samples 9"), drawn(&folder, "--samples 9"));
}

/// Returns the name and the samples of the first channel of an EXR.
fn channel(folder: &TempDir, name: &str) -> (String, Vec<f32>) {
    let read = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let layer = read.first_valid_layer().all_attributes();
    let image = layer.from_file(folder.path().join(name)).unwrap();
    let channel = &image.layer_data.channel_data.list[0];
    (channel.name.to_string(), channel.sample_data.values_as_f32().collect())
}

#[test]
fn depths_are_along_the_ray() {
    // A wall 0.5 deep at the origin, seen from a distance of 5: its face is 4.75 away.
    let scene = "box([9, 9, 0.5])\ncamera(eye: [0, 0, 5], target: [0, 0, 0], fov: 90deg)\n";
    let folder = folder(&[("wall.sdf", scene)]);
    let args = "render wall.sdf --backend cpu --size 3x3 --samples 1 -o w.exr --depth z.exr";
    let output = run(&folder, args);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let (name, depths) = channel(&folder, "z.exr");
    assert_eq!((name.as_str(), depths.len()), ("Z", 9));
    assert!((depths[4] - 4.75).abs() < 1e-3, "{depths:?}");
    // The centre of the next pixel is 2/3 to the side of the axis at distance 1.
    let slant = 4.75 * (1.0f32 + 4.0 / 9.0).sqrt();
    assert!((depths[3] - slant).abs() < 1e-2, "{depths:?} {slant}");
    let (name, blue) = channel(&folder, "w.exr");
    assert_eq!((name.as_str(), blue.len()), ("B", 9));
    assert!(blue[4] > 0.0);
}

#[test]
fn depths_of_a_sequence_are_numbered() {
    let folder = with_params();
    let args = "render params.sdf --backend cpu --size 8x8 -o f.gif --depth z.exr --frames 1..3";
    let output = run(&folder, args);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(names(folder.path()), ["f.gif", "params.sdf", "z.0001.exr", "z.0002.exr"]);
    assert!(channel(&folder, "z.0001.exr").1.contains(&f32::INFINITY));
    refused(&folder, "--depth z.png", "depths are written as EXR");
    refused(&folder, "-o z.exr --depth z.exr", "two outputs");
}

#[test]
fn live_literals_can_be_set_on_request() {
    let folder = with_params();
    let plain = drawn(&folder, "");
    assert_eq!(drawn(&folder, "--live-literals"), plain);

    refused(&folder, "--set at_6_20=9", "no param `at_6_20`");
    assert_ne!(
        drawn(&folder, "--live-literals --set at_6_20=9"),
        plain,
        "the camera is further away"
    );
}

/// The CPU uses `auto` for a scene that states another method, but refuses that method as an
/// option.
#[test]
fn without_a_gpu_auto_replaces_methods_that_the_cpu_lacks() {
    let folder = folder(&[("a.sdf", "sphere(0.8)\nmarch(method: \"segment\")\n")]);
    // With these variables Vulkan loaders find no driver. Elsewhere a GPU may exist, which has the
    // method.
    let hidden = [("VK_DRIVER_FILES", "/nowhere"), ("VK_ICD_FILENAMES", "/nowhere")];
    let output = run_in(folder.path(), "render a.sdf -o a.png --size 24x16", b"", &hidden);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    if cfg!(target_os = "linux") {
        assert!(
            said(&output).contains("has no method `segment`, `auto` is used instead"),
            "{}",
            said(&output)
        );
        let required = "render a.sdf -o b.png --size 24x16 --backend gpu";
        let output = run_in(folder.path(), required, b"", &hidden);
        assert_eq!(output.status.code(), Some(3), "{}", said(&output));
        let expected = "error: this machine has no Vulkan, Metal or DX12 adapter; install a Vulkan \
                        driver, such as the package `mesa-vulkan-drivers` of Debian, Ubuntu and \
                        Fedora\n";
        assert_eq!(said(&output), expected);
    }
    let both = run(&folder, "render a.sdf -o b.png --size 24x16 --backend cpu --march segment");
    assert_eq!(both.status.code(), Some(2), "{}", said(&both));
    assert!(said(&both).contains("it has `auto`, `sphere`, `interval`"), "{}", said(&both));
    assert_eq!(names(folder.path()), ["a.png", "a.sdf"]);
}
