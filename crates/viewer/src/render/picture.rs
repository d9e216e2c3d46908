//! The requests to the render worker, and its reports.

use std::sync::Arc;

use sdfc::FrameValues;
use sdfc_render::{Clock, DeviceTexture, EvaluationCounts, Image, PixelCounts, Pose, View};

use crate::scene::model::Model;
use crate::views::legend::Legend;
use crate::views::mode::ViewMode;
use crate::views::slice_plane::SlicePlane;

/// A request for a picture.
#[derive(Clone, Debug)]
pub struct RenderRequest {
    /// The scene.
    pub model: Arc<Model>,
    /// Param values and time.
    pub frame: FrameValues,
    /// The camera.
    pub pose: Pose,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The view.
    pub mode: ViewMode,
    /// The plane of [`ViewMode::Slice`].
    pub slice: SlicePlane,
    /// True if the next request is likely to differ, so that one pass is enough.
    pub moving: bool,
    /// True if finer passes may take long.
    pub refine: bool,
    /// Samples per pixel of the finished picture.
    pub samples: u32,
    /// The ray method's parameter as a multiple of the scene's.
    pub tolerance: f64,
}

impl RenderRequest {
    /// Returns true if `other` asks for the same picture in the same way.
    pub fn is_same(&self, other: &Self) -> bool {
        self.has_same_rays(other)
            && (self.mode, self.slice) == (other.mode, other.slice)
            && (self.moving, self.refine) == (other.moving, other.refine)
            && self.samples == other.samples
    }

    /// Returns true if `other` marches the same rays, so that an image of one serves the other.
    pub fn has_same_rays(&self, other: &Self) -> bool {
        self.model.serial == other.model.serial
            && self.size == other.size
            && self.pose == other.pose
            && self.frame == other.frame
            && self.tolerance == other.tolerance
    }
}

/// A picture to show.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The request that it answers.
    pub request: Arc<RenderRequest>,
    /// Depth, status and evaluation count of the one ray through the middle of each pixel.
    pub image: Arc<Image>,
    /// The rays of `image`.
    pub view: View,
    /// Red, green, blue, alpha of each pixel in sRGB.
    pub rgba: Vec<u8>,
    /// Width and height of `rgba`. While a slow view is being computed, it is smaller than `image`.
    pub rgba_size: [u32; 2],
    /// The meaning of the colours.
    pub legend: Legend,
    /// The requested width and height are divided by this in `image`.
    pub divisor: u32,
    /// Width and height of `image` are divided by this in `rgba`.
    pub stride: u32,
    /// Samples per pixel.
    pub samples: u32,
    /// True if no finer picture follows.
    pub finished: bool,
    /// Milliseconds to draw one ray per pixel.
    pub milliseconds: f64,
    /// The clock that measured `milliseconds`.
    pub clock: Clock,
    /// Milliseconds from receiving the request to reporting the picture.
    pub latency: f64,
    /// Evaluations of the field per pixel.
    pub evaluations: EvaluationCounts,
    /// Counts of rays by their status.
    pub counts: PixelCounts,
}

/// A picture of something that moves, which stays on the device of the window. Nothing of it is
/// known on the CPU.
#[derive(Clone, Debug)]
pub struct MovingPicture {
    /// The request that it answers.
    pub request: Arc<RenderRequest>,
    /// The picture.
    pub texture: DeviceTexture,
    /// The requested width and height are divided by this.
    pub divisor: u32,
    /// Milliseconds to draw one ray per pixel, by the CPU's clock.
    pub milliseconds: f64,
    /// Milliseconds from receiving the request to reporting the picture.
    pub latency: f64,
}

/// A report of the render worker.
#[derive(Debug)]
pub enum RenderEvent {
    /// A picture, which a finer one may follow.
    Picture(Box<Picture>),
    /// A picture that stays on the device, until another one of any kind follows.
    Moving(MovingPicture),
    /// The request could not be drawn.
    Failed {
        /// Why.
        message: String,
        /// True if another device may help.
        machine: bool,
        /// The model's [device generation](Model::device_generation).
        device_generation: u32,
    },
}
