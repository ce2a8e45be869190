//! Shadow maps kept over the frames of a run: the first frame draws all of them, later frames those that changed.

use crate::args::Args;
use crate::dirt::Dirt;
use crate::run::{Failure, Frames, Prepared, device, input, render};
use framegraph::{Extent, Format, Plan, Scratch, Target, TextureDesc};
use framegraph_passes::effects::exposure::MeasuredTextures;
use framegraph_passes::effects::shadow::{KeptShadows, Redraw, maps_slot};
use framegraph_passes::gpu_scene::shadow_views::ViewShadows;
use framegraph_passes::{Facts, FrameIo, Settings, Slot, ViewId, World, stages};
use framegraph_wgpu::{Frame, Gpu, Imports};

/// Shadow maps that outlive a frame.
#[derive(Debug, Default)]
pub struct Kept {
    maps: KeptShadows,
    /// Maps that the last declared frame draws with the reasons, and the total number of maps.
    due: (Vec<(u16, Redraw)>, usize),
}

impl Kept {
    /// Describes the number of maps that the last declared frame draws, and the reasons.
    fn describe(&self) -> String {
        let (due, all) = &self.due;
        let why =
            [Redraw::First, Redraw::Light, Redraw::Casters].map(|why| (why, due.iter().filter(|d| d.1 == why).count()));
        let reasons: Vec<_> =
            why.into_iter().filter(|(_, count)| *count > 0).map(|(why, count)| format!("{count} {why}")).collect();
        let reasons = if reasons.is_empty() { "all maps are kept".to_owned() } else { reasons.join(", ") };
        format!("draws {} of {all} shadow maps: {reasons}", due.len())
    }
}

/// Frame with its outputs and imports.
pub type Declared = (Frame<World>, FrameIo, Imports);

/// Resources of the application that a frame imports.
#[derive(Default)]
pub struct OwnResources<'a> {
    /// Kept shadow maps.
    pub kept: Option<(&'a Gpu, &'a mut Kept, &'a ViewShadows)>,
    /// Lens dirt.
    pub dirt: Option<&'a Dirt>,
}

/// Declares the standard frame with readback of the picture, and of the linear radiance if `linear` is set.
///
/// Dropped effects are noted in the graph.
///
/// # Errors
/// The error of a pass or of the device.
pub fn declare(settings: &Settings, facts: &Facts, linear: bool, own: OwnResources<'_>) -> Result<Declared, Failure> {
    let (mut frame, mut imports, mut handles) = (Frame::new(), Imports::new(), settings.handles());
    frame.allow_threads();
    facts.note(frame.graph_mut());
    if let Some(dirt) = own.dirt.filter(|_| settings.bloom.is_some()) {
        handles = dirt.declare(&mut frame, handles, &mut imports);
    }
    if let Some((gpu, kept, shadows)) = own.kept {
        kept.due = (kept.maps.due(shadows), shadows.maps.len());
        if let Some(maps) = kept.maps.declare(gpu, &mut frame, ViewId::MAIN, shadows).map_err(device)? {
            kept.maps.import(maps, &mut imports);
            handles = handles.with_shadow_maps(maps_slot(&shadows.settings), maps);
        }
    }
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
    let output = frame.graph_mut().texture("output", desc);
    // FXAA outputs sRGB-encoded values, so the target is written without another conversion.
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

/// Draws the frame that redraws all shadow maps, and declares the next frame, which is measured.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn first_frame(args: &Args, prepared: &mut Prepared) -> Result<(), Failure> {
    let Some(kept) = &prepared.kept else { return Ok(()) };
    program::line(format_args!("the first frame {}", kept.describe()));
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
    let kept = prepared.kept.as_ref().map(Kept::describe).unwrap_or_default();
    program::line(format_args!("each later frame {kept}"));
    Ok(())
}

impl Prepared {
    /// Declares the next frame.
    ///
    /// # Errors
    /// An input or device failure with a one-line message.
    pub fn declare(&mut self, args: &Args) -> Result<Declared, Failure> {
        let Self { gpu, kept, world, settings, facts, dirt, .. } = self;
        let view = &world.views.get(ViewId::MAIN).map_err(device)?.view;
        let kept = kept.as_mut().zip(view.shadows.as_ref()).map(|(kept, shadows)| (&*gpu, kept, shadows));
        declare(settings, facts, args.linear_out.is_some(), OwnResources { kept, dirt: dirt.as_ref() })
    }
}
