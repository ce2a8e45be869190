//! Passes that make the levels of bloom.

use super::settings::{Blend, BloomSettings, Threshold};
use crate::effects::color::surface::HDR_FORMAT;
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Extent, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::{BloomMixUniforms, BloomUniforms};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/bloom.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["bloom", "glow", "glow_sampler", "level"]], constants: &["NARROW"] };

/// Reduces a picture, or a level of bloom, to a smaller level. Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct BloomFirst {
    /// Pre-exposed radiance with one sample, or a level of bloom.
    pub source: Texture,
    /// Size of the result in texels.
    pub size: [u32; 2],
    /// Number of levels of the result.
    pub levels: u8,
    /// Part of the picture that glows.
    pub settings: BloomSettings,
    /// True if the source is the picture: applies the threshold and discards NaN and infinity.
    pub sifts: bool,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct BloomIo {
    source: View,
    /// The glow, with one level written.
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

/// Makes a level of bloom from the one above. Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct BloomDown {
    /// The glow, with all levels above written.
    pub glow: Texture,
    /// Index of the level, at least 1.
    pub level: u8,
    /// True if a side of the level above is odd.
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

/// Sums a level and all smaller levels. Levels are read instead of blended into, so nothing is loaded. Uses
/// [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct BloomUp {
    /// The glow, with all levels written.
    pub glow: Texture,
    /// Sums of smaller levels; `None` if the next level is the smallest.
    pub sum: Option<Texture>,
    /// Index of the level.
    pub level: u8,
    /// Number of levels of the sums.
    pub levels: u8,
    /// Size of the largest level in texels.
    pub size: [u32; 2],
    /// See [`BloomSettings::narrow`].
    pub narrow: bool,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct BloomUpIo {
    below: View,
    own: View,
    /// The sums, including this level.
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

/// Input of the bloom effect in [`Post`](crate::effects::post::Post).
#[derive(Clone, Copy, Debug)]
pub struct BloomMix {
    /// The summed levels; the first level is read.
    pub glow: Texture,
    /// Number of levels in the sum.
    pub levels: u8,
    /// Lens flare.
    pub flare: Option<Texture>,
    /// Lens dirt, over the whole picture.
    pub dirt: Option<Texture>,
    /// Settings.
    pub settings: BloomSettings,
}

impl BloomMix {
    /// Returns the uniforms of the effect for a picture of `size_px`.
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
