//! GPU, CPU in f32 and CPU in f64 see the same surface: every example of the library, without a list of them
//! here, and every scene under `examples`. At 64x64, depth outside edges within 1e-3, in small scenes within less, and
//! far from the origin within what rounding does to coordinates.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::render::{CpuScene, HIT, Image, View, compare, testing};
use sdfc::{Backend, FrameValues, PictureOptions, Scene, compile, unwatched};

/// Width and height in pixels.
const SIDE: u32 = 64;
/// Largest difference of depth outside edges, in scene units, and in parts of the scene's scale.
const DEPTH: f32 = 1e-3;
const DEPTH_PART: f32 = 1e-4;
/// Eight units in the last place of coordinates, in parts of the scale: what the shader allows itself.
const ROUNDING: f32 = 1e-6;
/// Largest difference of a colour channel outside edges, in steps of 1/255.
const COLOR: u8 = 2;
/// More edges than this share of the pixels, and the comparison says too little.
const EDGES: f64 = 0.5;
const METHOD: &str = "auto";

fn main() {
    let mut trials = Vec::new();
    let without_gpu = testing::without_gpu();
    for (name, text) in library_examples().into_iter().chain(scene_files()) {
        let (again, source) = (name.clone(), text.clone());
        trials.push(Trial::test(format!("cpu/{name}"), move || f32_and_f64(&again, &source)));
        let gpu = format!("gpu/{name}");
        trials.push(
            Trial::test(gpu, move || gpu_and_cpu(&name, &text)).with_ignored_flag(without_gpu),
        );
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn library_examples() -> Vec<(String, String)> {
    let entries = sdfc::lang::library::entries();
    entries
        .into_iter()
        .filter(|entry| !entry.example.is_empty())
        .map(|entry| (format!("std/{} ({})", entry.name, entry.kind), entry.example))
        .collect()
}

fn scene_files() -> Vec<(String, String)> {
    let mut scenes = Vec::new();
    let mut folders = vec![concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples").into()];
    while let Some(folder) = folders.pop() {
        let folder: std::path::PathBuf = folder;
        let entries = std::fs::read_dir(&folder).expect("examples can be listed");
        for path in entries.map(|entry| entry.expect("an entry").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "sdf") {
                let text = std::fs::read_to_string(&path).expect("a scene can be read");
                let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                scenes.push((format!("examples/{stem}"), text));
            }
        }
    }
    scenes.sort();
    scenes
}

fn scene(name: &str, text: &str) -> Result<Scene, Failed> {
    let compiled = compile(name, text);
    let findings = compiled.diagnostics_text(false);
    compiled.scene.ok_or_else(|| Failed::from(findings))
}

/// The CPU's picture of depths in f32 and in f64, and how far depths may differ.
struct Depths {
    single: Image,
    double: Image,
    limit: f32,
}

impl Depths {
    fn of(scene: &Scene) -> Result<Self, Failed> {
        let frame = FrameValues::defaults(scene.params());
        let view = View::new(scene.program(), &frame, scene.bounds_at(&frame), [SIDE; 2])?;
        let cpu = CpuScene::new(scene.program())?;
        let double = cpu.depth_map::<f64>(&view, &frame, METHOD)?;
        let hits = double.pixels().iter().filter(|pixel| pixel.status == HIT);
        let scale = view.eye.length() as f32 + hits.map(|pixel| pixel.depth).fold(0.0, f32::max);
        let limit = DEPTH.min(scale * DEPTH_PART).max(scale * ROUNDING);
        Ok(Self { single: cpu.depth_map::<f32>(&view, &frame, METHOD)?, double, limit })
    }
}

fn f32_and_f64(name: &str, text: &str) -> Result<(), Failed> {
    let Depths { single, double, limit } = Depths::of(&scene(name, text)?)?;
    if !double.pixels().iter().any(|pixel| pixel.status == HIT) {
        return Err("nothing is seen".into());
    }
    agree(&single, &double, "f32 and f64", limit, None)
}

fn gpu_and_cpu(name: &str, text: &str) -> Result<(), Failed> {
    let scene = scene(name, text)?;
    let picture = |backend| {
        let method = Some(METHOD.to_owned());
        let options = PictureOptions { size: [SIDE; 2], method, backend, ..Default::default() };
        scene.render(&options, &mut unwatched)
    };
    let (gpu, cpu) = (picture(Backend::Gpu)?.image, picture(Backend::Cpu)?.image);
    let Depths { double, limit, .. } = Depths::of(&scene)?;
    agree(&gpu, &cpu, "GPU and CPU in f32", limit, Some(COLOR))?;
    agree(&gpu, &double, "GPU and CPU in f64", limit, None)
}

fn agree(a: &Image, b: &Image, pair: &str, depth: f32, color: Option<u8>) -> Result<(), Failed> {
    let found = compare(a, b).ok_or("the sizes differ")?;
    let edges = found.edges as f64 / f64::from(SIDE * SIDE);
    if found.depth > depth || found.status > 0 || edges > EDGES {
        return Err(format!("{pair}: {found:?}, {edges:.2} of the pixels are edges").into());
    }
    match color {
        Some(limit) if found.color > limit => Err(format!("{pair}: {found:?}").into()),
        Some(_) | None => Ok(()),
    }
}
