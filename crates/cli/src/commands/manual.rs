//! `sdfc manual`: the manual pages of all commands.

use clap::CommandFactory;
use clap_mangen::Man;

use crate::args::{Args, Manual};
use crate::failure::Failure;
use crate::output::Output;

/// Writes `sdfc.1`, and a page such as `sdfc-render.1` for each command.
///
/// # Errors
///
/// The folder does not exist or is not writable.
pub fn run(args: &Manual) -> Result<(), Failure> {
    let mut command = Args::command().disable_help_subcommand(true);
    // It gives the commands the names of their pages.
    command.build();
    let commands = command.get_subcommands().filter(|command| !command.is_hide_set());
    for command in std::iter::once(&command).chain(commands) {
        let page = Man::new(command.clone());
        let mut bytes = Vec::new();
        let rendered = page.render(&mut bytes);
        rendered.map_err(|e| Failure::Machine(format!("cannot write a manual page: {e}")))?;
        Output::File(args.folder.join(page.get_filename())).write(&bytes)?;
    }
    Ok(())
}
