//! Drives the real window on a virtual display, as a user would: drags, turns the wheel, edits,
//! breaks and repairs the file, and looks at the screen.
//!
//! Needs `Xvfb` and `xdotool`, and a GPU driver that can show a window. The tests are ignored if a
//! program is missing, unless `SDFC_REQUIRE_GPU` is set.

mod display;
mod drag_and_drop;
mod unsaved_text;

use std::cell::Cell;
use std::process::{ExitCode, Stdio};
use std::time::Duration;

use image::RgbImage;
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_viewer::app::{DRAW_ON_WINDOW, LOSE_WINDOW};

use display::{
    Display, PICTURE, SIZE, Scene, Window, differ, expect, is_green, is_red, reds, viewer,
};

/// A pixel on the shape, beside the highlight.
const ON_SHAPE: [u32; 2] = [410, 370];

type Test = fn(Display) -> Result<(), Failed>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let missing: Vec<&str> = ["Xvfb", "xdotool"].into_iter().filter(|it| !is_there(it)).collect();
    let required = std::env::var_os("SDFC_REQUIRE_GPU").is_some();
    let trials: [(&str, Test); 16] = [
        ("an_edit_is_shown_and_a_broken_scene_keeps_the_picture", edits),
        ("the_camera_follows_the_pointer", camera),
        ("a_deleted_file_is_shown_again_when_it_comes_back", comes_back),
        ("a_file_with_crlf_and_bom_and_an_empty_file_are_followed", encodings),
        ("a_slider_changes_the_scene_and_keys_select_views", slider),
        ("without_a_scene_an_example_is_shown_and_exported", example),
        ("a_file_that_is_dropped_on_the_window_is_opened", dropped),
        ("the_window_survives_any_size_and_shows_the_newest_scene_after_hiding", sizes),
        ("closing_the_window_stores_the_settings", closing),
        ("a_window_whose_device_is_lost_is_replaced", lost),
        ("a_moving_picture_shows_the_scene_before_and_after_a_lost_device", moving),
        ("a_device_loss_within_a_frame_stores_the_settings", lost_midway),
        ("typed_text_survives_a_device_loss", unsaved_text::survives_a_loss_within_a_frame),
        ("an_idle_window_uses_no_cpu_time", idle),
        ("without_vulkan_the_cpu_draws_and_opengl_shows_the_window", no_vulkan),
        ("without_any_driver_the_program_says_what_to_install", no_driver),
    ];
    let trial = |(name, test): (&str, Test)| {
        let run = move || Display::open().and_then(test);
        Trial::test(name, run).with_ignored_flag(!missing.is_empty() && !required)
    };
    libtest_mimic::run(&arguments, trials.map(trial).into()).exit_code()
}

fn is_there(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

const BALL: &str = "sphere(1).color(#d94f30)\nbackground(#203040)\n\
                    camera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)\n";

fn edits(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    let ball = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    // A changed number.
    scene.write(&BALL.replace("sphere(1)", "sphere(1.6)"))?;
    let larger = window.settled(|picture| reds(picture) > reds(&ball) * 2)?;
    // Broken: diagnostics over the picture, and the ball still in the middle.
    scene.write("spere(1)\n")?;
    let broken = window.settled(|picture| differ(picture, &larger, [0..700, 40..200]) > 500)?;
    window.keep(&broken, "broken")?;
    expect(is_red(&broken, ON_SHAPE), "the last good picture is gone")?;
    // Another structure.
    let text = BALL.replace("sphere(1)", "box([1, 1, 1]).rotate(y: 30deg)");
    scene.write(&text.replace("#d94f30", "#30d94f"))?;
    let repaired = window.settled(|picture| is_green(picture, ON_SHAPE))?;
    window.keep(&repaired, "repaired")
}

fn camera(display: Display) -> Result<(), Failed> {
    let text = BALL.replace("sphere(1)", "box([1, 1, 1])");
    let scene = Scene::new(&text)?;
    let window = Window::open(&display, &scene)?;
    let before = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    let [x, y] = ON_SHAPE.map(|at| at.to_string());
    window.drag(ON_SHAPE, [120, 60])?;
    let turned = window.settled(|picture| differ(picture, &before, PICTURE) > 2000)?;
    window.keep(&turned, "turned")?;
    window.input(&["mousemove", &x, &y, "click", "4", "click", "4", "click", "4"])?;
    let nearer = window.settled(|picture| reds(picture) * 10 > reds(&turned) * 12)?;
    window.input(&["key", "h"])?;
    let home = window.settled(|picture| differ(picture, &before, PICTURE) < 200)?;
    expect(differ(&home, &nearer, PICTURE) > 2000, "the camera did not go home")
}

fn comes_back(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    window.settled(|picture| is_red(picture, ON_SHAPE))?;
    std::fs::remove_file(&scene.path)?;
    std::thread::sleep(Duration::from_millis(500));
    let gone = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    let temporary = scene.path.with_extension("new");
    std::fs::write(&temporary, BALL.replace("#d94f30", "#30d94f"))?;
    std::fs::rename(&temporary, &scene.path)?;
    let back = window.settled(|picture| is_green(picture, ON_SHAPE))?;
    expect(differ(&back, &gone, PICTURE) > 2000, "the new file is not shown")
}

fn encodings(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(&format!("\u{feff}{}", BALL.replace('\n', "\r\n")))?;
    let window = Window::open(&display, &scene)?;
    let ball = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    // The last good picture stays, and the status line says that nothing is drawn.
    scene.write("")?;
    let below = [500..1000, 610..640];
    window.settled(|picture| {
        is_red(picture, ON_SHAPE) && differ(picture, &ball, below.clone()) > 50
    })?;
    scene.write(&BALL.replace("#d94f30", "#30d94f").replace('\n', "\r\n"))?;
    window.settled(|picture| is_green(picture, ON_SHAPE))?;
    Ok(())
}

fn slider(display: Display) -> Result<(), Failed> {
    let text = format!("param r = 0.6 in 0.5..1.6\n{}", BALL.replace("sphere(1)", "sphere(r)"));
    let scene = Scene::new(&text)?;
    let window = Window::open(&display, &scene)?;
    let small = window.settled(|picture| is_red(picture, ON_SHAPE) || reds(picture) > 500)?;
    // The slider's handle, a tenth of the way along.
    window.drag([832, 77], [90, 0])?;
    let large = window.settled(|picture| reds(picture) > reds(&small) * 3)?;
    window.keep(&large, "slider")?;
    window.input(&["key", "v"])?;
    let normals = window.settled(|picture| differ(picture, &large, PICTURE) > 5000)?;
    window.input(&["key", "question"])?;
    let help = window.settled(|picture| differ(picture, &normals, PICTURE) > 5000)?;
    window.keep(&help, "help")?;
    window.input(&["key", "Escape"])?;
    window.settled(|picture| differ(picture, &normals, PICTURE) < 200)?;
    Ok(())
}

fn example(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open_example(&display, &scene)?;
    let shown = window.settled(has_a_picture)?;
    window.keep(&shown, "example")?;
    let folder = scene.own().join("sdfc/examples");
    expect(folder.join("welcome.sdf").is_file(), "the example was not copied")?;
    window.input(&["key", "ctrl+e"])?;
    let dialog = window.seen(|picture| differ(picture, &shown, PICTURE) > 5000)?;
    window.keep(&dialog, "save")?;
    window.input(&["key", "Return"])?;
    let file = folder.join("welcome.png");
    window.until("no picture was exported", || Ok(file.is_file()))?;
    expect(image::image_dimensions(&file)? == (1920, 1080), "it has another size")
}

fn dropped(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    window.settled(|picture| is_red(picture, ON_SHAPE))?;
    let other = scene.path.with_file_name("other.sdf");
    std::fs::write(&other, BALL.replace("#d94f30", "#30d94f"))?;
    window.drop_file(&other)?;
    window.settled(|picture| is_green(picture, ON_SHAPE))?;
    window.input(&["search", "--name", "other.sdf"])
}

/// Returns true if the picture has more than one colour.
fn has_a_picture(picture: &image::RgbImage) -> bool {
    let [columns, rows] = PICTURE;
    let first = *picture.get_pixel(columns.start, rows.start);
    rows.flat_map(|y| columns.clone().map(move |x| (x, y)))
        .filter(|(x, y)| *picture.get_pixel(*x, *y) != first)
        .count()
        > 50_000
}

fn sizes(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    window.settled(|picture| is_red(picture, ON_SHAPE))?;
    for size in [["1", "1"], ["300", "2"], ["3", "500"], ["2000", "2000"], ["1", "1"]] {
        window.act(&["windowsize", size[0], size[1]])?;
        std::thread::sleep(Duration::from_millis(300));
    }
    for step in 0..60_u32 {
        let [width, height] = [400 + step * 7 % 300, 300 + step * 13 % 200];
        window.act(&["windowsize", &width.to_string(), &height.to_string()])?;
    }
    window.act(&["windowunmap"])?;
    scene.write(&BALL.replace("#d94f30", "#30d94f"))?;
    std::thread::sleep(Duration::from_millis(500));
    window.act(&["windowmap"])?;
    let [width, height] = SIZE.map(|side| side.to_string());
    window.act(&["windowsize", &width, &height])?;
    window.act(&["windowmove", "0", "0"])?;
    let back = window.settled(|picture| is_green(picture, ON_SHAPE))?;
    window.keep(&back, "resized")
}

fn closing(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    for by_key in [false, true] {
        let mut window = Window::open(&display, &scene)?;
        window.settled(|picture| is_red(picture, ON_SHAPE))?;
        window.input(&["key", if by_key { "7" } else { "3" }])?;
        window.settled(|picture| is_red(picture, ON_SHAPE))?;
        if by_key {
            window.input(&["key", "ctrl+q"])?
        } else {
            window.request_close()?
        }
        let status = window.ended()?;
        expect(status.success(), &format!("{status}"))?;
        let settings = std::fs::read_to_string(scene.own().join("sdfc/view.json"))?;
        expect(settings.contains("scene.sdf") && settings.contains("\"eye\""), &settings)?;
    }
    Ok(())
}

/// As when a driver is updated. The new window has the same camera.
fn lost(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(&BALL.replace("sphere(1)", "box([1, 1, 1])"))?;
    // More frames than opening and dragging take.
    let window = Window::open_with(&display, &scene, &[(LOSE_WINDOW, "100")])?;
    let before = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    window.drag(ON_SHAPE, [120, 60])?;
    let is_turned = |picture: &RgbImage| differ(picture, &before, PICTURE) > 2000;
    let turned = window.settled(|picture| is_turned(picture) && !is_refining(picture))?;
    replaced(&window, &turned)?;
    window.input(&["key", "h"])?;
    window.settled(|picture| differ(picture, &before, PICTURE) < 200)?;
    Ok(())
}

/// Moves the pointer until the device is lost and another window shows the same picture.
fn replaced(window: &Window<'_>, shown: &RgbImage) -> Result<(), Failed> {
    let lost = window.id()?;
    // Each move is a frame. Only the new window must get the keyboard: X11 takes it from a window
    // that closes.
    let step = Cell::new(0);
    window.until("the window is not replaced", || {
        step.set((step.get() + 1) % 30);
        window.input(&["mousemove", &(ON_SHAPE[0] + step.get()).to_string(), "370"])?;
        Ok(window.id().is_ok_and(|id| id != lost))
    })?;
    window.arrange("scene.sdf")?;
    let other = window.settled(|picture| differ(picture, shown, PICTURE) < 200)?;
    window.keep(&other, "replaced")
}

/// True if the status line says in orange that the picture is not finished.
fn is_refining(picture: &RgbImage) -> bool {
    let line = (SIZE[1] - 30..SIZE[1]).flat_map(|y| (0..450).map(move |x| (x, y)));
    line.map(|(x, y)| picture.get_pixel(x, y).0)
        .any(|[red, green, blue]| red > 180 && red > green + 40 && green > blue + 40)
}

/// While the button is down, the picture counts as moving and is drawn coarsely on a slow machine.
/// It shows the scene, also in the window that replaces one whose device was lost.
fn moving(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(&BALL.replace("sphere(1)", "box([1, 1, 1])"))?;
    let environment = [(DRAW_ON_WINDOW, "1"), (LOSE_WINDOW, "150")];
    let window = Window::open_with(&display, &scene, &environment)?;
    let before = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    let turn = |name, since: &RgbImage| {
        window.drag_without_release(ON_SHAPE, [120, 60])?;
        let is_turned = |picture: &RgbImage| differ(picture, since, PICTURE) > 2000;
        let moving = window.settled(is_turned)?;
        window.keep(&moving, name)?;
        window.input(&["mouseup", "1"])?;
        std::thread::sleep(Duration::from_millis(500));
        // Refining may take longer than the screen rests.
        let turned = window.settled(|picture| is_turned(picture) && !is_refining(picture))?;
        // A slow machine may still be behind the pointer, and show the box from another side.
        let sizes = [&moving, &turned].map(reds);
        expect(2 * sizes[0] > sizes[1], &format!("red pixels: {sizes:?}"))?;
        Ok::<_, Failed>(turned)
    };
    let turned = turn("moving", &before)?;
    replaced(&window, &turned)?;
    turn("moving-again", &turned).map(drop)
}

/// egui cannot continue: the program ends and stores the settings.
fn lost_midway(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let mut window = Window::open_with(&display, &scene, &[(LOSE_WINDOW, "60.5")])?;
    window.settled(|picture| is_red(picture, ON_SHAPE))?;
    window.input(&["key", "3"])?;
    let mut steps = 0..3000;
    let status = loop {
        let step = steps.next().ok_or("the window is still open")?;
        if let Some(status) = window.status()? {
            break status;
        }
        window.input(&["mousemove", &(ON_SHAPE[0] + step % 30).to_string(), "370"])?;
        std::thread::sleep(Duration::from_millis(20));
    };
    let stderr = window.stderr()?;
    expect(status.code() == Some(3), &format!("{status}: {stderr}"))?;
    expect(
        stderr.contains("help: open the scene again") && !stderr.contains("no window"),
        &stderr,
    )?;
    let settings = std::fs::read_to_string(scene.own().join("sdfc/view.json"))?;
    expect(settings.contains("scene.sdf") && settings.contains("\"eye\""), &settings)
}

/// At most 0.1 s of CPU time in 3 s: more than wake-ups take, and far less than drawing.
fn idle(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    window.settled(|picture| is_red(picture, ON_SHAPE))?;
    // Antialiasing, a message or a blinking cursor may still take time.
    window.until("it never becomes idle", || {
        let before = window.cpu_ticks();
        std::thread::sleep(Duration::from_secs(3));
        Ok(window.cpu_ticks() - before <= 10)
    })
}

/// No driver for Vulkan: OpenGL shows the window.
const NO_VULKAN: (&str, &str) = ("VK_ICD_FILENAMES", "/nonexistent");
/// No driver for OpenGL.
const NO_OPENGL: (&str, &str) = ("LIBGL_DRIVERS_PATH", "/nonexistent");

fn no_vulkan(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open_with(&display, &scene, &[NO_VULKAN])?;
    let ball = window.settled(|picture| is_red(picture, ON_SHAPE))?;
    window.keep(&ball, "cpu")?;
    scene.write(&BALL.replace("#d94f30", "#30d94f"))?;
    window.settled(|picture| is_green(picture, ON_SHAPE))?;
    Ok(())
}

fn no_driver(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let environment = [NO_VULKAN, NO_OPENGL];
    let mut program = viewer(&display, &scene, &environment);
    let output = program.arg(&scene.path).stderr(Stdio::piped()).output()?;
    let stderr = String::from_utf8_lossy(&output.stderr);
    expect(output.status.code() == Some(3), &format!("{output:?}"))?;
    expect(stderr.contains("error: no window: ") && stderr.contains("sdfc render"), &stderr)
}
