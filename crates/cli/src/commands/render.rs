//! `sdfc render`: draws pictures of a scene.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use sdfc::{Error, FrameValues, Painter, Picture, PictureOptions, Scene};
use sdfc_render::{Animation, RenderError};

use crate::args::{Backend, Render};
use crate::console::{Console, Progress};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::{self, Output};
use crate::sequence::{self, Frames};
use sdfc_files::Format;

/// Number of frames that `--stats` times.
const TIMED_FRAMES: u32 = 5;
/// Greatest frame rate of a GIF: programs slow down GIFs with shorter frames.
const MAX_GIF_RATE: f64 = 50.0;

/// Draws the scene, and prints the names of the files.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; a param does not take its value; two of
/// the outputs and the scene are the same file; with `--strict`, a part of the picture is unproven;
/// the machine cannot draw or write; Ctrl-C.
pub fn run(args: &Render, console: &Console) -> Result<(), Failure> {
    let outputs = Outputs::new(args)?;
    let compiler = super::compiler_with(args.live_literals).loops(args.loops.into());
    let scene = super::scene_with(&args.file, compiler, &args.set, console)?;
    if !scene.draws() {
        return Err(super::lowering(&Error::NothingDrawn, console));
    }
    if args.depth.is_some() {
        scene.needs_solids("`--depth`").map_err(|e| super::lowering(&e, console))?;
    }
    let values = values(&scene, args);
    outputs.check(args.frames)?;
    let interrupt = Interrupt::watch();
    let options = options(args).hdr(outputs.format == Format::Exr);
    let painter = scene.painter(&options).map_err(|e| super::lowering(&e, console))?;
    let job = Job { args, console, interrupt, painter, values };
    match args.frames {
        None => job.still(&outputs),
        Some(frames) if outputs.format == Format::Gif => job.animation(&outputs, frames),
        Some(frames) => job.sequence(&outputs, frames),
    }
}

/// The destinations of the results.
struct Outputs {
    path: PathBuf,
    format: Format,
    depth: Option<PathBuf>,
    stats: Option<Output>,
}

impl Outputs {
    fn new(args: &Render) -> Result<Self, Failure> {
        let path = args.output.clone().unwrap_or_else(|| output::named_after(&args.file, "png"));
        let format = Format::of(&path).map_err(Failure::Call)?;
        let paths: Vec<&Path> =
            [Some(path.as_path()), args.depth.as_deref(), args.stats.as_deref()]
                .into_iter()
                .flatten()
                .collect();
        output::distinct(&args.file, &paths)?;
        if let Some(depth) = &args.depth
            && depth.as_os_str() != "-"
            && Format::of(depth).ok() != Some(Format::Exr)
        {
            let message = format!(
                "{}: depths are written as EXR; choose a name that ends in .exr",
                depth.display()
            );
            return Err(Failure::Call(message));
        }
        if args.frames.is_some() && format == Format::Gif && args.fps > MAX_GIF_RATE {
            let message =
                format!("a GIF has at most {MAX_GIF_RATE} frames per second; lower --fps");
            return Err(Failure::Call(message));
        }
        let is_stdout = |path: &Path| path.as_os_str() == "-";
        let to_stdout = is_stdout(&path) || args.depth.as_deref().is_some_and(is_stdout);
        if args.frames.is_some() && to_stdout {
            let message = "a sequence cannot be written to stdout; name a file with -o";
            return Err(Failure::Call(message.to_owned()));
        }
        let stats = args.stats.as_deref().map(Output::new);
        Ok(Self { path, format, depth: args.depth.clone(), stats })
    }

    /// Checks early that the outputs can be written, before long work.
    fn check(&self, frames: Option<Frames>) -> Result<(), Failure> {
        let first = frames.map(|frames| frames.first);
        self.picture(first).check()?;
        self.depth(first).map_or(Ok(()), |depth| depth.check())?;
        self.stats.as_ref().map_or(Ok(()), Output::check)
    }

    /// The destination of a picture. Frames of a sequence are numbered, except in a GIF.
    fn picture(&self, number: Option<u32>) -> Output {
        match number {
            Some(number) if self.format != Format::Gif => {
                Output::new(&sequence::numbered(&self.path, number))
            }
            Some(_) | None => Output::new(&self.path),
        }
    }

    /// The destination of a picture's depths. Frames of a sequence are numbered.
    fn depth(&self, number: Option<u32>) -> Option<Output> {
        let path = self.depth.as_deref()?;
        let numbered = number.map(|number| sequence::numbered(path, number));
        Some(Output::new(numbered.as_deref().unwrap_or(path)))
    }
}

fn options(args: &Render) -> PictureOptions {
    PictureOptions::new()
        .size(args.size)
        .method(args.march)
        .backend(match args.backend {
            Backend::Auto => sdfc::Backend::Auto,
            Backend::Gpu => sdfc::Backend::Gpu,
            Backend::Cpu => sdfc::Backend::Cpu,
        })
        .samples(args.samples)
        .isolines(args.isolines)
}

/// Returns the values of params, time and frame.
fn values(scene: &Scene, args: &Render) -> FrameValues {
    FrameValues { frame: (args.time * args.fps).round(), ..super::values(scene, args.time) }
}

/// Everything that drawing needs.
struct Job<'a> {
    args: &'a Render,
    console: &'a Console,
    interrupt: Interrupt,
    painter: Painter<'a>,
    values: FrameValues,
}

impl Job<'_> {
    fn still(&self, outputs: &Outputs) -> Result<(), Failure> {
        let repetitions = if outputs.stats.is_some() { TIMED_FRAMES } else { 1 };
        let progress = self.console.progress("drawing");
        let picture = self.paint(&self.values, repetitions, &progress, [0, 1])?;
        drop(progress);
        let output = outputs.picture(None);
        output.write(&self.encode(&picture, outputs.format)?)?;
        self.write_depth(&picture, outputs.depth(None))?;
        if let Some(stats_output) = &outputs.stats {
            stats_output.write(&super::json(&picture.stats)?)?;
        }
        self.print_notes(&picture);
        if let Some(unproven) = &picture.unproven {
            self.console.warning(unproven);
        }
        if let Output::File(path) = output {
            self.print_files(&picture, &path.display().to_string());
        }
        Ok(())
    }

    /// Writes one file per frame as soon as it is drawn.
    fn sequence(&self, outputs: &Outputs, frames: Frames) -> Result<(), Failure> {
        let progress = self.console.progress("drawing");
        let mut said = false;
        for (number, before) in frames.numbers().zip(0..) {
            let picture = self.frame(number, &progress, [before, frames.count()])?;
            self.warn_once(&picture, number, &mut said);
            outputs.picture(Some(number)).write(&self.encode(&picture, outputs.format)?)?;
            self.write_depth(&picture, outputs.depth(Some(number)))?;
            if before == 0 {
                self.print_notes(&picture);
            }
            if before + 1 == frames.count() {
                let first = sequence::numbered(&outputs.path, frames.first);
                let last = sequence::numbered(&outputs.path, number);
                let names = format!("{} to {}", first.display(), last.display());
                self.print_files(&picture, &names);
            }
        }
        Ok(())
    }

    /// Writes all frames to one file after the last is drawn.
    fn animation(&self, outputs: &Outputs, frames: Frames) -> Result<(), Failure> {
        let refused = |error: RenderError| super::lowering(&error.into(), self.console);
        let progress = self.console.progress("drawing");
        let mut file = Vec::new();
        let mut animation = Animation::new(&mut file).map_err(refused)?;
        let (mut last, mut said) = (None, false);
        for (number, before) in frames.numbers().zip(0..) {
            let picture = self.frame(number, &progress, [before, frames.count()])?;
            self.warn_once(&picture, number, &mut said);
            let shown = sequence::hundredths(number, self.args.fps);
            animation.push(&picture.image, shown).map_err(refused)?;
            self.write_depth(&picture, outputs.depth(Some(number)))?;
            last = Some(picture);
        }
        drop((animation, progress));
        let output = outputs.picture(None);
        output.write(&file)?;
        if let Some(picture) = last {
            self.print_notes(&picture);
            if let Output::File(path) = output {
                let name = format!("{}: {} frames", path.display(), frames.count());
                self.print_files(&picture, &name);
            }
        }
        Ok(())
    }

    /// Draws one frame of a sequence. `position` is how many come before it, and how many there
    /// are.
    fn frame(
        &self,
        number: u32,
        progress: &Progress,
        position: [u32; 2],
    ) -> Result<Picture, Failure> {
        let time = sequence::time(number, self.args.fps);
        let values = FrameValues { time, frame: f64::from(number), ..self.values.clone() };
        let picture = self.paint(&values, 1, progress, position);
        picture.map_err(|failure| {
            if !matches!(failure, Failure::Interrupted(_)) {
                return failure;
            }
            let [before, all] = position;
            Failure::Interrupted(format!("stopped after {before} of {all} frames"))
        })
    }

    fn paint(
        &self,
        values: &FrameValues,
        repetitions: u32,
        progress: &Progress,
        [before, all]: [u32; 2],
    ) -> Result<Picture, Failure> {
        let picture = self.painter.paint(values, repetitions, &mut |part| {
            let total = part.total * u64::from(all);
            progress.set(part.total * u64::from(before) + part.done, total);
            self.interrupt.flow()
        });
        // Ctrl-C after the last tile counts as well.
        let picture = match self.interrupt.flow() {
            ControlFlow::Continue(()) => picture,
            ControlFlow::Break(()) => Err(RenderError::Cancelled.into()),
        };
        let picture = picture.map_err(|e| super::lowering(&e, self.console))?;
        match &picture.unproven {
            Some(unproven) if self.args.strict => {
                self.console.error(unproven);
                Err(Failure::Scene)
            }
            Some(_) | None => Ok(picture),
        }
    }

    fn encode(&self, picture: &Picture, format: Format) -> Result<Vec<u8>, Failure> {
        format.encode(&picture.image).map_err(|e| super::lowering(&e.into(), self.console))
    }

    fn write_depth(&self, picture: &Picture, output: Option<Output>) -> Result<(), Failure> {
        let Some(output) = output else { return Ok(()) };
        let file = picture.image.depth_to_exr();
        output.write(&file.map_err(|e| super::lowering(&e.into(), self.console))?)
    }

    /// Warns of the first frame of a sequence that is unproven in part.
    fn warn_once(&self, picture: &Picture, number: u32, said: &mut bool) {
        if let (Some(unproven), false) = (&picture.unproven, *said) {
            self.console.warning(&format!("frame {number}: {unproven}"));
            *said = true;
        }
    }

    /// Prints why the device or the method differs from the options, a warning about pixels that
    /// are not finite and, with `-v`, statistics.
    fn print_notes(&self, picture: &Picture) {
        let counts = &picture.stats.pixels;
        if counts.nan > 0 {
            self.console.warning(&format!(
                "{} of {} pixels are not finite numbers, and are drawn in magenta: a formula \
                 divides by 0 or overflows",
                counts.nan,
                counts.all()
            ));
        }
        if let Some(note) = &picture.note {
            self.console.note(note);
        }
        let stats = &picture.stats;
        self.console.detail(|| {
            let pixels = &stats.pixels;
            format!(
                "method {} on {}: {:.1} ms per frame; {} pixels hit, {} missed, {} capped, {} NaN",
                stats.method,
                adapter(picture),
                stats.frame_ms.median,
                pixels.hit,
                pixels.miss,
                pixels.capped,
                pixels.nan
            )
        });
    }

    fn print_files(&self, picture: &Picture, name: &str) {
        let [width, height] = picture.stats.size;
        self.console.note(&format!("{name}: {width}x{height}, drawn on {}", adapter(picture)));
    }
}

fn adapter(picture: &Picture) -> &str {
    picture.stats.adapter.as_deref().unwrap_or("the CPU")
}
