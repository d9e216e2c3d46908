//! Faults of the machine while results are written: a full disk, a folder that is read only, a
//! process that ends in the middle of a file, two processes with one output, too little memory, no
//! adapter. Each file then has its old contents or all of the new ones.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use common::{folder, names, run, said};
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_render::testing::without_gpu;
use tempfile::TempDir;

const SCENE: &str = "sphere(0.8).color(#f80) | box([1.2, 0.4, 0.4]).rotate(y: 30deg)\n";
const OLD: &[u8] = b"the old contents";

/// The commands that write files on the CPU, and the files. Each writes more than [`BLOCKS`] allow.
const WRITERS: [(&str, &[&str]); 15] = [
    ("render a.sdf -o out.png --depth z.exr --backend cpu --size 160x100", &["out.png", "z.exr"]),
    ("render a.sdf -o out.exr --backend cpu --size 96x64", &["out.exr"]),
    ("render a.sdf -o out.gif --frames 0..3 --backend cpu --size 96x64", &["out.gif"]),
    (
        "render a.sdf -o out.png --frames 0..2 --backend cpu --size 96x64",
        &["out.0000.png", "out.0001.png"],
    ),
    ("mesh a.sdf -o out.stl --error 0.05 --json r.json", &["out.stl", "r.json"]),
    ("mesh a.sdf -o out.obj --error 0.05", &["out.obj"]),
    ("mesh a.sdf -o out.ply --error 0.05", &["out.ply"]),
    ("mesh a.sdf -o out.glb --error 0.05", &["out.glb"]),
    ("mesh a.sdf -o out.3mf --error 0.05", &["out.3mf"]),
    ("contour a.sdf -o out.svg --error 0.001 --json r.json", &["out.svg", "r.json"]),
    ("contour a.sdf -o out.dxf --error 0.001", &["out.dxf"]),
    ("bake a.sdf -o out.npy --resolution 16 --json r.json", &["out.npy", "r.json"]),
    ("bake a.sdf -o out.nrrd --resolution 16", &["out.nrrd"]),
    ("compile a.sdf -o out.wgsl --emit render --reflect r.json", &["out.wgsl", "r.json"]),
    ("join part1.png part2.png -o out.png", &["out.png"]),
];
/// Formats a scene in place. Its old contents are a text, which must not be lost.
const FORMAT: (&str, &[&str]) = ("fmt long.sdf", &["long.sdf"]);
/// The largest file, in blocks of 512 bytes.
const BLOCKS: &str = "ulimit -c 0; ulimit -f 1";
/// Limits of the address space in KiB: from one in which little runs to one in which all do.
const MEMORY: [u32; 6] = [60_000, 80_000, 120_000, 200_000, 400_000, 3_000_000];

/// Work on the CPU that takes minutes.
const LONG: [&str; 5] = [
    "render many.sdf -o out.png --backend cpu --size 4000x4000 --samples 64",
    "mesh many.sdf -o out.stl --error 1e-5",
    "contour many.sdf -o out.svg --error 5e-6",
    "measure many.sdf --error-relative 1e-9",
    "bake many.sdf -o out.npy --resolution 600",
];
/// Work that begins with a shader for which a software driver takes long.
const DRIVER: [&str; 3] = [
    "render many.sdf -o out.png --backend gpu --loops never",
    "render many.sdf -o out.gif --frames 0..3 --backend gpu --loops never",
    "chart many.sdf -o out.svg --no-cache --march sphere",
];
/// The time in which a process has to end: far less than the work takes, and more than a busy
/// machine needs.
const SOON: Duration = Duration::from_secs(10);

fn main() {
    let unix = cfg!(target_os = "linux");
    let mounts = unix && can_mount();
    let mut trials = vec![
        Trial::test("a file that cannot grow is not left", cannot_grow).with_ignored_flag(!unix),
        Trial::test("a process that ends in a write leaves no part of a file", ends_in_a_write)
            .with_ignored_flag(!unix),
        Trial::test("a full disk is reported, and leaves no part", full).with_ignored_flag(!mounts),
        Trial::test("a read-only folder is reported", read_only).with_ignored_flag(!mounts),
        Trial::test("two processes may write one file", two_processes),
        Trial::test("too little memory leaves no part of a file", too_little_memory)
            .with_ignored_flag(!unix),
        Trial::test("without an adapter the CPU draws, or the error says so", no_adapter)
            .with_ignored_flag(!unix),
    ];
    trials.extend([
        Trial::test("Ctrl-C ends long work", || ends_at_once(&LONG)).with_ignored_flag(!unix),
        Trial::test("Ctrl-C ends work while a driver compiles", || ends_at_once(&DRIVER))
            .with_ignored_flag(!unix || without_gpu()),
    ]);
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn writers() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    WRITERS.into_iter().chain([FORMAT])
}

/// A scene that is not formatted.
fn long_scene() -> String {
    (0..60).map(|at| format!("sphere( {at} ).translate( x:{at} )\n")).collect()
}

/// A folder with all that the commands read.
fn inputs() -> TempDir {
    static PARTS: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    let parts = PARTS.get_or_init(|| {
        let folder = folder(&[("a.sdf", SCENE)]);
        [1, 2].map(|part| {
            let options = "--backend cpu --size 96x64";
            let args = format!("render a.sdf -o {part}.png --region {part}/2 {options}");
            assert!(run(&folder, &args).status.success(), "{args}");
            let name =
                names(folder.path()).into_iter().find(|it| it.starts_with(&format!("{part}.")));
            std::fs::read(folder.path().join(name.unwrap())).unwrap()
        })
    });
    let folder = folder(&[("a.sdf", SCENE), ("long.sdf", &long_scene())]);
    for (at, part) in parts.iter().enumerate() {
        std::fs::write(folder.path().join(format!("part{}.png", at + 1)), part).unwrap();
    }
    folder
}

/// A folder with all that a command reads, and old files where it writes.
fn prepared(files: &[&str]) -> TempDir {
    let folder = inputs();
    for file in files.iter().filter(|file| !file.ends_with(".sdf")) {
        std::fs::write(folder.path().join(file), OLD).unwrap();
    }
    folder
}

/// The contents of files.
fn contents(folder: &Path, files: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let read = |file: &&str| ((*file).to_owned(), std::fs::read(folder.join(file)).unwrap());
    files.iter().map(read).collect()
}

/// The files that the command writes when nothing fails.
fn expected(command: &str, files: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let folder = inputs();
    let output = run(&folder, command);
    assert!(output.status.success(), "{command}: {}", said(&output));
    contents(folder.path(), files)
}

/// Runs a command after a line of the shell.
fn shell(folder: &Path, before: &str, command: &str) -> Output {
    let binary = env!("CARGO_BIN_EXE_sdfc");
    let line = format!("{before}; exec '{binary}' {command}");
    Command::new("sh").args(["-c", &line]).current_dir(folder).output().unwrap()
}

/// Runs a command where folders can be mounted, after lines that mount the folder `.` anew.
fn mounted(folder: &Path, mount: &str, command: &str) -> Output {
    let binary = env!("CARGO_BIN_EXE_sdfc");
    let line = format!("{mount} && '{binary}' {command}");
    let arguments = ["-rm", "sh", "-c", &line];
    Command::new("unshare").args(arguments).current_dir(folder).output().unwrap()
}

fn can_mount() -> bool {
    let mut command = Command::new("unshare");
    command.args(["-rm", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]);
    command.output().is_ok_and(|output| output.status.success())
}

/// Checks that each file has its old contents or all of the new ones, and returns how many are old.
fn whole_files(
    folder: &Path,
    command: &str,
    files: &[&str],
    new: &BTreeMap<String, Vec<u8>>,
) -> Result<usize, Failed> {
    let mut old = 0;
    for (name, found) in contents(folder, files) {
        let was = if name.ends_with(".sdf") { long_scene().into_bytes() } else { OLD.to_vec() };
        match (found == was, new.get(&name) == Some(&found)) {
            (true, _) => old += 1,
            (false, true) => {}
            (false, false) => {
                return Err(format!("{command}: {name} has {} other bytes", found.len()).into());
            }
        }
    }
    Ok(old)
}

/// The error of a command that could not write: its status, and what it says.
fn refused(command: &str, output: &Output, words: &[&str]) -> Result<(), Failed> {
    let said = said(output);
    let has_words = words.iter().all(|word| said.contains(word));
    if output.status.code() == Some(3) && has_words && !said.contains("panicked") {
        return Ok(());
    }
    Err(format!("{command}: {:?}, {said}", output.status).into())
}

fn stray(folder: &Path) -> Vec<String> {
    names(folder).into_iter().filter(|name| name.starts_with(".sdfc-")).collect()
}

fn cannot_grow() -> Result<(), Failed> {
    for (command, files) in writers() {
        let new = expected(command, files);
        let folder = prepared(files);
        let output = shell(folder.path(), &format!("trap '' XFSZ; {BLOCKS}"), command);
        refused(command, &output, &["cannot write", "File too large", "another disk"])?;
        let old = whole_files(folder.path(), command, files, &new)?;
        if old == 0 || !stray(folder.path()).is_empty() {
            return Err(format!("{command}: {old} old files, {:?}", names(folder.path())).into());
        }
    }
    Ok(())
}

/// The system ends a process that writes more than its limit, in the middle of the write.
fn ends_in_a_write() -> Result<(), Failed> {
    for (command, files) in writers() {
        let new = expected(command, files);
        let folder = prepared(files);
        let output = shell(folder.path(), BLOCKS, command);
        if output.status.code().is_some() {
            return Err(format!("{command}: {:?}, {}", output.status, said(&output)).into());
        }
        let old = whole_files(folder.path(), command, files, &new)?;
        // The part that was written has a name of its own.
        if old == 0 || stray(folder.path()).len() != 1 {
            return Err(format!("{command}: {old} old files, {:?}", names(folder.path())).into());
        }
        // It does not disturb the next process.
        let again = run(&folder, command);
        if !again.status.success() || contents(folder.path(), files) != new {
            return Err(format!("{command}, again: {}", said(&again)).into());
        }
    }
    Ok(())
}

fn full() -> Result<(), Failed> {
    let mut refusals = 0;
    for (command, files) in WRITERS {
        let folder = inputs();
        std::fs::create_dir(folder.path().join("full")).unwrap();
        // One page is free.
        let mount = "mount -t tmpfs -o size=4k tmpfs full";
        let command = command.replace("out.", "full/out.");
        // The folder is seen by this process alone, which lists it at its end.
        let output = mounted(folder.path(), &format!("trap 'ls -A full' EXIT; {mount}"), &command);
        let left = String::from_utf8_lossy(&output.stdout);
        if output.status.success() {
            continue;
        }
        refused(&command, &output, &["cannot write full/out.", "No space left", "free space"])?;
        refusals += 1;
        // A sequence keeps its whole frames.
        let is_first = |name: &str| files.len() > 1 && name.ends_with("0000.png");
        if !left.lines().all(is_first) {
            return Err(format!("{command}: left {left}").into());
        }
    }
    // Some results are smaller than a page.
    if refusals >= WRITERS.len() / 2 { Ok(()) } else { Err(format!("{refusals} refusals").into()) }
}

fn read_only() -> Result<(), Failed> {
    for (command, files) in writers() {
        let folder = prepared(files);
        let mount = "mount --bind . . && mount -o remount,ro,bind \"$PWD\" && cd \"$PWD\"";
        let output = mounted(folder.path(), mount, command);
        refused(command, &output, &["cannot write", "Read-only file system", "choose a folder"])?;
        let old = whole_files(folder.path(), command, files, &BTreeMap::new());
        if old.ok() != Some(files.len()) {
            return Err(format!("{command}: {:?}", names(folder.path())).into());
        }
    }
    Ok(())
}

fn two_processes() -> Result<(), Failed> {
    for (command, files) in writers() {
        let new = expected(command, files);
        let folder = prepared(files);
        let start = || {
            let mut process = Command::new(env!("CARGO_BIN_EXE_sdfc"));
            process.args(command.split(' ')).current_dir(folder.path());
            process.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped());
            process.spawn()
        };
        let processes = [start()?, start()?];
        for process in processes {
            let output = process.wait_with_output()?;
            // The second process may find that the first has formatted the file.
            let is_late = said(&output).contains("another program has just changed the file");
            if !output.status.success() && !is_late {
                return Err(format!("{command}: {}", said(&output)).into());
            }
        }
        if contents(folder.path(), files) != new || !stray(folder.path()).is_empty() {
            return Err(format!("{command}: {:?}", names(folder.path())).into());
        }
    }
    Ok(())
}

/// Rust ends a process that gets no memory, after a line about it. What takes much is asked for
/// in a way that can fail.
fn too_little_memory() -> Result<(), Failed> {
    for (command, words) in [
        ("render a.sdf -o out.png --backend cpu --size 16384x4096", "draw a smaller picture"),
        ("bake a.sdf -o out.npy --resolution 600", "lower the resolution"),
    ] {
        let folder = inputs();
        let output = shell(folder.path(), "ulimit -v 300000", command);
        refused(command, &output, &["out of memory", words])?;
    }
    for (command, files) in writers() {
        let new = expected(command, files);
        for limit in MEMORY {
            let folder = prepared(files);
            let before = format!("ulimit -c 0; ulimit -v {limit}");
            let output = shell(folder.path(), &before, command);
            let old = whole_files(folder.path(), command, files, &new)?;
            let is_said = output.status.success() || !said(&output).is_empty();
            if output.status.success() != (old == 0) || !is_said {
                let said = said(&output);
                return Err(
                    format!("{command}, {limit}: {:?}, {old}, {said}", output.status).into()
                );
            }
            if limit == 3_000_000 && !output.status.success() {
                return Err(format!("{command}: {}", said(&output)).into());
            }
        }
    }
    Ok(())
}

fn no_adapter() -> Result<(), Failed> {
    let folder = inputs();
    let without = |command: &str| {
        let none = "VK_DRIVER_FILES=/dev/null VK_ICD_FILENAMES=/dev/null";
        shell(folder.path(), &format!("export {none}"), command)
    };
    for command in [
        "render a.sdf -o out.png --size 24x16 --backend gpu",
        "bench a.sdf --size 24x16 --json out.json",
        "chart a.sdf --size 24x16 -o out.svg --no-cache",
        "tune a.sdf --size 24x16 --max-error 1 --json out.json --no-cache",
    ] {
        refused(command, &without(command), &["no Vulkan", "install a Vulkan driver"])?;
        if names(folder.path()).iter().any(|name| name.starts_with("out.")) {
            return Err(format!("{command}: {:?}", names(folder.path())).into());
        }
    }
    let output = without("render a.sdf -o out.png --size 24x16");
    let is_drawn = output.status.success() && folder.path().join("out.png").exists();
    if is_drawn && said(&output).contains("drawn on the CPU") {
        return Ok(());
    }
    Err(said(&output).into())
}

/// Smoothly united balls.
const MANY: &str = "union([for i in 0..400: sphere(0.08).translate(2 * (hash3(i) - 0.5))\
    .color(hsv(hash(i), 1, 1))], blend: smooth(0.05))\n";

/// Each command ends soon after Ctrl-C, with its status, and writes nothing.
fn ends_at_once(commands: &[&str]) -> Result<(), Failed> {
    for command in commands {
        let folder = folder(&[("many.sdf", MANY)]);
        let mut process = Command::new(env!("CARGO_BIN_EXE_sdfc"))
            .args(command.split(' '))
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()?;
        wait_for_handler(&mut process)?;
        std::thread::sleep(Duration::from_millis(500));
        let start = Instant::now();
        Command::new("kill").args(["-INT", &process.id().to_string()]).status()?;
        while process.try_wait()?.is_none() {
            if start.elapsed() > SOON {
                process.kill()?;
                return Err(format!("{command}: still running after {SOON:?}").into());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let output = process.wait_with_output()?;
        let said = said(&output);
        if output.status.code() != Some(130) || !said.contains("stopped") {
            return Err(format!("{command}: {:?}, {said}", output.status).into());
        }
        if names(folder.path()) != ["many.sdf"] {
            return Err(format!("{command}: {:?}", names(folder.path())).into());
        }
    }
    Ok(())
}

/// Waits until the process handles Ctrl-C: before that it would end as any process does.
fn wait_for_handler(process: &mut Child) -> Result<(), Failed> {
    let status = format!("/proc/{}/status", process.id());
    while process.try_wait()?.is_none() {
        let text = std::fs::read_to_string(&status)?;
        let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:\t"));
        let caught = caught.and_then(|mask| u64::from_str_radix(mask, 16).ok());
        // Signal 2 is the second bit.
        if caught.is_some_and(|mask| mask & 2 != 0) {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    Err("it ended by itself".into())
}
