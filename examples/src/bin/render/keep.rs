//! Shadow maps that are kept over the frames of a run: a first frame draws them, and the others draw what is due.

use crate::args::Args;
use crate::dirt::Dirt;
use crate::run::{Failure, Frames, Prepared, device, input, render};
use framegraph::{Extent, Format, Plan, Scratch, Target, TextureDesc};
use framegraph_passes::measure::MeasuredTextures;
use framegraph_passes::shadow::{KeptShadows, Redraw, ViewShadows, maps_slot};
use framegraph_passes::{Facts, FrameIo, Settings, Slot, ViewId, World, stages};
use framegraph_wgpu::{Frame, Gpu, Imports};

/// Shadow maps that outlive a frame.
#[derive(Debug, Default)]
pub struct Kept {
    maps: KeptShadows,
    /// Maps that the last declared frame draws, of so many.
    due: (Vec<(u16, Redraw)>, usize),
}

impl Kept {
    /// How many maps the last declared frame draws, and why.
    fn told(&self) -> String {
        let (due, all) = &self.due;
        let why =
            [Redraw::First, Redraw::Light, Redraw::Casters].map(|why| (why, due.iter().filter(|d| d.1 == why).count()));
        let reasons: Vec<_> =
            why.into_iter().filter(|(_, count)| *count > 0).map(|(why, count)| format!("{count} {why}")).collect();
        let reasons = if reasons.is_empty() { "all are kept".to_owned() } else { reasons.join(", ") };
        format!("draws {} of {all} shadow maps: {reasons}", due.len())
    }
}

/// A frame with what it imports.
pub type Declared = (Frame<World>, FrameIo, Imports);

/// What a frame is drawn over, of this application's own.
#[derive(Default)]
pub struct Own<'a> {
    /// Shadow maps that are kept.
    pub kept: Option<(&'a Gpu, &'a mut Kept, &'a ViewShadows)>,
    /// Dirt on the lens.
    pub dirt: Option<&'a Dirt>,
}

/// The standard frame with its picture read back, and the linear radiance too if it is asked for. What facts left out is noted
/// in the graph.
///
/// # Errors
/// What a pass refuses, or the device.
pub fn declare(settings: &Settings, facts: &Facts, linear: bool, own: Own<'_>) -> Result<Declared, Failure> {
    let (mut frame, mut imports, mut handles) = (Frame::new(), Imports::new(), settings.handles());
    facts.note(frame.graph_mut());
    if let Some(dirt) = own.dirt.filter(|_| settings.bloom.is_some()) {
        handles = dirt.declare(&mut frame, handles, &mut imports);
    }
    if let Some((gpu, kept, shadows)) = own.kept {
        kept.due = (kept.maps.due(shadows), shadows.maps.len());
        if let Some(maps) = kept.maps.declare(gpu, &mut frame, ViewId::MAIN, shadows).map_err(device)? {
            kept.maps.import(maps, &mut imports);
            handles = handles.with(maps_slot(&shadows.settings), maps);
        }
    }
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
    let output = frame.graph_mut().texture("output", desc);
    // The edge filter has codes of sRGB, which are written as they are: the device need not make them once more.
    let target = if settings.fxaa { output.viewed_as(Format::Rgba8Unorm).into() } else { Target::from(output) };
    let handles = stages(settings).declare(&mut frame, handles, target).map_err(device)?;
    let slot = |slot| handles.get(slot).map_err(device);
    let measured = MeasuredTextures::of(&handles);
    let io = FrameIo { hdr: slot(Slot::HDR)?, output: slot(Slot::PICTURE)?, measured };
    frame.graph_mut().readback(io.output).map_err(device)?;
    if linear {
        frame.graph_mut().readback(io.hdr).map_err(device)?;
    }
    Ok((frame, io, imports))
}

/// Draws the frame that all maps are due in, and declares the next one, which is that of the table and the picture.
///
/// # Errors
/// One line, by whose fault it is.
pub fn first_frame(args: &Args, prepared: &mut Prepared) -> Result<(), Failure> {
    let Some(kept) = &prepared.kept else { return Ok(()) };
    program::line(format_args!("the first frame {}", kept.told()));
    let (options, execute) = prepared.options(args);
    let mut plan = Plan::new();
    let mut executor = prepared.executor(args, execute)?;
    executor.compile(prepared.frame.graph(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
    render(prepared, &plan, &mut executor, 0..1, &mut Frames::new(1))?;
    let Prepared { kept, world, .. } = &mut *prepared;
    let view = &world.views.get(ViewId::MAIN).map_err(device)?.view;
    if let (Some(kept), Some(shadows)) = (kept, &view.shadows) {
        kept.maps.drawn(shadows);
    }
    (prepared.frame, prepared.io, prepared.imports) = prepared.declare(args)?;
    let kept = prepared.kept.as_ref().map(Kept::told).unwrap_or_default();
    program::line(format_args!("each frame after it {kept}"));
    Ok(())
}

impl Prepared {
    /// The next frame.
    ///
    /// # Errors
    /// One line, by whose fault it is.
    pub fn declare(&mut self, args: &Args) -> Result<Declared, Failure> {
        let Self { gpu, kept, world, settings, facts, dirt, .. } = self;
        let view = &world.views.get(ViewId::MAIN).map_err(device)?.view;
        let kept = kept.as_mut().zip(view.shadows.as_ref()).map(|(kept, shadows)| (&*gpu, kept, shadows));
        declare(settings, facts, args.linear_out.is_some(), Own { kept, dirt: dirt.as_ref() })
    }
}
