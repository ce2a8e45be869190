//! A chain of this library's passes: bloom, grading with tone mapping, FXAA.

use crate::execute::CameraTextures;
use framegraph::{DeclareError, Target, Texture};
use framegraph_passes::effects::bloom::{BloomChain, BloomMix, bloom};
use framegraph_passes::effects::fxaa::Fxaa;
use framegraph_passes::effects::post::Post;
use framegraph_passes::gpu_scene::view::Views;
use framegraph_passes::grading::GradingTables;
use framegraph_passes::program::Programs;
use framegraph_passes::{BloomSettings, FrameIndex, Handles, PostSettings, Slot, StageError};
use framegraph_shaders::layout::FxaaUniforms;
use framegraph_wgpu::{DeviceError, Frame, Gpu};

/// Data that recorders of a chain read. Lives as long as its camera.
#[derive(Debug)]
pub struct PostWorld {
    programs: Programs,
    views: Views,
    grading: GradingTables,
    frame: FrameIndex,
}

impl PostWorld {
    /// Creates the data, without views.
    ///
    /// # Errors
    /// Fails if the device fails.
    pub fn new(gpu: &Gpu) -> Result<Self, DeviceError> {
        Ok(Self {
            programs: Programs::new(),
            views: Views::new(gpu, [])?,
            grading: GradingTables::default(),
            frame: FrameIndex(0),
        })
    }

    pub(crate) const fn next_frame(&mut self) {
        self.frame.0 = self.frame.0.wrapping_add(1);
    }
}

impl AsRef<Programs> for PostWorld {
    fn as_ref(&self) -> &Programs {
        &self.programs
    }
}

impl AsRef<Views> for PostWorld {
    fn as_ref(&self) -> &Views {
        &self.views
    }
}

impl AsRef<GradingTables> for PostWorld {
    fn as_ref(&self) -> &GradingTables {
        &self.grading
    }
}

impl AsRef<FrameIndex> for PostWorld {
    fn as_ref(&self) -> &FrameIndex {
        &self.frame
    }
}

/// Settings of [`standard`].
#[derive(Clone, Copy, Debug)]
pub struct StandardPost {
    /// Bloom; `None` for none.
    pub bloom: Option<BloomSettings>,
    /// Grading, tone curve, vignette and dither.
    pub post: PostSettings,
    /// FXAA; `None` for none.
    pub fxaa: Option<FxaaUniforms>,
}

/// Declares bloom, grading with tone mapping, and FXAA into the output. Returns the output, for passes that draw over it.
///
/// # Errors
/// Returns the error of a refused pass.
pub fn standard(
    frame: &mut Frame<PostWorld>,
    camera: &CameraTextures,
    settings: &StandardPost,
) -> Result<Texture, StageError> {
    let mut handles = Handles::default().with(Slot::HDR, camera.hdr);
    let glow = settings.bloom.filter(BloomSettings::is_seen);
    if let Some(own) = &glow {
        bloom(frame, &mut handles, own, camera.size)?;
    }
    let mixed = glow.zip(handles.find(Slot::BLOOM)).map(|(settings, glow)| BloomMix {
        glow,
        levels: BloomChain::new(&settings, camera.size).levels,
        flare: handles.find(Slot::FLARE),
        dirt: None,
        settings,
    });
    let output = Target::from(camera.output);
    let post = Post {
        hdr: camera.hdr,
        bloom: mixed,
        into: if settings.fxaa.is_some() { Target::New } else { output },
        settings: settings.post,
        only: None,
        for_fxaa: settings.fxaa.is_some(),
        stored: None,
    };
    let graded = frame.add("grade", post)?.ldr;
    let filter = |settings| Fxaa { ldr: graded, into: output, settings };
    let filtered = settings.fxaa.map(|settings| frame.add("fxaa", filter(settings)).map(|io| io.output));
    Ok(filtered.unwrap_or(Ok::<_, DeclareError>(graded))?)
}
