//! What the slices load, store and clear, as the compiler planned it.

use framegraph::{Counts, Format, Plan, Scratch};
use framegraph_wgpu::{Frame, Imports};

use super::*;
use crate::light::ibl::cube::{LevelSamples, Prefilter, Source, level_kernel};
use crate::light::ibl::integrate::{declare_slice, program};
use crate::light::ibl::slices::compile;
use crate::light::ibl::texture::CubeShape;

/// The counts of one slice.
fn counts(gpu: &Gpu, frame: &Frame) -> Counts {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    compile(frame.graph(), gpu, &mut scratch, &mut plan).expect("the slice compiles");
    plan.counts()
}

/// A slice of draws that replace all that they touch.
fn overwrites(faces: u32) -> Counts {
    Counts { resolves: faces, steps: faces, render_passes: faces, passes: faces, ..Counts::default() }
}

#[test]
fn faces_are_stored_once_and_never_loaded() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = noop();
    let source = Source::new(&gpu, &gradient().map, 64, 1.0)?;
    let shape = CubeShape { texels: 64, levels: SMALL.levels, format: Format::Rgba16Float };
    let prefilter = Prefilter::new(&gpu, "cube", &source, &shape)?;
    let mut imports = Imports::new();
    let mut frame = Frame::new();
    source.resample(5, &mut frame, &mut imports)?;
    assert_eq!(counts(&gpu, &frame), overwrites(1));

    frame.reset();
    source.halve(&mut frame, &mut imports)?;
    assert_eq!(counts(&gpu, &frame), overwrites(6 * 6), "64 texels have six further levels");

    let samples = LevelSamples::new(&level_kernel(&SMALL, 2));
    for read_back in [false, true] {
        frame.reset();
        prefilter.face(2, 3, &samples, read_back, &mut frame, &mut imports)?;
        let draw_and_copy = Counts { steps: 2, passes: 2, ..overwrites(1) };
        assert_eq!(counts(&gpu, &frame), draw_and_copy, "{read_back}");
    }
    Ok(())
}

#[test]
fn the_table_is_cleared_once_and_then_added_to() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = noop();
    let program = program()?;
    let settings = DfgSettings { texels: 40, ..DfgSettings::default() };
    for (slice, expected) in [
        (0, Counts { clears: 1, ..overwrites(1) }),
        (1, Counts { unresolves: 1, ..overwrites(1) }),
        (2, Counts { unresolves: 1, ..overwrites(1) }),
    ] {
        let mut frame = Frame::new();
        declare_slice(settings, slice, &program, &mut frame)?;
        assert_eq!(counts(&gpu, &frame), expected, "slice {slice}");
    }
    Ok(())
}
