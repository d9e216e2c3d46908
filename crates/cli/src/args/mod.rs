//! The command line arguments, parsed with clap.

mod compile;
mod geometry;
mod measurement;
mod render;
mod values;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{Arg, CommandFactory, Parser, Subcommand, ValueEnum};

pub use compile::Compile;
pub use geometry::{Bake, Contour, Exactness, Measure, Mesh};
pub use measurement::{Bench, Cache, Chart, Tune};
pub use render::{Join, Render};
pub use values::Assignment;
use values::Params;

/// Compiles scenes of signed distance functions to shaders and pictures.
#[derive(Debug, Parser)]
#[command(name = "sdfc", version, propagate_version = true, max_term_width = 100)]
#[command(
    after_help = "Exit codes: 0, success; 1, error in the scene; 2, invalid command line; 3, the \
                  machine cannot do it (no GPU, or a file that cannot be read or written); 130, \
                  stopped by Ctrl-C.\n\n`sdfc FILE.sdf` is short for `sdfc render FILE.sdf`."
)]
pub struct Args {
    /// Options of all commands.
    #[command(flatten)]
    pub global: Global,
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// Options of all commands.
#[derive(clap::Args, Debug)]
pub struct Global {
    /// When to use colour in messages
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    pub color: ColorChoice,
    /// Print only errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Print more about what is done
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// When messages are coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ColorChoice {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Create a scene to start from
    New(New),
    /// Print all errors and warnings of scenes
    Check(Check),
    /// Format scenes in the standard layout
    #[command(name = "fmt")]
    Format(Format),
    /// Write the shader of a scene
    Compile(Compile),
    /// Draw a picture of a scene
    Render(Render),
    /// Join the regions of a picture that were drawn separately
    Join(Join),
    /// Write a closed mesh of a scene, with a proven error
    Mesh(Mesh),
    /// Write the outlines of a section of a scene, with a proven error
    Contour(Contour),
    /// Measure volume, center of mass, inertia and extent, as proven intervals
    Measure(Measure),
    /// Write a grid of distances, with a proven error of interpolation
    Bake(Bake),
    /// Show a scene in a window that updates when its file changes
    View(View),
    /// Explain how a scene is compiled: cost, ray method, bounds, Lipschitz constants
    Explain(Explain),
    /// Compare the speed of the specialised shader with shaders that interpret the scene
    Bench(Bench),
    /// Look up shapes, operators, functions, settings, types and error codes
    Doc(Doc),
    /// Print the script with which a shell completes commands and options
    Completions(Completions),
    /// Write the manual pages of all commands into a folder
    Manual(Manual),
    /// Serve an editor: the Language Server Protocol over stdin and stdout
    Lsp(Lsp),
    /// Compare the cost and the error of all ray methods on a scene
    Chart(Chart),
    /// Find the cheapest ray method and setting within an error limit
    Tune(Tune),
}

impl Command {
    /// Returns true if the command may open a GPU.
    pub fn opens_gpu(&self) -> bool {
        match self {
            Self::Render(_) | Self::Bench(_) | Self::Lsp(_) | Self::Chart(_) | Self::Tune(_) => {
                true
            }
            Self::New(_)
            | Self::Check(_)
            | Self::Format(_)
            | Self::Compile(_)
            | Self::Join(_)
            | Self::Mesh(_)
            | Self::Contour(_)
            | Self::Measure(_)
            | Self::Bake(_)
            | Self::View(_)
            | Self::Explain(_)
            | Self::Doc(_)
            | Self::Completions(_)
            | Self::Manual(_) => false,
        }
    }
}

/// Arguments of `completions`.
#[derive(clap::Args, Debug)]
pub struct Completions {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// Arguments of `manual`.
#[derive(clap::Args, Debug)]
pub struct Manual {
    /// An existing folder
    pub folder: PathBuf,
}

/// Arguments of `lsp`.
#[derive(clap::Args, Debug)]
pub struct Lsp {
    /// Has no effect: some editors add it to say what is the default
    #[arg(long, hide = true)]
    pub stdio: bool,
}

/// Arguments of `new`.
#[derive(clap::Args, Debug)]
pub struct New {
    /// The file, which must not exist; without an extension it gets .sdf
    pub file: PathBuf,
}

/// Arguments of `check`.
#[derive(clap::Args, Debug)]
pub struct Check {
    /// Scenes; `-` is stdin
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print the diagnostics to stdout as JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `fmt`.
#[derive(clap::Args, Debug)]
pub struct Format {
    /// Scenes, formatted in place; `-` formats stdin to stdout
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Change nothing, and fail if a file is not formatted
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `view`.
#[derive(clap::Args, Debug)]
pub struct View {
    /// The scene
    pub file: PathBuf,
}

/// Arguments of `explain`.
#[derive(clap::Args, Debug)]
pub struct Explain {
    /// The scene; `-` is stdin
    pub file: PathBuf,
    /// Values of params.
    #[command(flatten)]
    pub params: Params,
    /// Print JSON to stdout
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `doc`.
#[derive(clap::Args, Debug)]
pub struct Doc {
    /// A name, a topic, a code such as E0104, or a word of a description [default: everything]
    pub name: Option<String>,
    /// Print JSON to stdout
    #[arg(long)]
    pub json: bool,
}

/// Returns the arguments of the process with the default command, `render`, before a scene that
/// stands in place of a command. Options of `render` may precede the scene.
pub fn with_command(args: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut args: Vec<OsString> = args.into_iter().collect();
    let is_scene = |word: &OsString| Path::new(word).extension().is_some_and(|it| it == "sdf");
    if first_word(&args).is_some_and(is_scene) {
        args.insert(1, "render".into());
    }
    args
}

/// Returns the first argument that is neither an option nor the value of an option of `render`.
fn first_word(args: &[OsString]) -> Option<&OsString> {
    let command = Args::command();
    let commands = [Some(&command), command.find_subcommand("render")];
    let options: Vec<&Arg> =
        commands.into_iter().flatten().flat_map(|command| command.get_arguments()).collect();
    let mut words = args.iter().skip(1);
    while let Some(word) = words.next() {
        let option = word.to_string_lossy();
        if option == "--" {
            return words.next();
        }
        if option == "-" || !option.starts_with('-') {
            return Some(word);
        }
        if is_before_value(&options, &option) {
            words.next();
        }
    }
    None
}

/// Returns true if the argument after this option is its value.
fn is_before_value(options: &[&Arg], option: &str) -> bool {
    let mut with_value = options.iter().filter(|known| known.get_action().takes_values());
    if let Some(name) = option.strip_prefix("--") {
        return with_value.any(|known| known.get_long() == Some(name));
    }
    // Of several letters, the first that takes a value takes the rest of the word.
    let shorts: Vec<char> = with_value.filter_map(|known| known.get_short()).collect();
    let mut letters = option.chars().skip(1);
    letters.any(|letter| shorts.contains(&letter)) && letters.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn a_scene_without_a_command_is_drawn() {
        let with = |line: &str| {
            let args = with_command(line.split(' ').map(OsString::from));
            args.join(std::ffi::OsStr::new(" ")).into_string().unwrap()
        };
        for options in [
            "",
            "-q ",
            "--color never ",
            "--color=never ",
            "-q --size 16x16 ",
            "-o o.png ",
            "-oo.png ",
            "-qo o.png ",
            "-o - ",
            "--set file=b.sdf --watch ",
            "-- ",
        ] {
            let line = format!("{options}a.sdf --size 2x2");
            assert_eq!(with(&format!("sdfc {line}")), format!("sdfc render {line}"));
        }
        for line in [
            "sdfc",
            "sdfc --help",
            "sdfc a.png",
            "sdfc check a.sdf",
            "sdfc view a.sdf",
            "sdfc --color never check a.sdf",
            "sdfc -q -- check a.sdf",
            "sdfc -o a.sdf",
            "sdfc -o a.sdf o.png",
        ] {
            assert_eq!(with(line), line);
        }
    }

    #[test]
    fn a_scene_after_options_is_parsed() {
        let line = "sdfc --color never -qo o.png --size 16x8 a.sdf";
        let args = with_command(line.split(' ').map(OsString::from));
        let args = Args::try_parse_from(args).unwrap();
        assert!(args.global.quiet && args.global.color == ColorChoice::Never);
        let Command::Render(render) = args.command else { panic!("another command") };
        assert_eq!((render.size, render.file), ([16, 8], PathBuf::from("a.sdf")));
        assert_eq!(render.output, Some(PathBuf::from("o.png")));
    }
}
