//! `sdfc completions`: the script with which a shell completes commands and options.

use clap::CommandFactory;

use crate::args::{Args, Completions};
use crate::failure::Failure;
use crate::output;

/// Prints the script.
///
/// # Errors
///
/// Stdout cannot be written.
pub fn run(args: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "sdfc", &mut script);
    output::to_stdout(&script)
}
