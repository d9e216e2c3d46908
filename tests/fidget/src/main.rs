//! Draws and meshes the same models with sdfc and with Fidget, and prints tables. README.md says
//! how to run it.

mod draw;
mod error;
mod mesh;
mod model;
mod tree;
mod vm;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::draw::Renderer;
use crate::model::Model;

const USAGE: &str = "\
Usage: beside-fidget draw [--size N] [--frames N] FILE...
       beside-fidget mesh [--error FRACTION] [--out FOLDER] FILE...
       beside-fidget scene FILE.vm

FILE is a scene (.sdf) or a model of Fidget (.vm).";

/// A renderer that takes longer for its pictures of a model is stopped.
const LIMIT: Duration = Duration::from_secs(240);
/// The deepest octree of Fidget that is tried.
const DEEPEST: u8 = 9;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    let mut options = Options { size: 640, frames: 3, error: 1e-3, out: None, files: Vec::new() };
    let mut arguments = std::env::args().skip(1);
    let command = arguments.next().context(USAGE)?;
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().context(USAGE);
        match argument.as_str() {
            "--size" => options.size = value()?.parse()?,
            "--frames" => options.frames = value()?.parse()?,
            "--error" => options.error = value()?.parse()?,
            "--out" => options.out = Some(value()?.into()),
            _ => options.files.push(argument.into()),
        }
    }
    match command.as_str() {
        "draw" => options.draw(),
        "mesh" => options.mesh(),
        "scene" => options.scene(),
        // A process of its own for each renderer, so that nothing is left of the one before.
        "draw-with" => options.draw_with(),
        _ => bail!("{USAGE}"),
    }
}

struct Options {
    size: u32,
    frames: u32,
    error: f64,
    out: Option<PathBuf>,
    files: Vec<PathBuf>,
}

impl Options {
    fn scene(&self) -> Result<()> {
        for file in &self.files {
            print!("{}", Model::read(file)?.text);
        }
        Ok(())
    }

    fn draw(&self) -> Result<()> {
        println!(
            "| model | renderer | first picture, CPU s (elapsed) | frame, CPU s (elapsed) | other \
             hits | other depths | note |"
        );
        println!("|---|---|--:|--:|--:|--:|---|");
        for file in &self.files {
            let mut reference: Option<Vec<f32>> = None;
            for renderer in Renderer::ALL {
                let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                print!("| {name} | {} ", renderer.name());
                std::io::stdout().flush()?;
                let (times, depths) = match self.run(file, renderer) {
                    Ok(drawn) => drawn,
                    Err(error) => {
                        println!("| | | | | {error:#} |");
                        continue;
                    }
                };
                let (times, note) = times.split_once('\n').unwrap_or((&times, ""));
                let [hits, depth] = reference
                    .as_ref()
                    .map_or([0; 2], |other| draw::differences(other, &depths, self.size));
                println!("| {times} | {hits} | {depth} | {} |", note.trim());
                reference.get_or_insert(depths);
            }
        }
        Ok(())
    }

    /// Runs one renderer in a process with empty caches of the driver.
    fn run(&self, file: &Path, renderer: Renderer) -> Result<(String, Vec<f32>)> {
        let folder = tempfile::tempdir()?;
        let depths = folder.path().join("depths");
        let mut child = Command::new(std::env::current_exe()?)
            .arg("draw-with")
            .args(["--size", &self.size.to_string(), "--frames", &self.frames.to_string()])
            .arg("--out")
            .arg(&depths)
            .arg(renderer.name())
            .arg(file)
            .env("MESA_SHADER_CACHE_DIR", folder.path())
            .stdout(Stdio::piped())
            .spawn()?;
        let start = Instant::now();
        while child.try_wait()?.is_none() {
            if start.elapsed() > LIMIT {
                child.kill()?;
                child.wait()?;
                bail!("not done after {} s", LIMIT.as_secs());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let output = child.wait_with_output()?;
        if !output.status.success() {
            bail!("failed; see above");
        }
        let bytes = std::fs::read(&depths)?;
        let (floats, _) = bytes.as_chunks();
        let floats = floats.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
        Ok((String::from_utf8(output.stdout)?, floats))
    }

    fn draw_with(&self) -> Result<()> {
        let [renderer, file] = self.files.as_slice() else { bail!("{USAGE}") };
        let is_named = |r: &Renderer| Path::new(r.name()) == renderer;
        let renderer = Renderer::ALL.into_iter().find(is_named).context(USAGE)?;
        let drawn = draw::draw(&Model::read(file)?, renderer, self.size, self.frames)?;
        let times = [drawn.first, drawn.frame].map(|[cpu, elapsed]| {
            format!("{:.3} ({:.3})", cpu.as_secs_f64(), elapsed.as_secs_f64())
        });
        println!("{}\n{}", times.join(" | "), drawn.note);
        let bytes: Vec<u8> = drawn.depths.iter().flat_map(|depth| depth.to_le_bytes()).collect();
        std::fs::write(self.out.as_deref().context(USAGE)?, bytes)?;
        Ok(())
    }

    fn mesh(&self) -> Result<()> {
        println!(
            "| model | program | triangles | CPU s (elapsed) | mesh to surface | mean | surface to \
             mesh | open edges | other bad edges | note |"
        );
        println!("|---|---|--:|--:|--:|--:|--:|--:|--:|---|");
        for file in &self.files {
            let model = Model::read(file)?;
            let ours = self.row(&model, file, "sdfc", mesh::by_sdfc(&model, self.error)?)?;
            for depth in 5..=DEEPEST {
                let meshed = match mesh::by_fidget(&model, depth) {
                    Ok(meshed) => meshed,
                    Err(error) => {
                        println!("| {} | Fidget | | | | | | | | {error:#} |", file.display());
                        break;
                    }
                };
                let elapsed = meshed.time[1];
                let theirs = self.row(&model, file, "Fidget", meshed)?;
                if theirs <= ours || elapsed > LIMIT / 8 {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Prints a row, writes the mesh as a file, and returns the worst distance.
    fn row(&self, model: &Model, file: &Path, by: &str, mesh: mesh::Meshed) -> Result<f64> {
        let scene = model.scene()?;
        let mut field = scene.field(&scene.defaults())?;
        let errors = error::errors(&mesh, &mut field, model.view()?)?;
        let [open, other] = mesh.bad_edges();
        let [cpu, elapsed] = mesh.time.map(|time| time.as_secs_f64());
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        println!(
            "| {name} | {by} | {} | {cpu:.2} ({elapsed:.2}) | {:.2e} | {:.2e} | {:.2e} | {open} | \
             {other} | {} |",
            mesh.triangles.len(),
            errors.to_surface,
            errors.mean,
            errors.to_mesh,
            mesh.note,
        );
        if let Some(folder) = &self.out {
            std::fs::create_dir_all(folder)?;
            let name = format!("{name}-{}-{}.stl", by.to_lowercase(), mesh.triangles.len());
            std::fs::write(folder.join(name), mesh.stl())?;
        }
        Ok(errors.to_surface.max(errors.to_mesh))
    }
}
