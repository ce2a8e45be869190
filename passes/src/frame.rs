//! The standard frame: which passes, composed into one graph.

use crate::color::{Color, ColorIo, HDR_FORMAT};
use crate::fxaa::Fxaa;
use crate::post::{Look, Post, Stage};
use crate::prepass::Prepass;
use crate::shading::Shading;
use crate::shadow::Shadow;
use crate::transmission::{SceneCopy, SceneLevel, Transparent, scene_levels};
use crate::world::World;
use framegraph::{DeclareError, Format, Target, Texture};
use framegraph_scene::{AlphaMode, Lobe, Scene};
use framegraph_shaders::layout::{FxaaUniforms, Grading, ToneMap};
use framegraph_wgpu::Frame;
use framegraph_wgpu::StoreRounding;

/// What the frame is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples per texel of the color pass: 1 or 4.
    pub samples: u8,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// The sun casts shadows.
    pub shadows: bool,
    /// Width and height of the shadow map, in texels.
    pub shadow_map_texels: u32,
    /// Some surface blends: the color pass then says so, and cannot be graded in place.
    pub blended: bool,
    /// Levels of the picture that transmissive surfaces show what is behind them with, at most as many as
    /// [`scene_levels`] of the frame's size; 0: no surface transmits.
    pub scene_levels: u8,
    /// Soften edges of the finished picture.
    pub fxaa: bool,
    /// The tone curve.
    pub tone_map: ToneMap,
    /// Exposure compensation in EV.
    pub compensation_ev: f32,
    /// By how many stops the corners are darker than the middle; 0 is none.
    pub vignette_ev: f32,
    /// Color grading.
    pub grading: Grading,
    /// Amplitude of the dither: 1 is half a code either way, 0 is none.
    pub dither: f32,
    /// Format of the radiance between shading and post-processing.
    pub hdr_format: Format,
    /// Every point-wise effect is a pass of its own, instead of all in one.
    pub split_post: bool,
    /// Where post-processing is inlined into the color pass, round the radiance first as this device would on the way
    /// through a texture: the picture is then the same to the bit as without inlining, at one sample per texel. None
    /// grades what was shaded in 32 bits.
    pub stored: Option<StoreRounding>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            samples: 1,
            shading: Shading::default(),
            shadows: true,
            shadow_map_texels: 2048,
            blended: false,
            scene_levels: 0,
            fxaa: true,
            tone_map: ToneMap::Aces,
            compensation_ev: 0.0,
            vignette_ev: 0.0,
            grading: Grading::NEUTRAL,
            dither: 1.0,
            hdr_format: HDR_FORMAT,
            split_post: false,
            stored: None,
        }
    }
}

impl Settings {
    /// The same frame with the passes that the scene's materials call for, in a picture of this size.
    #[must_use]
    pub fn for_scene(self, scene: &Scene, size_texels: [u32; 2]) -> Self {
        let transmits = scene.lobes().contains(Lobe::Transmission);
        Self {
            blended: scene.materials.iter().any(|m| m.alpha == AlphaMode::Blend),
            scene_levels: if transmits { scene_levels(size_texels) } else { 0 },
            ..self
        }
    }

    /// The part that says how the picture is to look.
    pub const fn look(&self) -> Look {
        let Self { compensation_ev, vignette_ev, grading, tone_map, dither, .. } = *self;
        Look { compensation_ev, vignette_ev, grading, tone_map, dither }
    }

    /// The same frame with another look.
    #[must_use]
    pub const fn with_look(self, look: Look) -> Self {
        let Look { compensation_ev, vignette_ev, grading, tone_map, dither } = look;
        Self { compensation_ev, vignette_ev, grading, tone_map, dither, ..self }
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
    let Settings { samples, shading, shadows, shadow_map_texels, blended, scene_levels, fxaa, hdr_format, .. } =
        *settings;
    let shadow = if shadows { Some(frame.add("shadow", Shadow { map_texels: shadow_map_texels })?) } else { None };
    let depth = frame.add("prepass", Prepass { samples })?;
    let opaque_only = scene_levels > 0;
    let color = Color { depth, shadow, samples, blended, opaque_only, format: hdr_format, shading };
    let ColorIo { mut hdr, samples: hdr_samples, .. } = frame.add("color", color)?;
    if opaque_only {
        let scene = scene(frame, hdr, depth, scene_levels)?;
        let transparent = Transparent { depth, scene, hdr, samples: hdr_samples, shadow, shading };
        hdr = frame.add("transparent", transparent)?.hdr;
    }
    let mut output = post(frame, settings, hdr, if fxaa { Target::New } else { into })?;
    if fxaa {
        output = frame.add("fxaa", Fxaa { ldr: output, into, settings: FxaaUniforms::default() })?.output;
    }
    Ok(FrameIo { hdr, output })
}

/// The picture of what is behind transmissive surfaces: a pass a level.
fn scene(frame: &mut Frame<World>, hdr: Texture, depth: Texture, levels: u8) -> Result<Texture, DeclareError> {
    frame.scope("scene", |frame| {
        let mut scene = frame.add("copy", SceneCopy { hdr, depth, levels })?.scene;
        for level in 1..levels {
            scene = frame.add("level", SceneLevel { scene, level })?.scene;
        }
        Ok(scene)
    })
}

/// The point-wise effects, in one pass or one pass each.
fn post(frame: &mut Frame<World>, settings: &Settings, hdr: Texture, into: Target) -> Result<Texture, DeclareError> {
    let Settings { fxaa, stored, split_post, .. } = *settings;
    let look = settings.look();
    let whole = Post { hdr, into, look, only: None, for_fxaa: fxaa, stored };
    if !split_post {
        return Ok(frame.add("post", whole)?.ldr);
    }
    frame.scope("post", |frame| {
        let mut color = hdr;
        for stage in look.stages() {
            let into = if stage == Stage::Encode { into } else { Target::New };
            color = frame.add(stage.name(), Post { hdr: color, into, only: Some(stage), ..whole })?.ldr;
        }
        Ok(color)
    })
}
