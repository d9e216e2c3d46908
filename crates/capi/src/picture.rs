//! Pictures of a scene.

use std::ffi::{CString, c_char, c_void};

use sdfc::{Backend, Method, PictureOptions, Pose, Tile};
use serde::Deserialize;

use crate::boundary::{Failure, boxed, free, guarded, handle, json, pointer_into, store, writable};
use crate::bytes::Bytes;
use crate::options::options;
use crate::progress::{Progress, Reporter};
use crate::scene::Scene;
use crate::status::Status;

/// A finished picture.
#[derive(Debug)]
pub struct Picture {
    image: sdfc::Image,
    /// Red, green, blue, alpha of each pixel.
    rgba: Vec<u8>,
    depths: Vec<f32>,
    described: CString,
}

/// The options of a picture.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct PictureKeys {
    size: Option<[u32; 2]>,
    region: Option<[u32; 4]>,
    backend: Option<String>,
    method: Option<String>,
    samples: Option<u32>,
    isolines: Option<f64>,
    camera: Option<Camera>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Camera {
    eye: [f64; 3],
    #[serde(default)]
    target: [f64; 3],
    #[serde(default = "upwards")]
    up: [f64; 3],
    /// Radians.
    fov: Option<f64>,
    height: Option<f64>,
}

fn upwards() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

impl Camera {
    fn pose(&self) -> Result<Pose, Failure> {
        let Self { eye, target, up, fov, height } = *self;
        let pose = match (fov, height) {
            (Some(_), Some(_)) => {
                let message = "the camera states `fov` and `height`: state one of them";
                return Err(Failure::argument(message));
            }
            (None, Some(height)) => Pose::with_height(eye, target, up, height),
            (fov, None) => Pose::with_fov(eye, target, up, fov.unwrap_or(Pose::FITTED_FOV)),
        };
        pose.map_err(Failure::argument)
    }
}

impl PictureKeys {
    fn options(&self) -> Result<PictureOptions, Failure> {
        let backend = self.backend.as_ref().map(|name| name.parse::<Backend>());
        let method = self.method.as_ref().map(|name| name.parse::<Method>());
        let tile = |[x, y, width, height]: [u32; 4]| Tile { origin: [x, y], size: [width, height] };
        let options = PictureOptions::new();
        let size = self.size.unwrap_or(options.size);
        Ok(options
            .size(size)
            .region(self.region.map(tile))
            .backend(backend.transpose().map_err(Failure::argument)?.unwrap_or_default())
            .method(method.transpose().map_err(Failure::argument)?)
            .samples(self.samples)
            .isolines(self.isolines)
            .pose(self.camera.as_ref().map(Camera::pose).transpose()?))
    }
}

/// Draws the scene, on the GPU or on all cores of the CPU.
///
/// `options` is a JSON object with these keys, all of them optional; null is the same as `{}`.
/// `size`: width and height in pixels, by default `[640, 360]`. `region`: the part of the picture
/// that is drawn: left, top, width, height in pixels. `backend`: `auto`, `gpu` or `cpu`; `auto`
/// draws on the CPU without a GPU. `method`: the ray method, by default the scene's or `auto`.
/// `samples`: rays per pixel. `isolines`: the distance between the isolines of a picture of
/// regions. `camera`: `eye`, `target`, `up`, three numbers each, and either `fov`, in radians, or
/// `height`, in scene units, for parallel rays; by default the scene's camera, or one that sees the
/// whole scene.
///
/// `progress` is called with `context`; it may be null.
///
/// Returns null if the machine cannot draw the scene, or `progress` stops the work. Free the
/// picture with `sdfc_picture_free`.
///
/// # Safety
///
/// `scene` is null or a valid scene. `options` is null or ends in a null byte. `progress` may be
/// called with `context`, and returns normally.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_render(
    scene: *const Scene,
    options: *const c_char,
    progress: Progress,
    context: *mut c_void,
) -> *mut Picture {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, keys, reporter) = unsafe {
            let keys = self::options::<PictureKeys>(options)?;
            (handle(scene)?, keys, Reporter::new(progress, context))
        };
        let options = keys.options()?.frame(scene.frame.clone());
        let mut report = |at: sdfc::Progress| reporter.report(at.done, at.total);
        let picture = scene.scene.render(&options, &mut report)?;
        finished(picture)
    })
}

fn finished(picture: sdfc::Picture) -> Result<Picture, Failure> {
    let sdfc::Picture { image, stats, note, unproven, .. } = picture;
    let described = serde_json::json!({ "note": note, "unproven": unproven, "stats": stats });
    let described = json(&described)?;
    let colors = image.to_srgb8();
    let rgba = colors
        .as_chunks::<3>()
        .0
        .iter()
        .flat_map(|[red, green, blue]| [*red, *green, *blue, u8::MAX]);
    let rgba = rgba.collect();
    let raster = image.depth_raster();
    let bytes = raster.bytes();
    let depths = bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Ok(Picture { image, rgba, depths, described })
}

/// Stores width and height of the picture in pixels.
///
/// # Safety
///
/// `picture` is null or a valid picture. `width` and `height` are null or valid for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_picture_size(
    picture: *const Picture,
    width: *mut u32,
    height: *mut u32,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let [columns, rows] = unsafe { handle(picture)? }.image.size();
        writable(height, 1)?;
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        unsafe {
            store(width, &[columns])?;
            store(height, &[rows])
        }
    })
}

/// Returns the colours of the pixels, row by row from the top: red, green, blue in sRGB and an
/// alpha of 255 for each. Returns null for null.
///
/// # Safety
///
/// `picture` is null or a valid picture, and is not freed while the bytes are used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_picture_rgba(picture: *const Picture) -> *const u8 {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer_into(picture, |picture| picture.rgba.as_ptr()) }
}

/// Returns the distance from the eye to the surface along the ray of each pixel, row by row from
/// the top, in scene units: infinite for a ray that hit nothing. Returns null for null.
///
/// # Safety
///
/// `picture` is null or a valid picture, and is not freed while the numbers are used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_picture_depths(picture: *const Picture) -> *const f32 {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer_into(picture, |picture| picture.depths.as_ptr()) }
}

/// Returns what is known about the picture as JSON. `note` says why device or method differ from
/// the options, and `unproven` says which part of the picture is unproven; both may be null.
/// `stats` has what `sdfc render --stats` writes. Returns null for null.
///
/// # Safety
///
/// `picture` is null or a valid picture, and is not freed while the string is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_picture_describe(picture: *const Picture) -> *const c_char {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer_into(picture, |picture| picture.described.as_ptr()) }
}

/// Writes the picture as a PNG file. Returns null for null. Free the result with `sdfc_bytes_free`.
///
/// # Safety
///
/// `picture` is null or a valid picture.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_picture_png(picture: *const Picture) -> *mut Bytes {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let bytes = unsafe { handle(picture)? }.image.to_png().map_err(sdfc::Error::from)?;
        Ok(Bytes(bytes))
    })
}

/// Frees a picture. Does nothing for null.
///
/// # Safety
///
/// The picture was returned by `sdfc_render` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_picture_free(picture: *mut Picture) {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { free(picture) }
}
