//! Memory budget of loading, shared by files, decoding, mip levels and upload.
//!
//! Memory of results is kept ([`Memory::keep`]); temporary memory is lent ([`Memory::lend`]). A loan waits until other
//! loans are returned, and fails if the budget is still exceeded.

use std::fs;
use std::sync::{Condvar, Mutex, MutexGuard};

/// Memory budget in bytes, shared by all loading of a scene.
///
/// ```
/// use framegraph_scene::memory::Memory;
///
/// let memory = Memory::new(1000);
/// memory.keep(600)?;
/// let loan = memory.lend(400)?;
/// assert!(memory.keep(1).is_err_and(|short| short.left_bytes == 0));
/// drop(loan);
/// assert!(memory.keep(400).is_ok());
/// # Ok::<(), framegraph_scene::memory::OverBudget>(())
/// ```
#[derive(Debug)]
pub struct Memory {
    limit_bytes: u64,
    taken: Mutex<Taken>,
    returned: Condvar,
}

#[derive(Debug, Default)]
struct Taken {
    kept_bytes: u64,
    lent_bytes: u64,
}

/// Error: an allocation exceeds the memory budget.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} of memory are needed, but only {} are left of the {} budget",
    mebibytes(*needed_bytes), mebibytes(*left_bytes), mebibytes(*limit_bytes)
)]
pub struct OverBudget {
    /// Requested bytes.
    pub needed_bytes: u64,
    /// Available bytes.
    pub left_bytes: u64,
    /// Bytes of the entire budget.
    pub limit_bytes: u64,
}

impl std::fmt::Debug for OverBudget {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// Temporarily charged memory; dropping it returns the bytes.
#[derive(Debug)]
pub struct Loan<'a> {
    memory: &'a Memory,
    bytes: u64,
}

impl Default for Memory {
    /// Returns half of the memory of the machine or its control group.
    fn default() -> Self {
        Self::new(machine_bytes() / 2)
    }
}

impl Memory {
    /// Creates a budget of `limit_bytes`.
    #[must_use]
    pub fn new(limit_bytes: u64) -> Self {
        Self { limit_bytes, taken: Mutex::default(), returned: Condvar::new() }
    }

    /// Creates an unlimited budget, for data that is already loaded.
    #[must_use]
    pub fn unlimited() -> Self {
        Self::new(u64::MAX)
    }

    /// Charges bytes until they are freed.
    ///
    /// # Errors
    /// Fails with [`OverBudget`] if fewer bytes are available.
    pub fn keep(&self, bytes: u64) -> Result<(), OverBudget> {
        let mut taken = self.taken();
        self.fits(&taken, bytes)?;
        taken.kept_bytes += bytes;
        Ok(())
    }

    /// Releases bytes charged by [`keep`](Self::keep).
    pub fn free(&self, bytes: u64) {
        let mut taken = self.taken();
        taken.kept_bytes = taken.kept_bytes.saturating_sub(bytes);
        self.returned.notify_all();
    }

    /// Charges bytes temporarily. Waits while other loans occupy the needed memory.
    ///
    /// # Errors
    /// Fails with [`OverBudget`] if fewer bytes are available without any loans.
    pub fn lend(&self, bytes: u64) -> Result<Loan<'_>, OverBudget> {
        let mut taken = self.taken();
        loop {
            match self.fits(&taken, bytes) {
                Ok(()) => break,
                Err(short) if taken.lent_bytes == 0 => return Err(short),
                Err(_) => taken = self.returned.wait(taken).unwrap_or_else(|poisoned| poisoned.into_inner()),
            }
        }
        taken.lent_bytes += bytes;
        Ok(Loan { memory: self, bytes })
    }

    fn fits(&self, taken: &Taken, bytes: u64) -> Result<(), OverBudget> {
        let left_bytes = self.limit_bytes - taken.kept_bytes - taken.lent_bytes;
        let short = OverBudget { needed_bytes: bytes, left_bytes, limit_bytes: self.limit_bytes };
        if bytes <= left_bytes { Ok(()) } else { Err(short) }
    }

    fn taken(&self) -> MutexGuard<'_, Taken> {
        self.taken.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Loan<'_> {
    /// Keeps `bytes` of the loan, and returns the rest.
    pub fn keep(self, bytes: u64) {
        self.memory.taken().kept_bytes += bytes.min(self.bytes);
    }
}

impl Drop for Loan<'_> {
    fn drop(&mut self) {
        self.memory.taken().lent_bytes -= self.bytes;
        self.memory.returned.notify_all();
    }
}

/// Assumed memory if the system does not report it.
const ASSUMED_BYTES: u64 = 8 << 30;

/// Returns the memory of the machine, or of its control group if that is smaller (Linux: `/proc/meminfo`,
/// `memory.max`).
fn machine_bytes() -> u64 {
    let meminfo = fs::read_to_string("/proc/meminfo").ok();
    let total = meminfo.as_deref().and_then(total_of).unwrap_or(ASSUMED_BYTES);
    let groups = ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"];
    let group = groups.iter().find_map(|file| fs::read_to_string(file).ok()?.trim().parse().ok());
    group.map_or(total, |group: u64| group.min(total))
}

/// Returns `MemTotal` of `/proc/meminfo`, in bytes.
fn total_of(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn what_is_kept_and_lent_together_stays_within_the_budget() {
        let memory = Memory::new(100);
        memory.keep(30).expect("30 of 100");
        let loan = memory.lend(50).expect("50 of 70");
        let short = OverBudget { needed_bytes: 21, left_bytes: 20, limit_bytes: 100 };
        assert_eq!(memory.keep(21), Err(short));
        drop(loan);
        assert_eq!(memory.lend(71).map(drop), Err(OverBudget { needed_bytes: 71, left_bytes: 70, limit_bytes: 100 }));
        memory.free(30);
        assert!(memory.lend(100).is_ok());
        memory.lend(90).expect("90 of 100").keep(60);
        assert!(memory.keep(41).is_err_and(|short| short.left_bytes == 40));
        assert!(Memory::unlimited().lend(u64::MAX).is_ok());
    }

    #[test]
    fn a_loan_waits_for_the_one_before_it() {
        let memory = Memory::new(10);
        let returned = AtomicBool::new(false);
        let first = memory.lend(6).expect("6 of 10");
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let _second = memory.lend(6).expect("6 of 10, once the first is returned");
                assert!(returned.load(Ordering::SeqCst), "both were out at once");
            });
            // Usually long enough for the other thread to have requested memory; the test also passes if it is not.
            std::thread::sleep(std::time::Duration::from_millis(20));
            returned.store(true, Ordering::SeqCst);
            drop(first);
        });
    }

    #[test]
    fn the_machine_says_how_much_it_has() {
        assert_eq!(total_of("MemFree: 1 kB\nMemTotal:       16384 kB\n"), Some(16 << 20));
        assert_eq!(total_of("MemTotal: lots\n"), None);
        assert!(machine_bytes() >= 1 << 26, "less than 64 MiB");
    }
}
