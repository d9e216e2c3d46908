//! No example uses more registers on a GPU than `docs/gpu.md` says.
//!
//! Mesa's RADV compiles shaders for AMD chips that the machine does not have, and reports what its
//! compiler made of them. Without RADV the tests are reported as ignored, unless `SDFC_REQUIRE_GPU`
//! is 1. After a change of the emitted shaders, `GPU_UPDATE=1 cargo test -p sdfc-occupancy` writes
//! the table again. `GPU_STATISTICS=1` prints what the driver of this machine reports instead.

#![allow(clippy::print_stdout, reason = "a run of the driver prints what it found")]

mod driver;
mod field;
mod native;
mod radv;
mod table;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Compiler, Emit, Scene, ShaderOptions, Target};
use sdfc_test_support::repository;
use sdfc_tests::compiled_examples;

use crate::radv::Chip;
use crate::table::{Part, Row, Table};

/// The environment variable with scenes, separated by spaces, whose times to compile are printed
/// instead of a test. Paths are relative to the repository.
const TIMES: &str = "GPU_TIMES";
/// The environment variable that makes this program print what the driver of this machine reports.
const STATISTICS: &str = "GPU_STATISTICS";
/// The number of runs of which the shortest counts.
const RUNS: usize = 5;

fn main() {
    if let Some(folder) = std::env::var_os(radv::SHADERS) {
        return radv::print_statistics(&folder);
    }
    if std::env::var_os(STATISTICS).is_some() {
        return native::print_statistics().unwrap_or_else(give_up);
    }
    if let Ok(scenes) = std::env::var(TIMES) {
        return print_times(&scenes).unwrap_or_else(give_up);
    }
    let is_required = std::env::var_os("SDFC_REQUIRE_GPU").is_some_and(|value| value == "1");
    let is_ignored = !is_required && radv::manifest().is_none();
    let trial = Trial::test("no_example_takes_more_of_a_gpu_than_the_tables_say", check);
    libtest_mimic::run(&Arguments::from_args(), vec![trial.with_ignored_flag(is_ignored)]).exit();
}

fn give_up(error: Failed) {
    println!("{}", error.message().unwrap_or_default());
    std::process::exit(1);
}

fn check() -> Result<(), Failed> {
    let path = repository().join("docs/gpu.md");
    let mut page = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let mut problems = Vec::new();
    for part in Part::ALL {
        let known = Table::read(&page, part)?;
        let found = measure(part)?;
        if std::env::var_os("GPU_UPDATE").is_some() {
            page = found.written_into(&page, part)?;
            continue;
        }
        if found.driver != known.driver {
            let (here, there) = (&found.driver, &known.driver);
            return Err(format!("docs/gpu.md is of {there}; this machine has {here}").into());
        }
        let worse = found.worse_than(&known).into_iter();
        problems.extend(worse.map(|problem| format!("{}: {problem}", part.name())));
    }
    if std::env::var_os("GPU_UPDATE").is_some() {
        std::fs::write(&path, page)?;
    }
    if problems.is_empty() {
        return Ok(());
    }
    let advice = "if the change is worth it, rewrite docs/gpu.md with GPU_UPDATE=1";
    Err(format!("{}\n{advice}", problems.join("\n")).into())
}

/// The SPIR-V module of a part of a scene's shader.
fn spirv(scene: &Scene, part: Part) -> Result<Vec<u8>, Failed> {
    match part {
        Part::Render => {
            let options = ShaderOptions::new().target(Target::Spirv).emit(Emit::Render);
            Ok(scene.write_shader(&options)?.code.into_bytes())
        }
        Part::Field => {
            let options = ShaderOptions::new().target(Target::Wgsl).emit(Emit::Field);
            let code = scene.write_shader(&options)?.code.into_bytes();
            Ok(field::spirv(&String::from_utf8(code)?)?)
        }
    }
}

/// Compiles a part of all examples for all chips.
fn measure(part: Part) -> Result<Table, Failed> {
    let manifest = radv::manifest().ok_or("there is no RADV driver")?;
    let folder = tempfile::tempdir()?;
    let mut names = Vec::new();
    for (name, scene) in compiled_examples()? {
        let path = folder.path().join(format!("{:03}.spv", names.len()));
        std::fs::write(path, spirv(scene, part)?)?;
        names.push(name.clone());
    }
    // Each chip needs a process of its own: the driver reads the environment once.
    let [first, second, third] = std::thread::scope(|scope| {
        let folder = folder.path();
        let run = |chip| scope.spawn(move || radv::statistics(chip, manifest, folder));
        Chip::ALL.map(run).map(|thread| thread.join())
    });
    let of = |run: std::thread::Result<Result<radv::Run, String>>| {
        run.map_err(|_| "a run of the driver panicked".to_owned())?
    };
    let runs = [of(first)?, of(second)?, of(third)?];
    let driver = runs[0].driver.clone();
    let row = |(index, name): (usize, String)| {
        let chips = runs.each_ref().map(|run| run.shaders.get(index).copied().unwrap_or_default());
        Row { name, chips }
    };
    Ok(Table { driver, rows: names.into_iter().enumerate().map(row).collect() })
}

/// Prints the time that the shader of each scene's picture takes to compile.
fn print_times(scenes: &str) -> Result<(), Failed> {
    let manifest = radv::manifest().ok_or("there is no RADV driver")?;
    for name in scenes.split_whitespace() {
        let text = std::fs::read_to_string(repository().join(name))?;
        let scene = Compiler::new().compile(name, &text)?;
        let folder = tempfile::tempdir()?;
        std::fs::write(folder.path().join("0.spv"), spirv(&scene, Part::Render)?)?;
        let mut least = u64::MAX;
        for _ in 0..RUNS {
            let run = radv::statistics(Chip::Navi21, manifest, folder.path())?;
            least = run.times.into_iter().fold(least, u64::min);
        }
        println!("{name}: {:.2} s", least as f64 * 1e-6);
    }
    Ok(())
}
