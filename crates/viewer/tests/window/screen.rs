//! A display without a screen, the viewer on it, and what is to be seen there.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use image::RgbImage;
use libtest_mimic::Failed;
use x11rb::protocol::xproto::{ClientMessageEvent, ConnectionExt, EventMask, Window as XWindow};

use crate::drag::drop_file;

/// Long enough for a busy machine and a software adapter; reached only where a test fails.
pub const PATIENCE: Duration = Duration::from_secs(120);
pub const SIZE: [u32; 2] = [1000, 640];
/// Columns and rows of the window that show nothing but the picture.
pub const PICTURE: [std::ops::Range<u32>; 2] = [40..680, 120..500];

pub fn expect(holds: bool, otherwise: &str) -> Result<(), Failed> {
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

pub fn reds(picture: &RgbImage) -> usize {
    pixels(picture).filter(|pixel| red(*pixel)).count()
}

pub fn is_red(picture: &RgbImage, [x, y]: [u32; 2]) -> bool {
    red(picture.get_pixel(x, y).0)
}

pub fn is_green(picture: &RgbImage, [x, y]: [u32; 2]) -> bool {
    let [r, g, b] = picture.get_pixel(x, y).0;
    red([g, r, b])
}

/// How many pixels of a part differ by more than the rounding of edges.
pub fn differ(a: &RgbImage, b: &RgbImage, [columns, rows]: [std::ops::Range<u32>; 2]) -> usize {
    let places = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    let far = |(x, y): &(u32, u32)| {
        let (a, b) = (a.get_pixel(*x, *y).0, b.get_pixel(*x, *y).0);
        a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 24)
    };
    places.filter(far).count()
}

/// A scene in a folder of its own.
pub struct Scene {
    pub path: PathBuf,
    _folder: tempfile::TempDir,
}

impl Scene {
    pub fn new(text: &str) -> Result<Self, Failed> {
        let folder = tempfile::tempdir()?;
        let scene = Self { path: folder.path().join("scene.sdf"), _folder: folder };
        scene.write(text)?;
        Ok(scene)
    }

    /// Where the viewer keeps what is its own.
    pub fn own(&self) -> PathBuf {
        self.path.with_file_name("own")
    }

    pub fn write(&self, text: &str) -> Result<(), Failed> {
        Ok(std::fs::write(&self.path, text)?)
    }
}

/// A display without a screen.
pub struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// The server chooses a number that is free, and writes it out.
    pub fn open() -> Result<Self, Failed> {
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

/// The viewer, with settings and data beside the scene.
pub fn viewer(display: &Display, scene: &Scene, environment: &[(&str, &str)]) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_sdfc-view"));
    program
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .envs(["XDG_CONFIG_HOME", "XDG_DATA_HOME"].map(|name| (name, scene.own())))
        .envs(environment.iter().copied());
    program
}

/// The viewer on it.
pub struct Window<'a> {
    viewer: Child,
    display: &'a Display,
}

impl<'a> Window<'a> {
    pub fn open(display: &'a Display, scene: &Scene) -> Result<Self, Failed> {
        Self::open_with(display, scene, &[])
    }

    pub fn open_with(
        display: &'a Display,
        scene: &Scene,
        environment: &[(&str, &str)],
    ) -> Result<Self, Failed> {
        let mut program = viewer(display, scene, environment);
        Self::shown(display, program.arg(&scene.path), "scene.sdf")
    }

    /// Without a scene.
    pub fn open_example(display: &'a Display, scene: &Scene) -> Result<Self, Failed> {
        Self::shown(display, &mut viewer(display, scene, &[]), "params.sdf")
    }

    fn shown(
        display: &'a Display,
        program: &mut Command,
        title: &'static str,
    ) -> Result<Self, Failed> {
        let viewer = program.stderr(Stdio::piped()).spawn()?;
        let window = Self { viewer, display };
        window.arrange(title)?;
        Ok(window)
    }

    /// Without a window manager nobody gives it the whole screen, or the keyboard.
    pub fn arrange(&self, title: &str) -> Result<(), Failed> {
        let [width, height] = SIZE.map(|side| side.to_string());
        self.retry(&["search", "--sync", "--name", title, "windowsize", &width, &height])?;
        self.retry(&["search", "--name", title, "windowmove", "0", "0", "windowfocus"])
    }

    /// As `xdotool` does it to the window.
    pub fn act(&self, what: &[&str]) -> Result<(), Failed> {
        self.input(&[&["search", "--name", "sdfc$"], what].concat())
    }

    /// Moves the pointer with the button held, as slowly as a hand does.
    pub fn drag(&self, [x, y]: [u32; 2], [right, down]: [i32; 2]) -> Result<(), Failed> {
        const STEPS: i32 = 6;
        self.input(&["mousemove", &x.to_string(), &y.to_string(), "mousedown", "1"])?;
        for _ in 0..STEPS {
            // A slow machine would see all of the drag between two frames, as no drag at all.
            std::thread::sleep(Duration::from_millis(250));
            let [right, down] = [right, down].map(|by| (by / STEPS).to_string());
            self.input(&["mousemove_relative", "--", &right, &down])?;
        }
        std::thread::sleep(Duration::from_millis(250));
        self.input(&["mouseup", "1"])
    }

    /// Asks it to close, as the button of a window manager does.
    pub fn request_close(&self) -> Result<(), Failed> {
        let (connection, _) = x11rb::connect(Some(&self.display.name))?;
        let atom = |name: &str| -> Result<u32, Failed> {
            Ok(connection.intern_atom(false, name.as_bytes())?.reply()?.atom)
        };
        let (protocols, delete) = (atom("WM_PROTOCOLS")?, atom("WM_DELETE_WINDOW")?);
        let window = self.id()?;
        let event = ClientMessageEvent::new(32, window, protocols, [delete, 0, 0, 0, 0]);
        connection.send_event(false, window, EventMask::NO_EVENT, event)?.check()?;
        // An answer, so that the display has seen all of it.
        connection.get_input_focus()?.reply()?;
        Ok(())
    }

    /// Lets a file go over it, dragged from elsewhere.
    pub fn drop_file(&self, file: &Path) -> Result<(), Failed> {
        drop_file(&self.display.name, self.id()?, SIZE.map(|side| side / 2), file)
    }

    fn id(&self) -> Result<XWindow, Failed> {
        let output = self.output(&["search", "--name", "sdfc$"])?;
        Ok(String::from_utf8_lossy(&output.stdout).trim().parse()?)
    }

    /// Hundredths of a second that the processor has spent on it; 0 where the system does not say.
    pub fn processor_ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.viewer.id()));
        let stat = stat.unwrap_or_default();
        // After the name, which may hold anything: user and system time are the 12th and 13th.
        let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<u64>().ok()).sum()
    }

    /// How it ended, if it has.
    pub fn status(&mut self) -> Result<Option<ExitStatus>, Failed> {
        Ok(self.viewer.try_wait()?)
    }

    /// What it has said, once it has ended.
    pub fn said(&mut self) -> Result<String, Failed> {
        Ok(self.viewer.stderr.take().map(std::io::read_to_string).transpose()?.unwrap_or_default())
    }

    /// How it ended, once it has.
    pub fn ended(&mut self) -> Result<ExitStatus, Failed> {
        let start = Instant::now();
        loop {
            if let Some(status) = self.status()? {
                return Ok(status);
            }
            expect(start.elapsed() < PATIENCE, "the window is still open")?;
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits until something holds that is not on the screen.
    pub fn until(
        &self,
        otherwise: &str,
        holds: impl Fn() -> Result<bool, Failed>,
    ) -> Result<(), Failed> {
        let start = Instant::now();
        while !holds()? {
            expect(start.elapsed() < PATIENCE, otherwise)?;
            std::thread::sleep(Duration::from_millis(50));
        }
        Ok(())
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

    fn output(&self, arguments: &[&str]) -> std::io::Result<std::process::Output> {
        Command::new("xdotool").args(arguments).env("DISPLAY", &self.display.name).output()
    }

    pub fn input(&self, arguments: &[&str]) -> Result<(), Failed> {
        let output = self.output(arguments)?;
        expect(output.status.success(), &format!("xdotool {arguments:?}: {output:?}"))
    }

    /// What is on the screen once it is as expected and no longer changes.
    pub fn settled(&self, expected: impl Fn(&RgbImage) -> bool) -> Result<RgbImage, Failed> {
        // The next finer picture of a slow machine comes later than one look.
        const SAME: u32 = 4;
        let start = Instant::now();
        let (mut before, mut same) = (self.screen()?, 0);
        loop {
            std::thread::sleep(Duration::from_millis(300));
            let now = self.screen()?;
            same = if now == before { same + 1 } else { 0 };
            if same >= SAME && expected(&now) {
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
    pub fn keep(&self, picture: &RgbImage, name: &str) -> Result<(), Failed> {
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
