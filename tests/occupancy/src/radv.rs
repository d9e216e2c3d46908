//! Runs of Mesa's driver for AMD chips that the machine does not have.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Instant;

use crate::driver;

/// The environment variable that makes this program compile the shaders of a folder and print what
/// the driver says of them.
pub const SHADERS: &str = "SDFC_OCCUPANCY_SHADERS";

/// A chip, by the name that RADV has for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chip {
    /// RDNA 2: Radeon RX 6800.
    Navi21,
    /// RDNA 1: Radeon RX 5700.
    Navi10,
    /// GCN 5: Radeon RX Vega.
    Vega10,
}

impl Chip {
    /// All chips.
    pub const ALL: [Self; 3] = [Self::Navi21, Self::Navi10, Self::Vega10];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Navi21 => "NAVI21",
            Self::Navi10 => "NAVI10",
            Self::Vega10 => "VEGA10",
        }
    }
}

/// What the compiler made of one shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Vector registers.
    pub registers: u64,
    /// Vector registers that did not fit and are kept in memory.
    pub spilled: u64,
    /// Groups of threads that run at once on one SIMD unit.
    pub waves: u64,
    /// Instructions.
    pub instructions: u64,
    /// The compiler's estimate of the cycles of one group ("inverse throughput"), where it counts
    /// every loop as eight iterations.
    pub cost: u64,
}

/// What the compiler made of the shaders of a folder.
#[derive(Clone, Debug)]
pub struct Run {
    /// Name and version of the driver.
    pub driver: String,
    /// The shaders, in the order of their names.
    pub shaders: Vec<Statistics>,
    /// The time that each took to compile, in microseconds.
    pub times: Vec<u64>,
}

/// The file that tells the Vulkan loader where RADV is; `None` if it is not installed.
pub fn manifest() -> Option<&'static Path> {
    static FOUND: OnceLock<Option<PathBuf>> = OnceLock::new();
    FOUND
        .get_or_init(|| {
            let folders = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
            let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok());
            let mut paths = entries.flatten().flatten().map(|entry| entry.path());
            paths.find(|path| {
                let name = path.file_name().and_then(OsStr::to_str).unwrap_or("");
                name.starts_with("radeon_icd") && name.contains(std::env::consts::ARCH)
            })
        })
        .as_deref()
}

/// Compiles the shaders of a folder for a chip, in a process of its own.
///
/// # Errors
///
/// The process fails, or prints something else.
pub fn statistics(chip: Chip, manifest: &Path, folder: &Path) -> Result<Run, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new(program)
        .env(SHADERS, folder)
        .env("VK_ICD_FILENAMES", manifest)
        .env("VK_DRIVER_FILES", manifest)
        .env("RADV_FORCE_FAMILY", chip.name())
        .env("RADV_DEBUG", "nocache")
        .output()
        .map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{}: {} {text}{errors}", chip.name(), output.status));
    }
    let mut lines = text.lines();
    let driver = lines.next().unwrap_or("").to_owned();
    let shaders = lines.map(parsed).collect::<Option<Vec<_>>>();
    let (shaders, times) =
        shaders.ok_or_else(|| format!("not understood: {text}"))?.into_iter().unzip();
    Ok(Run { driver, shaders, times })
}

fn parsed(line: &str) -> Option<(Statistics, u64)> {
    let numbers: Vec<u64> = line.split(' ').map(str::parse).collect::<Result<_, _>>().ok()?;
    let [registers, spilled, waves, instructions, cost, time] = numbers[..] else { return None };
    Some((Statistics { registers, spilled, waves, instructions, cost }, time))
}

/// Compiles the shaders of a folder and prints the driver and a line for each shader.
pub fn print_statistics(folder: &OsStr) {
    match compiled(Path::new(folder)) {
        Ok(Run { driver, shaders, times }) => {
            println!("{driver}");
            for (shader, time) in shaders.into_iter().zip(times) {
                let Statistics { registers, spilled, waves, instructions, cost } = shader;
                println!("{registers} {spilled} {waves} {instructions} {cost} {time}");
            }
        }
        Err(message) => {
            println!("{message}");
            std::process::exit(1);
        }
    }
}

fn compiled(folder: &Path) -> Result<Run, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| error.to_string())?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let device = driver::Device::open().map_err(|error| error.to_string())?;
    let (mut shaders, mut times) = (Vec::new(), Vec::new());
    for path in paths {
        let code = std::fs::read(&path).map_err(|error| error.to_string())?;
        let words = driver::words(&code);
        let start = Instant::now();
        let named = device.statistics(&words).map_err(|e| format!("{}: {e}", path.display()))?;
        times.push(start.elapsed().as_micros() as u64);
        let get = |name: &str| {
            let found = named.iter().find(|(known, _)| known == name);
            found.map(|found| found.1).ok_or_else(|| format!("the driver does not report {name}"))
        };
        shaders.push(Statistics {
            registers: get("VGPRs")?,
            spilled: get("Spilled VGPRs")?,
            waves: get("Subgroups per SIMD")?,
            instructions: get("Instructions")?,
            cost: get("Inverse Throughput")?,
        });
    }
    Ok(Run { driver: device.driver().to_owned(), shaders, times })
}
