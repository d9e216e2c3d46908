//! Draws a Bevy app into an image, without a window, and reads the image back.

#![allow(clippy::expect_used, reason = "what fails here ends the example or the test")]

use std::sync::{Arc, Mutex};

use bevy::app::{PanicHandlerPlugin, PluginsState, TerminalCtrlCHandlerPlugin};
use bevy::camera::RenderTarget;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use sdfc_bevy::{SdfcPlugin, SdfcSolid, SdfcStatus};

/// A picture: red, green, blue and alpha of each pixel in sRGB, row by row from the top.
#[derive(Clone, Debug)]
pub struct Picture {
    pub size: [u32; 2],
    pub bytes: Vec<u8>,
}

/// An app without a window. Its time stands still.
pub struct Headless {
    pub app: App,
    target: Handle<Image>,
    size: [u32; 2],
}

/// Frames after which everything that a scene needs is on the GPU.
const FRAMES: usize = 4;
/// Frames after which a scene that is not ready never will be.
const MOST_FRAMES: usize = 200;

impl Headless {
    /// An app with a target of `size` pixels. Its width is a multiple of 64, so that the rows of
    /// the picture that is read back have no padding. Assets are read from `folder`.
    pub fn new(size: [u32; 2], folder: &str) -> Self {
        let mut app = App::new();
        let window = WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        };
        let assets = AssetPlugin { file_path: folder.to_owned(), ..default() };
        let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
        // Several apps in one program cannot each set the program's logger and handlers.
        let plugins = DefaultPlugins
            .set(window)
            .set(assets)
            .set(render)
            .disable::<LogPlugin>()
            .disable::<PanicHandlerPlugin>()
            .disable::<TerminalCtrlCHandlerPlugin>()
            .disable::<PipelinedRenderingPlugin>();
        app.add_plugins((plugins, SdfcPlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(std::time::Duration::ZERO));
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        let format = TextureFormat::Rgba8UnormSrgb;
        let mut image = Image::new_target_texture(size[0], size[1], format, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        Self { app, target, size }
    }

    /// What a camera must draw to.
    pub fn target(&self) -> RenderTarget {
        RenderTarget::Image(self.target.clone().into())
    }

    /// Draws frames until the picture is complete, and returns it.
    pub fn picture(&mut self) -> Picture {
        for _ in 0..MOST_FRAMES {
            self.app.update();
            let mut solids = self.app.world_mut().query_filtered::<&SdfcStatus, With<SdfcSolid>>();
            if solids.iter(self.app.world()).all(|status| *status != SdfcStatus::Waiting) {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        for _ in 0..FRAMES {
            self.app.update();
        }
        let read: Arc<Mutex<Option<Vec<u8>>>> = Arc::default();
        let found = Arc::clone(&read);
        let world = self.app.world_mut();
        let reader = world
            .spawn(Readback::texture(self.target.clone()))
            .observe(move |complete: On<ReadbackComplete>| {
                *found.lock().expect("no other thread panicked") = Some(complete.data.clone());
            })
            .id();
        let mut bytes = None;
        for _ in 0..MOST_FRAMES {
            self.app.update();
            bytes = read.lock().expect("no other thread panicked").take();
            if bytes.is_some() {
                break;
            }
        }
        self.app.world_mut().despawn(reader);
        Picture { size: self.size, bytes: bytes.expect("the GPU returns the picture") }
    }
}

impl Picture {
    /// Writes the picture as PNG.
    pub fn save(
        &self,
        path: impl AsRef<std::path::Path>,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let file = std::io::BufWriter::new(std::fs::File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.size[0], self.size[1]);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&self.bytes)?;
        Ok(())
    }
}
