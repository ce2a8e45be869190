//! Stages that make the picture for the display.

use super::lens::mix_of;
use super::{Declared, Settings, StandardWorld};
use crate::fxaa::Fxaa;
use crate::post::{Post, PostEffect};
use crate::stages::{Handles, Slot, StageError};
use crate::upscale::encoded_target;
use framegraph::{Target, Texture};
use framegraph_shaders::layout::FxaaUniforms;
use framegraph_wgpu::Frame;

/// The point-wise effects, in one pass or one pass each.
pub(super) fn post<W: StandardWorld + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &Settings,
) -> Declared {
    let bloom = mix_of(handles, settings);
    let into = if settings.fxaa { handles.target() } else { encoded_target(frame, handles, settings.upscale) };
    let Settings { fxaa, stored, split_post, post: settings, .. } = *settings;
    let hdr = handles.get(Slot::HDR)?;
    let whole = Post { hdr, bloom, into, settings, only: None, for_fxaa: fxaa, stored };
    let picture = if split_post {
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

/// Softens edges.
pub(super) fn fxaa<W: StandardWorld + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &Settings,
) -> Declared {
    let into = encoded_target(frame, handles, settings.upscale);
    let pass = Fxaa { ldr: handles.get(Slot::PICTURE)?, into, settings: FxaaUniforms::default() };
    handles.set(Slot::PICTURE, frame.add("fxaa", pass)?.output);
    Ok(())
}
