//! A session without a window: files on disk in, pictures drawn on the GPU out.
//!
//! The tests are ignored without a GPU, unless `SDFC_REQUIRE_GPU` is set.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Method, PictureOptions, no_progress};

use sdfc_render::{Gpu, HIT, testing};
use sdfc_viewer::render::picture::Picture;
use sdfc_viewer::render::window_device::WindowDevice;
use sdfc_viewer::scene::model::{Engine, Model};
use sdfc_viewer::session::Session;
use sdfc_viewer::views::mode::ViewMode;

/// Long enough for a busy machine and a software GPU; reached only if a test fails.
const TIMEOUT: Duration = Duration::from_secs(300);
const SIZE: [u32; 2] = [96, 64];

type Test = fn() -> Result<(), Failed>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let required = std::env::var_os("SDFC_REQUIRE_GPU").is_some();
    let ignored = !required && Gpu::new().is_err();
    let tests: [(&str, Test); 13] = [
        ("a_changed_number_makes_no_pipeline", numbers),
        ("a_changed_number_in_a_rerolled_scene_makes_no_pipeline", many),
        ("a_param_that_decides_what_is_built_compiles_the_scene_again", counts),
        ("a_broken_scene_keeps_model_and_picture", broken),
        ("a_picture_is_refined_to_full_resolution_and_then_antialiased", refined),
        ("all_views_are_computed_from_one_image", views),
        ("all_methods_draw_as_the_command_line_does", methods),
        ("the_projection_can_differ_from_the_scenes_camera", parallel),
        ("regions_are_panned_instead_of_turned", planar),
        ("a_software_driver_leaves_long_formulas_to_the_cpu", long),
        ("a_moving_picture_stays_on_the_device_of_the_window", on_window),
        ("lost_devices_are_opened_again", lost),
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

    /// Does what the window does until the condition holds.
    fn until(&mut self, holds: impl Fn(&Session) -> bool) -> Result<(), Failed> {
        let start = Instant::now();
        while !holds(&self.session) {
            if start.elapsed() > TIMEOUT {
                return Err(format!("still waiting: {:?}", self.session.problem).into());
            }
            std::thread::sleep(Duration::from_millis(2));
            self.session.poll();
            self.session.request_picture(SIZE, false);
        }
        Ok(())
    }

    fn model(&self) -> Result<Arc<Model>, Failed> {
        self.session.model.clone().ok_or_else(|| "there is no model".into())
    }

    fn picture(&self) -> Result<&Picture, Failed> {
        self.session.picture.as_deref().ok_or_else(|| "there is no picture".into())
    }

    /// Waits for the finished picture of the newest model.
    fn finish(&mut self) -> Result<(), Failed> {
        self.until(|session| {
            let (Some(model), Some(picture)) = (&session.model, session.known_picture()) else {
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

fn on_window() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    let gpu = Gpu::new()?;
    fixture.session.set_window_device(Some(WindowDevice::new(gpu.clone())));
    fixture.until(|session| session.model.as_ref().is_some_and(|model| model.on_window))?;
    fixture.finish()?;
    // The same rays: the picture that is there serves.
    fixture.session.request_picture(SIZE, true);
    fixture.finish()?;
    let start = Instant::now();
    let mut turns = 0;
    while fixture.session.moving.is_none() {
        expect(start.elapsed() < TIMEOUT, "no picture stays on the device")?;
        fixture.session.move_camera(|camera| camera.orbit(0.01, 0.0));
        fixture.session.request_picture(SIZE, true);
        turns += 1;
        std::thread::sleep(Duration::from_millis(2));
        fixture.session.poll();
    }
    let moving = fixture.session.moving.clone().ok_or("it is there")?;
    expect(turns > 0 && fixture.session.pixel_info([0.5, 0.5]).is_none(), "its pixels are known")?;
    expect(moving.texture.size() == SIZE.map(|side| side.div_ceil(moving.divisor)), "its size")?;
    let bytes = testing::read_texture(&gpu, &moving.texture)?;
    let red = bytes.chunks_exact(4).filter(|pixel| pixel[0] / 2 > pixel[2]).count();
    expect(red * 20 > bytes.len() / 4, "it does not show the ball")?;
    // At rest the pixels are known again.
    fixture.finish()?;
    expect(fixture.session.moving.is_none(), "the moving picture is still shown")?;
    let info = fixture.session.pixel_info([0.5, 0.5]).ok_or("no pixel")?;
    expect(info.status == HIT, "the ball is not in the middle")
}

fn numbers() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    fixture.finish()?;
    let (first, before) = (fixture.model()?, fixture.picture()?.counts.hit);
    fixture.write(&ball("1.5"))?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.source.contains("1.5")))?;
    fixture.finish()?;
    let (second, after) = (fixture.model()?, fixture.picture()?.counts.hit);
    expect(after > before * 2, "the ball has not grown")?;
    expect((first.pipelines, second.pipelines) == (1, 1), "a number made a pipeline")?;
    expect(second.build_times.pipeline.is_none(), "time was spent on a pipeline")?;
    fixture.write(&ball("1.5").replace("sphere(1.5)", "sphere(1.5) - sphere(0.5)"))?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.source.contains(" - ")))?;
    expect(fixture.model()?.pipelines == 2, "another structure made no pipeline")?;
    fixture.finish()
}

/// The other param of the scene changes without a compilation.
fn counts() -> Result<(), Failed> {
    let text = "param n: int = 2 in 1..9\nparam r = 0.3 in 0.1..0.4\n\
                union(for i in 0..n: sphere(r).translate(x: i - 1))\n\
                camera(eye: [0, 0, 12], target: 0, fov: 40deg)\nsun()\n";
    let mut fixture = Fixture::new(text)?;
    fixture.finish()?;
    let (first, before) = (fixture.model()?, fixture.picture()?.counts.hit);
    let set = |fixture: &mut Fixture, name: &str, value: f64| {
        let params = &mut fixture.session.param_values.params;
        params.insert(name.to_owned(), [value, 0.0, 0.0, 0.0]);
    };
    set(&mut fixture, "n", 4.0);
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.serial > first.serial))?;
    fixture.finish()?;
    let (second, after) = (fixture.model()?, fixture.picture()?.counts.hit);
    expect(after > before * 3 / 2, "there are not more balls")?;
    expect(second.serial == first.serial + 1, "the scene was compiled more than once")?;
    set(&mut fixture, "r", 0.1);
    let hits = |it: &Session| it.picture.as_ref().map_or(after, |it| it.counts.hit);
    fixture.until(|it| hits(it) < after / 4)?;
    expect(fixture.model()?.serial == second.serial, "a per-frame param compiled the scene")?;
    fixture.session.param_values.params.clear();
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.serial > second.serial))?;
    fixture.until(|it| hits(it) == before)
}

/// The numbers of a rerolled scene are in lists.
fn many() -> Result<(), Failed> {
    let leaf = |index: u32| {
        let kind = if index.is_multiple_of(2) { "sphere" } else { "box" };
        let [x, y] = [index % 20, index / 20].map(|it| 0.3 * f64::from(it) - 3.0);
        format!("{kind}(0.1{index:03}).translate([{x}, {y}, 0.0{index}])\n")
    };
    let text: String = (0..400).map(leaf).collect();
    let text = text + "camera(eye: [0, 0, 12], target: 0, fov: 40deg)\nsun()\n";
    let mut fixture = Fixture::new(&text)?;
    fixture.finish()?;
    let before = fixture.picture()?.counts.hit;
    expect(!fixture.model()?.scene.report().loops.is_empty(), "there are no loops")?;
    for ball in ["sphere(0.1190)", "sphere(0.1390)"] {
        let edited = text.replace(ball, "sphere(1.5)");
        fixture.write(&edited)?;
        fixture.until(|it| it.model.as_ref().is_some_and(|it| it.source == edited))?;
        fixture.finish()?;
        let (model, after) = (fixture.model()?, fixture.picture()?.counts.hit);
        expect(model.pipelines == 1, "a number made a pipeline")?;
        expect(after > before + 100, "the ball has not grown")?;
    }
    // The first source again, with the lists of the first.
    fixture.write(&text)?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.source == text))?;
    fixture.finish()?;
    expect(fixture.picture()?.counts.hit == before, "another picture of the same source")
}

fn broken() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    fixture.finish()?;
    let (model, pictures) = (fixture.model()?.serial, fixture.session.picture_count);
    fixture.write("spere(1)\n")?;
    fixture.until(|session| session.diagnostics.errors() == 1)?;
    expect(fixture.model()?.serial == model, "the model is another one")?;
    expect(fixture.session.picture_count == pictures, "something was drawn")?;
    // The last good scene still moves.
    fixture.session.move_camera(|camera| camera.orbit(0.1, 0.0));
    fixture.until(|session| session.picture_count > pictures)?;
    // The projection changes, then a device is lost.
    fixture.session.move_camera(|camera| camera.set_parallel(true));
    fixture.until(|it| it.picture.as_ref().is_some_and(|it| it.finished && it.view.parallel))?;
    expect(fixture.session.diagnostics.errors() == 1, "the error is not reported")?;
    let model = fixture.model()?;
    let Engine::Gpu(pipeline) = &model.engine else { return Err("no device".into()) };
    testing::lose(pipeline.gpu());
    let pictures = fixture.session.picture_count;
    fixture.session.move_camera(|camera| camera.orbit(0.1, 0.0));
    fixture.until(|session| session.picture_count > pictures)?;
    std::fs::remove_file(&fixture.path)?;
    fixture.until(|session| session.problem.is_some())?;
    fixture.write(&ball("0.5"))?;
    fixture.until(|it| it.model.as_ref().is_some_and(|it| it.source.contains("0.5")))?;
    expect(fixture.session.problem.is_none(), "the problem is over and still reported")
}

fn refined() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    fixture.session.samples = Some(4);
    fixture.until(|session| session.picture_count > 0)?;
    fixture.finish()?;
    let picture = fixture.picture()?;
    expect((picture.divisor, picture.samples) == (1, 4), "it is not finished")?;
    expect(picture.image.size() == SIZE, "it has another size")?;
    let info = fixture.session.pixel_info([0.5, 0.5]).ok_or("nothing is there")?;
    expect(info.status == HIT && (info.depth - 4.0).abs() < 0.01, &format!("{info:?}"))?;
    let distance = info.distance.ok_or("no field")?;
    expect(distance.abs() < 0.01, &format!("{info:?}"))
}

fn views() -> Result<(), Failed> {
    // A blend is not analytic: it is marched.
    let blend = "union(sphere(0.8), box([1, 1, 1]).translate(x: 0.8), blend: smooth(0.4))\n";
    let mut fixture = Fixture::new(blend)?;
    fixture.session.samples = Some(1);
    fixture.finish()?;
    let image = Arc::clone(&fixture.picture()?.image);
    for mode in ViewMode::ALL {
        fixture.session.mode = mode;
        fixture.until(|session| {
            session.picture.as_ref().is_some_and(|picture| picture.request.mode == mode)
        })?;
        let picture = fixture.picture()?;
        expect(Arc::ptr_eq(&picture.image, &image), "the rays were drawn again")?;
        let first = &picture.rgba[..4];
        let differs = picture.rgba.chunks_exact(4).any(|pixel| pixel != first);
        expect(differs || mode == ViewMode::OutOfSteps, &format!("{mode:?} is blank"))?;
    }
    Ok(())
}

/// For a certified field, and for one that grows faster than the distance.
fn methods() -> Result<(), Failed> {
    let flower = "solid flower() = pow(length(p), 3) - 0.5 - 0.45 * sin(3 * atan2(p.z, p.x)) * pow(length(p.xz), 2)\n\
                  flower()\ncamera(eye: [1, 2, 3], target: [0, 0, 0], fov: 40deg)\n";
    for text in [ball("1").as_str(), flower] {
        let mut fixture = Fixture::new(text)?;
        fixture.session.samples = Some(1);
        for method in Method::all() {
            fixture.session.update_build(|build| build.method = Some(method));
            let serial = fixture.session.model.as_ref().map_or(0, |model| model.serial);
            fixture.until(|session| {
                session.problem.is_some()
                    || session.model.as_ref().is_some_and(|model| model.serial > serial)
            })?;
            expect(fixture.session.problem.is_none(), &format!("{:?}", fixture.session.problem))?;
            fixture.finish()?;
            let model = fixture.model()?;
            let options = PictureOptions::new().size(SIZE).method(method).samples(Some(1));
            let expected = model.scene.render(&options, &mut no_progress)?;
            let (shown, meant) = (fixture.picture()?.counts, expected.image.counts());
            let what = format!("{method}: {shown:?}, not {meant:?}");
            expect(model.method.name() == expected.stats.method, &what)?;
            expect(shown.hit.abs_diff(meant.hit) <= 2, &what)?;
            expect(shown.capped.abs_diff(meant.capped) <= 2, &what)?;
            // The other methods step over an uncertified field.
            expect(!["auto", "interval"].contains(&method.name()) || shown.hit > 100, &what)?;
        }
    }
    Ok(())
}

/// With both projections rays end on the ball, and `render` draws the same picture.
fn parallel() -> Result<(), Failed> {
    let camera = "camera(eye: [0, 0, 5], target: [0, 0, 0], ";
    for lens in ["fov: 40deg)\n", "height: 4)\n"] {
        let mut fixture = Fixture::new(&format!("sphere(1)\n{camera}{lens}"))?;
        fixture.finish()?;
        for parallel in [true, false, true] {
            fixture.session.move_camera(|camera| camera.set_parallel(parallel));
            let is_drawn = |it: &Picture| it.finished && it.view.parallel == parallel;
            fixture.until(|session| session.picture.as_deref().is_some_and(is_drawn))?;
            let Picture { image, view, request, counts, .. } = fixture.picture()?;
            let is_hit =
                |(x, y): &(u32, u32)| image.pixel(*x, *y).is_some_and(|it| it.status == HIT);
            let off = |(x, y): (u32, u32)| {
                let ([start, direction], depth) = (view.ray(x, y), image.pixel(x, y)?.depth);
                let point = start + direction * f64::from(depth);
                Some((point.length() - 1.0).abs())
            };
            let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
            let worst = pixels.filter(is_hit).filter_map(off).fold(0.0, f64::max);
            expect(worst < 0.01, &format!("{lens} {parallel}: rays end {worst} off the ball"))?;
            let pose = Some(request.pose);
            let options = PictureOptions::new().size(SIZE).pose(pose).samples(1);
            let file = request.model.scene.render(&options, &mut no_progress)?;
            expect(file.image.counts() == *counts, &format!("{:?}", file.image.counts()))?;
        }
    }
    Ok(())
}

/// A drag moves a planar picture, and every view of it is computed.
fn planar() -> Result<(), Failed> {
    let text = "circle(1).color(#f00)\nrect([0.5, 0.5]).color(#00f)\n";
    let mut fixture = Fixture::new(text)?;
    fixture.session.samples = Some(1);
    fixture.finish()?;
    let model = fixture.model()?;
    expect(model.parallel && model.pipelines == 1, "it is drawn twice")?;
    let info = |session: &Session| session.pixel_info([0.5, 0.5]);
    fixture.until(|session| info(session).is_some_and(|middle| middle.shape.is_some()))?;
    let middle = info(&fixture.session).ok_or("nothing is there")?;
    let shape = middle.shape.unwrap_or_default();
    expect(shape.contains("rect"), &format!("the middle shows {shape}"))?;
    expect(middle.distance.is_some_and(|distance| distance < -0.9), "not the union's field")?;
    // One unit to the right: the left edge of the disc is in the middle.
    let pictures = fixture.session.picture_count;
    fixture.session.move_camera(|camera| {
        let height = camera.pose().height_at_target();
        camera.orbit(1.0 / height, 0.0);
    });
    fixture.until(|session| session.picture_count > pictures)?;
    fixture.finish()?;
    let edge = fixture.session.pixel_info([0.5, 0.5]).ok_or("nothing is there")?;
    expect((edge.point.x + 1.0).abs() < 0.05, &format!("{edge:?}"))?;
    for mode in ViewMode::ALL {
        fixture.session.mode = mode;
        fixture.until(|session| {
            session.picture.as_ref().is_some_and(|picture| picture.request.mode == mode)
        })?;
    }
    fixture.session.compare(false);
    expect(fixture.session.accuracy.progress().is_none(), "rays are compared")
}

fn long() -> Result<(), Failed> {
    let rings: String = (0..1500)
        .map(|i| {
            let [x, y] = [f64::from(i * 37 % 1500) * 0.06, f64::from(i * 23 % 1500) * 0.05];
            let width = 0.01 + 0.0001 * f64::from(i % 7);
            format!("abs(length(p - [{x:.3}, {y:.3}]) - 0.03) - {width:.4},\n")
        })
        .collect();
    let mut fixture = Fixture::new(&format!("region page() = min({rings})\npage()\n"))?;
    fixture.finish()?;
    let model = fixture.model()?;
    let is_software = Gpu::new()?.info().software;
    expect(matches!(model.engine, Engine::Cpu(_)) == is_software, "another engine draws")?;
    let is_reported = model.note.as_ref().is_some_and(|note| note.contains("drawn on the CPU"));
    expect(is_reported == is_software, &format!("{:?}", model.note))?;
    // The next text is short.
    fixture.write(&ball("1"))?;
    fixture.until(|session| session.model.as_ref().is_some_and(|it| it.serial > model.serial))?;
    expect(matches!(fixture.model()?.engine, Engine::Gpu(_)), "the CPU still draws")
}

/// More losses than are allowed without a picture in between.
fn lost() -> Result<(), Failed> {
    let mut fixture = Fixture::new(&ball("1"))?;
    for loss in 0..6 {
        fixture.finish()?;
        let (model, pictures) = (fixture.model()?, fixture.session.picture_count);
        let Engine::Gpu(pipeline) = &model.engine else {
            return Err(format!("after {loss} losses the CPU draws").into());
        };
        testing::lose(pipeline.gpu());
        fixture.session.move_camera(|camera| camera.orbit(0.1, 0.0));
        fixture.until(|session| {
            session.model.as_ref().is_some_and(|it| it.serial > model.serial)
                && session.picture_count > pictures
        })?;
    }
    expect(!fixture.session.build().on_cpu, "the CPU draws")?;
    expect(fixture.session.build().device_generation == 6, "devices are opened once for each loss")
}

fn compared() -> Result<(), Failed> {
    let blend = "union(sphere(0.8), box([1, 1, 1]).translate(x: 0.8), blend: smooth(0.4))\n";
    let mut fixture = Fixture::new(blend)?;
    fixture.finish()?;
    fixture.session.compare(true);
    fixture.until(|session| session.accuracy.progress().is_none())?;
    fixture.session.poll();
    let result = fixture.session.accuracy.result.as_ref().ok_or("there is no result")?;
    expect(result.finished && result.refused.is_empty(), &format!("{result:?}"))?;
    let settings: usize = Method::all().map(|method| method.definition().chart_factors.len()).sum();
    expect(result.all.len() == settings, &format!("{} results", result.all.len()))?;
    let auto = result.all.iter().find(|it| (it.method.name(), it.setting) == ("auto", 1.0));
    let auto = auto.ok_or("auto is missing")?;
    expect(auto.failed() == 0 && auto.metrics.depth.pixels.p99 < 0.25, &format!("{auto:?}"))?;
    expect(auto.metrics == result.shown.metrics, "auto draws another picture than the shown one")?;
    // With a quarter of the steps that it needs, rays run out of steps or step over the surface.
    let fixed = result.all.iter().find(|it| (it.method.name(), it.setting) == ("fixed", 0.25));
    let fixed = fixed.ok_or("fixed is missing")?;
    expect(fixed.failed() > 100, &format!("{fixed:?}"))
}
