//! One depth per texel from several samples, for effects that read depth.

use crate::error::PassError;
use crate::stages::{Handles, Holds, Slot, StageError};
use framegraph::{DeclareError, Pass, PassBuilder, ResolveMode, Texture, TextureDesc};
use framegraph_wgpu::{Cx, Frame, Gpu, Record, RecordError};

/// Which of a texel's samples gives its depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthOf {
    /// The first: a depth that some surface has there, the same one from frame to frame.
    #[default]
    FirstSample = 0,
    /// The one nearest to the eye.
    Nearest = 1,
    /// The one farthest from the eye.
    Farthest = 2,
}

impl DepthOf {
    /// The resolve that takes that sample of reversed depth: nearer is larger.
    pub const fn mode(self) -> ResolveMode {
        match self {
            Self::FirstSample => ResolveMode::Sample0,
            Self::Nearest => ResolveMode::Max,
            Self::Farthest => ResolveMode::Min,
        }
    }
}

/// Resolves depth of several samples into a texture of one. It draws nothing, so it shares the step that drew the depth when
/// it is declared right behind; a device that resolves depth in its store then does that without leaving the tile.
#[derive(Clone, Copy, Debug)]
pub struct DepthResolve {
    /// Reversed depth, of several samples.
    pub depth: Texture,
    /// Which sample counts.
    pub which: DepthOf,
}

/// What the pass wrote.
#[derive(Clone, Copy, Debug)]
pub struct DepthResolveIo {
    /// Reversed depth, of one sample and the same size.
    pub depth: Texture,
}

impl Pass for DepthResolve {
    type Io = DepthResolveIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<DepthResolveIo, DeclareError> {
        let desc = pass.desc(self.depth)?;
        if desc.samples == 1 {
            return Err(pass.error("the depth has one sample per texel", "read it as it is"));
        }
        pass.depth_read_only(self.depth)?;
        let depth = pass.texture("resolved_depth", TextureDesc::new(desc.extent, desc.format.depth_alone()));
        Ok(DepthResolveIo { depth: pass.resolve_as(self.which.mode(), self.depth, depth)? })
    }
}

impl<W: ?Sized> Record<W> for DepthResolve {
    fn record(&self, _: &DepthResolveIo, _: &W, _: &mut Cx<'_>) -> Result<(), RecordError> {
        Ok(())
    }
}

/// Refuses a back end that cannot read depth of so many samples: wgpu 30 makes no storage for textures of several samples
/// that OpenGL is to read; they hold nothing.
pub(crate) fn can_read_samples(samples: u8, gpu: &Gpu) -> Result<(), PassError> {
    if samples > 1 && gpu.info().backend == wgpu::Backend::Gl {
        return Err(PassError::DepthSamples);
    }
    Ok(())
}

/// Depth of one sample per texel, for a stage whose effect reads depth: the depth so far as it is where the frame has one
/// sample, else of a pass `depth_resolve`, which is declared when the first stage asks and serves all that ask alike.
///
/// # Errors
/// When no stage has handed on depth.
pub fn single_sample_depth<W: ?Sized + 'static>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    which: DepthOf,
) -> Result<Texture, StageError> {
    let depth = handles.get(Slot::DEPTH)?;
    let graph = frame.graph();
    let desc = graph.resource_of(depth).and_then(|resource| graph.resources()[resource.index()].desc.texture());
    if desc.is_some_and(|desc| desc.samples == 1) {
        return Ok(depth);
    }
    let [slot, of] = match which {
        DepthOf::FirstSample => ["depth_first_sample", "depth_first_sample_of"],
        DepthOf::Nearest => ["depth_nearest", "depth_nearest_of"],
        DepthOf::Farthest => ["depth_farthest", "depth_farthest_of"],
    };
    // Transmissive surfaces add to the depth: what was resolved before is not the depth so far any more.
    let (slot, of) = (Slot::new(slot, Holds::Depth), Slot::new(of, Holds::DepthSamples));
    if let Some(resolved) = handles.find(slot).filter(|_| handles.find(of) == Some(depth)) {
        return Ok(resolved);
    }
    let resolved = frame.add("depth_resolve", DepthResolve { depth, which })?.depth;
    handles.set(slot, resolved);
    handles.set(of, depth);
    Ok(resolved)
}
