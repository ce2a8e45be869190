//! Savings of drops: the plan of the frame with each effect compared with the plan without it.

use super::decided::Facts;
use super::effect::{Effect, EffectSet};
use crate::frame::{Settings, StandardWorld, standard};
use crate::stages::StageError;
use framegraph::{Caps, CompileErrors, Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_wgpu::Frame;

/// Cost of a frame according to its plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Number of passes that run.
    pub passes: u32,
    /// Number of attachments loaded into the tile.
    pub loads: u32,
    /// Number of attachments stored.
    pub stores: u32,
    /// Bytes moved by loads and stores.
    pub moved_bytes: u64,
    /// Bytes of memory of the frame's own textures, shared ones and histories.
    pub memory_bytes: u64,
}

impl Cost {
    /// Returns the cost of a plan.
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

/// Savings of dropping one effect, with all other drops made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saved {
    /// The effect.
    pub effect: Effect,
    /// Cost of the frame with the effect.
    pub with: Cost,
    /// Cost of the frame without the effect.
    pub without: Cost,
    /// Measured times of both frames in milliseconds.
    pub ms: Option<[f64; 2]>,
}

/// Error of planning a frame.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum CostError {
    /// A stage refused the settings.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The graph did not compile.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
}

impl std::fmt::Debug for CostError {
    /// Prints the message, as `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Returns the cost of the standard frame with these settings, for a read-back picture with 8 bits per channel.
///
/// # Errors
/// Fails if the device cannot hold the frame, or the settings contradict each other.
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

/// Returns the savings of each drop on a device.
///
/// # Errors
/// Fails as [`costs`] does.
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
