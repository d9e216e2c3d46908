//! A virtual display, the viewer on it, and what the screen shows.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use image::RgbImage;
use libtest_mimic::Failed;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    ClientMessageEvent, ConnectionExt, EventMask, ImageFormat, Window as XWindow,
};
use x11rb::rust_connection::RustConnection;

use crate::drag_and_drop::drop_file;

/// Long enough for a busy machine and a software GPU; reached only if a test fails.
pub const TIMEOUT: Duration = Duration::from_secs(120);
pub const SIZE: [u32; 2] = [1000, 640];
/// Columns and rows of the window in which there is only the picture.
pub const PICTURE: [std::ops::Range<u32>; 2] = [40..680, 120..500];

pub fn expect(holds: bool, otherwise: &str) -> Result<(), Failed> {
    if holds { Ok(()) } else { Err(otherwise.into()) }
}

fn pixels(picture: &RgbImage) -> impl Iterator<Item = [u8; 3]> + '_ {
    let [columns, rows] = PICTURE;
    rows.flat_map(move |y| columns.clone().map(move |x| picture.get_pixel(x, y).0))
}

/// True in highlights too.
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

/// The number of pixels of an area that differ by more than antialiasing explains.
pub fn differ(a: &RgbImage, b: &RgbImage, [columns, rows]: [std::ops::Range<u32>; 2]) -> usize {
    let pixels = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    let far = |(x, y): &(u32, u32)| {
        let (a, b) = (a.get_pixel(*x, *y).0, b.get_pixel(*x, *y).0);
        a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 24)
    };
    pixels.filter(far).count()
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

    /// The folder of the viewer's settings and data.
    pub fn own(&self) -> PathBuf {
        self.path.with_file_name("own")
    }

    pub fn write(&self, text: &str) -> Result<(), Failed> {
        Ok(std::fs::write(&self.path, text)?)
    }
}

/// A virtual display.
pub struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    /// The window that covers the screen.
    root: XWindow,
}

impl Display {
    /// Starts a server, which chooses a free display number and prints it.
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
        expect(name.len() > 1, "Xvfb prints no display number")?;
        let (connection, screen) = x11rb::connect(Some(&name))?;
        let root = connection.setup().roots.get(screen).ok_or("no screen")?.root;
        Ok(Self { server, name, connection, root })
    }

    /// Returns what the screen shows. A pixel of 24 bits takes 32: blue, green, red and padding.
    fn screen(&self) -> Result<Vec<u8>, Failed> {
        let all_planes = u32::MAX;
        let [columns, rows] = SIZE.map(|side| side as u16);
        let (format, root) = (ImageFormat::Z_PIXMAP, self.root);
        let image = self.connection.get_image(format, root, 0, 0, columns, rows, all_planes)?;
        Ok(image.reply()?.data)
    }
}

fn image(screen: &[u8]) -> Result<RgbImage, Failed> {
    let [width, height] = SIZE;
    let channels = screen.as_chunks::<4>().0.iter().flat_map(|&[b, g, r, _]| [r, g, b]);
    RgbImage::from_raw(width, height, channels.collect()).ok_or("a part of the screen".into())
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

    /// Opens the viewer without a scene.
    pub fn open_example(display: &'a Display, scene: &Scene) -> Result<Self, Failed> {
        Self::shown(display, &mut viewer(display, scene, &[]), "welcome.sdf")
    }

    fn shown(
        display: &'a Display,
        program: &mut Command,
        title: &'static str,
    ) -> Result<Self, Failed> {
        let viewer = program.stderr(Stdio::piped()).spawn()?;
        let window = Self { viewer, display };
        window.arrange(title)?;
        // Closes the panel "Code", so that the picture is as large as the tests expect.
        window.input(&["key", "t"])?;
        Ok(window)
    }

    /// Gives the window the whole screen and the keyboard, as there is no window manager.
    pub fn arrange(&self, title: &str) -> Result<(), Failed> {
        let [width, height] = SIZE.map(|side| side.to_string());
        self.retry(&["search", "--sync", "--name", title, "windowsize", &width, &height])?;
        // The server refuses to focus a window that is not viewable yet.
        self.retry(&["search", "--name", title, "windowmove", "0", "0", "windowfocus"])
    }

    /// Runs an `xdotool` command on the window.
    pub fn act(&self, what: &[&str]) -> Result<(), Failed> {
        self.input(&[&["search", "--name", "sdfc$"], what].concat())
    }

    /// Moves the pointer with the button held, as slowly as a user does.
    pub fn drag(&self, from: [u32; 2], by: [i32; 2]) -> Result<(), Failed> {
        self.drag_without_release(from, by)?;
        self.input(&["mouseup", "1"])
    }

    /// The part of a drag before the button is released.
    pub fn drag_without_release(
        &self,
        [x, y]: [u32; 2],
        [right, down]: [i32; 2],
    ) -> Result<(), Failed> {
        const STEPS: i32 = 6;
        self.input(&["mousemove", &x.to_string(), &y.to_string(), "mousedown", "1"])?;
        for _ in 0..STEPS {
            // A slow machine would get the whole drag within a frame and see no drag.
            std::thread::sleep(Duration::from_millis(250));
            let [right, down] = [right, down].map(|by| (by / STEPS).to_string());
            self.input(&["mousemove_relative", "--", &right, &down])?;
        }
        std::thread::sleep(Duration::from_millis(250));
        Ok(())
    }

    /// Requests closing, as the button of a window manager does.
    pub fn request_close(&self) -> Result<(), Failed> {
        let connection = &self.display.connection;
        let atom = |name: &str| -> Result<u32, Failed> {
            Ok(connection.intern_atom(false, name.as_bytes())?.reply()?.atom)
        };
        let (protocols, delete) = (atom("WM_PROTOCOLS")?, atom("WM_DELETE_WINDOW")?);
        let window = self.id()?;
        let event = ClientMessageEvent::new(32, window, protocols, [delete, 0, 0, 0, 0]);
        connection.send_event(false, window, EventMask::NO_EVENT, event)?.check()?;
        // Waits for an answer, so that the server has handled the event.
        connection.get_input_focus()?.reply()?;
        Ok(())
    }

    /// Drops a file on the window.
    pub fn drop_file(&self, file: &Path) -> Result<(), Failed> {
        drop_file(&self.display.name, self.id()?, SIZE.map(|side| side / 2), file)
    }

    pub fn id(&self) -> Result<XWindow, Failed> {
        let output = self.output(&["search", "--name", "sdfc$"])?;
        Ok(String::from_utf8_lossy(&output.stdout).trim().parse()?)
    }

    /// CPU time of the viewer in hundredths of a second; 0 if the system does not say.
    pub fn cpu_ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.viewer.id()));
        let stat = stat.unwrap_or_default();
        // User and system time are the 12th and 13th fields after the name in parentheses.
        let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<u64>().ok()).sum()
    }

    /// The exit status, if the viewer has ended.
    pub fn status(&mut self) -> Result<Option<ExitStatus>, Failed> {
        Ok(self.viewer.try_wait()?)
    }

    /// The error output, once the viewer has ended.
    pub fn stderr(&mut self) -> Result<String, Failed> {
        Ok(self.viewer.stderr.take().map(std::io::read_to_string).transpose()?.unwrap_or_default())
    }

    /// Waits for the exit status.
    pub fn ended(&mut self) -> Result<ExitStatus, Failed> {
        let start = Instant::now();
        loop {
            if let Some(status) = self.status()? {
                return Ok(status);
            }
            expect(start.elapsed() < TIMEOUT, "the window is still open")?;
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits for a condition that does not show on the screen.
    pub fn until(
        &self,
        otherwise: &str,
        holds: impl Fn() -> Result<bool, Failed>,
    ) -> Result<(), Failed> {
        let start = Instant::now();
        while !holds()? {
            expect(start.elapsed() < TIMEOUT, otherwise)?;
            std::thread::sleep(Duration::from_millis(50));
        }
        Ok(())
    }

    fn retry(&self, arguments: &[&str]) -> Result<(), Failed> {
        let start = Instant::now();
        loop {
            match self.input(arguments) {
                Err(error) if start.elapsed() > TIMEOUT => return Err(error),
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

    /// Waits until the screen is as expected and no longer changes, and returns it.
    pub fn settled(&self, expected: impl Fn(&RgbImage) -> bool) -> Result<RgbImage, Failed> {
        // On a slow machine the next finer picture takes long.
        self.still_for(Duration::from_millis(1200), expected)
    }

    /// Waits until the screen is as expected, and returns it. A cursor may blink in it.
    pub fn seen(&self, expected: impl Fn(&RgbImage) -> bool) -> Result<RgbImage, Failed> {
        self.still_for(Duration::ZERO, expected)
    }

    fn still_for(
        &self,
        time: Duration,
        expected: impl Fn(&RgbImage) -> bool,
    ) -> Result<RgbImage, Failed> {
        let start = Instant::now();
        let (mut before, mut changed, mut checked) = (self.display.screen()?, start, false);
        loop {
            std::thread::sleep(Duration::from_millis(50));
            let now = self.display.screen()?;
            if now != before {
                (before, changed, checked) = (now, Instant::now(), false);
            } else if changed.elapsed() > time && !checked {
                // Looking at pixels takes time from the viewer, so each screen is looked at once.
                let picture = image(&now)?;
                if expected(&picture) {
                    return Ok(picture);
                }
                checked = true;
            }
            if start.elapsed() > TIMEOUT {
                self.keep(&image(&before)?, "unexpected")?;
                return Err("the window does not show what is expected: see target/window".into());
            }
        }
    }

    /// Saves a screenshot for people to look at.
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
