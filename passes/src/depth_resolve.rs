//! One depth per texel from several samples, for effects that read depth.

use crate::error::PassError;
use crate::full_screen::FullScreen;
use crate::prepass::DEPTH_FORMAT;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::stages::{Handles, Holds, Slot, StageError};
use framegraph::{DeclareError, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::Module;
use framegraph_wgpu::{Cx, Depth, Frame, Gpu, Record, RecordError};
use wgpu::CompareFunction;

static INTERFACE: Interface = Interface { groups: &[&["depth_samples"]], constants: &["DEPTH_RESOLVE"] };

static SHADER: Module<'static> = Module::new("depth_resolve.wgsl", include_str!("depth_resolve.wgsl"));

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

/// Makes a single-sampled depth texture of one with several samples, by a full-screen pass. Needs no more of the world than
/// [`Programs`].
#[derive(Clone, Copy, Debug)]
pub struct DepthResolve {
    /// Reversed depth, of several samples.
    pub depth: Texture,
    /// Which sample counts.
    pub which: DepthOf,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct DepthResolveIo {
    samples: View,
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
        let samples = pass.sampled(self.depth)?;
        let depth = pass.texture("resolved_depth", TextureDesc::new(desc.extent, DEPTH_FORMAT));
        Ok(DepthResolveIo { samples, depth: pass.depth(depth, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for DepthResolve {
    fn record(&self, io: &DepthResolveIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        can_read_samples(2, cx.gpu())?;
        let provided = [Some(cx.view(io.samples)?.into())];
        let depth = Depth { compare: CompareFunction::Always, write: true, ..Depth::NONE };
        let draw = FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[]);
        let constants = [f64::from(self.which as u8)];
        FullScreen { constants: &constants, groups: &[&provided], depth, ..draw }.draw(world.as_ref(), cx)
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
pub fn single_sample_depth<W: AsRef<Programs> + ?Sized + 'static>(
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
