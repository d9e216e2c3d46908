//! Draws the previews that editors ask for, and lists params.

use std::ops::ControlFlow;

use sdfc::{
    Compiler, Error, FrameValues, Painter, Param, ParamKind, Picture, PictureOptions, Pose, Scene,
    degrees,
};
use sdfc_lsp::{
    Answer, Ask, Draw, ParamInfo, ParamValue, Preview, PreviewCamera, PreviewLens, PreviewOptions,
    Question, Questions,
};
use sdfc_render::{Gpu, linear_to_srgb8};

/// Draws with the façade.
pub struct Drawer;

impl Draw for Drawer {
    fn answer_all(&self, questions: &Questions<'_>) {
        let mut device = None;
        let mut next = questions.next();
        while let Some(question) = next {
            let compiled = question.with_resolver(|resolver| {
                Compiler::new().resolver(resolver).compile(&question.name, &question.text)
            });
            next = match compiled {
                Ok(scene) => answer_about(&scene, &mut device, question, questions),
                Err(errors) => {
                    let first = errors.located().into_iter().find(|it| it.code.starts_with('E'));
                    let first = first.map(|it| format!(": {}", it.message)).unwrap_or_default();
                    question.answer(Err(format!("the scene has errors{first}")));
                    questions.next()
                }
            };
        }
    }
}

/// Answers questions as long as they are about one scene, and returns the first about another.
fn answer_about<'q>(
    scene: &Scene,
    device: &mut Option<Gpu>,
    first: Question<'q>,
    questions: &Questions<'q>,
) -> Option<Question<'q>> {
    let (name, revision) = (first.name.clone(), first.revision);
    let mut painter = None;
    let mut next = Some(first);
    while let Some(question) = next.take_if(|it| it.name == name && it.revision == revision) {
        let answer = match &question.ask {
            Ask::Params => Ok(Answer::Params(scene.params().iter().map(param).collect())),
            Ask::Preview(options) => {
                let drawn = preview(scene, (device, &mut painter), options, &question);
                drawn.map(Answer::Preview)
            }
        };
        question.answer(answer);
        next = questions.next();
    }
    next
}

fn preview<'s>(
    scene: &'s Scene,
    drawer: (&mut Option<Gpu>, &mut Option<Painter<'s>>),
    options: &PreviewOptions,
    question: &Question<'_>,
) -> Result<Preview, String> {
    let values = values(scene, options)?;
    let [width, height] = options.size;
    let pose = match &options.camera {
        Some(camera) => pose(camera)?,
        None => own_pose(scene, &values, f64::from(width) / f64::from(height))?,
    };
    let picture = paint(scene, drawer, options.size, pose, &values, question);
    let picture = picture.map_err(|e| e.to_string())?;
    let device = picture.stats.adapter.clone().unwrap_or_else(|| "CPU".to_owned());
    Ok(Preview {
        png: picture.image.to_png().map_err(|e| e.to_string())?,
        camera: camera(&pose),
        device,
        notes: picture.note.into_iter().chain(picture.unproven).collect(),
    })
}

/// The camera that the scene states, or one that sees the whole scene with its defaults: a slider
/// that makes the only shape larger must not draw the same picture from farther away.
fn own_pose(scene: &Scene, values: &FrameValues, aspect: f64) -> Result<Pose, String> {
    let stated = scene.program().settings.camera.is_some();
    let pose =
        if stated { scene.pose(values, aspect) } else { scene.pose(&scene.defaults(), aspect) };
    pose.map_err(|e| e.to_string())
}

/// Draws with the painter that there is, or makes one, which compiles the shader. The device stays
/// open from one scene to the next.
fn paint<'s>(
    scene: &'s Scene,
    (device, painter): (&mut Option<Gpu>, &mut Option<Painter<'s>>),
    size: [u32; 2],
    pose: Pose,
    values: &FrameValues,
    question: &Question<'_>,
) -> Result<Picture, Error> {
    if !scene.draws() {
        return Err(Error::NothingDrawn);
    }
    if !painter.as_mut().is_some_and(|known| known.aim(size, pose)) {
        // One ray for each pixel: a preview is drawn often.
        let options = PictureOptions::new().size(size).pose(pose).samples(1);
        if device.is_none() {
            *device = Gpu::new().ok();
        }
        *painter = Some(match device {
            Some(gpu) => scene.painter_on(gpu, &options)?,
            None => scene.painter(&options)?,
        });
    }
    let Some(drawer) = painter else { return Err(Error::NothingDrawn) };
    let picture = drawer.paint(values, 1, &mut |_| {
        if question.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    if picture.as_ref().is_err_and(Error::is_machine) {
        // The device may be lost.
        (*device, *painter) = (None, None);
    }
    picture
}

fn values(scene: &Scene, options: &PreviewOptions) -> Result<FrameValues, String> {
    let mut values = scene.defaults();
    for (name, value) in &options.values {
        let mut params = scene.params().iter();
        let angle = params.find(|it| it.name == *name && it.kind == ParamKind::Angle);
        let set = match (value, angle) {
            (ParamValue::Number(number), Some(param)) => match end(param, *number) {
                Some(end) => scene.set(&mut values, name, end),
                None => scene.set_param(&mut values, name, &format!("{number}deg")),
            },
            (ParamValue::Number(number), None) => scene.set(&mut values, name, *number),
            (ParamValue::Bool(truth), _) => scene.set(&mut values, name, *truth),
            (ParamValue::Text(text), _) => scene.set_param(&mut values, name, text),
        };
        set.map_err(|e| e.to_string())?;
    }
    values.time = options.time;
    Ok(values)
}

/// The end of an angle's range that a number of degrees means: `sdfc/params` rounds ends, and a
/// rounded one may lie outside.
fn end(param: &Param, number: f64) -> Option<f64> {
    param.range?.into_iter().find(|end| degrees(*end) == number)
}

fn param(param: &Param) -> ParamInfo {
    let [number, ..] = param.default;
    let (kind, default) = match param.kind {
        ParamKind::Number => ("number", ParamValue::Number(number)),
        ParamKind::Int => ("int", ParamValue::Number(number)),
        ParamKind::Angle => ("angle", ParamValue::Number(degrees(number))),
        ParamKind::Bool => ("bool", ParamValue::Bool(number != 0.0)),
        ParamKind::Color => ("color", ParamValue::Text(color(param.default))),
        ParamKind::Choice => {
            let choice = param.choices.get(number as usize).cloned().unwrap_or_default();
            ("choice", ParamValue::Text(choice))
        }
    };
    let angle = param.kind == ParamKind::Angle;
    let range = param.range.map(|range| if angle { range.map(degrees) } else { range });
    ParamInfo { name: param.name.clone(), kind, default, range, choices: param.choices.clone() }
}

/// A colour as a scene writes it.
fn color([red, green, blue, alpha]: [f64; 4]) -> String {
    let [red, green, blue] = [red, green, blue].map(|part| linear_to_srgb8(part as f32));
    let alpha = (alpha.clamp(0.0, 1.0) * 255.0).round() as u8;
    let opaque = format!("#{red:02x}{green:02x}{blue:02x}");
    if alpha == u8::MAX { opaque } else { format!("{opaque}{alpha:02x}") }
}

fn pose(camera: &PreviewCamera) -> Result<Pose, String> {
    let (parallel, half_height) = match camera.lens {
        PreviewLens::Fov(fov) if fov > 0.0 && fov < 180.0 => {
            (false, (fov.to_radians() / 2.0).tan())
        }
        PreviewLens::Height(height) if height > 0.0 => (true, height / 2.0),
        PreviewLens::Fov(fov) => {
            return Err(format!("`camera.fov` is between 0 and 180 degrees, not {fov}"));
        }
        PreviewLens::Height(height) => {
            return Err(format!("`camera.height` is greater than 0, not {height}"));
        }
    };
    if camera.eye == camera.target {
        return Err("`camera.eye` and `camera.target` are the same point".to_owned());
    }
    let [eye, target, up] = [camera.eye, camera.target, camera.up].map(Into::into);
    Ok(Pose { eye, target, up, parallel, half_height })
}

fn camera(pose: &Pose) -> PreviewCamera {
    let lens = if pose.parallel {
        PreviewLens::Height(pose.half_height * 2.0)
    } else {
        PreviewLens::Fov(degrees(2.0 * pose.half_height.atan()))
    };
    let [eye, target, up] = [pose.eye, pose.target, pose.up].map(|vector| vector.to_array());
    PreviewCamera { eye, target, up, lens }
}
