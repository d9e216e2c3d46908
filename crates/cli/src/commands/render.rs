//! `sdfc render`: a picture of a scene.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use sdfc::PictureOptions;

use crate::args::{Backend, Render};
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// How often a frame is drawn for its figures.
const TIMED_FRAMES: u32 = 5;

/// Draws the scene, and says where the picture is.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; two outputs, or an output and the scene, are
/// one file; the machine cannot draw or write it.
pub fn run(args: &Render, console: &Console) -> Result<(), Failure> {
    let picture_path = args.output.clone().unwrap_or_else(|| default_output(&args.file));
    let stats_path = args.stats.as_deref();
    let outputs: Vec<&Path> =
        [Some(picture_path.as_path()), stats_path].into_iter().flatten().collect();
    output::distinct(&args.file, &outputs)?;
    let scene = super::scene(&args.file, console)?;
    if !scene.draws() {
        return Err(super::lowering(&sdfc::Error::NothingDrawn, console));
    }
    let output = Output::new(&picture_path);
    let stats_output = stats_path.map(Output::new);
    output.check()?;
    stats_output.as_ref().map_or(Ok(()), Output::check)?;

    let picture = draw(&scene, args, console)?;
    let png = picture.image.to_png().map_err(|e| super::lowering(&e.into(), console))?;
    output.write(&png)?;
    if let Some(stats_output) = stats_output {
        stats_output.write(&super::json(&picture.stats)?)?;
    }
    tell(&picture, &output, console);
    Ok(())
}

fn draw(scene: &sdfc::Scene, args: &Render, console: &Console) -> Result<sdfc::Picture, Failure> {
    let options = PictureOptions {
        size: args.size,
        method: args.march.clone(),
        backend: match args.backend {
            Backend::Auto => sdfc::Backend::Auto,
            Backend::Gpu => sdfc::Backend::Gpu,
            Backend::Cpu => sdfc::Backend::Cpu,
        },
        repetitions: if args.stats.is_some() { TIMED_FRAMES } else { 1 },
        ..PictureOptions::default()
    };
    let progress = console.progress("drawing");
    let picture = scene.render(&options, &mut |part| {
        progress.set(part.done, part.total);
        ControlFlow::Continue(())
    });
    picture.map_err(|e| super::lowering(&e, console))
}

/// One line about where it was drawn if not where one might think, one about where the picture is.
fn tell(picture: &sdfc::Picture, output: &Output, console: &Console) {
    if let Some(note) = &picture.note {
        console.note(note);
    }
    let stats = &picture.stats;
    let adapter = stats.adapter.as_deref().unwrap_or("the processor");
    console.detail(|| {
        let pixels = &stats.pixels;
        format!(
            "method {} on {adapter}: {:.1} ms a frame; {} pixels hit, {} miss, {} ran out of steps, {} not finite",
            stats.method, stats.frame_ms.median, pixels.hit, pixels.miss, pixels.capped, pixels.nan
        )
    });
    if let Output::File(path) = output {
        let [width, height] = stats.size;
        console.note(&format!("{}: {width}x{height}, drawn on {adapter}", path.display()));
    }
}

/// `scenes/ball.sdf` is drawn to `ball.png` in the current folder.
fn default_output(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().filter(|stem| *stem != "-");
    let mut name = stem.map_or_else(|| "scene".into(), ToOwned::to_owned);
    name.push(".png");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_named_after_scenes() {
        assert_eq!(default_output(Path::new("a/b.c/ball.sdf")), Path::new("ball.png"));
        assert_eq!(default_output(Path::new("ball")), Path::new("ball.png"));
        assert_eq!(default_output(Path::new("-")), Path::new("scene.png"));
    }
}
