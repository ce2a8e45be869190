//! Measures the memory for declaring and compiling graphs of several sizes.

use crate::{COUNTING, Frames, workload};
use stats_alloc::Region;

/// Returns the bytes allocated since `region` began, ignoring deallocations. An upper bound of the peak.
fn asked(region: &Region<'_, std::alloc::System>) -> usize {
    // Includes the growth of arrays.
    region.change().bytes_allocated
}

const HEAD: &str = "\
## Memory

Bytes for each pass of a graph that is declared and compiled for the first time: all that the counting allocator was asked
for, so no less than the peak, with the spare room of arrays that grow by doubling. Again is what the second set of arrays
takes, when the graph is declared anew while a plan holds the first.

| graph | declare, bytes a pass | compile, bytes a pass | both | again |
| --- | --- | --- | --- | --- |";

/// Prints bytes per pass of cold graphs of three sizes.
pub fn print() {
    program::line(HEAD);
    for passes in [10_000, 50_000, 100_000] {
        let mut frames = Frames::new(workload::dag(passes, 42));
        frames.handles.reserve(frames.work.resources.len());
        let bytes = |run: &mut dyn FnMut()| {
            let region = Region::new(COUNTING);
            run();
            asked(&region) / passes
        };
        let declared = bytes(&mut || frames.declare());
        let compiled = bytes(&mut || frames.compile());
        let again = bytes(&mut || frames.declare());
        program::line(format_args!("| dag_{passes} | {declared} | {compiled} | {} | {again} |", declared + compiled));
    }
    program::line("");
}
