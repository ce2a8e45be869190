//! The passes that make levels of what glows.

use super::settings::{Blend, BloomSettings, Threshold};
use crate::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::surface::HDR_FORMAT;
use framegraph::{DeclareError, Extent, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::{BloomMixUniforms, BloomUniforms};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/bloom.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["bloom", "glow", "glow_sampler", "level"]], constants: &["NARROW"] };

/// What glows of a picture, smaller. Of the world it needs [`Programs`].
#[derive(Clone, Copy, Debug)]
pub struct BloomFirst {
    /// Pre-exposed radiance, single-sampled; or what glows of it.
    pub source: Texture,
    /// Size of the result in texels.
    pub size: [u32; 2],
    /// How many levels the result is to have.
    pub levels: u8,
    /// What glows.
    pub settings: BloomSettings,
    /// The source is the picture: what does not glow is left out, and what is not finite.
    pub sifts: bool,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct BloomIo {
    source: View,
    /// What glows; a level of it is written.
    pub glow: Texture,
}

impl Pass for BloomFirst {
    type Io = BloomIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<BloomIo, DeclareError> {
        let source = pass.sampled(self.source.mip(0))?;
        let [width, height] = self.size;
        let desc = TextureDesc::new(Extent::absolute(width, height), HDR_FORMAT).mips(self.levels);
        let glow = pass.texture("glow", desc);
        Ok(BloomIo { source, glow: pass.color(glow.mip(0), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for BloomFirst {
    fn record(&self, io: &BloomIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let BloomSettings { threshold, threshold_at, highlight, fireflies, multiple_px, .. } = self.settings;
        let flag = |on: bool| f32::from(u8::from(on && self.sifts));
        let multiple_px = if self.sifts { multiple_px } else { 1 };
        let (span_px, begin_px) = BloomSettings::span(cx.texels(io.source)?, multiple_px);
        let uniforms = BloomUniforms {
            span_px,
            begin_px,
            threshold: threshold_at,
            hard: flag(threshold == Threshold::Hard),
            per_highlight: highlight.max(1e-3).recip(),
            thresholds: flag(threshold != Threshold::None),
            fireflies: flag(fireflies && threshold != Threshold::None),
            ..BloomUniforms::default()
        };
        let provided = [Some(cx.uniform(&uniforms)), Some(cx.view(io.source)?.into()), None, None];
        draw("fs_first", false, &provided, world.as_ref(), cx)
    }
}

/// A level of what glows, from the one above. Of the world it needs [`Programs`].
#[derive(Clone, Copy, Debug)]
pub struct BloomDown {
    /// All levels above are written.
    pub glow: Texture,
    /// Which one, at least 1.
    pub level: u8,
    /// A side of the level above is odd.
    pub odd: bool,
}

impl Pass for BloomDown {
    type Io = BloomIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<BloomIo, DeclareError> {
        let source = pass.sampled(self.glow.mip(self.level - 1))?;
        Ok(BloomIo { source, glow: pass.color(self.glow.mip(self.level), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for BloomDown {
    fn record(&self, io: &BloomIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let sampler = cx.sampler(SamplerDesc::LINEAR).into();
        let provided = [None, Some(cx.view(io.source)?.into()), Some(sampler), None];
        let fragment = if self.odd { "fs_down_odd" } else { "fs_down" };
        draw(fragment, false, &provided, world.as_ref(), cx)
    }
}

/// The sum of a level and of all that are smaller. The levels are read, not blended into: nothing is loaded. Of the world it
/// needs [`Programs`].
#[derive(Clone, Copy, Debug)]
pub struct BloomUp {
    /// What glows, all levels written.
    pub glow: Texture,
    /// The sums of smaller levels; none where the next is the smallest.
    pub sum: Option<Texture>,
    /// Which level.
    pub level: u8,
    /// How many levels the sums have.
    pub levels: u8,
    /// Size of the largest, in texels.
    pub size: [u32; 2],
    /// See [`BloomSettings::narrow`].
    pub narrow: bool,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct BloomUpIo {
    below: View,
    own: View,
    /// The sums, this level written too.
    pub sum: Texture,
}

impl Pass for BloomUp {
    type Io = BloomUpIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<BloomUpIo, DeclareError> {
        let own = pass.sampled(self.glow.mip(self.level))?;
        let below = pass.sampled(self.sum.unwrap_or(self.glow).mip(self.level + 1))?;
        let [width, height] = self.size;
        let desc = TextureDesc::new(Extent::absolute(width, height), HDR_FORMAT).mips(self.levels);
        let sum = self.sum.unwrap_or_else(|| pass.texture("glow_sum", desc));
        Ok(BloomUpIo { below, own, sum: pass.color(sum.mip(self.level), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for BloomUp {
    fn record(&self, io: &BloomUpIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let sampler = cx.sampler(SamplerDesc::LINEAR).into();
        let provided = [None, Some(cx.view(io.below)?.into()), Some(sampler), Some(cx.view(io.own)?.into())];
        draw("fs_up", self.narrow, &provided, world.as_ref(), cx)
    }
}

fn draw(
    fragment: &'static str,
    narrow: bool,
    provided: &[Option<framegraph_wgpu::Binding>],
    programs: &Programs,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let program = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&SHADER, &INTERFACE) };
    FullScreen { constants: &[f64::from(narrow)], ..FullScreen::new(program, &[provided]) }.draw(programs, cx)
}

/// What [`Post`](crate::post::Post) lays over the picture.
#[derive(Clone, Copy, Debug)]
pub struct BloomMix {
    /// All levels of what glows, added up: its first level is read.
    pub glow: Texture,
    /// How many levels were added up.
    pub levels: u8,
    /// Lens flare.
    pub flare: Option<Texture>,
    /// What dirt on the lens lets light up, over the whole picture.
    pub dirt: Option<Texture>,
    /// How.
    pub settings: BloomSettings,
}

impl BloomMix {
    /// As the effect reads it, for a picture of `size_px`.
    pub(crate) fn uniforms(&self, size_px: [u32; 2]) -> BloomMixUniforms {
        let BloomSettings { strength, blend, dirt, multiple_px, .. } = self.settings;
        let (span, begin_px) = BloomSettings::span(size_px, multiple_px);
        let glow = strength / f32::from(self.levels.max(1));
        let picture = match blend {
            Blend::Add => 1.0,
            Blend::Interpolate => 1.0 - glow,
        };
        BloomMixUniforms { glow, picture, flare: strength, dirt, begin_px, per_px: span.map(f32::recip) }
    }
}
