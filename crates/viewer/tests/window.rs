//! Drives the real window on a display of its own, as a user would: looks at it, drags, turns the wheel,
//! edits the file on disk, breaks it, mends it.
//!
//! Needs `Xvfb`, `xdotool` and `import`, and an adapter that serves a window; the tests are reported as
//! ignored where a program is missing, unless `SDFC_REQUIRE_GPU` is set.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use image::RgbImage;
use libtest_mimic::{Arguments, Failed, Trial};

/// Long enough for a busy machine and a software adapter; reached only where a test fails.
const PATIENCE: Duration = Duration::from_secs(120);
const SIZE: [u32; 2] = [1000, 640];
/// Columns and rows of the window that show nothing but the picture.
const PICTURE: [std::ops::Range<u32>; 2] = [40..680, 120..500];
/// A place on what is shown, beside the light's reflection.
const PLACE: [u32; 2] = [410, 370];

type Test = fn(Display) -> Result<(), Failed>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let missing: Vec<&str> =
        ["Xvfb", "xdotool", "import"].into_iter().filter(|it| !is_there(it)).collect();
    let required = std::env::var_os("SDFC_REQUIRE_GPU").is_some();
    let trials: [(&str, Test); 5] = [
        ("an_edit_is_seen_and_broken_text_keeps_the_picture", edits),
        ("the_camera_follows_the_pointer", camera),
        ("a_file_that_goes_and_comes_back_is_seen", comes_back),
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
    let window = Window::open(&display, &scene.path)?;
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
    let window = Window::open(&display, &scene.path)?;
    let before = window.settled(|picture| is_red(picture, PLACE))?;
    let [x, y] = PLACE.map(|at| at.to_string());
    window.input(&["mousemove", &x, &y, "mousedown", "1"])?;
    for _ in 0..6 {
        // A slow machine would see all of the drag between two frames, as no drag at all.
        std::thread::sleep(Duration::from_millis(250));
        window.input(&["mousemove_relative", "--", "20", "10"])?;
    }
    window.settled(|picture| differ(picture, &before, PICTURE) > 2000)?;
    window.input(&["mouseup", "1"])?;
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
    let window = Window::open(&display, &scene.path)?;
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

/// No driver for Vulkan: OpenGL shows the window.
const NO_VULKAN: (&str, &str) = ("VK_ICD_FILENAMES", "/nonexistent");
/// None for OpenGL either.
const NO_OPENGL: (&str, &str) = ("LIBGL_DRIVERS_PATH", "/nonexistent");

fn no_adapter(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let window = Window::open_with(&display, &scene.path, &[NO_VULKAN])?;
    let ball = window.settled(|picture| is_red(picture, PLACE))?;
    window.keep(&ball, "processor")?;
    scene.write(&BALL.replace("#d94f30", "#30d94f"))?;
    window.settled(|picture| is_green(picture, PLACE))?;
    Ok(())
}

fn no_driver(display: Display) -> Result<(), Failed> {
    let scene = Scene::new(BALL)?;
    let environment = [NO_VULKAN, NO_OPENGL];
    let output = viewer(&display, &scene.path, &environment).stderr(Stdio::piped()).output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    expect(output.status.code() == Some(3), &format!("{output:?}"))?;
    expect(said.contains("error: no window: ") && said.contains("sdfc render"), &said)
}

fn expect(holds: bool, otherwise: &str) -> Result<(), Failed> {
    if holds { Ok(()) } else { Err(otherwise.into()) }
}

fn pixels(picture: &RgbImage) -> impl Iterator<Item = [u8; 3]> + '_ {
    let [columns, rows] = PICTURE;
    rows.flat_map(move |y| columns.clone().map(move |x| picture.get_pixel(x, y).0))
}

/// Also where it reflects the light.
fn red([r, g, b]: [u8; 3]) -> bool {
    let outweighs = |other: u8| 2 * u32::from(r) > 3 * u32::from(other);
    r > 60 && outweighs(g) && outweighs(b)
}

fn reds(picture: &RgbImage) -> usize {
    pixels(picture).filter(|pixel| red(*pixel)).count()
}

fn is_red(picture: &RgbImage, [x, y]: [u32; 2]) -> bool {
    red(picture.get_pixel(x, y).0)
}

fn is_green(picture: &RgbImage, [x, y]: [u32; 2]) -> bool {
    let [r, g, b] = picture.get_pixel(x, y).0;
    red([g, r, b])
}

/// How many pixels of a part differ by more than the rounding of edges.
fn differ(a: &RgbImage, b: &RgbImage, [columns, rows]: [std::ops::Range<u32>; 2]) -> usize {
    let places = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    let far = |(x, y): &(u32, u32)| {
        let (a, b) = (a.get_pixel(*x, *y).0, b.get_pixel(*x, *y).0);
        a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 24)
    };
    places.filter(far).count()
}

/// A scene in a folder of its own.
struct Scene {
    path: PathBuf,
    _folder: tempfile::TempDir,
}

impl Scene {
    fn new(text: &str) -> Result<Self, Failed> {
        let folder = tempfile::tempdir()?;
        let scene = Self { path: folder.path().join("scene.sdf"), _folder: folder };
        scene.write(text)?;
        Ok(scene)
    }

    fn write(&self, text: &str) -> Result<(), Failed> {
        Ok(std::fs::write(&self.path, text)?)
    }
}

/// A display without a screen.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// The server chooses a number that is free, and writes it out.
    fn open() -> Result<Self, Failed> {
        let [width, height] = SIZE;
        let screen = format!("{width}x{height}x24");
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &screen, "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let mut number = String::new();
        if let Some(out) = server.stdout.take() {
            std::io::BufRead::read_line(&mut std::io::BufReader::new(out), &mut number)?;
        }
        let name = format!(":{}", number.trim());
        let display = Self { server, name };
        expect(display.name.len() > 1, "Xvfb names no display")?;
        Ok(display)
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        drop(self.server.kill());
        drop(self.server.wait());
    }
}

/// The viewer, with settings and data of its own.
fn viewer(display: &Display, scene: &Path, environment: &[(&str, &str)]) -> Command {
    let own = scene.with_file_name("own");
    let mut program = Command::new(env!("CARGO_BIN_EXE_sdfc-view"));
    program
        .arg(scene)
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .envs(["XDG_CONFIG_HOME", "XDG_DATA_HOME"].map(|name| (name, &own)))
        .envs(environment.iter().copied());
    program
}

/// The viewer on it.
struct Window<'a> {
    viewer: Child,
    display: &'a Display,
}

impl<'a> Window<'a> {
    fn open(display: &'a Display, scene: &Path) -> Result<Self, Failed> {
        Self::open_with(display, scene, &[])
    }

    fn open_with(
        display: &'a Display,
        scene: &Path,
        environment: &[(&str, &str)],
    ) -> Result<Self, Failed> {
        let viewer = viewer(display, scene, environment).stderr(Stdio::null()).spawn()?;
        let window = Self { viewer, display };
        // Without a window manager nobody gives it the whole screen, or the keyboard.
        let [width, height] = SIZE.map(|side| side.to_string());
        let title = "scene.sdf";
        window.retry(&["search", "--sync", "--name", title, "windowsize", &width, &height])?;
        window.retry(&["search", "--name", title, "windowmove", "0", "0", "windowfocus"])?;
        Ok(window)
    }

    fn retry(&self, arguments: &[&str]) -> Result<(), Failed> {
        let start = Instant::now();
        loop {
            match self.input(arguments) {
                Err(error) if start.elapsed() > PATIENCE => return Err(error),
                Err(_) => std::thread::sleep(Duration::from_millis(200)),
                Ok(()) => return Ok(()),
            }
        }
    }

    fn input(&self, arguments: &[&str]) -> Result<(), Failed> {
        let output =
            Command::new("xdotool").args(arguments).env("DISPLAY", &self.display.name).output()?;
        expect(output.status.success(), &format!("xdotool {arguments:?}: {output:?}"))
    }

    /// What is on the screen once it is as expected and no longer changes.
    fn settled(&self, expected: impl Fn(&RgbImage) -> bool) -> Result<RgbImage, Failed> {
        let start = Instant::now();
        let mut before = self.screen()?;
        loop {
            std::thread::sleep(Duration::from_millis(300));
            let now = self.screen()?;
            if now == before && expected(&now) {
                return Ok(now);
            }
            if start.elapsed() > PATIENCE {
                self.keep(&now, "unexpected")?;
                return Err("the window does not show what is expected: see target/window".into());
            }
            before = now;
        }
    }

    fn screen(&self) -> Result<RgbImage, Failed> {
        let output = Command::new("import")
            .args(["-window", "root", "png:-"])
            .env("DISPLAY", &self.display.name)
            .output()?;
        Ok(image::load_from_memory(&output.stdout)?.to_rgb8())
    }

    /// For people to look at.
    fn keep(&self, picture: &RgbImage, name: &str) -> Result<(), Failed> {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../window");
        std::fs::create_dir_all(&folder)?;
        Ok(picture.save(folder.join(format!("{name}.png")))?)
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        drop(self.viewer.kill());
        drop(self.viewer.wait());
    }
}
