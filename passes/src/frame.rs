//! The standard frame: which passes, composed into one graph.

use crate::color::Color;
use crate::fxaa::Fxaa;
use crate::post::Post;
use crate::prepass::Prepass;
use crate::shadow::Shadow;
use crate::world::World;
use framegraph::{DeclareError, Target, Texture};
use renderer::Frame;
use shaders::layout::{FxaaUniforms, ToneMap};

/// What the frame is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples per texel of the color pass: 1 or 4.
    pub samples: u8,
    /// The sun casts shadows.
    pub shadows: bool,
    /// Width and height of the shadow map, in texels.
    pub shadow_map_texels: u32,
    /// Some surface blends: the color pass then says so, and cannot be graded in place.
    pub blended: bool,
    /// Soften edges of the finished picture.
    pub fxaa: bool,
    /// The tone curve.
    pub tone_map: ToneMap,
    /// Exposure compensation in EV.
    pub compensation_ev: f32,
    /// Amplitude of the dither: 1 is half a code either way, 0 is none.
    pub dither: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            samples: 1,
            shadows: true,
            shadow_map_texels: 2048,
            blended: false,
            fxaa: true,
            tone_map: ToneMap::Aces,
            compensation_ev: 0.0,
            dither: 1.0,
        }
    }
}

/// The frame's results.
#[derive(Clone, Copy, Debug)]
pub struct FrameIo {
    /// Scene-referred radiance times exposure, linear Rec.709, single-sampled.
    pub hdr: Texture,
    /// The finished picture.
    pub output: Texture,
}

/// Declares the standard frame, its picture going into `into`.
///
/// # Errors
/// What a pass refuses: a target of another graph, or of a format that cannot be drawn into.
pub fn standard(frame: &mut Frame<World>, settings: &Settings, into: Target) -> Result<FrameIo, DeclareError> {
    let Settings { samples, shadows, shadow_map_texels, blended, fxaa, tone_map, compensation_ev, dither } = *settings;
    let shadow = if shadows { Some(frame.add("shadow", Shadow { map_texels: shadow_map_texels })?) } else { None };
    let depth = frame.add("prepass", Prepass { samples })?;
    let hdr = frame.add("color", Color { depth, shadow, samples, blended })?.hdr;
    let target = if fxaa { Target::New } else { into };
    let post = Post { hdr, into: target, tone_map, compensation_ev, dither, for_fxaa: fxaa };
    let mut output = frame.add("post", post)?.ldr;
    if fxaa {
        output = frame.add("fxaa", Fxaa { ldr: output, into, settings: FxaaUniforms::default() })?.output;
    }
    Ok(FrameIo { hdr, output })
}
