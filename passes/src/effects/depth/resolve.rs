//! Resolves multisampled depth to one value per texel, for effects that read depth.

use crate::error::PassError;
use crate::stages::{Handles, Holds, Slot, StageError};
use framegraph::{DeclareError, Pass, PassBuilder, ResolveMode, Texture, TextureDesc};
use framegraph_wgpu::{Cx, Frame, Gpu, Record, RecordError};

/// Sample that gives the depth of a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthOf {
    /// Sample 0: the depth of a real surface, stable from frame to frame.
    #[default]
    FirstSample = 0,
    /// Sample nearest to the eye.
    Nearest = 1,
    /// Sample farthest from the eye.
    Farthest = 2,
}

impl DepthOf {
    /// Returns the resolve mode for reversed depth, in which nearer is larger.
    pub const fn mode(self) -> ResolveMode {
        match self {
            Self::FirstSample => ResolveMode::Sample0,
            Self::Nearest => ResolveMode::Max,
            Self::Farthest => ResolveMode::Min,
        }
    }
}

/// Resolves multisampled depth into a single-sampled texture. Draws nothing, so it shares the step that drew the depth
/// if declared directly after it. Devices that resolve depth at the end of a pass then keep it in the tile.
#[derive(Clone, Copy, Debug)]
pub struct DepthResolve {
    /// Reversed depth with several samples.
    pub depth: Texture,
    /// Sample that gives the depth.
    pub which: DepthOf,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct DepthResolveIo {
    /// Reversed depth with one sample, of the same size.
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

/// Fails if the back end cannot read depth with this number of samples. On OpenGL, wgpu 30 does not allocate sampled
/// multisampled textures; they stay empty.
pub(crate) fn can_read_samples(samples: u8, gpu: &Gpu) -> Result<(), PassError> {
    if samples > 1 && gpu.info().backend == wgpu::Backend::Gl {
        return Err(PassError::DepthSamples);
    }
    Ok(())
}

/// Returns single-sampled depth for a stage. If the frame has several samples, the first request declares a pass
/// `depth_resolve`; later requests for the same sample share it.
///
/// # Errors
/// Fails if no stage has set the depth.
pub fn single_sample_depth<W: ?Sized>(
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
    // Transmissive surfaces write depth later; an earlier resolve is then outdated.
    let (slot, of) = (Slot::new(slot, Holds::Depth), Slot::new(of, Holds::DepthSamples));
    if let Some(resolved) = handles.find(slot).filter(|_| handles.find(of) == Some(depth)) {
        return Ok(resolved);
    }
    let resolved = frame.add("depth_resolve", DepthResolve { depth, which })?.depth;
    handles.set(slot, resolved);
    handles.set(of, depth);
    Ok(resolved)
}
