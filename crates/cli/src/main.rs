//! The command line of sdfc: arguments, files and exit codes around the `sdfc` library.
//!
//! Exit codes: 0, success; 1, error in the scene; 2, invalid command line; 3, the machine cannot do
//! it (no GPU, or a file that cannot be read or written); 130, stopped by Ctrl-C.
//!
//! Only this crate, the viewer and `sdfc-build` print, and only the first two end the process.

mod args;
mod cache;
mod commands;
mod console;
mod driver;
mod failure;
mod farm;
mod interrupt;
mod output;
mod sequence;

use std::process::ExitCode;

use args::{Args, Command};
use clap::Parser;
use console::Console;
use failure::Failure;

fn main() -> ExitCode {
    let args = Args::parse_from(args::with_command(std::env::args_os()));
    if args.command.opens_gpu() {
        driver::silence();
    }
    let console = Console::new(&args.global);
    match run(&args, &console) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console.failure(&failure);
            failure.exit_code()
        }
    }
}

fn run(args: &Args, console: &Console) -> Result<(), Failure> {
    if args.global.quiet && args.global.verbose {
        let message = "`--quiet` prints only errors and `--verbose` prints more: write one of them";
        return Err(Failure::Call(message.to_owned()));
    }
    match &args.command {
        Command::New(args) => commands::new::run(args, console),
        Command::Check(args) => commands::check::run(args, console),
        Command::Format(args) => commands::format::run(args, console),
        Command::Compile(args) => commands::compile::run(args, console),
        Command::Render(args) => commands::render::run(args, console),
        Command::Join(args) => commands::join::run(args, console),
        Command::Mesh(args) => commands::mesh::run(args, console),
        Command::Contour(args) => commands::contour::run(args, console),
        Command::Measure(args) => commands::measure::run(args, console),
        Command::Bake(args) => commands::bake::run(args, console),
        Command::View(args) => commands::view::run(args),
        Command::Explain(args) => commands::explain::run(args, console),
        Command::Bench(args) => commands::bench::run(args, console),
        Command::Doc(args) => commands::doc::run(args, console),
        Command::Completions(args) => commands::completions::run(args),
        Command::Manual(args) => commands::manual::run(args),
        Command::Lsp(_) => commands::lsp::run(),
        Command::Chart(args) => commands::charts::run(args, console),
        Command::Tune(args) => commands::tune::run(args, console),
    }
}
