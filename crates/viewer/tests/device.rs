//! A session without a window: files on disk in, pictures of a device out.
//!
//! Reported as ignored where there is no adapter, unless `SDFC_REQUIRE_GPU` is set.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::march::METHODS;
use sdfc::render::{Gpu, HIT, testing};
use sdfc::{PictureOptions, no_progress};
use sdfc_viewer::mode::Mode;
use sdfc_viewer::model::{Engine, Model};
use sdfc_viewer::painter::Picture;
use sdfc_viewer::session::Session;

/// Long enough for a busy machine and a software adapter; reached only where a test fails.
const PATIENCE: Duration = Duration::from_secs(300);
const SIZE: [u32; 2] = [96, 64];

type Test = fn() -> Result<(), Failed>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let required = std::env::var_os("SDFC_REQUIRE_GPU").is_some();
    let ignored = !required && Gpu::new().is_err();
    let tests: [(&str, Test); 9] = [
        ("a_changed_number_makes_no_pipeline", numbers),
        ("a_changed_number_of_a_scene_of_many_parts_makes_no_pipeline", many),
        ("broken_text_keeps_model_and_picture", broken),
        ("a_picture_is_refined_to_full_resolution_and_then_smoothed", refined),
        ("all_views_are_drawn_from_one_picture", views),
        ("all_methods_draw_as_the_command_line_does", methods),
        ("rays_are_parallel_or_not_whatever_the_camera_of_the_scene_is", parallel),
        ("lost_devices_are_opened_anew", lost),
        ("all_methods_are_compared_with_the_oracle", compared),
    ];
    let trial = |(name, test)| Trial::test(name, test).with_ignored_flag(ignored);
    libtest_mimic::run(&arguments, tests.map(trial).into()).exit_code()
}

struct Fixture {
    session: Session,
    path: PathBuf,
    _folder: tempfile::TempDir,
}

impl Fixture {
    fn new(text: &str) -> Result<Self, Failed> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("scene.sdf");
        std::fs::write(&path, text)?;
        let session = Session::open(&path, Arc::new(|| {}))?;
        Ok(Self { session, path, _folder: folder })
    }

    fn write(&self, text: &str) -> Result<(), Failed> {
        Ok(std::fs::write(&self.path, text)?)
    }

    /// Does as the window does until it is so.
    fn until(&mut self, holds: impl Fn(&Session) -> bool) -> Result<(), Failed> {
        let start = Instant::now();
        while !holds(&self.session) {
            if start.elapsed() > PATIENCE {
                return Err(format!("still waiting: {:?}", self.session.trouble).into());
            }
            std::thread::sleep(Duration::from_millis(2));
            self.session.poll();
            self.session.ask(SIZE, false);
        }
        Ok(())
    }

    fn model(&self) -> Result<Arc<Model>, Failed> {
        self.session.model.clone().ok_or_else(|| "there is no model".into())
    }

    fn picture(&self) -> Result<&Picture, Failed> {
        self.session.picture.as_deref().ok_or_else(|| "there is no picture".into())
    }

    /// The picture of the newest model, done.
    fn finish(&mut self) -> Result<(), Failed> {
        self.until(|session| {
            let (Some(model), Some(picture)) = (&session.model, &session.picture) else {
                return false;
            };
            picture.finished && picture.request.model.serial == model.serial
        })
    }
}

fn expect(holds: bool, otherwise: &str) -> Result<(), Failed> {
    if holds { Ok(()) } else { Err(otherwise.into()) }
}

fn ball(radius: &str) -> String {
    format!(
        "sphere({radius}).color(#d94f30)\ncamera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)\n"
    )
}

fn numbers() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    fixture.finish()?;
    let (first, before) = (fixture.model()?, fixture.picture()?.counts.hit);
    fixture.write(&ball("1.5"))?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.text.contains("1.5")))?;
    fixture.finish()?;
    let (second, after) = (fixture.model()?, fixture.picture()?.counts.hit);
    expect(after > before * 2, "the ball has not grown")?;
    expect((first.pipelines, second.pipelines) == (1, 1), "a number made a pipeline")?;
    expect(second.stages.pipeline.is_none(), "time was spent on a pipeline")?;
    fixture.write(&ball("1.5").replace("sphere(1.5)", "sphere(1.5) - sphere(0.5)"))?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.text.contains(" - ")))?;
    expect(fixture.model()?.pipelines == 2, "another structure made no pipeline")?;
    fixture.finish()
}

/// Its numbers lie in lists, whichever of them it is.
fn many() -> Result<(), Failed> {
    let leaf = |place: u32| {
        let kind = if place.is_multiple_of(2) { "sphere" } else { "box" };
        let [x, y] = [place % 20, place / 20].map(|it| 0.3 * f64::from(it) - 3.0);
        format!("{kind}(0.1{place:03}).translate([{x}, {y}, 0.0{place}])\n")
    };
    let text: String = (0..400).map(leaf).collect();
    let text = text + "camera(eye: [0, 0, 12], target: 0, fov: 40deg)\n";
    let mut fixture = Fixture::new(&text)?;
    fixture.finish()?;
    let before = fixture.picture()?.counts.hit;
    expect(!fixture.model()?.scene.report().loops.is_empty(), "there are no loops")?;
    for ball in ["sphere(0.1190)", "sphere(0.1390)"] {
        let edited = text.replace(ball, "sphere(1.5)");
        fixture.write(&edited)?;
        fixture.until(|it| it.model.as_ref().is_some_and(|it| it.text == edited))?;
        fixture.finish()?;
        let (model, after) = (fixture.model()?, fixture.picture()?.counts.hit);
        expect(model.pipelines == 1, "a number made a pipeline")?;
        expect(after > before + 100, "the ball has not grown")?;
    }
    // As it was, from the lists of the first.
    fixture.write(&text)?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.text == text))?;
    fixture.finish()?;
    expect(fixture.picture()?.counts.hit == before, "another picture of the same text")
}

fn broken() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    fixture.finish()?;
    let (model, pictures) = (fixture.model()?.serial, fixture.session.pictures);
    fixture.write("spere(1)\n")?;
    fixture.until(|session| session.findings.errors() == 1)?;
    expect(fixture.model()?.serial == model, "the model is another one")?;
    expect(fixture.session.pictures == pictures, "something was drawn")?;
    // The last good scene still moves.
    fixture.session.move_camera(|orbit| orbit.turn(0.1, 0.0));
    fixture.until(|session| session.pictures > pictures)?;
    // Its rays become parallel, and a device is lost.
    fixture.session.move_camera(|orbit| orbit.set_parallel(true));
    fixture.until(|it| it.picture.as_ref().is_some_and(|it| it.finished && it.view.parallel))?;
    expect(fixture.session.findings.errors() == 1, "the text is broken and that is not told")?;
    let model = fixture.model()?;
    let Engine::Gpu(pipeline) = &model.engine else { return Err("no device".into()) };
    testing::lose(pipeline.gpu());
    let pictures = fixture.session.pictures;
    fixture.session.move_camera(|orbit| orbit.turn(0.1, 0.0));
    fixture.until(|session| session.pictures > pictures)?;
    std::fs::remove_file(&fixture.path)?;
    fixture.until(|session| session.trouble.is_some())?;
    fixture.write(&ball("0.5"))?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.text.contains("0.5")))?;
    expect(fixture.session.trouble.is_none(), "the trouble is over and still told")
}

fn refined() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    fixture.session.samples = Some(4);
    fixture.until(|session| session.pictures > 0)?;
    fixture.finish()?;
    let picture = fixture.picture()?;
    expect((picture.divisor, picture.samples) == (1, 4), "it is not finished")?;
    expect(picture.image.size() == SIZE, "it has another size")?;
    let look = fixture.session.look([0.5, 0.5]).ok_or("nothing is there")?;
    expect(look.status == HIT && (look.depth - 4.0).abs() < 0.01, &format!("{look:?}"))?;
    let distance = look.distance.ok_or("no field")?;
    expect(distance.abs() < 0.01, &format!("{look:?}"))
}

fn views() -> Result<(), Failed> {
    // A blend has no closed form: it is marched.
    let blend = "union(sphere(0.8), box([1, 1, 1]).translate(x: 0.8), blend: smooth(0.4))\n";
    let mut fixture = Fixture::new(blend)?;
    fixture.session.samples = Some(1);
    fixture.finish()?;
    let image = Arc::clone(&fixture.picture()?.image);
    for mode in Mode::ALL {
        fixture.session.mode = mode;
        fixture.until(|session| {
            session.picture.as_ref().is_some_and(|picture| picture.request.mode == mode)
        })?;
        let picture = fixture.picture()?;
        expect(Arc::ptr_eq(&picture.image, &image), "the rays were drawn again")?;
        let first = &picture.rgba[..4];
        let differs = picture.rgba.chunks_exact(4).any(|pixel| pixel != first);
        expect(differs || mode == Mode::Capped, &format!("{mode:?} is blank"))?;
    }
    Ok(())
}

/// Of a scene whose field is certified, and of one whose field grows faster than its distance.
fn methods() -> Result<(), Failed> {
    let flower = "solid flower() = pow(length(p), 3) - 0.5 - 0.45 * sin(3 * atan2(p.z, p.x)) * pow(length(p.xz), 2)\n\
                  flower()\ncamera(eye: [1, 2, 3], target: [0, 0, 0], fov: 40deg)\n";
    for text in [ball("1").as_str(), flower] {
        let mut fixture = Fixture::new(text)?;
        fixture.session.samples = Some(1);
        for method in METHODS {
            fixture.session.set_build(|build| build.method = Some(method.name.to_owned()));
            let serial = fixture.session.model.as_ref().map_or(0, |model| model.serial);
            fixture.until(|session| {
                session.trouble.is_some()
                    || session.model.as_ref().is_some_and(|model| model.serial > serial)
            })?;
            expect(fixture.session.trouble.is_none(), &format!("{:?}", fixture.session.trouble))?;
            fixture.finish()?;
            let model = fixture.model()?;
            let options = PictureOptions {
                size: SIZE,
                method: Some(method.name.to_owned()),
                samples: Some(1),
                ..PictureOptions::default()
            };
            let expected = model.scene.render(&options, &mut no_progress)?;
            let (shown, meant) = (fixture.picture()?.counts, expected.image.counts());
            let what = format!("{}: {shown:?}, not {meant:?}", method.name);
            expect(model.method == expected.stats.method, &what)?;
            expect(shown.hit.abs_diff(meant.hit) <= 2, &what)?;
            expect(shown.capped.abs_diff(meant.capped) <= 2, &what)?;
            // Others step over a field like that.
            expect(!["auto", "interval"].contains(&method.name) || shown.hit > 100, &what)?;
        }
    }
    Ok(())
}

/// A disc of the ball's own size, and the same in a file.
fn parallel() -> Result<(), Failed> {
    let camera = "camera(eye: [0, 0, 5], target: [0, 0, 0], ";
    for lens in ["fov: 40deg)\n", "height: 4)\n"] {
        let mut fixture = Fixture::new(&format!("sphere(1)\n{camera}{lens}"))?;
        fixture.finish()?;
        for parallel in [true, false, true] {
            fixture.session.move_camera(|orbit| orbit.set_parallel(parallel));
            let is_drawn = |it: &Picture| it.finished && it.view.parallel == parallel;
            fixture.until(|session| session.picture.as_deref().is_some_and(is_drawn))?;
            let Picture { image, view, request, counts, .. } = fixture.picture()?;
            let is_met =
                |(x, y): &(u32, u32)| image.pixel(*x, *y).is_some_and(|it| it.status == HIT);
            let off = |(x, y): (u32, u32)| {
                let ([start, direction], depth) = (view.ray(x, y), image.pixel(x, y)?.depth);
                let point = start + direction * f64::from(depth);
                Some((point.length() - 1.0).abs())
            };
            let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
            let worst = places.filter(is_met).filter_map(off).fold(0.0, f64::max);
            expect(worst < 0.01, &format!("{lens} {parallel}: rays end {worst} off the ball"))?;
            let pose = Some(request.pose);
            let options = PictureOptions { size: SIZE, pose, ..PictureOptions::default() };
            let file = request.model.scene.render(&options, &mut no_progress)?;
            expect(file.image.counts() == *counts, &format!("{:?}", file.image.counts()))?;
        }
    }
    Ok(())
}

/// More often than devices are opened anew where no picture comes of it.
fn lost() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    for round in 0..6 {
        fixture.finish()?;
        let (model, pictures) = (fixture.model()?, fixture.session.pictures);
        let Engine::Gpu(pipeline) = &model.engine else {
            return Err(format!("after {round} losses the processor draws").into());
        };
        testing::lose(pipeline.gpu());
        fixture.session.move_camera(|orbit| orbit.turn(0.1, 0.0));
        fixture.until(|session| {
            session.model.as_ref().is_some_and(|it| it.serial > model.serial)
                && session.pictures > pictures
        })?;
    }
    expect(!fixture.session.build().on_cpu, "the processor draws")?;
    expect(fixture.session.build().renewed == 6, "devices are opened once for each loss")
}

fn compared() -> Result<(), Failed> {
    let blend = "union(sphere(0.8), box([1, 1, 1]).translate(x: 0.8), blend: smooth(0.4))\n";
    let mut fixture = Fixture::new(blend)?;
    fixture.finish()?;
    fixture.session.compare(true);
    fixture.until(|session| session.comparing.progress().is_none())?;
    fixture.session.poll();
    let judgement = fixture.session.comparing.judgement.as_ref().ok_or("there are no figures")?;
    expect(judgement.finished && judgement.refused.is_empty(), &format!("{judgement:?}"))?;
    let settings: usize = METHODS.iter().map(|method| method.chart_factors.len()).sum();
    expect(judgement.all.len() == settings, &format!("{} figures", judgement.all.len()))?;
    let auto = judgement.all.iter().find(|it| (it.method.as_str(), it.part) == ("auto", 1.0));
    let auto = auto.ok_or("auto is missing")?;
    expect(auto.failed() == 0 && auto.metrics.depth.pixels.p99 < 0.25, &format!("{auto:?}"))?;
    expect(auto.metrics == judgement.shown.metrics, "auto draws otherwise than what is shown")?;
    // With a quarter of the steps that it needs, it does not get there: rays run out of steps, or step over what they look for,
    // which of both depends on where steps fall.
    let fixed = judgement.all.iter().find(|it| (it.method.as_str(), it.part) == ("fixed", 0.25));
    let fixed = fixed.ok_or("fixed is missing")?;
    expect(fixed.failed() > 100, &format!("{fixed:?}"))
}
