//! What a process holds of the system's resources.

use std::fs;

/// Memory, threads and open files of a process; all 0 where `/proc` does not tell them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resources {
    /// Resident memory in MiB.
    pub memory: u64,
    /// Threads.
    pub threads: u64,
    /// Open files, pipes and sockets.
    pub files: u64,
}

/// Allowed growth of memory in MiB: allocators keep freed memory.
const MEMORY_SLACK: u64 = 48;
/// The number of threads and files that may be open for a moment.
const TRANSIENT: u64 = 8;

impl Resources {
    /// Those of a process by its number, or of this one by `"self"`.
    pub fn of(process: &str) -> Self {
        let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
        let number = |name: &str| -> u64 {
            let line = status.lines().find_map(|line| line.strip_prefix(name));
            line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
        };
        let files = fs::read_dir(format!("/proc/{process}/fd"));
        Self {
            memory: number("VmRSS:") / 1024,
            threads: number("Threads:"),
            files: files.map_or(0, |files| files.count() as u64),
        }
    }

    /// Compares the last sample with the most of the first half.
    ///
    /// # Errors
    ///
    /// Says what has grown, with all samples.
    pub fn have_not_grown(samples: &[Self]) -> Result<(), String> {
        let Some(end) = samples.last() else { return Ok(()) };
        let half = &samples[..=samples.len() / 2];
        let most = |of: fn(&Self) -> u64| half.iter().map(of).max().unwrap_or(0);
        let grown = if end.threads > most(|it| it.threads) + TRANSIENT {
            "threads"
        } else if end.files > most(|it| it.files) + TRANSIENT {
            "open files"
        } else if end.memory > most(|it| it.memory) + MEMORY_SLACK {
            "memory"
        } else {
            return Ok(());
        };
        Err(format!("{grown}: {samples:?}"))
    }
}
