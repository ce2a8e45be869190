//! Stages that make the picture for the display.

use crate::effects::bloom::BloomMix;
use crate::effects::fxaa::Fxaa;
use crate::effects::post::{Post, PostEffect, PostSettings};
use crate::effects::upscale::{Upscale, encoded_target};
use crate::grading::GradingTables;
use crate::program::Programs;
use crate::settings::frame_index::FrameIndex;
use crate::stages::{Handles, Slot, StageError};
use framegraph::{Target, Texture};
use framegraph_shaders::layout::FxaaUniforms;
use framegraph_wgpu::{Frame, StoreRounding};

/// Options of declaring post-processing.
#[derive(Clone, Copy)]
pub(super) struct PostWay {
    /// True if an edge filter follows.
    pub fxaa: bool,
    /// See [`Post::stored`].
    pub stored: Option<StoreRounding>,
    /// Declares a pass for each effect.
    pub split: bool,
    /// Upscaling after post-processing.
    pub upscale: Option<Upscale>,
}

/// Declares the point-wise effects, in one pass or in one pass each.
pub(super) fn post<W: AsRef<Programs> + AsRef<FrameIndex> + AsRef<GradingTables> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    (settings, bloom): (PostSettings, Option<BloomMix>),
    way: PostWay,
) -> Result<(), StageError> {
    let into = if way.fxaa { handles.target() } else { encoded_target(frame, handles, way.upscale) };
    let hdr = handles.get(Slot::HDR)?;
    let whole = Post { hdr, bloom, into, settings, only: None, for_fxaa: way.fxaa, stored: way.stored };
    let picture = if way.split {
        frame.scope("post", |frame| {
            let mut color = hdr;
            for effect in settings.effects(bloom.is_some()) {
                let into = if effect == PostEffect::Encode { into } else { Target::New };
                color = frame.add(effect.name(), Post { hdr: color, into, only: Some(effect), ..whole })?.ldr;
            }
            Ok::<Texture, StageError>(color)
        })?
    } else {
        frame.add("post", whole)?.ldr
    };
    handles.set(Slot::PICTURE, picture);
    Ok(())
}

/// Declares FXAA.
pub(super) fn fxaa<W: AsRef<Programs> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    upscale: Option<Upscale>,
) -> Result<(), StageError> {
    let into = encoded_target(frame, handles, upscale);
    let pass = Fxaa { ldr: handles.get(Slot::PICTURE)?, into, settings: FxaaUniforms::default() };
    handles.set(Slot::PICTURE, frame.add("fxaa", pass)?.output);
    Ok(())
}
