//! A region of a picture is drawn as in the whole picture, bit for bit, wherever it begins.

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Backend, Compiler, LoopStrategy, PictureOptions, Tile, no_progress};
use sdfc_render::testing::without_gpu;

/// Neither side is a multiple of a block.
const SIZE: [u32; 2] = [150, 101];

fn main() {
    let mut trials = Vec::new();
    for (name, text) in scenes() {
        for (device, backend) in [("the CPU", Backend::Cpu), ("the GPU", Backend::Gpu)] {
            let text = text.clone();
            let drawn = move || are_crops(&text, backend);
            let trial = Trial::test(format!("{name}, on {device}"), drawn);
            trials.push(trial.with_ignored_flag(backend == Backend::Gpu && without_gpu()));
        }
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn scenes() -> Vec<(&'static str, String)> {
    let balls = "for i in 0..150: sphere(0.2).translate(4 * hash3(i) - [2, 2, 2])";
    vec![
        ("a fitted camera and the default light", "box(1).rotate(y: 30deg)\nplane(y: -1)\n".into()),
        (
            "mirrors and soft shadows",
            "sphere(1)\nplane(y: -1).color(#884422)\nsun(shadow: soft(6))\nreflections(2)\n\
             ambient_occlusion(radius: 0.5)\nsky()\n"
                .into(),
        ),
        ("parallel rays", "torus(1, 0.3)\ncamera(eye: [4, 3, 6], target: 0, height: 4)\n".into()),
        (
            "an uncertified field",
            "solid lump()\n  bounds -1..1\n  \
             = max(length(p) - 1, sqrt(abs(p.x)) - 0.7)\nlump()\n"
                .into(),
        ),
        ("many parts, culled", format!("union({balls})\nplane(y: -2.5)\n")),
        ("many blended parts, culled", format!("union({balls}, blend: smooth(0.15))\n")),
        (
            "many small parts from within, culled",
            "union(for i in 0..600: sphere(0.05 * hash(i, 7)).translate(4 * hash3(i) - [2, 2, 2]))\n\
             camera(eye: [0.1, 0.2, 0.3], target: [1, 0.4, 2], fov: 100deg)\n"
                .into(),
        ),
    ]
}

fn are_crops(text: &str, backend: Backend) -> Result<(), Failed> {
    let compiler = Compiler::new().loops(LoopStrategy::Looped);
    let scene = compiler.compile("a.sdf", text).map_err(|e| e.render(false))?;
    let options = PictureOptions::new().size(SIZE).backend(backend).samples(2);
    let whole = scene.render(&options, &mut no_progress)?.image;
    let regions = [
        ([0, 0], [150, 1]),
        ([13, 7], [5, 3]),
        ([41, 29], [64, 40]),
        ([143, 96], [7, 5]),
        ([72, 0], [8, 101]),
    ];
    for (origin, size) in regions {
        let options = options.clone().region(Tile { origin, size });
        let part = scene.render(&options, &mut no_progress)?.image;
        if part.size() != size {
            return Err(format!("{size:?} pixels asked for, {:?} drawn", part.size()).into());
        }
        for (index, pixel) in part.pixels().iter().enumerate() {
            let [x, y] = [index as u32 % size[0] + origin[0], index as u32 / size[0] + origin[1]];
            // Debug output tells all floats apart, except the kinds of NaN.
            let (drawn, expected) = (format!("{pixel:?}"), whole.pixel(x, y));
            if Some(&drawn) != expected.map(|pixel| format!("{pixel:?}")).as_ref() {
                return Err(format!("{origin:?} {size:?} at {x},{y}: {drawn}, {expected:?}").into());
            }
        }
    }
    Ok(())
}
