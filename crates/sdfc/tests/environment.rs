//! Pictures of the surroundings light scenes, on the CPU and on the GPU.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{
    Backend, Code, Compiler, Emit, NoFiles, PictureOptions, Resolver, Scene, ShaderOptions, Stage,
    Target, no_progress,
};
use sdfc_render::testing;

type Vector = [f64; 3];

/// Width and height of the pictures that are drawn.
const SIZE: [u32; 2] = [33, 33];
const CAMERA: &str = "camera(eye: [0, 0, 6], fov: 24deg)\nambient_occlusion(strength: 0)\n\
                      exposure(tone: \"clip\")\nantialias(1)\n";

/// Pictures of 128 by 64 pixels, by name.
struct Pictures;

impl Pictures {
    fn light(name: &str, to: Vector) -> Option<Vector> {
        let spot =
            |axis: usize, sign: f64| if sign * to[axis] > 0.8 { [4.0; 3] } else { [0.125; 3] };
        Some(match name {
            "even.hdr" => [0.5, 0.25, 0.75],
            "right.hdr" => spot(0, 1.0),
            "left.hdr" => spot(0, -1.0),
            "above.hdr" => spot(1, 1.0),
            "below.hdr" => spot(1, -1.0),
            "front.hdr" => spot(2, 1.0),
            "stripes.hdr" => [0.5 + 0.25 * (9.0 * to[0]).sin(), 0.25 + 0.125 * to[1], 0.5],
            _ => return None,
        })
    }
}

impl Resolver for Pictures {
    fn read(&self, path: &str) -> Result<String, String> {
        NoFiles.read(path)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let mut bytes = b"#?RADIANCE\n\n-Y 64 +X 128\n".to_vec();
        for pixel in 0..64 * 128 {
            let angle = |at: usize, count: f64| std::f64::consts::PI * ((at as f64 + 0.5) / count);
            let (from_above, longitude) = (angle(pixel / 128, 64.0), angle(pixel % 128, 64.0));
            let (radius, y) = from_above.sin_cos();
            let to = [-radius * longitude.sin(), y, radius * longitude.cos()];
            let light = Self::light(path, to).ok_or("no such file")?;
            // The exponent of light from 2 to 4.
            let [red, green, blue] = light.map(|lane| (lane * 32.0).round().min(255.0) as u8);
            bytes.extend([red, green, blue, 131]);
        }
        Ok(bytes)
    }
}

fn scene(text: &str) -> Scene {
    let text = format!("{text}\n{CAMERA}");
    let scene = Compiler::new().resolver(&Pictures).compile("a.sdf", &text);
    scene.unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

/// The linear colours of a picture, row by row.
fn colors(text: &str) -> Vec<[f32; 3]> {
    let options = PictureOptions::new().size(SIZE).backend(Backend::Cpu).hdr(true);
    let picture = scene(text).render(&options, &mut no_progress).unwrap();
    let color = |color: [f32; 4]| [color[0], color[1], color[2]];
    picture.image.pixels().iter().map(|pixel| color(pixel.color)).collect()
}

/// The brightness of a pixel of a picture, from the lower left.
fn at(colors: &[[f32; 3]], [x, y]: [usize; 2]) -> f32 {
    colors[(SIZE[1] as usize - 1 - y) * SIZE[0] as usize + x][0]
}

const BALLS: [&str; 6] = [
    "sphere(1)",
    "sphere(1).color(#c08040)",
    "sphere(1).color(#fff).metallic(1).roughness(0.1)",
    "sphere(1).color(#fa5).metallic(1).roughness(0.45)",
    "sphere(1).color(#fff).metallic(1).roughness(1)",
    "sphere(1).color(#237).metallic(0.5).roughness(0.7).emission(#111)",
];

#[test]
fn even_surroundings_are_ambient_light() {
    const LIGHT: &str = "linear_rgb(0.5, 0.25, 0.75)";
    for ball in BALLS {
        let picture = colors(&format!("{ball}\nsky(image: \"even.hdr\")"));
        let ambient = format!("ambient({LIGHT}, 1)\nbackground({LIGHT})\nsun(strength: 0)");
        let expected = colors(&format!("{ball}\n{ambient}"));
        // Reflected rays bring a part of the same light.
        let mirrored = colors(&format!("{ball}\nsky(image: \"even.hdr\")\nreflections()"));
        for ((found, mirrored), expected) in picture.iter().zip(&mirrored).zip(expected) {
            let near = |found: &[f32; 3], most: f32| {
                (0..3).all(|lane| (found[lane] - expected[lane]).abs() < most)
            };
            assert!(near(found, 2e-3), "{ball}: {found:?} {expected:?}");
            // A surface without a material is polished only if there are reflections.
            let is_bare = ball == BALLS[0];
            assert!(is_bare || near(mirrored, 2e-3), "{ball}: {mirrored:?} {expected:?}");
        }
    }
}

#[test]
fn a_white_mirror_loses_no_more_light_than_its_facets_catch() {
    for step in 1..=10 {
        let roughness = f64::from(step) / 10.0;
        let ball = format!("sphere(1).color(#fff).metallic(1).roughness({roughness})");
        let colors = colors(&format!("{ball}\nsky(image: \"even.hdr\")"));
        // Karis' fit for white at any angle: 1 - 0.55 roughness.
        let least = 0.5 * (1.0 - 0.55 * roughness) as f32;
        assert!(colors.iter().all(|it| it[0] > least - 4e-3 && it[0] < 0.5 + 4e-3), "{roughness}");
    }
}

#[test]
fn surfaces_are_lit_from_where_the_picture_is_bright() {
    let [left, right, low, high] = [[9, 16], [23, 16], [16, 9], [16, 23]];
    for material in ["", ".color(#888).roughness(0.4)", ".color(#ccc).metallic(1).roughness(0.6)"] {
        let lit = |sky: &str| colors(&format!("sphere(1){material}\nsky({sky})"));
        let check = |sky: &str, bright: [usize; 2], dark: [usize; 2]| {
            let colors = lit(sky);
            let (bright, dark) = (at(&colors, bright), at(&colors, dark));
            assert!(bright > 1.5 * dark, "{material} {sky}: {bright} {dark}");
        };
        check("image: \"right.hdr\"", right, left);
        check("image: \"left.hdr\"", left, right);
        check("image: \"above.hdr\"", high, low);
        check("image: \"below.hdr\"", low, high);
        check("image: \"front.hdr\"", [16, 16], [4, 16]);
        // What was in front is turned to the right.
        check("image: \"front.hdr\", turn: 90deg", right, left);
        check("image: \"left.hdr\", turn: 180deg", right, left);
    }
}

#[test]
fn the_background_is_the_picture() {
    let colors = colors("sphere(0.01)\nsky(image: \"front.hdr\", turn: 180deg, strength: 0.5)");
    assert!((at(&colors, [3, 3]) - 2.0).abs() < 0.01, "{}", at(&colors, [3, 3]));
}

#[test]
fn fog_without_a_colour_hides_surfaces_in_the_picture() {
    let sky = "sky(image: \"stripes.hdr\")\nfog(density: 9)";
    let [with, without] = ["sphere(1)", "sphere(0.001)"].map(|it| colors(&format!("{it}\n{sky}")));
    for (a, b) in with.iter().zip(without) {
        assert!((0..3).all(|lane| (a[lane] - b[lane]).abs() < 1e-4), "{a:?} {b:?}");
    }
}

#[test]
fn the_gpu_draws_the_same_picture_as_the_cpu() {
    if testing::without_gpu() {
        return;
    }
    let floor = "plane(y: -1).color(#777).roughness(0.3)";
    for ball in BALLS {
        for (sky, rest) in [
            ("image: \"stripes.hdr\"", ""),
            ("image: \"right.hdr\", turn: 20deg, strength: 0.3", "reflections(count: 2)\nfog()"),
            ("image: \"stripes.hdr\"", "ambient(#fff, 0.3)\nsun(shadow: hard)"),
        ] {
            let text = format!("{ball}\n{floor}\nsky({sky})\n{rest}");
            let [gpu, cpu] = [Backend::Gpu, Backend::Cpu].map(|backend| {
                let options = PictureOptions::new().size([64, 48]).backend(backend);
                scene(&text).render(&options, &mut no_progress).unwrap().image.to_srgb8()
            });
            let off: Vec<u8> = gpu.iter().zip(&cpu).map(|(a, b)| a.abs_diff(*b)).collect();
            let far = off.iter().filter(|&&it| it > 1).count();
            // A ray that grazes an edge may hit on one side only.
            assert!(far <= off.len() / 200, "{text}: {far} channels, {:?}", off.iter().max());
        }
    }
}

#[test]
fn only_pictures_have_the_list_of_texels() {
    let scene = scene("sphere(1).color(#f00)\nsky(image: \"even.hdr\")");
    let write = |emit, target| {
        let stage = if target == Target::Wgsl { Stage::Compute } else { Stage::Fragment };
        let options = ShaderOptions::new().emit(emit).target(target).stage(stage);
        scene.write_shader(&options)
    };
    for emit in [Emit::Field, Emit::March] {
        let written = write(emit, Target::Wgsl).unwrap();
        let Code::Text(text) = written.code else { panic!("WGSL is text") };
        assert!(written.reflection.lists.is_empty() && !text.contains("radiance"));
    }
    let picture = write(Emit::Render, Target::Wgsl).unwrap();
    assert!(picture.reflection.lists.len() > 10_000);
    for target in [Target::GlslEs, Target::Shadertoy] {
        let error = write(Emit::Render, target).err().unwrap().to_string();
        assert!(error.contains("storage buffers") && error.contains("sky()"), "{error}");
    }
}

/// The files of `docs/look`.
struct Folder;

impl Resolver for Folder {
    fn read(&self, path: &str) -> Result<String, String> {
        NoFiles.read(path)
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let folder = sdfc_test_support::repository().join("docs/look");
        std::fs::read(folder.join(path)).map_err(|error| error.to_string())
    }
}

#[test]
fn the_studio_is_formatted_and_drawn() {
    let path = sdfc_test_support::repository().join("docs/look/studio.sdf");
    let text = std::fs::read_to_string(path).unwrap().replace("\r\n", "\n");
    let formatted = sdfc::format("studio.sdf", &text).map_err(|errors| errors.to_string());
    assert!(formatted.as_deref() == Ok(&*text), "run `sdfc fmt docs/look/studio.sdf`");
    let scene = Compiler::new().resolver(&Folder).compile("studio.sdf", &text);
    let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
    assert!(scene.diagnostics().is_empty());
    let options = PictureOptions::new().size([80, 40]).samples(1).backend(Backend::Cpu);
    let picture = scene.render(&options, &mut no_progress).unwrap().image.to_srgb8();
    let count = |range: std::ops::RangeInclusive<u8>| {
        picture.chunks(3).filter(|it| it.iter().all(|lane| range.contains(lane))).count()
    };
    // The lights in the ball, and what no light reaches.
    assert!(count(245..=255) > 10 && count(0..=40) > 10, "{} {}", count(245..=255), count(0..=40));
}

#[test]
fn literals_of_the_sky_are_live() {
    let live = |text: &str| {
        let compiler = Compiler::new().resolver(&Pictures).live_literals(None);
        compiler.compile("a.sdf", text).unwrap_or_else(|errors| panic!("{errors}"))
    };
    let [a, b] = ["30deg, strength: 1", "50deg, strength: 2"].map(|turn| {
        let scene = live(&format!("sphere(1)\nsky(image: \"stripes.hdr\", turn: {turn})"));
        assert_eq!(scene.live_literals().len(), 3);
        let written = scene.write_shader(&ShaderOptions::new().emit(Emit::Render)).unwrap();
        let Code::Text(text) = written.code else { panic!("WGSL is text") };
        let lines: Vec<String> = text.lines().skip(1).map(str::to_owned).collect();
        (lines, written.reflection.lists)
    });
    assert!(a == b, "only params differ");
}
