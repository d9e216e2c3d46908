//! `sdfc new`: a scene to start from.

use std::io::ErrorKind;

use crate::args::New;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

/// Writes the scene, and prints what to do with it.
///
/// # Errors
///
/// The file exists, or cannot be written.
pub fn run(args: &New, console: &Console) -> Result<(), Failure> {
    let mut path = args.file.clone();
    if path.extension().is_none() {
        path.set_extension("sdf");
    }
    let name = path.display();
    sdfc_files::create(&path, sdfc_examples::NEW.as_bytes()).map_err(|error| {
        if error.kind() == ErrorKind::AlreadyExists {
            Failure::Call(format!("{name} exists; choose another name"))
        } else {
            output::cannot_write(&path, &error)
        }
    })?;
    console.note(&format!(
        "{name}: a scene to start from\n  sdfc view {name}            a window that follows each save\n  \
         sdfc render {name} --watch  a picture that follows each save"
    ));
    Ok(())
}
