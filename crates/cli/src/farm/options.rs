//! The options of `render` for work that is shared between machines.

use clap::ValueEnum;

use super::region::{Region, region};
use super::share::{Share, share};

/// Options for work that is shared between machines.
#[derive(clap::Args, Debug)]
pub struct Farm {
    /// Draw only a share of the frames: K/N is the K-th of N shares of equal size, such as 2/5
    #[arg(long, value_name = "K/N", requires = "frames", value_parser = share)]
    pub chunk: Option<Share>,
    /// Draw only a region of each picture, for `sdfc join`: X,Y,WxH in pixels from the upper left
    /// corner, or K/N, the K-th of N bands of rows. The region is added to the file's name
    #[arg(long, value_name = "X,Y,WxH|K/N", value_parser = region)]
    pub region: Option<Region>,
    /// Skip pictures that are finished: their files are whole, and say that this scene and these
    /// settings made them
    #[arg(long, conflicts_with = "stats")]
    pub resume: bool,
    /// How to report progress
    #[arg(long, value_enum, default_value_t, value_name = "FORM")]
    pub progress: ProgressForm,
}

/// How progress is reported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ProgressForm {
    /// A bar on stderr, if that is a terminal
    #[default]
    Bar,
    /// The same, and one line of JSON on stdout for each finished picture
    Json,
}

impl Farm {
    /// The options that do not fit a file that holds a whole animation, as they are written.
    pub fn for_separate_files(&self) -> Option<&'static str> {
        let stated = [
            (self.chunk.is_some(), "--chunk"),
            (self.region.is_some(), "--region"),
            (self.resume, "--resume"),
        ];
        stated.into_iter().find(|(is_stated, _)| *is_stated).map(|(_, name)| name)
    }
}
