//! A warm frame allocates as often as the same wgpu calls by hand, because the executor itself allocates nothing.
//!
//! This is a program without the test harness, because the allocator counts for the whole process.

#[path = "../benches/overhead/by_hand.rs"]
mod by_hand;
#[allow(dead_code, reason = "the bench records on threads too")]
#[path = "../benches/overhead/executed.rs"]
mod executed;
#[path = "../benches/overhead/shared.rs"]
mod shared;

use by_hand::ByHand;
use executed::{Executed, declare};
use framegraph_wgpu::{FrameLoop, Gpu};
use shared::{Case, TEXELS};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::error::Error;
use std::sync::Arc;

#[global_allocator]
static COUNTING: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Number of frames before the measured ones, and of measured frames. Both are longer than the age at which unused
/// objects are looked for, and filled so far that lists do not grow while frames are measured.
const WARM_UP: usize = 140;
const FRAMES: usize = 60;

/// Returns the number of allocations of all measured frames.
fn allocations(mut frame: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<usize, Box<dyn Error>> {
    (0..WARM_UP).try_for_each(|_| frame())?;
    let region = Region::new(COUNTING);
    (0..FRAMES).try_for_each(|_| frame())?;
    let change = region.change();
    Ok(change.allocations + change.reallocations)
}

fn main() -> Result<(), Box<dyn Error>> {
    for (passes, draws) in [(2, 1), (5, 1), (50, 1)] {
        let (gpu, case) = (Gpu::noop()?, Case { passes, draws });
        let mut hand = ByHand::new(&gpu, case);
        let of_hand = allocations(|| hand.frame())?;
        let done = Arc::new(());
        let of_called = allocations(|| {
            hand.frame()?;
            let done = done.clone();
            gpu.queue.on_submitted_work_done(move || drop(done));
            Ok(())
        })?;
        let mut own = Executed::new(&gpu, case, false)?;
        let executed = allocations(|| own.frame())?;
        let mut timed = Executed::new(&gpu, case, true)?;
        let timed = allocations(|| timed.frame())?;
        let mut frames = FrameLoop::<()>::new(&gpu);
        let looped = allocations(|| {
            frames.run([TEXELS; 2], &(), |frame, _| declare(frame, case))?;
            Ok(())
        })?;
        let [hand, called, executed, timed, looped] =
            [of_hand, of_called, executed, timed, looped].map(|sum| sum as f64 / FRAMES as f64);
        program::line(format_args!(
            "{passes} × {draws}: allocations a frame: {hand:.2} by hand, {executed:.2} executed, {timed:.2} timed; \
             {called:.2} by hand with a callback at the end, {looped:.2} declared and executed by a frame loop"
        ));
        assert!(executed <= hand, "the executor allocates");
        assert!(looped <= called, "the frame loop allocates");
    }
    Ok(())
}
