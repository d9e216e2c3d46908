//! Drives the real window on a display of its own, as a user would: looks at it, drags, turns the wheel,
//! edits the file on disk, breaks it, mends it.
//!
//! Needs `Xvfb`, `xdotool` and `import`, and an adapter that serves a window; the tests are reported as
//! ignored where a program is missing, unless `SDFC_REQUIRE_GPU` is set.

mod drag;
mod screen;

use std::process::{ExitCode, Stdio};
use std::time::Duration;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_viewer::app::LOSE_WINDOW;

use screen::{
    Display, PICTURE, SIZE, Scene, Window, differ, expect, is_green, is_red, reds, viewer,
};

/// A place on what is shown, beside the light's reflection.
const PLACE: [u32; 2] = [410, 370];

type Test = fn(Display) -> Result<(), Failed>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let missing: Vec<&str> =
        ["Xvfb", "xdotool", "import"].into_iter().filter(|it| !is_there(it)).collect();
    let required = std::env::var_os("SDFC_REQUIRE_GPU").is_some();
    let trials: [(&str, Test); 14] = [
        ("an_edit_is_seen_and_broken_text_keeps_the_picture", edits),
        ("the_camera_follows_the_pointer", camera),
        ("a_file_that_goes_and_comes_back_is_seen", comes_back),
        ("files_of_other_systems_and_empty_ones_are_seen", other_texts),
        ("a_slider_moves_the_scene_and_keys_choose_views", slider),
        ("without_a_scene_an_example_is_shown_and_saved_as_a_picture", example),
        ("a_file_that_is_let_go_over_the_window_is_shown", dropped),
        ("any_size_is_survived_and_a_hidden_window_shows_the_newest_text", sizes),
        ("closed_by_the_window_manager_it_remembers", closing),
        ("a_window_whose_device_is_lost_is_replaced_by_another", lost),
        ("a_window_whose_device_is_lost_while_it_is_drawn_is_not_forgotten", lost_midway),
        ("a_still_window_takes_no_processor_time", idle),
        ("without_an_adapter_the_processor_draws_in_a_window", no_adapter),
        ("without_any_driver_it_says_what_to_do", no_driver),
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
    let ball = window.settled(|picture| is_red(picture, PLACE))?;
    // Another number: it grows.
    scene.write(&BALL.replace("sphere(1)", "sphere(1.6)"))?;
    let larger = window.settled(|picture| reds(picture) > reds(&ball) * 2)?;
    // Broken: findings over the picture, and the ball still in the middle.
    scene.write("spere(1)\n")?;
    let broken = window.settled(|picture| differ(picture, &larger, [0..700, 40..200]) > 500)?;
    window.keep(&broken, "broken")?;
    expect(is_red(&broken, PLACE), "the last good picture is gone")?;
    // Another structure.
    let text = BALL.replace("sphere(1)", "box([1, 1, 1]).rotate(y: 30deg)");
    scene.write(&text.replace("#d94f30", "#30d94f"))?;
    let mended = window.settled(|picture| is_green(picture, PLACE))?;
    window.keep(&mended, "mended")
}

fn camera(display: Display) -> Result<(), Failed> {
    let text = BALL.replace("sphere(1)", "box([1, 1, 1])");
    let scene = Scene::new(&text)?;
    let window = Window::open(&display, &scene)?;
    let before = window.settled(|picture| is_red(picture, PLACE))?;
    let [x, y] = PLACE.map(|at| at.to_string());
    window.drag(PLACE, [120, 60])?;
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
    window.settled(|picture| is_red(picture, PLACE))?;
    std::fs::remove_file(&scene.path)?;
    std::thread::sleep(Duration::from_millis(500));
    let gone = window.settled(|picture| is_red(picture, PLACE))?;
    let aside = scene.path.with_extension("new");
    std::fs::write(&aside, BALL.replace("#d94f30", "#30d94f"))?;
    std::fs::rename(&aside, &scene.path)?;
    let back = window.settled(|picture| is_green(picture, PLACE))?;
    expect(differ(&back, &gone, PICTURE) > 2000, "the new file is not seen")
}

fn other_texts(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(&format!("\u{feff}{}", BALL.replace('\n', "\r\n")))?;
    let window = Window::open(&display, &scene)?;
    let ball = window.settled(|picture| is_red(picture, PLACE))?;
    // The last good picture stays, and the line below says that nothing is drawn.
    scene.write("")?;
    let below = [500..1000, 610..640];
    window
        .settled(|picture| is_red(picture, PLACE) && differ(picture, &ball, below.clone()) > 50)?;
    scene.write(&BALL.replace("#d94f30", "#30d94f").replace('\n', "\r\n"))?;
    window.settled(|picture| is_green(picture, PLACE))?;
    Ok(())
}

fn slider(display: Display) -> Result<(), Failed> {
    let text = format!("param r = 0.6 in 0.5..1.6\n{}", BALL.replace("sphere(1)", "sphere(r)"));
    let scene = Scene::new(&text)?;
    let window = Window::open(&display, &scene)?;
    let small = window.settled(|picture| is_red(picture, PLACE) || reds(picture) > 500)?;
    // The slider's knob, a tenth of the way along.
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
    expect(folder.join("params.sdf").is_file(), "the example is no file of the user's")?;
    window.input(&["key", "ctrl+s"])?;
    let dialog = window.settled(|picture| differ(picture, &shown, PICTURE) > 5000)?;
    window.keep(&dialog, "save")?;
    window.input(&["key", "Return"])?;
    let file = folder.join("params.png");
    window.until("no picture was saved", || Ok(file.is_file()))?;
    expect(image::image_dimensions(&file)? == (1920, 1080), "it has another size")
}

fn dropped(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    window.settled(|picture| is_red(picture, PLACE))?;
    let other = scene.path.with_file_name("other.sdf");
    std::fs::write(&other, BALL.replace("#d94f30", "#30d94f"))?;
    window.drop_file(&other)?;
    window.settled(|picture| is_green(picture, PLACE))?;
    window.input(&["search", "--name", "other.sdf"])
}

/// Whether what is shown has more than one colour.
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
    window.settled(|picture| is_red(picture, PLACE))?;
    for size in [["1", "1"], ["300", "2"], ["3", "500"], ["2000", "2000"], ["1", "1"]] {
        window.act(&["windowsize", size[0], size[1]])?;
        std::thread::sleep(Duration::from_millis(300));
    }
    for round in 0..60_u32 {
        let [width, height] = [400 + round * 7 % 300, 300 + round * 13 % 200];
        window.act(&["windowsize", &width.to_string(), &height.to_string()])?;
    }
    window.act(&["windowunmap"])?;
    scene.write(&BALL.replace("#d94f30", "#30d94f"))?;
    std::thread::sleep(Duration::from_millis(500));
    window.act(&["windowmap"])?;
    let [width, height] = SIZE.map(|side| side.to_string());
    window.act(&["windowsize", &width, &height])?;
    window.act(&["windowmove", "0", "0"])?;
    let back = window.settled(|picture| is_green(picture, PLACE))?;
    window.keep(&back, "resized")
}

fn closing(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    for way in [0, 1] {
        let mut window = Window::open(&display, &scene)?;
        window.settled(|picture| is_red(picture, PLACE))?;
        window.input(&["key", if way == 0 { "3" } else { "7" }])?;
        window.settled(|picture| is_red(picture, PLACE))?;
        if way == 0 {
            window.request_close()?
        } else {
            window.input(&["key", "ctrl+q"])?
        }
        let status = window.ended()?;
        expect(status.success(), &format!("{status}"))?;
        let memory = std::fs::read_to_string(scene.own().join("sdfc/view.json"))?;
        expect(memory.contains("scene.sdf") && memory.contains("\"eye\""), &memory)?;
    }
    Ok(())
}

/// As when a driver is renewed. What was moved in the one window is so in the next.
fn lost(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(&BALL.replace("sphere(1)", "box([1, 1, 1])"))?;
    // More frames than it takes to be there, fewer than it takes to drag.
    let window = Window::open_with(&display, &scene, &[(LOSE_WINDOW, "60")])?;
    let before = window.settled(|picture| is_red(picture, PLACE))?;
    window.drag(PLACE, [120, 60])?;
    let turned = window.settled(|picture| differ(picture, &before, PICTURE) > 2000)?;
    let place = |step: i32| (PLACE[0] as i32 + step % 30).to_string();
    for step in 0..120 {
        window.input(&["mousemove", &place(step), "370"])?;
        std::thread::sleep(Duration::from_millis(20));
    }
    window.arrange("scene.sdf")?;
    let other = window.settled(|picture| differ(picture, &turned, PICTURE) < 200)?;
    window.keep(&other, "replaced")?;
    window.input(&["key", "h"])?;
    window.settled(|picture| differ(picture, &before, PICTURE) < 200)?;
    Ok(())
}

/// There egui cannot go on: the program ends, and keeps what was moved.
fn lost_midway(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let mut window = Window::open_with(&display, &scene, &[(LOSE_WINDOW, "60.5")])?;
    window.settled(|picture| is_red(picture, PLACE))?;
    window.input(&["key", "3"])?;
    let mut steps = 0..3000;
    let status = loop {
        let step = steps.next().ok_or("the window is still open")?;
        if let Some(status) = window.status()? {
            break status;
        }
        window.input(&["mousemove", &(PLACE[0] + step % 30).to_string(), "370"])?;
        std::thread::sleep(Duration::from_millis(20));
    };
    let said = window.said()?;
    expect(status.code() == Some(3), &format!("{status}: {said}"))?;
    expect(said.contains("help: open the scene again") && !said.contains("no window"), &said)?;
    let memory = std::fs::read_to_string(scene.own().join("sdfc/view.json"))?;
    expect(memory.contains("scene.sdf") && memory.contains("\"eye\""), &memory)
}

/// A tenth of a second of the processor in three is more than wake-ups take, and far less than drawing.
fn idle(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open(&display, &scene)?;
    window.settled(|picture| is_red(picture, PLACE))?;
    // Smoothing on a busy machine, a remark or a cursor may still have to do something.
    window.until("it takes time for ever", || {
        let before = window.processor_ticks();
        std::thread::sleep(Duration::from_secs(3));
        Ok(window.processor_ticks() - before <= 10)
    })
}

/// No driver for Vulkan: OpenGL shows the window.
const NO_VULKAN: (&str, &str) = ("VK_ICD_FILENAMES", "/nonexistent");
/// None for OpenGL either.
const NO_OPENGL: (&str, &str) = ("LIBGL_DRIVERS_PATH", "/nonexistent");

fn no_adapter(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open_with(&display, &scene, &[NO_VULKAN])?;
    let ball = window.settled(|picture| is_red(picture, PLACE))?;
    window.keep(&ball, "processor")?;
    scene.write(&BALL.replace("#d94f30", "#30d94f"))?;
    window.settled(|picture| is_green(picture, PLACE))?;
    Ok(())
}

fn no_driver(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let environment = [NO_VULKAN, NO_OPENGL];
    let mut program = viewer(&display, &scene, &environment);
    let output = program.arg(&scene.path).stderr(Stdio::piped()).output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    expect(output.status.code() == Some(3), &format!("{output:?}"))?;
    expect(said.contains("error: no window: ") && said.contains("sdfc render"), &said)
}
