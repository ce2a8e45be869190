//! One process under limits of time and memory.

use program::interrupt;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Time between two looks at a process.
const PAUSE: Duration = Duration::from_millis(10);
/// Bytes of an output that are read.
const MAX_OUTPUT_BYTES: u64 = 1 << 20;

/// Limits of a process.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Wall-clock time.
    pub time: Duration,
    /// Resident memory in bytes. Checked on Linux, where the system reports it.
    pub memory_bytes: u64,
}

/// End of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// By itself, or by a signal that this program did not send.
    Status(ExitStatus),
    /// Stopped at the time limit.
    Time,
    /// Stopped above the memory limit.
    Memory,
    /// Stopped because this program was asked to stop.
    Interrupted,
}

/// A process that has ended.
#[derive(Debug)]
pub struct Ended {
    /// Its end.
    pub end: End,
    /// Wall-clock time that it took.
    pub took: Duration,
    /// Largest resident memory in bytes that was seen; 0 where the system does not report it.
    pub peak_bytes: u64,
    /// Start of its standard output.
    pub out: String,
    /// Start of its standard error.
    pub err: String,
}

/// Runs a command to its end or to a limit. Its outputs go through files in `scratch`.
///
/// # Errors
/// When the process cannot be started or watched.
pub fn run(command: &mut Command, limits: Limits, scratch: &Path) -> io::Result<Ended> {
    let (out, err) = (scratch.join("stdout"), scratch.join("stderr"));
    command.stdin(Stdio::null()).stdout(File::create(&out)?).stderr(File::create(&err)?);
    let start = Instant::now();
    let mut child = command.spawn()?;
    let watched = watch(&mut child, limits, start);
    if !matches!(watched, Ok((End::Status(_), _))) {
        // A process that has just ended by itself cannot be stopped; both are waited for.
        let _ = child.kill();
        child.wait()?;
    }
    let (end, peak_bytes) = watched?;
    Ok(Ended { end, took: start.elapsed(), peak_bytes, out: start_of(&out)?, err: start_of(&err)? })
}

fn watch(child: &mut Child, limits: Limits, start: Instant) -> io::Result<(End, u64)> {
    let mut peak_bytes = 0;
    loop {
        if let Some(status) = child.try_wait()? {
            // A signal to the whole group ends children too: their ends are no verdicts.
            let end = if interrupt::check().is_err() { End::Interrupted } else { End::Status(status) };
            return Ok((end, peak_bytes));
        }
        peak_bytes = peak_bytes.max(resident_bytes(child.id()).unwrap_or(0));
        if interrupt::check().is_err() {
            return Ok((End::Interrupted, peak_bytes));
        }
        if peak_bytes > limits.memory_bytes {
            return Ok((End::Memory, peak_bytes));
        }
        if start.elapsed() >= limits.time {
            return Ok((End::Time, peak_bytes));
        }
        std::thread::sleep(PAUSE);
    }
}

/// Returns the resident memory of a process, as Linux reports it (proc(5), `/proc/pid/status`, VmRSS).
///
/// An address-space limit (RLIMIT_AS) would not do: drivers reserve far more addresses than they use.
fn resident_bytes(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

fn start_of(file: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(file)?.take(MAX_OUTPUT_BYTES).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
