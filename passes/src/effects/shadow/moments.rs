//! Moments of a layer: averages over samples, separable blur, and mip levels.

use super::draw::{ShadowLayer, confine};
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::ShadowBlurUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};
use glam::IVec2;

static SHADER: Module<'static> = library::pass("pass/shadow_blur.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["shadow_blur", "moments"]], constants: &["REACH"] };

/// Step of making a layer of moments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MomentStep {
    /// Horizontal half of a Gaussian blur, into a separate texture.
    Across,
    /// Vertical half of a Gaussian blur, into the layer.
    Up,
    /// Copies averages over samples into the layer.
    Average,
}

/// One step for the moments of the maps of a layer. Each map stays within its rectangle.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBlur {
    /// View of the maps.
    pub view: ViewId,
    /// Shadow settings.
    pub settings: ShadowSettings,
    /// The maps.
    pub layer: ShadowLayer,
    /// Texture of all maps.
    pub maps: Texture,
    /// Result of the previous step, of a layer's size; `None` reads the layer.
    pub source: Option<Texture>,
    /// The step.
    pub step: MomentStep,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBlurIo {
    source: View,
    /// The blurred texture, or the maps.
    pub blurred: Texture,
}

impl Pass for ShadowBlur {
    type Io = ShadowBlurIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ShadowBlurIo, DeclareError> {
        let Self { settings, layer: ShadowLayer { layer, only }, maps, .. } = *self;
        let own = maps.mip(0).layer(layer);
        // A cascade fills its layer. Texels beside other maps are not read.
        let is_whole = layer < u16::from(settings.cascades);
        let anew = if is_whole { Intent::Overwrite } else { Intent::Clear(ClearValue::BLACK) };
        let source = match self.source {
            Some(source) => pass.sampled(source)?,
            None => pass.sampled(own)?,
        };
        let blurred = if self.step == MomentStep::Across {
            let extent = Extent::absolute(settings.map_texels, settings.map_texels);
            let format = settings.filter.moments().unwrap_or(Format::Rg16Float);
            let across = pass.texture("shadow_across", TextureDesc::new(extent, format));
            pass.color(across, anew)?
        } else {
            pass.color(own, if only.is_some() { Intent::Modify } else { anew })?
        };
        Ok(ShadowBlurIo { source, blurred })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for ShadowBlur {
    fn record(&self, io: &ShadowBlurIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let width = self.settings.moments.blur_texels.clamp(1.0, 125.0);
        // Filament's filter: sigma is a sixth of the width, with taps over the whole width.
        let sigma = (width + 1.0) / 6.0;
        let reach = (0.5 * width).ceil() as i32;
        let (step, reach) = match self.step {
            MomentStep::Across => (IVec2::X, reach),
            MomentStep::Up => (IVec2::Y, reach),
            MomentStep::Average => (IVec2::ZERO, 0),
        };
        let (views, programs): (&Views, &Programs) = (world.as_ref(), world.as_ref());
        let program = ProgramDesc { fragment: Some("fs_blur"), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        for (_, map) in self.layer.maps(views.get(self.view)?.shadows(self.settings.layers())?) {
            confine(map, cx)?;
            let first = IVec2::from(map.place.corner.map(|texel| texel as i32));
            let last = first + map.place.texels as i32 - 1;
            let uniforms = ShadowBlurUniforms { step, falloff: -0.5 / (sigma * sigma), _pad: 0.0, first, last };
            let provided = [cx.uniform(&uniforms), cx.view(io.source)?.into()].map(Some);
            FullScreen { constants: &[f64::from(reach)], ..FullScreen::new(program, &[&provided]) }
                .draw(programs, cx)?;
        }
        Ok(())
    }
}

/// Makes one mip level of a layer's moments from the level above.
#[derive(Clone, Copy, Debug)]
pub struct ShadowLevel {
    /// Index of the layer.
    pub layer: u16,
    /// Index of the level, at least 1.
    pub level: u8,
    /// Texture of all maps, with the levels above written.
    pub maps: Texture,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct ShadowLevelIo {
    above: View,
    /// Texture of all maps, including this level.
    pub maps: Texture,
}

impl Pass for ShadowLevel {
    type Io = ShadowLevelIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ShadowLevelIo, DeclareError> {
        let Self { layer, level, maps } = *self;
        let above = pass.sampled(maps.mip(level - 1).layer(layer))?;
        Ok(ShadowLevelIo { above, maps: pass.color(maps.mip(level).layer(layer), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for ShadowLevel {
    fn record(&self, io: &ShadowLevelIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let provided = [None, Some(cx.view(io.above)?.into())];
        let program = ProgramDesc { fragment: Some("fs_halve"), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen::new(program, &[&provided]).draw(world.as_ref(), cx)
    }
}
