//! What drops save: the plan of the frame with each against the plan without it.

use super::decided::Facts;
use super::effect::{Effect, EffectSet};
use crate::frame::{Settings, StandardWorld, standard};
use crate::stages::StageError;
use framegraph::{Caps, CompileErrors, Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_wgpu::Frame;

/// What a frame costs by its plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Passes that run.
    pub passes: u32,
    /// Attachments that are loaded from memory into the tile.
    pub loads: u32,
    /// Attachments that are stored.
    pub stores: u32,
    /// Bytes that both move.
    pub moved_bytes: u64,
    /// Bytes of memory that the frame's own textures take: shared ones, and those that outlive the frame.
    pub memory_bytes: u64,
}

impl Cost {
    /// That of a plan.
    pub fn of(plan: &Plan) -> Self {
        let (counts, traffic, memory) = (plan.counts(), plan.traffic(plan.frame()), plan.memory());
        Self {
            passes: counts.passes,
            loads: counts.unresolves,
            stores: counts.resolves,
            moved_bytes: traffic.loaded_bytes + traffic.stored_bytes,
            memory_bytes: memory.bytes + memory.own_bytes,
        }
    }
}

/// What leaving one effect out saves, all other drops being made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saved {
    /// Which.
    pub effect: Effect,
    /// The frame with it.
    pub with: Cost,
    /// The frame without.
    pub without: Cost,
    /// What both take in ms, if that was measured.
    pub ms: Option<[f64; 2]>,
}

/// A frame cannot be planned.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum CostError {
    /// A stage refuses what the settings ask for.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The plan is refused.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
}

impl std::fmt::Debug for CostError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// What the standard frame of these settings costs, its picture of eight bits a channel read back.
///
/// # Errors
/// When the device cannot hold the frame, or the settings do not go together.
pub fn costs<W: StandardWorld + ?Sized>(
    settings: &Settings,
    caps: &Caps,
    options: &Options,
    scratch: &mut Scratch,
) -> Result<Cost, CostError> {
    let mut frame = Frame::<W>::new();
    let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
    let io = standard(&mut frame, settings, Target::from(output))?;
    frame.graph_mut().readback(io.output).map_err(StageError::from)?;
    let mut plan = Plan::new();
    compile(frame.graph(), caps, options, scratch, &mut plan)?;
    Ok(Cost::of(&plan))
}

/// What each drop saves on a device.
///
/// # Errors
/// As [`costs`].
pub fn savings<W: StandardWorld + ?Sized>(
    facts: &Facts,
    asked: &Settings,
    caps: &Caps,
    options: &Options,
) -> Result<Vec<Saved>, CostError> {
    let mut scratch = Scratch::new();
    let without = costs::<W>(&facts.apply(asked), caps, options, &mut scratch)?;
    let mut saved = Vec::new();
    for effect in facts.dropped().iter() {
        let kept = facts.apply_but(asked, EffectSet::NONE.with(effect));
        saved.push(Saved { effect, with: costs::<W>(&kept, caps, options, &mut scratch)?, without, ms: None });
    }
    Ok(saved)
}
