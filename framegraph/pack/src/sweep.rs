//! First fit in the order of birth, for instances too dense to examine pairs of items.
//!
//! Simulates an allocator over time: each item gets the lowest gap that fits among the live items (Robson 1974 bounds
//! the waste of such allocators). It does not know the future, so its packings are seldom the best, but it needs only
//! linear memory.

use super::problem::{Problem, align_up};

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    births: Vec<(u32, u64, u32)>,
    deaths: Vec<(u32, u32)>,
    /// Offset and end of each live item, ascending.
    live: Vec<(u64, u64)>,
}

impl Sweep {
    /// Packs all items. Returns the top. Time: for each item, linear in the number of items live at its birth.
    pub fn pack(&mut self, problem: &Problem, offsets: &mut [u64]) -> u64 {
        let Self { births, deaths, live } = self;
        births.clear();
        deaths.clear();
        for i in 0..problem.len() {
            births.push((problem.lo[i], !problem.size[i], i as u32));
            deaths.push((problem.hi[i], i as u32));
        }
        births.sort_unstable();
        deaths.sort_unstable();
        live.clear();
        let (mut top, mut died) = (0, 0);
        for &(section, _, i) in births.iter() {
            while let Some(&(_, dead)) = deaths.get(died).filter(|(end, _)| *end <= section) {
                let offset = offsets[dead as usize];
                live.remove(live.partition_point(|item| item.0 < offset));
                died += 1;
            }
            let (size, align) = (problem.size[i as usize], problem.align[i as usize]);
            let mut roof = 0;
            let gap = live.iter().position(|&(offset, end)| {
                let fits = align_up(roof, align) + size <= offset;
                roof = if fits { roof } else { end };
                fits
            });
            let offset = align_up(roof, align);
            live.insert(gap.unwrap_or(live.len()), (offset, offset + size));
            offsets[i as usize] = offset;
            top = top.max(offset + size);
        }
        top
    }
}
