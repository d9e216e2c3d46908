//! `sdfc render`: draws pictures of a scene.

mod watch;

use std::cell::OnceCell;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use sdfc::{Error, FrameValues, Painter, Picture, PictureOptions, Scene, Tile};
use sdfc_render::{Animation, Raster, RasterKind, RenderError};

use crate::args::Render;
use crate::console::{Console, Progress};
use crate::failure::Failure;
use crate::farm::options::ProgressForm;
use crate::farm::progress::{Finished, Reporter};
use crate::farm::provenance::{Drawing, Provenance};
use crate::farm::region;
use crate::farm::resume::{Existing, existing};
use crate::interrupt::Interrupt;
use crate::output::{self, Output, PartialFile};
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
    if args.watch {
        return watch::run(args, console);
    }
    once(args, &Interrupt::watch("stopped; no picture was written", console), console)
}

fn once(args: &Render, interrupt: &Interrupt, console: &Console) -> Result<(), Failure> {
    let Some(Work { frames, region }) = Work::of(args, console)? else { return Ok(()) };
    let outputs = Outputs::new(args, region)?;
    let compiler = super::compiler_with(args.live.live_literals).loops(args.loops.into());
    let compiler = compiler.camera(args.camera.as_deref());
    let (scene, checksum) =
        super::scene_and_checksum(&args.file, compiler, &args.params.set, console)?;
    if !scene.draws() {
        return Err(super::lowering(&Error::NothingDrawn, console));
    }
    if args.depth.is_some() {
        scene.needs_solids("`--depth`").map_err(|e| super::lowering(&e, console))?;
    }
    let values = values(&scene, args);
    outputs.check(frames)?;
    let job = Job {
        args,
        console,
        interrupt,
        scene: &scene,
        options: options(args).region(region).hdr(outputs.format == Format::Exr),
        painter: OnceCell::new(),
        values,
        drawing: Drawing::new(args, checksum),
        reporter: Reporter::new(args.farm.progress),
    };
    match frames {
        None => job.still(&outputs),
        Some(frames) if outputs.format == Format::Gif => job.animation(&outputs, frames),
        Some(frames) => job.sequence(&outputs, frames),
    }
}

/// The frames and the region that this process draws.
struct Work {
    /// `None` for a single picture.
    frames: Option<Frames>,
    /// `None` for whole pictures.
    region: Option<Tile>,
}

impl Work {
    /// Returns the share that the command line asks for. `None`, after a note, if it is empty.
    fn of(args: &Render, console: &Console) -> Result<Option<Self>, Failure> {
        let frames = match (args.frames, args.farm.chunk) {
            (Some(all), Some(share)) => {
                let Some(frames) = share.of_frames(all) else {
                    let count = all.count();
                    console.note(&format!("there is no frame in share {share} of {count} frames"));
                    return Ok(None);
                };
                Some(frames)
            }
            (frames, _) => frames,
        };
        let Some(region) = args.farm.region else {
            return Ok(Some(Self { frames, region: None }));
        };
        let region = region.of(args.size).map_err(Failure::Call)?;
        if region.is_none() {
            let height = args.size[1];
            console.note(&format!("there is no row in this share of {height} rows"));
        }
        Ok(region.map(|region| Self { frames, region: Some(region) }))
    }
}

/// The destinations of the results.
struct Outputs {
    path: PathBuf,
    format: Format,
    depth: Option<PathBuf>,
    stats: Option<Output>,
    region: Option<Tile>,
}

impl Outputs {
    fn new(args: &Render, region: Option<Tile>) -> Result<Self, Failure> {
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
        if let (Format::Gif, Some(option)) = (format, args.farm.for_separate_files()) {
            let message = format!(
                "{option} needs one file per picture, and a GIF holds all frames; write PNG or EXR \
                 files and join them with a program such as ffmpeg"
            );
            return Err(Failure::Call(message));
        }
        let stats = args.stats.as_deref().map(Output::new);
        let lines = args.farm.progress == ProgressForm::Json;
        if lines && (to_stdout || stats == Some(Output::Stdout)) {
            let message = "--progress json writes to stdout; write the results to files";
            return Err(Failure::Call(message.to_owned()));
        }
        Ok(Self { path, format, depth: args.depth.clone(), stats, region })
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
            Some(_) if self.format == Format::Gif => Output::new(&self.path),
            Some(_) | None => self.named(&self.path, number),
        }
    }

    /// The destination with the number of the frame and the region in its name.
    fn named(&self, path: &Path, number: Option<u32>) -> Output {
        let numbered = number.map(|number| sequence::numbered(path, number));
        let path = numbered.as_deref().unwrap_or(path);
        match (Output::new(path), self.region) {
            (Output::File(path), Some(region)) => Output::File(region::part_path(&path, region)),
            (output, _) => output,
        }
    }

    /// What the file of a picture holds.
    fn kind(&self) -> RasterKind {
        match self.format {
            Format::Png | Format::Gif => RasterKind::Srgb,
            Format::Exr => RasterKind::Linear,
        }
    }

    /// The destination of a picture's depths. Frames of a sequence are numbered.
    fn depth(&self, number: Option<u32>) -> Option<Output> {
        self.depth.as_deref().map(|path| self.named(path, number))
    }
}

fn options(args: &Render) -> PictureOptions {
    PictureOptions::new()
        .size(args.size)
        .method(args.march)
        .backend(args.backend)
        .samples(args.samples)
        .isolines(args.isolines)
}

/// Returns the values of params, time and frame.
fn values(scene: &Scene, args: &Render) -> FrameValues {
    FrameValues { frame: sequence::frame(args.time, args.fps), ..super::values(scene, args.time) }
}

/// Everything that drawing needs.
struct Job<'a> {
    args: &'a Render,
    console: &'a Console,
    interrupt: &'a Interrupt,
    scene: &'a Scene,
    options: PictureOptions,
    painter: OnceCell<Painter<'a>>,
    values: FrameValues,
    /// What files say of the whole picture at `--time`.
    drawing: Drawing,
    reporter: Reporter,
}

impl<'a> Job<'a> {
    fn still(&self, outputs: &Outputs) -> Result<(), Failure> {
        let drawing = self.drawing.in_region(outputs.region);
        let output = outputs.picture(None);
        if let Some(unproven) = self.finished(outputs, None, &drawing) {
            self.report(outputs, None, true, [1, 1], unproven)?;
            self.console.note(&format!("{output}: finished before"));
            return Ok(());
        }
        let repetitions = if outputs.stats.is_some() { TIMED_FRAMES } else { 1 };
        let progress = self.console.progress("drawing");
        let picture = self.paint(&self.values, repetitions, &progress, [0, 1])?;
        drop(progress);
        self.save(&picture, outputs, None, &drawing)?;
        if let Some(stats_output) = &outputs.stats {
            stats_output.write(&output::json(&picture.stats)?)?;
        }
        self.report(outputs, None, false, [1, 1], picture.stats.pixels.unproven)?;
        self.print_notes(&picture);
        if let Some(unproven) = &picture.unproven {
            self.console.warning(unproven);
        }
        if let Output::File(_) = output {
            self.print_files(&picture, &output.to_string());
        }
        Ok(())
    }

    /// Writes one file per frame as soon as it is drawn.
    fn sequence(&self, outputs: &Outputs, frames: Frames) -> Result<(), Failure> {
        let progress = self.console.progress("drawing");
        let (mut said, mut skipped, mut last) = (false, 0, None);
        for (number, before) in frames.numbers().zip(0..) {
            self.say_finished(before, frames);
            let time = sequence::time(number, self.args.fps);
            let drawing = self.drawing.at_frame(number, time).in_region(outputs.region);
            let position = [before + 1, frames.count()];
            if let Some(unproven) = self.finished(outputs, Some(number), &drawing) {
                if self.interrupt.flow().is_break() {
                    return Err(self.interrupt.failure());
                }
                self.report(outputs, Some(number), true, position, unproven)?;
                skipped += 1;
                continue;
            }
            let picture = self.frame(number, &progress, [before, frames.count()])?;
            self.warn_once(&picture, number, &mut said);
            self.save(&picture, outputs, Some(number), &drawing)?;
            let unproven = picture.stats.pixels.unproven;
            self.report(outputs, Some(number), false, position, unproven)?;
            if last.is_none() {
                self.print_notes(&picture);
            }
            last = Some(picture);
        }
        drop(progress);
        let [first, end] =
            [frames.first, frames.end - 1].map(|number| outputs.picture(Some(number)));
        let names = format!("{first} to {end}");
        if skipped > 0 {
            self.console.note(&format!("{names}: {skipped} of them finished before"));
        }
        if let Some(picture) = last {
            self.print_files(&picture, &names);
        }
        Ok(())
    }

    /// Returns the number of unproven pixels of a picture whose files are finished, if `--resume`
    /// skips those. Says why a file is drawn again.
    fn finished(&self, outputs: &Outputs, number: Option<u32>, drawing: &Drawing) -> Option<u64> {
        if !self.args.farm.resume {
            return None;
        }
        let picture = (outputs.picture(number), outputs.kind());
        let depth = outputs.depth(number).map(|output| (output, RasterKind::Depth));
        let mut all = None;
        for (output, kind) in std::iter::once(picture).chain(depth) {
            let Output::File(path) = &output else { return None };
            match existing(path, drawing, kind) {
                Existing::Missing => return None,
                Existing::Finished(unproven) if self.args.strict && unproven > 0 => return None,
                Existing::Finished(unproven) => all = Some(unproven),
                Existing::Other(reason) => {
                    self.console.note(&format!("{output} is drawn again: {reason}"));
                    return None;
                }
            }
        }
        all
    }

    /// Writes a picture and its depths.
    fn save(
        &self,
        picture: &Picture,
        outputs: &Outputs,
        number: Option<u32>,
        drawing: &Drawing,
    ) -> Result<(), Failure> {
        let file = match outputs.format {
            Format::Png => self.encode(picture, &picture.image.srgb_raster(), drawing)?,
            Format::Exr => self.encode(picture, &picture.image.linear_raster(), drawing)?,
            Format::Gif => {
                let file = outputs.format.encode(&picture.image);
                file.map_err(|e| super::lowering(&e.into(), self.console))?
            }
        };
        outputs.picture(number).write(&file)?;
        let Some(output) = outputs.depth(number) else { return Ok(()) };
        output.write(&self.encode(picture, &picture.image.depth_raster(), drawing)?)
    }

    fn encode(
        &self,
        picture: &Picture,
        raster: &Raster,
        drawing: &Drawing,
    ) -> Result<Vec<u8>, Failure> {
        let (origin, size) = (drawing.tile().origin, drawing.size);
        let unproven = picture.stats.pixels.unproven;
        let said = Provenance::new(drawing.clone(), &device(picture), unproven, raster);
        let file = raster.to_file(origin, size, Some(&said.to_note()));
        file.map_err(|e| super::lowering(&e.into(), self.console))
    }

    /// Reports a picture that is finished; `skipped` is true if it was finished before.
    fn report(
        &self,
        outputs: &Outputs,
        frame: Option<u32>,
        skipped: bool,
        position: [u32; 2],
        unproven: u64,
    ) -> Result<(), Failure> {
        let output = outputs.picture(frame);
        let file = match &output {
            Output::File(path) => Some(path.as_path()),
            Output::Stdout => None,
        };
        let region = outputs.region.map(region::name);
        self.reporter.finished(Finished { frame, region, skipped, file, position, unproven })
    }

    /// The painter, which is made for the first picture that is not finished.
    fn painter(&self) -> Result<&Painter<'a>, Failure> {
        if let Some(painter) = self.painter.get() {
            return Ok(painter);
        }
        let painter = self.scene.painter(&self.options);
        let painter = painter.map_err(|e| super::lowering(&e, self.console))?;
        Ok(self.painter.get_or_init(|| painter))
    }

    /// Writes each frame as soon as it is drawn to one file, which gets its name after the last.
    fn animation(&self, outputs: &Outputs, frames: Frames) -> Result<(), Failure> {
        let Output::File(path) = outputs.picture(None) else { return Ok(()) };
        let mut file = PartialFile::begin(&path)?;
        let last = self.frames_into(&mut file, outputs, frames);
        // A file that could not be written is the reason, and not what the encoder makes of it.
        file.failure().map_or(Ok(()), Err)?;
        let last = last?;
        file.finish()?;
        if let Some(picture) = last {
            self.print_notes(&picture);
            let name = format!("{}: {} frames", path.display(), frames.count());
            self.print_files(&picture, &name);
        }
        Ok(())
    }

    /// Draws the frames of an animation, and returns the last.
    fn frames_into(
        &self,
        file: &mut PartialFile,
        outputs: &Outputs,
        frames: Frames,
    ) -> Result<Option<Picture>, Failure> {
        let refused = |error: RenderError| super::lowering(&error.into(), self.console);
        let progress = self.console.progress("drawing");
        let mut animation = Animation::new(file).map_err(refused)?;
        let (mut last, mut said) = (None, false);
        for (number, before) in frames.numbers().zip(0..) {
            self.say_finished(before, frames);
            let picture = self.frame(number, &progress, [before, frames.count()])?;
            self.warn_once(&picture, number, &mut said);
            let shown = sequence::hundredths(number, self.args.fps);
            animation.push(&picture.image, shown).map_err(refused)?;
            if let Some(output) = outputs.depth(Some(number)) {
                let time = sequence::time(number, self.args.fps);
                let drawing = self.drawing.at_frame(number, time);
                output.write(&self.encode(&picture, &picture.image.depth_raster(), &drawing)?)?;
            }
            let unproven = picture.stats.pixels.unproven;
            self.report(outputs, Some(number), false, [before + 1, frames.count()], unproven)?;
            last = Some(picture);
        }
        Ok(last)
    }

    /// Lets Ctrl-C say from now on how many frames are finished.
    fn say_finished(&self, finished: u32, frames: Frames) {
        let all = frames.count();
        self.interrupt.set_message(format!("stopped after {finished} of {all} frames"));
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
        self.paint(&values, 1, progress, position)
    }

    fn paint(
        &self,
        values: &FrameValues,
        repetitions: u32,
        progress: &Progress,
        [before, all]: [u32; 2],
    ) -> Result<Picture, Failure> {
        let picture = self.painter()?.paint(values, repetitions, &mut |part| {
            let total = part.total * u64::from(all);
            progress.set(part.total * u64::from(before) + part.done, total);
            self.interrupt.flow()
        });
        // Ctrl-C after the last tile counts as well.
        let picture = match self.interrupt.flow() {
            ControlFlow::Continue(()) => picture,
            ControlFlow::Break(()) => Err(RenderError::Cancelled.into()),
        };
        let failed = |e| self.interrupt.explained(super::lowering(&e, self.console));
        let picture = picture.map_err(failed)?;
        match &picture.unproven {
            Some(unproven) if self.args.strict => {
                self.console.error(unproven);
                Err(Failure::Scene)
            }
            Some(_) | None => Ok(picture),
        }
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

/// The device that drew, with its driver.
fn device(picture: &Picture) -> String {
    match (&picture.stats.adapter, &picture.stats.driver) {
        (Some(adapter), Some(driver)) => format!("{adapter}, {driver}"),
        (Some(adapter), None) => adapter.clone(),
        (None, _) => "CPU".to_owned(),
    }
}

fn adapter(picture: &Picture) -> &str {
    picture.stats.adapter.as_deref().unwrap_or("the CPU")
}
